#include "lua/safe_mode.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

#include "files/file.hpp"
#include "lua/bind.hpp"
#include "lua/interrupt.hpp"
#include "lua/memory_limit.hpp"
#include "lua/standard_globals.hpp"
#include "terminal/progress.hpp"
#include "text/characters.hpp"

namespace dinal::lua {

namespace {

// ---- what exists

struct Library {
    const char* name;
    lua_CFunction open;
    std::initializer_list<const char*> members;
};

const std::initializer_list<Library> libraries = {
    {LUA_GNAME, luaopen_base, {"assert", "collectgarbage", "error",  "getmetatable", "ipairs",   "load",
                               "next",   "pairs",          "pcall",  "print",        "select",   "rawequal",
                               "rawget", "rawlen",         "rawset", "setmetatable", "tonumber", "tostring",
                               "type",   "warn",           "xpcall", "_VERSION"}},
    {LUA_COLIBNAME,
     luaopen_coroutine,
     {"close", "create", "isyieldable", "resume", "running", "status", "wrap", "yield"}},
    {LUA_STRLIBNAME,
     luaopen_string,
     {"byte", "char", "find", "format", "gmatch", "gsub", "len", "lower", "match", "pack", "packsize", "rep", "reverse",
      "sub", "unpack", "upper"}},
    {LUA_TABLIBNAME, luaopen_table, {"concat", "insert", "move", "pack", "remove", "sort", "unpack"}},
    {LUA_UTF8LIBNAME, luaopen_utf8, {"char", "charpattern", "codepoint", "codes", "len", "offset"}},
    {LUA_MATHLIBNAME, luaopen_math, {"abs", "acos",       "asin", "atan",      "ceil", "cos",    "deg",
                                     "exp", "floor",      "fmod", "huge",      "log",  "max",    "maxinteger",
                                     "min", "mininteger", "modf", "pi",        "rad",  "random", "randomseed",
                                     "sin", "sqrt",       "tan",  "tointeger", "type", "ult"}},
    {LUA_OSLIBNAME, luaopen_os, {"clock", "date", "difftime", "time"}},
    {LUA_DBLIBNAME, luaopen_debug, {"traceback"}},
};

std::atomic<bool> is_safe = false;
// Atomic for the reason given in interrupt.cpp.
std::atomic<lua_CFunction> original_load = nullptr;
std::atomic<lua_CFunction> original_setmetatable = nullptr;
std::atomic<lua_CFunction> original_xpcall = nullptr;
std::atomic<lua_CFunction> original_warn = nullptr;

// ---- functions that differ from Lua's

/// Text only: Lua does not verify bytecode.
int load(lua_State* L) {
    if (lua_gettop(L) < 3) {
        lua_settop(L, 3);
    }
    lua_pushliteral(L, "t");
    lua_replace(L, 3);
    return original_load.load()(L);
}

/// Without __gc: nothing can stop an endless loop in a finalizer.
int set_metatable(lua_State* L) {
    if (lua_type(L, 2) == LUA_TTABLE) {
        lua_pushliteral(L, "__gc");
        if (lua_rawget(L, 2) != LUA_TNIL) {
            raise(L, {.sentence = "setmetatable: a metatable with __gc is not possible in safe mode",
                      .call = "setmetatable"});
        }
        lua_pop(L, 1);
    }
    return original_setmetatable.load()(L);
}

/// Calls the handler of xpcall, the upvalue. While code is being stopped, Lua calls it with hooks switched off.
int handle(lua_State* L) {
    if (interrupt_requested()) {
        return 1;
    }
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
    return lua_gettop(L);
}

int xpcall_safely(lua_State* L) {
    if (lua_type(L, 2) == LUA_TFUNCTION) {
        lua_pushvalue(L, 2);
        lua_pushcclosure(L, handle, 1);
        lua_replace(L, 2);
    }
    return original_xpcall.load()(L);
}

int collect_garbage(lua_State* L) {
    const std::string_view what = luaL_optstring(L, 1, "collect");
    if (what == "count") {
        lua_pushnumber(L, lua_gc(L, LUA_GCCOUNT) + lua_gc(L, LUA_GCCOUNTB) / 1024.0);
        return 1;
    }
    if (what != "collect") {
        raise(L, {.sentence = "collectgarbage: only \"collect\" and \"count\" are possible in safe mode",
                  .call = "collectgarbage"});
    }
    lua_pushinteger(L, lua_gc(L, LUA_GCCOLLECT));
    return 1;
}

/// Returns loaded modules only. The upvalue is the table of these.
int require(lua_State* L) {
    luaL_checkstring(L, 1);
    lua_settop(L, 1);
    lua_pushvalue(L, 1);
    if (lua_rawget(L, lua_upvalueindex(1)) == LUA_TNIL) {
        raise(L, {.sentence = "require: there is no module '" + std::string(lua_tostring(L, 1)) +
                              "' in safe mode, which loads none",
                  .call = "require",
                  .culprit = written(L, 1)});
    }
    return 1;
}

/// Removes control sequences (titles, a cleared screen) if the stream is a terminal; otherwise writes unchanged.
void put(std::FILE* stream, std::string_view text) {
    const std::string shown = ::isatty(::fileno(stream)) == 1 ? text::harmless(text) : "";
    if (!shown.empty()) text = shown;
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stream));
}

