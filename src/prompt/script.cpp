#include "prompt/script.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>

#include "files/file.hpp"
#include "help/library.hpp"
#include "lab/lab_course.hpp"
#include "lab/report.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_headers.hpp"
#include "lua/options.hpp"
#include "lua/safe_mode.hpp"
#include "lua/standard_globals.hpp"
#include "prompt/call.hpp"
#include "prompt/line_editor.hpp"
#include "prompt/marking.hpp"
#include "prompt/notices.hpp"
#include "prompt/output.hpp"
#include "prompt/session.hpp"
#include "prompt/user_files.hpp"
#include "source/function_source.hpp"
#include "text/version.hpp"

namespace dinal::prompt {
namespace {

bool was_interrupted = false;

/// After Ctrl-C, passes the partial result of a run or sweep, or nil, to dinal.on_interrupt. Another Ctrl-C stops that
/// function as well.
void hand_over_partial(lua_State* L) {
    was_interrupted = true;
    lua::push_dinal_table(L);
    if (lua::push_field(L, -1, "on_interrupt") == LUA_TFUNCTION) {
        lua::push_field(L, -2, "partial");
        if (call(L, 1, 0) != LUA_OK) {
            complain(take_text(L));
        }
    } else {
        if (!lua_isnil(L, -1)) {
            complain(fmt::format("dinal.on_interrupt must be a function; it is a {}, so it is not called",
                                 luaL_typename(L, -1)));
        }
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

/// Reports the result of a piece of work, which has an error text on the top of the stack if it failed. `file` is the
/// file of a chunk that did not compile.
bool finished(lua_State* L, int status, const char* file = nullptr) {
    const bool interrupted = lua::stop_requested() == lua::Stop::interrupted;
    if (status != LUA_OK) {
        const std::string text =
            status == LUA_ERRSYNTAX || status == LUA_ERRMEM ? load_error_text(L, file) : take_text(L);
        // A run-time error text already reports the interruption and its place.
        const bool unreported = interrupted && status != LUA_ERRRUN;
        complain(unreported ? "interrupted" : text);
    } else if (interrupted) {
        complain("interrupted");
    }
    if (interrupted) {
        hand_over_partial(L);
    }
    return status == LUA_OK && !interrupted;
}

bool run_loaded(lua_State* L, int status, int arguments = 0) {
    // NOTE: a Ctrl-C during reading a script from standard input is detected here.
    const bool go_on = status == LUA_OK && !lua::interrupt_requested();
    return finished(L, go_on ? call(L, arguments, 0) : status);
}

/// Loads text that is in no file and keeps it, as files of results and errors may need the source of its functions.
int load_text(lua_State* L, std::string_view text, const char* name) {
    const int status = luaL_loadbufferx(L, text.data(), text.size(), name, lua::load_mode());
    if (status == LUA_OK || status == LUA_ERRSYNTAX) {
        source::keep_source(L, name, text);  // also on an error, whose message shows its line
    }
    return status;
}

bool run_text(lua_State* L, const char* text, const char* name) {
    return run_loaded(L, load_text(L, text, name));
}

/// Like luaL_loadfile(L, nullptr), including byte order mark and `#!` line, but keeps the text.
int load_standard_input(lua_State* L) {
    std::string text;
    std::array<char, BUFSIZ> piece{};
    while (const std::size_t size = std::fread(piece.data(), 1, piece.size(), stdin)) {
        text.append(piece.data(), size);
    }
    if (std::ferror(stdin) != 0) {
        lua_pushfstring(L, "cannot read stdin: %s", std::strerror(errno));  // NOLINT(concurrency-mt-unsafe): one thread
        return LUA_ERRFILE;
    }
    if (text.compare(0, 3, "\xEF\xBB\xBF") == 0) {
        text.erase(0, 3);
    }
    if (text.compare(0, 1, "#") == 0) {
        text.erase(0, text.find('\n'));  // the newline stays, to keep line numbers
    }
    return load_text(L, text, "=stdin");
}

bool run_init(lua_State* L) {
    const char* name = "=LUA_INIT_5_4";
    const char* init = std::getenv(name + 1);  // NOLINT(concurrency-mt-unsafe): one thread
    if (init == nullptr) {
        name = "=LUA_INIT";
        init = std::getenv(name + 1);  // NOLINT(concurrency-mt-unsafe): one thread
    }
    if (init == nullptr) {
        return true;
    }
    return *init == '@' ? run_loaded(L, luaL_loadfile(L, init + 1)) : run_text(L, init, name);
}

/// -l mod, -l global=mod
bool require_module(lua_State* L, std::string_view value) {
    const std::size_t equals = value.find('=');
    const std::string global(value.substr(0, equals));
    const std::string module(equals == std::string_view::npos ? value : value.substr(equals + 1));
    lua_getglobal(L, "require");
    lua_pushlstring(L, module.data(), module.size());
    const int status = call(L, 1, 1);
    if (status == LUA_OK) {
        lua_setglobal(L, global.c_str());
    }
    return finished(L, status);
}

bool run_step(lua_State* L, const StartStep& step) {
    switch (step.option) {
        case 'e':
            return run_text(L, step.value, "=(command line)");
        case 'l':
            return require_module(L, step.value);
        default:
            lua_warning(L, "@on", 0);
            return true;  // W
    }
}

bool run_steps(lua_State* L, const Arguments& arguments) {
    return std::ranges::all_of(arguments.steps, [L](const StartStep& s) { return run_step(L, s); });
}

/// Sets the global `arg`: the script at 0, its arguments from 1, words before it at negative indices.
void set_arg(lua_State* L, const Arguments& arguments) {
    const auto zero = static_cast<lua_Integer>(arguments.has_script() ? arguments.script : 0);
    lua_newtable(L);
    lua_Integer place = -zero;
    for (const char* word : arguments.words) {
        lua_pushstring(L, word);
        lua_rawseti(L, -2, place++);
    }
    lua_setglobal(L, "arg");
}

int push_script_arguments(lua_State* L) {
    if (lua_getglobal(L, "arg") != LUA_TTABLE) {
        luaL_error(L, "'arg' is not a table");
    }
    const int count = static_cast<int>(luaL_len(L, -1));
    luaL_checkstack(L, count + 3, "too many arguments to script");
    for (int i = 1; i <= count; ++i) {
        lua_rawgeti(L, -i, i);
    }
    lua_remove(L, -count - 1);
    return count;
}

bool run_script(lua_State* L, const Arguments& arguments) {
    const char* file = arguments.words[arguments.script];
    const bool after_dashes = std::string_view(arguments.words[arguments.script - 1]) == "--";
    const bool standard_input = std::string_view(file) == "-" && !after_dashes;
    if (!standard_input) {
        files::allow_reading(file);
    }
    const int status = standard_input ? load_standard_input(L) : load_file(L, file);
    return status == LUA_OK ? run_loaded(L, status, push_script_arguments(L))
                            : finished(L, status, standard_input ? nullptr : file);
}

/// Runs a script into a page and reports its name, also if the script failed.
bool run_reported_script(lua_State* L, const Arguments& arguments) {
    const char* script = arguments.words[arguments.script];
    if (std::string_view(script) != "-" && access(script, R_OK) != 0) {
        return run_script(L, arguments);  // no report without a script
    }
    std::string errors;
    lab::ScriptReport report(script, errors);
    bool fine = false;
    {
        const ErrorsInto collected(errors);
        fine = run_script(L, arguments);
    }
    const auto saved = report.save();
    if (!errors.empty()) {
        say_error(errors.substr(0, errors.size() - 1));
    }
    if (!saved) {
        complain(saved.error().message());
        return false;
    }
    say(saved.value() + "\n");
    if (const std::string note = other_number(script, lab::lab_number_of(L)); !note.empty()) say_error(note);
    return fine;
}

void open(lua_State* L, const Arguments& arguments) {
    luaL_checkversion(L);
    if (arguments.ignore_environment) {
        lua_pushboolean(L, 1);
        lua_setfield(L, LUA_REGISTRYINDEX, "LUA_NOENV");
    }
    arguments.safe ? lua::open_safe_libraries(L) : luaL_openlibs(L);
    help::open_library(L);
    lua::look_at_options = report_nil_option;
    set_arg(L, arguments);
    if (arguments.strict) be_strict(L);
    lua_gc(L, LUA_GCGEN, 0, 0);  // as lua does
    lua::set_limits(L, arguments.limits);
}

int failure() {
    return was_interrupted || lua::stop_requested() == lua::Stop::interrupted ? exit_code::interrupted
                                                                              : exit_code::script_error;
}

int prompt(lua_State* L, const Arguments& arguments) {
    if (!arguments.show_version) {
        say(greeting() + "\n");
    }
    return run_prompt(L, arguments.no_init ? Start::plain : Start::with_init_file) ? exit_code::ok
                                                                                   : exit_code::interrupted;
}

int run_all(lua_State* L, const Arguments& arguments, Kernel kernel) {
    if (arguments.show_version) {
        say((arguments.interactive ? greeting() : version_line()) + "\n");
    }
    open(L, arguments);
    if (!arguments.ignore_environment && !run_init(L)) {
        return failure();
    }
    if (!run_steps(L, arguments) ||
        (arguments.has_script() && !(arguments.report ? run_reported_script : run_script)(L, arguments))) {
        return failure();
    }
    if (arguments.kernel) {
        return kernel(L, *arguments.kernel) ? exit_code::ok : exit_code::usage;
    }
    if (arguments.interactive) {
        return prompt(L, arguments);
    }
    if (arguments.has_script() || arguments.executes || arguments.show_version) {
        return exit_code::ok;
    }
    if (isatty(STDIN_FILENO) != 0) {
        return prompt(L, arguments);
    }
    return run_loaded(L, load_standard_input(L)) ? exit_code::ok : failure();
}

struct Program {
    const Arguments* arguments;
    Kernel kernel;
    int code = exit_code::script_error;
};

int protected_run(lua_State* L) {
    auto* program = static_cast<Program*>(lua_touserdata(L, 1));
    lua_settop(L, 0);
    program->code = run_all(L, *program->arguments, program->kernel);
    return 0;
}

void close_state(lua_State* L) {
    // Finalizers run now without hooks, so a Ctrl-C must be able to end an endless one.
    static_cast<void>(std::signal(SIGINT, SIG_DFL));
    const lua::TimeAllowance time;
    lua_close(L);
}

}  // namespace

int run(const Arguments& arguments, Kernel kernel) {
    if (!arguments.lab_marks.empty()) {
        const char* script = arguments.has_script() ? arguments.words[arguments.script] : "-";
        if (const auto wrong = lab::start_answer_log(arguments.lab_marks, script)) {
            complain(wrong->sentence);
            return exit_code::script_error;
        }
    } else {
        const bool of_a_stranger = arguments.safe && !arguments.report;  // other people's scripts must not use up tries
        lab::keep_lab_tries([] { return state_file("lab-tries"); },
                            of_a_stranger ? lab::Tries::read : lab::Tries::write);
    }
    const std::unique_ptr<lua_State, void (*)(lua_State*)> state(luaL_newstate(), close_state);
    lua_State* L = state.get();
    if (L == nullptr) {
        complain("cannot start Lua: not enough memory");
        return exit_code::script_error;
    }
    lua::install_interrupt_handler();
    files::clean_up_on_signals();
    Program program{&arguments, kernel};
    lua_pushcfunction(L, protected_run);
    lua_pushlightuserdata(L, &program);
    if (lua_pcall(L, 1, 0, 0) != LUA_OK) {
        complain(take_text(L));
        return failure();
    }
    if (const auto lost = lab::lost_lab_mark()) {
        complain(lost->sentence);
        program.code = exit_code::script_error;
    }
    if (!lua::reached_limit().empty()) {
        lua::exit_in_time(program.code);  // without closing the script's objects, which might take for ever
    }
    return program.code;
}

void complain(const std::string& text) {
    say_error("dinal: " + text);
}

std::string version_line() {
    return "dinal " DINAL_VERSION " (" LUA_RELEASE ")";
}

std::string version_text() {
    return fmt::format("{}\nThe source of dinal is under the MIT licence; Lua is as well, {}.\n{}\n", version_line(),
                       std::string_view(LUA_COPYRIGHT).substr(std::string_view(LUA_RELEASE).size() + 2),
                       LineEditor::about());
}

}  // namespace dinal::prompt
