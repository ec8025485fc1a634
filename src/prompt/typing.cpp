#include "prompt/typing.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>

#include "terminal/display.hpp"
#include "text/characters.hpp"

namespace dinal::prompt {
namespace {

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
    if (hint.empty()) return {};
    // octal where a digit follows: \x1b7 would be one character
    const std::string right = used > 0 ? fmt::format("\x1b[{}C", used) : "";
    return {fmt::format("\0337\r{}\x1b[90m{}\x1b[0m\x1b[K\0338", right, hint), true};
}

Completion complete_safely(lua_State* L, const std::string& before) {
    Completion completion;
    safely(L, [&](lua_State* state) { completion = complete(state, before); });
    return completion;
}

}  // namespace dinal::prompt
