#include "errors/error_remarks.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "errors/advice.hpp"
#include "files/file.hpp"
#include "lua/lua_headers.hpp"
#include "lua/lua_message.hpp"
#include "lua/lua_text.hpp"
#include "source/function_source.hpp"
#include "terminal/display.hpp"
#include "text/characters.hpp"
#include "text/expected.hpp"
#include "text/words.hpp"

namespace dinal::errors {

std::optional<Message> parse_message(std::string_view message) {
    for (std::size_t colon = message.find(':'); colon != std::string_view::npos; colon = message.find(':', colon + 1)) {
        std::size_t end = colon + 1;
        int line = 0;
        while (end < message.size() && text::is_digit(message[end]) && line < 100'000'000) {
            line = 10 * line + (message[end++] - '0');
        }
        if (line > 0 && message.substr(end, 2) == ": ") {
            return Message{message.substr(0, colon), line, message.substr(end + 2)};
        }
        if (message.substr(0, colon).find('\n') != std::string_view::npos) {
            break;
        }
    }
    return std::nullopt;
}

bool find_frame(lua_State* L, const Message& message, lua_Debug& frame) {
    constexpr int deepest = 100;  // in a deep recursion the error is near the top
    for (int level = 0; level < deepest && lua_getstack(L, level, &frame) != 0; ++level) {
        lua_getinfo(L, "Sl", &frame);
        if (frame.currentline == message.line && message.chunk == frame.short_src) {
            return true;
        }
    }
    return false;
}

std::string_view SourceText::line(int number) const {
    const std::vector<std::string_view> lines = text::split(text, '\n');
    const auto place = static_cast<std::size_t>(number - first_line);
    return number < first_line || place >= lines.size() ? std::string_view() : lines[place];
}

std::string_view SourceText::statement(int number) const {
    const std::string_view first = line(number);
    if (first.empty()) {
        return {};
    }
    const auto begin = static_cast<std::size_t>(first.data() - text.data());
    const std::string_view rest = std::string_view(text).substr(begin);
    constexpr std::size_t longest = 10'000;  // bytes
    int depth = 0;
    for (const lua::Token& token : lua::tokens(rest.substr(0, longest))) {
        if (depth <= 0 && token.at > first.size()) {
            return rest.substr(0, std::max(first.size(), token.at - 1));
        }
        depth += token.nesting();
    }
    return rest.substr(0, longest);
}

std::optional<SourceText> source_of_frame(lua_State* L, lua_Debug& frame) {
    lua_getinfo(L, "Sf", &frame);  // pushes the function
    const std::string_view source = frame.source;
    std::optional<SourceText> found;
    if (source.starts_with('@')) {
        found = source_of_file(std::string(source.substr(1)));
    } else if (!source.starts_with('=')) {
        found = SourceText{std::string(source)};  // load("...")
    } else if (frame.what == std::string_view("main")) {
        found = source_kept(L, source.substr(1));
    } else if (const auto text = source::function_source(L, -1)) {
        found = SourceText{*text, frame.linedefined};
    }
    lua_pop(L, 1);
    return found;
}

std::optional<SourceText> source_of_file(const std::string& path) {
    std::error_code wrong;
    if (!std::filesystem::is_regular_file(path, wrong)) return std::nullopt;  // /dev/zero has no end
    auto text = files::read_file(path);
    return text ? std::optional(SourceText{std::move(text).value()}) : std::nullopt;
}

std::optional<SourceText> source_kept(lua_State* L, std::string_view chunk) {
    const auto text = source::last_kept_source(L, "=" + std::string(chunk));
    return text ? std::optional(SourceText{*text}) : std::nullopt;
}

std::optional<SourceText> source_running(lua_State* L, std::string_view chunk) {
    lua_Debug frame{};
    for (int level = 0; level < 100 && lua_getstack(L, level, &frame) != 0; ++level) {
        lua_getinfo(L, "S", &frame);
        if (chunk == frame.short_src && *frame.source == '@') {
            return source_of_file(frame.source + 1);
        }
    }
    return std::nullopt;
}

namespace {

// Remarks on a value alone on a line of a script, which only the prompt accepts.

bool compiles(lua_State* L, const std::string& text) {
    const bool good = luaL_loadbufferx(L, text.data(), text.size(), "=part", "t") == LUA_OK;
    lua_pop(L, 1);
    return good;
}

/// The line without a final comment and semicolons.
std::string_view code_of(std::string_view line) {
    std::size_t end = 0;
    for (const lua::Token& token : lua::tokens(line)) {
        if (token.kind != lua::TokenKind::comment && !token.is(";")) end = token.end();
    }
    return text::trimmed(line.substr(0, end), " \t");
}

bool is_value(lua_State* L, std::string_view code) {
    return !code.empty() && compiles(L, "return " + std::string(code)) && !compiles(L, std::string(code));
}

/// "; a value alone is not a statement: print(6*7) shows it", for the error's line or the one before; or "".
std::string bare_value(lua_State* L, const SourceText& source, int line, const lua::SyntaxMessage& message) {
    luaL_checkstack(L, LUA_MINSTACK, "for a value alone on a line");
    if (message.complaint != "syntax error" && message.complaint != "unexpected symbol") return "";
    // The parser rejects a name as a statement only at the next token, possibly on a later line.
    for (int number = line; number >= source.first_line && number + 2 > line; --number) {
        const std::string_view code = code_of(source.line(number));
        if (!is_value(L, code)) continue;
        constexpr std::size_t longest = 40;
        const std::string where = number == line ? "a value alone" : fmt::format("line {}, a value alone,", number);
        return fmt::format("; {} is not a statement: print({}) shows it", where, code.size() > longest ? "..." : code);
    }
    return "";
}

// The source line of an error with a mark below it.

/// Adds a name, also in quotes, as a key or choice may be written.
void add_name(std::vector<std::string>& names, std::string_view name) {
    if (!name.empty()) {
        names.insert(names.end(), {std::string(name), fmt::format("\"{}\"", name), fmt::format("'{}'", name)});
    }
}

struct Mark {
    std::size_t at = 0;
    std::size_t size = 1;
};

/// Returns whether the token is a value, of which a statement may contain several.
bool is_value(const lua::Token& token) {
    return token.kind == lua::TokenKind::number || token.is("nil") || token.is("true") || token.is("false");
}

/// The place of the first suspect in the statement; none if only the line is known.
std::optional<Mark> marked(std::string_view statement, const std::vector<std::string>& names) {
    const lua::Tokens all = lua::tokens(statement);
    for (const std::string& name : names) {
        const auto is_it = [&name](const lua::Token& token) {
            return token.text == name && token.kind != lua::TokenKind::comment;
        };
        const auto found = std::ranges::find_if(all, is_it);
        if (found != all.end() && (!is_value(*found) || std::none_of(found + 1, all.end(), is_it))) {
            return Mark{found->at, found->text.size()};
        }
    }
    return std::nullopt;
}

/// The line, cut so that the mark is visible, with the mark below it.
std::string excerpt_of(std::string_view line, int number, Mark mark, const terminal::Display& screen) {
    std::string text = terminal::spelled(text::displayable(line), screen);
    mark.at = terminal::spelled(text::displayable(line.substr(0, mark.at)), screen).size();
    const std::string head = fmt::format("{:>4} | ", number);
    const std::size_t room = std::max<std::size_t>(screen.width, head.size() + 12) - head.size() - 1;
    std::size_t indent = std::min(text.find_first_not_of(' '), mark.at);
    text.erase(0, indent);
    mark.at -= indent;
    if (text::columns(text) > room && mark.at + mark.size > room) {
        const std::size_t cut = std::min(mark.at, mark.at + mark.size + 4 - std::min(room, mark.at + mark.size + 4));
        text = "..." + text.substr(std::min(cut + 3, text.size()));
        mark.at -= std::min(cut, mark.at);
    }
    text = text::cut_to_columns(text, room);
    const std::size_t column = text::columns(text.substr(0, std::min(mark.at, text.size())));
    const std::size_t size = std::clamp<std::size_t>(mark.size, 1, room > column ? room - column : 1);
    const std::string carets(size, '^');
    return fmt::format("\n{}{}\n     | {}{}{}{}", head, text, std::string(column, ' '), screen.colour ? "\x1b[31m" : "",
                       carets, screen.colour ? "\x1b[0m" : "");
}

/// The excerpt around the mark, in a text whose first line has this number.
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
    const bool good = status == LUA_OK || lua::is_about_end(lua_tostring(L, -1));
    lua_pop(L, 1);
    return good;
}

/// Returns whether the token fits the message, which has only the beginning of a malformed number, and only the first
/// byte of a non-ASCII letter: <\\206>.
bool may_be(const lua::Token& token, std::string_view near) {
    return token.text == near ||
           (token.kind == lua::TokenKind::number && !near.empty() && token.text.starts_with(near)) ||
           (near.starts_with("<\\") && static_cast<unsigned char>(token.text.front()) >= 0x80);
}

/// The token that the parser rejects: the first one on that line with that text after which no continuation compiles.
std::optional<Mark> stumbled_at(lua_State* L, const SourceText& source, int line, std::string_view near) {
    std::string text = source.text;
    if (text.starts_with("#!")) {
        text.replace(0, 2, "--");  // Lua skips such a line in files only
    }
    for (const lua::Token& token : lua::tokens(text)) {
        if (token.line == line && may_be(token, near) &&
            !compiles_so_far(L, std::string_view(text).substr(0, token.end()))) {
            return Mark{token.at, token.text.size()};
        }
    }
    return std::nullopt;
}

/// Words of the source that an error may be about, the likeliest first.
std::vector<std::string> suspects(const text::Error& error) {
    std::vector<std::string> names;
    add_name(names, error.option.empty() ? error.culprit : error.option);
    const std::string call = error.call.substr(0, error.call.find_first_of("({"));  // the tokens are views into it
    for (const lua::Token& token : lua::tokens(call)) {
        if (token.kind == lua::TokenKind::name) {
            names.emplace_back(token.text);
        }
    }
    return names;
}

std::vector<std::string> suspects(const lua::LuaMessage& message) {
    std::vector<std::string> names;
    for (const std::string_view quoted : message.quoted) {
        add_name(names, quoted);
    }
    if (message.kind == "for iterator") {
        names.emplace_back("in");
    }
    return names;
}

/// "\n  10 | x = sytem{}\n     |     ^^^^^", with the mark below the first suspect found. Empty if the line is
/// unavailable, or if it is the only one, just typed, and has no suspect.
std::string excerpt(const SourceText& source, int line, const std::vector<std::string>& suspects) {
    const std::string_view statement = source.statement(line);
    auto mark = marked(statement, suspects);
    if (statement.empty() || (!mark && source.text.find('\n') == std::string::npos)) {
        return "";  // the only line was just typed
    }
    if (!mark) {
        mark = marked(statement, {"error", "assert"});
    }
    const std::size_t begin = std::min(statement.find_first_not_of(" \t"), statement.size());
    return marked_excerpt(statement, line, mark.value_or(Mark{begin, 1}));
}

/// The same for a chunk that does not compile, with the message in that line.
std::string syntax_excerpt(lua_State* L, const SourceText& source, int line, const lua::SyntaxMessage& message) {
    if (const auto mark = stumbled_at(L, source, line, message.near)) {
        return marked_excerpt(source.text, source.first_line, *mark);
    }
    if (!message.opened.empty()) {
        return excerpt(source, message.opened_line, {std::string(message.opened)});
    }
    const std::string_view text = source.line(line);
    const std::size_t last = text.find_last_not_of(" \t\r");
    return last == std::string_view::npos ? "" : marked_excerpt(text, line, {last + 1, 1});
}

// The remarks.

std::string_view statement_of(const std::optional<SourceText>& source, int line) {
    return source ? source->statement(line) : std::string_view();
}

/// The remarks on an error of dinal or of Lua.
template <class Error>
lua::Remarks remarks(lua_State* L, lua_Debug* frame, const Error& error, const std::optional<SourceText>& source,
                     int line) {
    const Advice advice = advice_on(L, frame, error, statement_of(source, line));
    std::vector<std::string> names = suspects(error);
    if (!advice.culprit.empty()) {
        names.insert(names.begin(), advice.culprit);
    }
    return {advice.end_of_sentence, source ? excerpt(*source, line, names) : "", ""};
}

/// The remarks on a message about the result of the function at the index.
lua::Remarks remarks_on_result(const text::Error& error, const SourceText& source, int line) {
    const lua::Tokens all = lua::tokens(source.text);
    const bool returns = std::ranges::any_of(all, [](const lua::Token& t) { return t.is("return"); });
    std::vector<std::string> names = suspects(error);
    names.insert(names.end(), {"return", "function"});
    return {error.culprit == "nil" && !returns ? "; is the word return missing?" : "", excerpt(source, line, names),
            ""};
}

}  // namespace

