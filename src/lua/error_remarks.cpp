#include "lua/error_remarks.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <vector>

#include "io/screen.hpp"
#include "lua/misspelling.hpp"
#include "lua/source_text.hpp"
#include "lua/tokens.hpp"

namespace dinal {
namespace {

const char memory_key = 0;  // registry key of { error value, suggestion, excerpt, during, raised again }

std::vector<std::string> quoted_words(std::string_view words) {
    std::vector<std::string> found;
    for (std::size_t at = words.find('\''); at != std::string_view::npos; at = words.find('\'', at)) {
        const std::size_t end = words.find('\'', at + 1);
        if (end == std::string_view::npos) {
            break;
        }
        found.emplace_back(words.substr(at + 1, end - at - 1));
        at = end + 1;
    }
    return found;
}

/// The words of the source that the message may be about, the likeliest first: near which it was, what the suggestion
/// and the message quote, then the option in "system: I = -1 must ...", then the function at the head of it.
std::vector<std::string> suspects(std::string_view words, std::string_view suggestion) {
    const std::string_view sentence = words.substr(0, words.find('\n'));
    std::vector<std::string> names;
    if (const std::size_t near = sentence.rfind("near '"); near != std::string_view::npos) {
        names = quoted_words(sentence.substr(near));
    }
    if (suggestion.starts_with("; '")) {
        names = quoted_words(suggestion.substr(0, suggestion.find(" is nil")));
    }
    const std::vector<std::string> quoted = quoted_words(sentence);
    names.insert(names.end(), quoted.begin(), quoted.end());
    const std::size_t head = std::min(words.find(": "), words.find(" needs "));
    if (head != std::string_view::npos) {
        for (const Token& token : tokens(words.substr(head + 1).substr(0, 60))) {
            if (token.kind == TokenKind::name && !token.is("needs")) {
                names.emplace_back(token.text);
                break;
            }
        }
    }
    const std::string_view call = words.substr(0, words.find_first_of(" ({"));
    for (const Token& token : tokens(call)) {
        if (token.kind == TokenKind::name) {
            names.insert(names.end(), std::string(token.text));
        }
    }
    return names;
}

struct Mark {
    std::size_t at = 0;
    std::size_t size = 1;
};

/// Where in the statement the first of the suspects stands. None when nothing is known but the line.
std::optional<Mark> marked(std::string_view statement, const std::vector<std::string>& names, bool stumbled) {
    const std::vector<Token> all = tokens(statement);
    for (const std::string& suspect : names) {
        const auto is_suspect = [&suspect](const Token& token) {
            return token.text == suspect && token.kind != TokenKind::comment;
        };
        // What a parser stumbles over stands behind what it has accepted.
        const bool last = &suspect == &names.front() && stumbled;
        const auto behind = std::find_if(all.rbegin(), all.rend(), is_suspect);
        const auto first = std::find_if(all.begin(), all.end(), is_suspect);
        if (first != all.end()) {
            const Token& token = last ? *behind : *first;
            return Mark{token.at, token.text.size()};
        }
    }
    return std::nullopt;
}

/// The line, cut so that the mark is on the screen, and the mark below it.
std::string excerpt_of(std::string_view line, int number, Mark mark, const Screen& screen) {
    std::string text = printable(line, screen);
    mark.at = printable(line.substr(0, mark.at), screen).size();
    const std::string head = fmt::format("{:>4} | ", number);
    const std::size_t room = std::max<std::size_t>(screen.width, head.size() + 12) - head.size() - 1;
    std::size_t indent = std::min(text.find_first_not_of(' '), mark.at);
    text.erase(0, indent);
    mark.at -= indent;
    if (columns(text) > room && mark.at + mark.size > room) {
        const std::size_t cut = std::min(mark.at, mark.at + mark.size + 4 - std::min(room, mark.at + mark.size + 4));
        text = "..." + text.substr(std::min(cut + 3, text.size()));
        mark.at -= std::min(cut, mark.at);
    }
    while (columns(text) > room) {
        text.pop_back();
    }
    const std::size_t column = columns(text.substr(0, std::min(mark.at, text.size())));
    const std::size_t size = std::clamp<std::size_t>(mark.size, 1, room > column ? room - column : 1);
    const std::string carets(size, '^');
    return fmt::format("\n{}{}\n     | {}{}{}{}", head, text, std::string(column, ' '), screen.colour ? "\x1b[31m" : "",
                       carets, screen.colour ? "\x1b[0m" : "");
}

/// "'end' expected (to close 'if' at line 1) near <eof>": what was opened there.
std::optional<Message> unclosed(const Message& message) {
    const std::size_t close = message.words.find("(to close ");
    const std::size_t line = message.words.find(" at line ");
    if (close == std::string_view::npos || line == std::string_view::npos) {
        return std::nullopt;
    }
    const std::string number(message.words.substr(line + 9, message.words.find(')', line) - line - 9));
    return Message{message.chunk, std::atoi(number.c_str()), message.words.substr(close + 10, line - close - 10)};
}

/// `suggestion` is that of help_with().
std::string excerpt_from(const SourceText& source, const Message& message, std::string_view suggestion) {
    const Screen screen = screen_of(STDERR_FILENO);
    if (const auto opener = unclosed(message); opener && message.words.ends_with("near <eof>")) {
        return excerpt_from(source, *opener, suggestion);
    }
    const std::string_view statement = source.statement(message.line);
    if (statement.empty()) {
        return "";
    }
    auto found =
        marked(statement, suspects(message.words, suggestion), message.words.find(" near '") != std::string_view::npos);
    if (message.words.ends_with("near <eof>")) {
        found = Mark{statement.find_last_not_of(" \t\r\n") + 1, 1};
    }
    if (!found && source.text.find('\n') == std::string::npos) {
        return "";  // the one line was typed just now
    }
    if (!found) {
        found = marked(statement, {"error", "assert"}, false);
    }
    Mark mark = found.value_or(Mark{std::min(statement.find_first_not_of(" \t"), statement.size()), 1});
    int number = message.line;
    std::string_view rest = statement;
    for (std::size_t end = rest.find('\n'); end < mark.at && end != std::string_view::npos; end = rest.find('\n')) {
        mark.at -= end + 1;
        rest.remove_prefix(end + 1);
        ++number;
    }
    return excerpt_of(rest.substr(0, rest.find('\n')), number, mark, screen);
}

Remarks fresh_remarks(lua_State* L, std::string_view text) {
    Remarks remarks;
    const auto message = parse_message(text);
    if (!message) {
        return remarks;
    }
    lua_Debug frame{};
    const bool there = find_frame(L, *message, frame);
    const auto source = there ? source_of_frame(L, frame) : source_running(L, message->chunk);
    const std::string_view statement = source ? source->statement(message->line) : std::string_view();
    remarks.suggestion = help_with(L, there ? &frame : nullptr, message->words, statement);
    if (source) {
        remarks.excerpt = excerpt_from(*source, *message, remarks.suggestion);
    }
    return remarks;
}

std::string text_item(lua_State* L, int table, int item) {
    lua_rawgeti(L, table, item);
    std::string text = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "";
    lua_pop(L, 1);
    return text;
}

/// Pushes the table of remembered remarks on the error value at `index`; false (and nothing) when there are none.
bool push_memory(lua_State* L, int index) {
    index = lua_absindex(L, index);
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &memory_key) == LUA_TTABLE) {
        lua_rawgeti(L, -1, 1);
        const bool same = lua_rawequal(L, -1, index) != 0;
        lua_pop(L, 1);
        if (same) {
            return true;
        }
    }
    lua_pop(L, 1);
    return false;
}

