#include "prompt/repl.hpp"

#include <unistd.h>

#include "lua/safe_mode.hpp"
#include "prompt/call.hpp"
#include "prompt/chunk.hpp"
#include "prompt/commands.hpp"
#include "prompt/notices.hpp"
#include "prompt/output.hpp"
#include "prompt/script.hpp"
#include "prompt/session.hpp"
#include "prompt/user_files.hpp"
#include "source/function_source.hpp"

namespace dinal::prompt {
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

/// Tells the message on the top of the stack, of a text that does not compile.
void reject(Session& session, const std::string& text) {
    source::keep_source(session.L, prompt_chunk, text);  // the message shows the line
    say_error(told_error(session.L, nullptr));
}

/// Reads the lines that are missing of a chunk, and compiles it: its function is then on the stack.
TypedLine read_rest(Session& session, Chunk& chunk, TypedLine input) {
    lua_State* L = session.L;
    while (chunk.result == Compiled::incomplete) {
        TypedLine more = session.editor.read(prompt_text(L, "_PROMPT2", ">> "), input.text);
        if (more.reading == Reading::end) {
            say("\n");
            chunk.result = Compiled::wrong;
            return input;
        }
        lua_settop(L, 0);
        if (more.reading == Reading::interrupted) {
            return more;
        }
        input.text.append("\n").append(more.text);
        chunk = compile(L, input.text);
    }
    return input;
}

/// Reads one input and does what it says.
Reading read_and_run(Session& session) {
    lua_State* L = session.L;
    TypedLine input = session.editor.read(prompt_text(L, "_PROMPT", "> "));
    if (input.reading != Reading::line) {
        return input.reading;
    }
    if (is_command(input.text)) {
        session.editor.remember(input.text);
        run_command(session, input.text);
        return Reading::line;
    }
    Chunk chunk = compile(L, input.text);
    if (const std::string notice = chunk.result == Compiled::incomplete ? colon_notice(L, input.text) : "";
        !notice.empty()) {
        session.editor.remember(input.text);
        say_notice(notice);
        return Reading::line;
    }
    input = read_rest(session, chunk, input);
    if (input.reading == Reading::interrupted) {
        return input.reading;
    }
    session.editor.remember(input.text);
    if (chunk.result == Compiled::ready) {
        run_chunk(session, chunk, input.text);
    } else {
        reject(session, input.text);
    }
    return Reading::line;
}

void run_init_file(lua_State* L) {
    const std::string file = init_file();
    if (file.empty()) {
        return;
    }
    if (luaL_loadfilex(L, file.c_str(), lua::load_mode()) != LUA_OK) {
        say_error(told_error(L, file.c_str()));
    } else if (call(L, 0, 0) != LUA_OK) {
        say_error(take_text(L));
    }
    lua_settop(L, 0);
}

}  // namespace

bool run_chunk(Session& session, const Chunk& chunk, const std::string& text) {
    source::keep_source(session.L, prompt_chunk,
                        text);  // errors and files of results may need the text of what is defined here
    const Evaluated result = evaluate(session.L, chunk, session.show_values);
    if (!result.fine) {
        return false;
    }
    if (const std::string notice = session.local_noticed ? "" : local_notice(text); !notice.empty()) {
        say_notice(notice);
        session.local_noticed = true;
    }
    say_notice(nil_notice(session.L, text));
    say_notice(comma_notice(text));
    const std::string before = session.record.problem();
    session.record.add(chunk, result);
    if (const std::string& problem = session.record.problem(); !problem.empty() && before.empty()) {
        say_error(":record: " + problem);
    }
    return true;
}

bool run_text(Session& session, const std::string& text) {
    lua_settop(session.L, 0);
    const Chunk chunk = compile(session.L, text);
    const bool ready = chunk.result == Compiled::ready;
    if (!ready) {
        reject(session, text);
    }
    const bool fine = ready && run_chunk(session, chunk, text);
    lua_settop(session.L, 0);
    return fine;
}

std::string greeting() {
    return version_line() + ": help() for help, Ctrl-D to leave";
}

bool run_prompt(lua_State* L, Start start) {
    lua_settop(L, 0);
    if (start == Start::with_init_file) {
        run_init_file(L);
    }
    Session session(L);
    while (!session.leaving) {
        const Reading reading = read_and_run(session);
        lua_settop(L, 0);
        flush_output();
        if (reading == Reading::end) {
            say("\n");
            return true;
        }
        if (reading == Reading::interrupted && isatty(STDIN_FILENO) == 0) {
            return false;
        }
    }
    return true;
}

}  // namespace dinal::prompt