lua::Remarks first_remarks(lua_State* L, int error, int function) {
    luaL_checkstack(L, LUA_MINSTACK, "for the remarks on an error");
    const std::string text = lua_type(L, error) == LUA_TSTRING ? lua_tostring(L, error) : "";
    const auto message = parse_message(text);
    if (!message) {
        return {};
    }
    const text::Error* facts = lua::facts_of(L, text);
    if (function != 0 && facts != nullptr) {
        const auto source = source::function_source(L, function);
        return source ? remarks_on_result(*facts, {*source, message->line}, message->line) : lua::Remarks();
    }
    lua_Debug found{};
    lua_Debug* frame = find_frame(L, *message, found) ? &found : nullptr;
    const auto source = frame != nullptr ? source_of_frame(L, *frame) : source_running(L, message->chunk);
    if (facts != nullptr) {
        return remarks(L, frame, *facts, source, message->line);
    }
    if (const auto syntax = lua::syntax_message(message->words)) {  // from a load() in the chunk
        const std::string habit = syntax_habit(L, *syntax, statement_of(source, message->line));
        return {habit, source ? excerpt(*source, message->line, {std::string(syntax->near)}) : "", ""};
    }
    return remarks(L, frame, lua::running_message(message->words), source, message->line);
}

lua::Remarks remarks_on(lua_State* L, int index) {
    const lua::Remarks* remembered = lua::remembered_remarks(L, index);
    return remembered != nullptr ? *remembered : first_remarks(L, lua_absindex(L, index), 0);
}

lua::Remarks remarks_on_syntax(lua_State* L, int index, const char* file) {
    const std::string text = lua_tostring(L, index);
    const auto message = parse_message(text);
    if (!message) {
        return {};
    }
    const auto source = file != nullptr ? source_of_file(file) : source_kept(L, message->chunk);
    const lua::SyntaxMessage syntax = lua::syntax_message(message->words).value_or(lua::SyntaxMessage{message->words});
    std::string habit = syntax_habit(L, syntax, statement_of(source, message->line));
    if (habit.empty() && source) habit = bare_value(L, *source, message->line, syntax);
    return {habit, source ? syntax_excerpt(L, *source, message->line, syntax) : "", ""};
}

}  // namespace dinal::errors