void set_item(lua_State* L, int item, const std::string& text) {
    lua_pushlstring(L, text.data(), text.size());
    lua_rawseti(L, -2, item);
}

}  // namespace

Remarks remarks_on(lua_State* L, int index) {
    luaL_checkstack(L, LUA_MINSTACK, "for the remarks on an error");
    index = lua_absindex(L, index);
    if (push_memory(L, index)) {
        const int memory = lua_gettop(L);
        Remarks remarks{text_item(L, memory, 2), text_item(L, memory, 3), text_item(L, memory, 4)};
        lua_pop(L, 1);
        return remarks;
    }
    if (lua_type(L, index) != LUA_TSTRING) {
        return {};
    }
    return fresh_remarks(L, lua_tostring(L, index));
}

Remarks remarks_on_syntax(lua_State* L, int index, const char* file) {
    const std::string text = lua_tostring(L, index);
    const auto message = parse_message(text);
    if (!message) {
        return {};
    }
    const auto source = file != nullptr ? source_of_file(file) : source_kept(L, message->chunk);
    const std::string_view statement = source ? source->statement(message->line) : std::string_view();
    Remarks remarks;
    remarks.suggestion = help_with(L, nullptr, message->words, statement);
    remarks.excerpt = source ? excerpt_from(*source, *message, remarks.suggestion) : "";
    return remarks;
}

int remember_remarks(lua_State* L) {
    // NOTE: texts that are equal may be two errors; it is the same one only when it has been raised again.
    if (push_memory(L, 1)) {
        const bool again = lua_rawgeti(L, -1, 5) == LUA_TBOOLEAN;
        lua_pop(L, 1);
        lua_pushnil(L);
        lua_rawseti(L, -2, 5);
        lua_settop(L, 1);
        if (again) {
            return 1;
        }
    }
    const Remarks remarks = lua_type(L, 1) == LUA_TSTRING ? fresh_remarks(L, lua_tostring(L, 1)) : Remarks{};
    lua_createtable(L, 4, 0);
    lua_pushvalue(L, 1);
    lua_rawseti(L, -2, 1);
    set_item(L, 2, remarks.suggestion);
    set_item(L, 3, remarks.excerpt);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &memory_key);
    return 1;
}

void remember_time(lua_State* L, double t) {
    luaL_checkstack(L, LUA_MINSTACK, "for the remarks on an error");
    if (push_memory(L, -1)) {
        const int memory = lua_gettop(L);
        set_item(L, 4, text_item(L, memory, 4) + fmt::format("\n  in M at t = {:.14g}", t));
        lua_pop(L, 1);
    }
}

void keep_remarks(lua_State* L) {
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &memory_key) == LUA_TTABLE) {
        lua_pushboolean(L, 1);
        lua_rawseti(L, -2, 5);
    }
    lua_pop(L, 1);
}

}  // namespace dinal