int print_safely(lua_State* L) {
    const int count = lua_gettop(L);
    for (int i = 1; i <= count; ++i) {
        std::size_t length = 0;
        const char* text = luaL_tolstring(L, i, &length);
        if (i > 1) put(stdout, "\t");
        put(stdout, {text, length});
        lua_pop(L, 1);
    }
    put(stdout, "\n");
    static_cast<void>(std::fflush(stdout));
    return 0;
}

/// Warns through Lua, which writes to standard error.
int warn_safely(lua_State* L) {
    for (int i = 1; ::isatty(STDERR_FILENO) == 1 && i <= lua_gettop(L); ++i) {
        std::size_t length = 0;
        const char* text = luaL_checklstring(L, i, &length);
        const std::string shown = text::harmless({text, length});
        lua_pushlstring(L, shown.data(), shown.size());
        lua_replace(L, i);
    }
    return original_warn.load()(L);
}

// ---- io: standard output, error and input, without files
//
// NOTE: Lua's own handles are not exposed: with seek, a script could overwrite what others have written to a file to
// which standard output is redirected.

/// Writes the arguments from `first` on to the stream in the first upvalue.
int write_from(lua_State* L, int first) {
    auto* stream = static_cast<std::FILE*>(lua_touserdata(L, lua_upvalueindex(1)));
    terminal::make_way_for_output(lua_isstring(L, -1) != 0 && std::string_view(lua_tostring(L, -1)).ends_with('\n'));
    for (int i = first; i <= lua_gettop(L); ++i) {
        std::size_t length = 0;
        const char* text = luaL_checklstring(L, i, &length);
        put(stream, {text, length});
    }
    return 0;
}

/// io.write(...); the second upvalue is the stream's Lua table, for io.write(1):write(2).
int write(lua_State* L) {
    write_from(L, 1);
    lua_pushvalue(L, lua_upvalueindex(2));
    return 1;
}

/// io.stdout:write(...)
int write_to(lua_State* L) {
    luaL_checktype(L, 1, LUA_TTABLE);
    write_from(L, 2);
    lua_pushvalue(L, 1);
    return 1;
}

int flush(lua_State* L) {
    static_cast<void>(std::fflush(static_cast<std::FILE*>(lua_touserdata(L, lua_upvalueindex(1)))));
    return 0;
}

void push_stream_function(lua_State* L, std::FILE* stream, lua_CFunction function) {
    lua_pushlightuserdata(L, stream);
    lua_pushcclosure(L, function, 1);
}

/// io.stdout or io.stderr, a table with write and flush.
void push_stream(lua_State* L, std::FILE* stream) {
    lua_createtable(L, 0, 2);
    push_stream_function(L, stream, guarded<write_to>);
    lua_setfield(L, -2, "write");
    push_stream_function(L, stream, guarded<flush>);
    lua_setfield(L, -2, "flush");
}

/// io.read is Lua's own: it reads standard input and returns strings and numbers only.
void push_io(lua_State* L) {
    lua_createtable(L, 0, 4);
    push_stream(L, stderr);
    lua_setfield(L, -2, "stderr");
    push_stream(L, stdout);
    lua_pushlightuserdata(L, stdout);
    lua_pushvalue(L, -2);
    lua_pushcclosure(L, guarded<write>, 2);
    lua_setfield(L, -3, "write");
    lua_setfield(L, -2, "stdout");
    luaopen_io(L);
    lua_getfield(L, -1, "read");
    lua_setfield(L, -3, "read");
    lua_pop(L, 1);
}

// ---- assembly

/// Replaces the function `name` in the table on the top by dinal's; returns Lua's own.
lua_CFunction replace(lua_State* L, const char* name, lua_CFunction ours) {
    lua_getfield(L, -1, name);
    const lua_CFunction original = lua_tocfunction(L, -1);
    lua_pop(L, 1);
    lua_pushcfunction(L, ours);
    lua_setfield(L, -2, name);
    return original;
}

