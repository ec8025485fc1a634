#include "prompt/typing.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "lua/bind.hpp"
#include "lua/tokens.hpp"
#include "terminal/display.hpp"
#include "text/characters.hpp"

namespace dinal::prompt {
namespace {

constexpr std::string_view grey = "\x1b[90m";
constexpr std::string_view plain = "\x1b[0m";

std::string_view colour_of(const lua::Token& token) {
    switch (token.kind) {
        case lua::TokenKind::keyword:
            return "\x1b[35m";
        case lua::TokenKind::number:
            return "\x1b[36m";
        case lua::TokenKind::string:
            return token.open ? "\x1b[31m" : "\x1b[32m";
        case lua::TokenKind::comment:
            return grey;
        default:
            return "";
    }
}

/// Runs `work` with Lua's errors (there is only the lack of memory) kept inside.
template <class Work>
void safely(lua_State* L, Work work) {
    const auto trampoline = [](lua_State* state) {
        auto& function = *static_cast<Work*>(lua_touserdata(state, 1));
        lua_settop(state, 0);
        function(state);
        return 0;
    };
    const int top = lua_gettop(L);
    lua_pushcfunction(L, trampoline);
    lua_pushlightuserdata(L, &work);
    lua_pcall(L, 1, 0, 0);
    lua_settop(L, top);
}

bool is_simple(std::string_view text, bool unicode) {
    return std::all_of(text.begin(), text.end(), [unicode](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte >= 0x20 && byte != 0x7F && (byte < 0x80 || unicode);
    });
}

bool opens(char c) {
    return c == '(' || c == '[' || c == '{';
}
bool closes(char c) {
    return c == ')' || c == ']' || c == '}';
}

/// The brackets of the text that belong together with that at the cursor, or just before it.
struct Pair {
    std::size_t one = std::string_view::npos, other = std::string_view::npos;
};

/// Of brackets only, in order; a wrong one in between ends the search.
std::size_t partner(const std::vector<lua::Token>& brackets, std::size_t i) {
    const bool forward = opens(brackets[i].text.front());
    int depth = 0;
    for (std::size_t k = i; k < brackets.size(); forward ? ++k : --k) {  // below 0 it is great
        depth += opens(brackets[k].text.front()) ? 1 : -1;
        if (depth == 0) {
            return brackets[k].at;
        }
    }
    return std::string_view::npos;
}

Pair brackets_at(std::string_view text, std::size_t cursor) {
    std::vector<lua::Token> brackets;
    for (const lua::Token& token : lua::tokens(text)) {
        const bool one = token.kind == lua::TokenKind::symbol && token.text.size() == 1;
        if (one && (opens(token.text.front()) || closes(token.text.front()))) {
            brackets.push_back(token);
        }
    }
    for (const std::size_t place : {cursor - 1, cursor}) {
        for (std::size_t i = 0; i < brackets.size(); ++i) {
            if (brackets[i].at == place) {
                return {place, partner(brackets, i)};
            }
        }
    }
    return {};
}

/// As much of a list as there is room for, whole words of it.
std::string fitting_list(const std::string& list, std::size_t room, bool unicode) {
    if (text::columns(list) <= room) {
        return list;
    }
    const std::string_view more = unicode ? ", …" : ", ...";
    const std::string_view cut = text::cut_to_columns(list, room > 5 ? room - 5 : 0);
    const std::size_t comma = cut.rfind(',');
    return comma == std::string_view::npos ? "" : std::string(cut.substr(0, comma)).append(more);
}

}  // namespace

std::string in_colours(std::string_view text) {
    std::string result;
    std::size_t at = 0;
    for (const lua::Token& token : lua::tokens(text)) {
        result += text.substr(at, token.at - at);
        at = token.end();
        const std::string_view colour = colour_of(token);
        result.append(colour).append(token.text).append(colour.empty() ? "" : plain);
    }
    return result.append(text.substr(at));
}

namespace {

/// The line in colours, with the bracket at the cursor and its partner in bold. The brackets are looked for in the
/// whole chunk, of which the line is the end.
std::string painted_line(const LineOnScreen& shown) {
    constexpr std::string_view bold = "\x1b[1;4m";
    const std::string whole = shown.pending + std::string(shown.line);
    const Pair pair = brackets_at(whole, shown.pending.size() + shown.cursor);
    if (pair.one == std::string_view::npos || pair.other == std::string_view::npos) {
        return in_colours(shown.line);
    }
    std::vector<std::size_t> marks;
    for (const std::size_t place : {std::min(pair.one, pair.other), std::max(pair.one, pair.other)}) {
        if (place >= shown.pending.size()) {
            marks.push_back(place - shown.pending.size());
        }
    }
    // Each piece between the brackets alone would lose what a string or a remark is: so they are put in afterwards.
    const std::string coloured = in_colours(shown.line);
    std::string result;
    std::size_t plain_at = 0;
    for (std::size_t i = 0; i < coloured.size();) {
        if (coloured[i] == '\x1b') {
            const std::size_t end = coloured.find('m', i) + 1;
            result.append(coloured, i, end - i);
            i = end;
            continue;
        }
        const bool marked = std::find(marks.begin(), marks.end(), plain_at) != marks.end();
        result.append(marked ? bold : "").append(1, coloured[i]).append(marked ? plain : "");
        ++plain_at;
        ++i;
    }
    return result;
}

}  // namespace

Painted paint(lua_State* L, const LineOnScreen& shown) {
    const terminal::Display screen = terminal::display_of(STDOUT_FILENO);
    const std::size_t before = text::columns(shown.prompt);
    const std::size_t used = before + text::columns(shown.line);
    constexpr std::size_t spare = 2;  // a row that is full to its end may have been wrapped already
    if (used + spare >= screen.width || !is_simple(shown.prompt, screen.unicode) ||
        !is_simple(shown.line, screen.unicode)) {
        return {};
    }
    const std::size_t room = screen.width - used - spare;
    constexpr std::size_t gap = 2;
    std::string hint;
    if (shown.line.empty()) {
        hint = text::cut_to_columns(shown.cue, room);
    } else if (shown.cursor == shown.line.size() && !shown.rest.empty() && is_simple(shown.rest, screen.unicode)) {
        hint = text::cut_to_columns(shown.rest, room);
    } else if (shown.cursor == shown.line.size()) {
        safely(L, [&](lua_State* state) { hint = signature_hint(state, shown.pending + std::string(shown.line)); });
        hint = fitting_list(hint, room > gap ? room - gap : 0, screen.unicode);
        hint.insert(0, hint.empty() ? 0 : gap, ' ');
    }
    // octal where a digit follows: \x1b7 would be one character
    std::string text = "\0337\r";
    text += before > 0 ? fmt::format("\x1b[{}C", before) : "";
    text += painted_line(shown);
    text += hint.empty() ? "" : fmt::format("{}{}{}", grey, hint, plain);
    return {text + "\x1b[K\0338", !hint.empty()};
}

Completion complete_safely(lua_State* L, const std::string& before) {
    Completion completion;
    safely(L, [&](lua_State* state) { completion = complete(state, before); });
    return completion;
}

}  // namespace dinal::prompt
