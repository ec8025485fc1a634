#include "repl/repl.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include "lua/dinal_table.hpp"
#include "lua/function_source.hpp"
#include "lua/interrupt.hpp"
#include "repl/call.hpp"
#include "repl/chunk.hpp"
#include "repl/line_editor.hpp"
#include "repl/output.hpp"
#include "repl/printer.hpp"
#include "repl/script.hpp"

namespace dinal {
namespace {

/// As in lua, a string in the global _PROMPT or _PROMPT2 replaces ours. Raw: a strict _G must not make it an error.
std::string prompt_text(lua_State* L, const char* global, const char* ours) {
    lua_pushglobaltable(L);
    lua_pushstring(L, global);
    lua_rawget(L, -2);
    std::string text = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : ours;
    lua_pop(L, 2);
    return text;
}

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
    push_dinal_table(L);
    lua_pushliteral(L, "partial");
    lua_rawget(L, -2);
    lua_remove(L, -2);
}

int print_partial(lua_State* L) {
    say_error("the part of the run that was done is in ans: " + show(L, 1, screen_of(STDOUT_FILENO)));
    return 0;
}

int print_values(lua_State* L) {
    const int count = lua_gettop(L);
    std::string text;
    for (int i = 1; i <= count; ++i) {
        text.append(i == 1 ? "" : "\t").append(show(L, i, screen_of(STDOUT_FILENO)));
    }
    text += '\n';
    say(text);
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
void show_values(lua_State* L, int base) {
    if (lua_gettop(L) == base) {
        return;
    }
    if (!lua_isnil(L, base + 1)) {
        set_ans(L, base + 1);
    }
    show_by(L, print_values, base);
}

/// The part of a run that was done before the error is worth keeping. `before` is where the earlier one stands.
void keep_partial_run(lua_State* L, int before) {
    push_partial(L);
    if (!lua_isnil(L, -1) && lua_rawequal(L, -1, before) == 0) {
        set_ans(L, -1);
        show_by(L, print_partial, lua_gettop(L) - 1);
    }
}

/// Runs the function on the top of the stack and empties the stack.
void evaluate(lua_State* L) {
    push_partial(L);
    lua_insert(L, 1);
    if (call(L, 0, LUA_MULTRET) == LUA_OK) {
        if (interrupt_requested()) {
            say_error("interrupted");
        }
        show_values(L, 1);
    } else {
        say_error(take_text(L));
        keep_partial_run(L, 1);
    }
    lua_settop(L, 0);
}

/// Takes the message from the top of the stack.
Line reject(lua_State* L, LineEditor& editor, const std::string& text) {
    editor.remember(text);
    say_error(take_text(L));
    return {Reading::line, ""};
}

/// Reads lines until they make a chunk and compiles it: its function is then on the stack. Nothing is when there is
/// nothing to run.
Line read_chunk(lua_State* L, LineEditor& editor) {
    Line chunk = editor.read(prompt_text(L, "_PROMPT", "> "));
    while (chunk.reading == Reading::line) {
        const Compiled result = compile(L, chunk.text);
        if (result == Compiled::ready) {
            break;
        }
        if (result == Compiled::wrong) {
            return reject(L, editor, chunk.text);
        }
        Line more = editor.read(prompt_text(L, "_PROMPT2", ">> "));
        if (more.reading == Reading::end) {
            say("\n");
            return reject(L, editor, chunk.text);
        }
        lua_settop(L, 0);
        if (more.reading == Reading::interrupted) {
            return more;
        }
        chunk.text.append("\n").append(more.text);
    }
    if (chunk.text.find("function") != std::string::npos) {
        keep_source(L, prompt_chunk, chunk.text);  // a file of results may need the text of what is defined here
    }
    editor.remember(chunk.text);
    return chunk;
}

}  // namespace

std::string greeting() {
    return version_line() + ": help() for help, Ctrl-D to leave";
}

bool run_prompt(lua_State* L) {
    LineEditor editor;
    lua_settop(L, 0);
    for (;;) {
        const Line chunk = read_chunk(L, editor);
        if (chunk.reading == Reading::end) {
            say("\n");
            return true;
        }
        if (chunk.reading == Reading::interrupted && isatty(STDIN_FILENO) == 0) {
            return false;
        }
        if (lua_gettop(L) > 0) {
            evaluate(L);
        }
        lua_settop(L, 0);
        flush_output();
    }
}

}  // namespace dinal