/// Pushes a new table with the listed members of a library.
void push_library(lua_State* L, const Library& library) {
    lua_pushcfunction(L, library.open);
    lua_pushstring(L, library.name);
    lua_call(L, 1, 1);
    lua_newtable(L);
    for (const char* name : library.members) {
        lua_getfield(L, -2, name);
        lua_setfield(L, -2, name);
    }
    lua_remove(L, -2);
}

/// Makes ("x"):rep(3) use our table, and hides the metatable that all strings share.
void guard_strings(lua_State* L) {
    lua_pushliteral(L, "");
    lua_getmetatable(L, -1);
    lua_getglobal(L, LUA_STRLIBNAME);
    lua_setfield(L, -2, "__index");
    lua_pushliteral(L, "string");
    lua_setfield(L, -2, "__metatable");
    lua_pop(L, 2);
}

/// Replaces the globals and the table of loaded modules by new ones; the old ones become unreachable.
void replace_globals(lua_State* L) {
    lua_newtable(L);  // loaded
    for (const Library& library : libraries) {
        push_library(L, library);
        lua_setfield(L, -2, library.name);
    }
    push_io(L);
    lua_setfield(L, -2, LUA_IOLIBNAME);
    lua_getfield(L, -1, LUA_GNAME);
    copy_fields(L);
    lua_rawseti(L, LUA_REGISTRYINDEX, LUA_RIDX_GLOBALS);
    lua_setfield(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
}

}  // namespace

void open_safe_libraries(lua_State* L) {
    // Only once, because a nested sweep opens states while other threads already read files.
    if (!is_safe.exchange(true)) files::confine_files();
    replace_globals(L);
    lua_pushglobaltable(L);
    original_load = replace(L, "load", load);
    original_setmetatable = replace(L, "setmetatable", guarded<set_metatable>);
    original_xpcall = replace(L, "xpcall", xpcall_safely);
    original_warn = replace(L, "warn", guarded<warn_safely>);
    replace(L, "print", guarded<print_safely>);
    replace(L, "collectgarbage", guarded<collect_garbage>);
    lua_getfield(L, LUA_REGISTRYINDEX, LUA_LOADED_TABLE);
    lua_pushcclosure(L, guarded<require>, 1);
    lua_setfield(L, -2, "require");
    lua_pop(L, 1);
    guard_strings(L);
}

bool safe_mode() noexcept {
    return is_safe;
}

const char* load_mode() noexcept {
    return is_safe ? "t" : nullptr;
}

// The limits of a script.

namespace {

/// "256M", as in the command line.
std::string size_text(std::size_t bytes) {
    constexpr std::array<std::pair<std::size_t, char>, 3> units{{{30, 'G'}, {20, 'M'}, {10, 'K'}}};
    for (const auto& [shift, letter] : units) {
        if (const std::size_t unit = std::size_t{1} << shift; bytes >= unit && bytes % unit == 0) {
            return fmt::format("{}{}", bytes / unit, letter);
        }
    }
    return fmt::format("{} bytes", bytes);
}

}  // namespace

void set_limits(lua_State* L, const ScriptLimits& limits) {
    if (limits.memory > 0) {
        set_memory_limit(L, limits.memory);
    }
    if (limits.seconds > 0) {
        set_time_limit(limits.seconds);
    }
}

std::string limit_sentence(Stop reason, const std::string& place) {
    const std::string what = reason == Stop::time
                                 ? fmt::format("ran longer than the {:.6g} s that --max-time allows", time_limit())
                                 : "needed more than the " + size_text(memory_limit()) + " that --max-memory allows";
    return fmt::format("stopped{}{}: it {}", place.empty() ? "" : " at ", place, what);
}

std::string reached_limit() {
    const Stop reason = stop_requested();
    return reason == Stop::time || reason == Stop::memory ? limit_sentence(reason, stopped_at()) : "";
}

namespace {

bool takes_more(int descriptor, int wait_ms) {
    pollfd output{descriptor, POLLOUT, 0};
    return poll(&output, 1, wait_ms) == 1 && (output.revents & POLLOUT) != 0;
}

}  // namespace

void write_error_in_time(std::string_view text) {
    // A pipe accepts up to PIPE_BUF bytes without blocking.
    constexpr std::size_t most = 4096;
    constexpr int patient_ms = 500;
    while (!text.empty() && takes_more(STDERR_FILENO, patient_ms)) {
        const ssize_t written = ::write(STDERR_FILENO, text.data(), std::min(text.size(), most));
        if (written <= 0) {
            return;
        }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

void exit_in_time(int code) {
    if (takes_more(STDOUT_FILENO, 0)) {
        std::exit(code);
    }
    _exit(code);
}

}  // namespace dinal::lua
