#include "prompt/evaluate.hpp"

#include <unistd.h>

#include <string>

#include "lua/bind.hpp"
#include "lua/interrupt.hpp"
#include "lua/standard_globals.hpp"
#include "prompt/call.hpp"
#include "prompt/notices.hpp"
#include "prompt/output.hpp"
#include "prompt/printer.hpp"
#include "terminal/display.hpp"

namespace dinal::prompt {
namespace {

/// Sets the global ans to the value at `index`.
void set_ans(lua_State* L, int index) {
    index = lua_absindex(L, index);
    lua_pushglobaltable(L);
    lua_pushliteral(L, "ans");
    lua_pushvalue(L, index);
    lua_rawset(L, -3);
    lua_pop(L, 1);
}

/// What a run that failed or was stopped has left behind, or nil.
void push_partial(lua_State* L) {
    lua::push_dinal_table(L);
    lua_pushliteral(L, "partial");
    lua_rawget(L, -2);
    lua_remove(L, -2);
}

/// What is done of a run goes on by itself; what is done of a sweep when it is called again.
int print_partial(lua_State* L) {
    const lua::Documented kept = lua::documented(L, 1);
    const bool run = kept.owner != nullptr && kept.owner->name == std::string_view("run");
    say_error((run ? "the finished part of the run is in dinal.partial and in ans (ans:continue() continues it):\n"
                   : "the finished points are in dinal.partial and in ans; the same call continues:\n") +
              show(L, 1, terminal::display_of(STDERR_FILENO)));
    return 0;
}

/// Shows the values on top of `base` by one of the two functions above, which take them.
void show_by(lua_State* L, lua_CFunction function, int base) {
    luaL_checkstack(L, LUA_MINSTACK, "too many values to show");
    lua_pushcfunction(L, function);
    lua_insert(L, base + 1);
    if (call(L, lua_gettop(L) - base - 1, 0) != LUA_OK) {
        say_error(take_text(L));
    }
}

/// The values on top of `base` become ans (the first) and are shown.
void take_values(lua_State* L, int base, const Chunk& chunk, lua_CFunction show_values) {
    if (lua_gettop(L) == base) {
        return;
    }
    const bool single = lua_gettop(L) == base + 1;
    if (!lua_isnil(L, base + 1) && !only_looks(chunk)) {
        set_ans(L, base + 1);
    }
    const std::string element = single && lua_isnil(L, base + 1) ? element_notice(L, chunk) : "";
    const std::string greatest = single ? greatest_notice(L, base + 1, chunk) : "";
    if (!chunk.silent) {
        show_by(L, show_values, base);
    }
    if (single) {
        say_notice(name_notice(L, chunk));
        say_notice(element);
        say_notice(greatest);
    }
}

/// The part of a run that was done before the error is worth keeping. `before` is where the earlier one stands.
void keep_partial_run(lua_State* L, int before) {
    push_partial(L);
    if (!lua_isnil(L, -1) && lua_rawequal(L, -1, before) == 0 && luaL_len(L, -1) > 0) {
        set_ans(L, -1);
        show_by(L, print_partial, lua_gettop(L) - 1);
    }
}

/// Runs the function on the top of the stack and shows its values; false, and the message on the stack, when it failed.
bool run_and_show(lua_State* L, const Chunk& chunk, lua_CFunction show_values, Evaluated& result) {
    const lua::InterruptScope running(L);  // a Ctrl-C meant for the function may come when its values are being shown
    if (call(L, 0, LUA_MULTRET) != LUA_OK) {
        return false;
    }
    result = {!lua::interrupt_requested(), lua_gettop(L) - 1, lua_gettop(L) > 1 && lua_isnil(L, 2)};
    if (!result.fine) {
        say_error("interrupted");
    }
    take_values(L, 1, chunk, show_values);
    return true;
}

}  // namespace

std::string values_text(lua_State* L) {
    const int count = lua_gettop(L);
    std::string text;
    for (int i = 1; i <= count; ++i) {
        text.append(i == 1 ? "" : "\t").append(show(L, i, terminal::display_of(STDOUT_FILENO)));
    }
    return text;
}

int print_values(lua_State* L) {
    say_value(values_text(L) + "\n");
    return 0;
}

Evaluated evaluate(lua_State* L, const Chunk& chunk, lua_CFunction show_values) {
    Evaluated result;
    push_partial(L);
    lua_insert(L, 1);
    if (!run_and_show(L, chunk, show_values, result)) {
        say_error(take_text(L));
        keep_partial_run(L, 1);
    }
    lua_settop(L, 0);
    return result;
}

}  // namespace dinal::prompt
