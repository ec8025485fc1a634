#include "errors/excerpt.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <vector>

#include "lua/tokens.hpp"
#include "terminal/display.hpp"

namespace dinal::errors {
namespace {

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

/// The words of the source that the message may be about, the likeliest first: what the suggestion
/// and the message quote, then the option in "system: I = -1 must ...", then the function at the head of it.
std::vector<std::string> suspects(std::string_view words, std::string_view suggestion) {
    const std::string_view sentence = words.substr(0, words.find('\n'));
    std::vector<std::string> names;
    if (suggestion.starts_with("; '")) {
        names = quoted_words(suggestion.substr(0, suggestion.find(" is nil")));
    }
    const std::vector<std::string> quoted = quoted_words(sentence);
    for (const std::string& name : quoted) {
        names.insert(names.end(), {name, '"' + name + '"', "'" + name + "'"});
    }
    if (words.starts_with("there is no ") || words.starts_with("use a colon: ")) {
        const std::string_view name = words.substr(0, words.find_first_of(";{(", 13));
        for (const lua::Token& token :
             lua::tokens(name.substr(name.find_first_of(" :") + 1))) {  // the object, then the member
            names.insert(words.starts_with("use") ? names.end() : names.begin(), std::string(token.text));
        }
    }
    if (words.starts_with("M returned ")) {
        names.insert(names.end(), {"return", "function"});
    }
    if (words.find("for iterator") != std::string_view::npos) {
        names.emplace_back("in");
    }
    const std::size_t head = std::min(words.find(": "), words.find(" needs "));
    if (head != std::string_view::npos) {
        for (const lua::Token& token : lua::tokens(words.substr(head + 1).substr(0, 60))) {
            if (token.kind == lua::TokenKind::name && !token.is("needs")) {
                names.emplace_back(token.text);
                break;
            }
        }
    }
    const std::string_view call = words.substr(0, words.find_first_of(" ({"));
    for (const lua::Token& token : lua::tokens(call)) {
        if (token.kind == lua::TokenKind::name) {
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
std::optional<Mark> marked(std::string_view statement, const std::vector<std::string>& names) {
    const std::vector<lua::Token> all = lua::tokens(statement);
    for (const std::string& name : names) {
        for (const lua::Token& token : all) {
            if (token.text == name && token.kind != lua::TokenKind::comment) {
                return Mark{token.at, token.text.size()};
            }
        }
    }
    return std::nullopt;
}

/// The line, cut so that the mark is on the screen, and the mark below it.
std::string excerpt_of(std::string_view line, int number, Mark mark, const terminal::Display& screen) {
    std::string text = terminal::printable(line, screen);
    mark.at = terminal::printable(line.substr(0, mark.at), screen).size();
    const std::string head = fmt::format("{:>4} | ", number);
    const std::size_t room = std::max<std::size_t>(screen.width, head.size() + 12) - head.size() - 1;
    std::size_t indent = std::min(text.find_first_not_of(' '), mark.at);
    text.erase(0, indent);
    mark.at -= indent;
    if (terminal::columns(text) > room && mark.at + mark.size > room) {
        const std::size_t cut = std::min(mark.at, mark.at + mark.size + 4 - std::min(room, mark.at + mark.size + 4));
        text = "..." + text.substr(std::min(cut + 3, text.size()));
        mark.at -= std::min(cut, mark.at);
    }
    while (terminal::columns(text) > room) {
        text.pop_back();
    }
    const std::size_t column = terminal::columns(text.substr(0, std::min(mark.at, text.size())));
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
    int number = 0;
    const std::string_view digits = message.words.substr(line + 9);
    std::from_chars(digits.data(), digits.data() + digits.size(), number);
    return Message{message.chunk, number, message.words.substr(close + 10, line - close - 10)};
}

/// The excerpt with the mark at a place in the text that begins with the line of that number.
std::string marked_excerpt(std::string_view text, int number, Mark mark) {
    for (std::size_t end = text.find('\n'); end < mark.at && end != std::string_view::npos; end = text.find('\n')) {
        mark.at -= end + 1;
        text.remove_prefix(end + 1);
        ++number;
    }
    return excerpt_of(text.substr(0, text.find('\n')), number, mark, terminal::display_of(STDERR_FILENO));
}

bool compiles_so_far(lua_State* L, std::string_view text) {
    const int status = luaL_loadbufferx(L, text.data(), text.size(), "=part", "t");
    const bool good = status == LUA_OK || std::string_view(lua_tostring(L, -1)).ends_with("<eof>");
    lua_pop(L, 1);
    return good;
}

/// The message has the beginning of a malformed number, and of a letter that is not plain its first byte: <\\206>.
bool may_be(const lua::Token& token, std::string_view near) {
    return token.text == near || (token.kind == lua::TokenKind::number && token.text.starts_with(near)) ||
           (near.starts_with("<\\") && static_cast<unsigned char>(token.text.front()) >= 0x80);
}

/// The token that the parser does not accept: the first one of that line and text with which the chunk is wrong
/// however it goes on.
std::optional<Mark> stumbled_at(lua_State* L, const SourceText& source, const Message& message) {
    const std::vector<std::string> names =
        quoted_words(message.words.substr(std::min(message.words.rfind("near '"), message.words.size())));
    std::string text = source.text;
    if (text.starts_with("#!")) {
        text.replace(0, 2, "--");  // Lua skips such a line in files only
    }
    for (const lua::Token& token : lua::tokens(text)) {
        const bool candidate = token.line == message.line && !names.empty() && may_be(token, names.front());
        if (candidate && !compiles_so_far(L, std::string_view(text).substr(0, token.end()))) {
            return Mark{token.at, token.text.size()};
        }
    }
    return std::nullopt;
}

}  // namespace

std::string excerpt(const SourceText& source, const Message& message, std::string_view suggestion) {
    const std::string_view statement = source.statement(message.line);
    auto mark = marked(statement, suspects(message.words, suggestion));
    if (statement.empty() || (!mark && source.text.find('\n') == std::string::npos)) {
        return "";  // the one line was typed just now
    }
    if (!mark) {
        mark = marked(statement, {"error", "assert"});
    }
    const std::size_t begin = std::min(statement.find_first_not_of(" \t"), statement.size());
    return marked_excerpt(statement, message.line, mark.value_or(Mark{begin, 1}));
}

std::string syntax_excerpt(lua_State* L, const SourceText& source, const Message& message) {
    if (const auto mark = stumbled_at(L, source, message)) {
        return marked_excerpt(source.text, source.first_line, *mark);
    }
    if (const auto opener = unclosed(message)) {
        return excerpt(source, *opener, "");
    }
    const std::string_view line = source.line(message.line);
    const std::size_t last = line.find_last_not_of(" \t\r");
    return last == std::string_view::npos ? "" : marked_excerpt(line, message.line, {last + 1, 1});
}

}  // namespace dinal::errors
