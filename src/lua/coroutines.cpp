// coroutine.resume, wrap and close: Lua's own functions, which also record the running thread.
//
// A C function may call another one directly on its own frame: arguments, results, upvalues and errors are the same, so
// Lua's own functions do the work. Only the result of coroutine.wrap is new: Lua's own closes a failed coroutine before
// it returns, and in a stopped coroutine no hook is called any more, so that an endless __close could not be stopped.
#include <atomic>

#include "lua/interrupt.hpp"

namespace dinal::lua {

namespace {

// Equal in every lua_State of the process. Atomic, because nested sweeps open states on several threads at once, each
// of which writes them.
std::atomic<lua_CFunction> original_resume = nullptr;
std::atomic<lua_CFunction> original_close = nullptr;
std::atomic<lua_CFunction> original_create = nullptr;

int resume(lua_State* L) {
    lua_State* coroutine = lua_tothread(L, 1);
    if (coroutine == nullptr) {
        return original_resume.load()(L);  // raises Lua's error about the argument
    }
    const RunningThread note(L, coroutine);
    return original_resume.load()(L);
}

int close(lua_State* L) {
    lua_State* coroutine = lua_tothread(L, 1);
    if (coroutine == nullptr) {
        return original_close.load()(L);
    }
    if (interrupt_requested()) {
        raise_interrupted(L);  // its variables stay open: nothing of this chunk runs on
    }
    const RunningThread note(L, coroutine);
    return original_close.load()(L);
}

/// Closes the failed coroutine and raises its error here, with the position of the caller in front, as Lua does.
int raise_error_of(lua_State* L, lua_State* coroutine) {
    int status = lua_status(coroutine);
    if (status != LUA_OK && status != LUA_YIELD && !interrupt_requested()) {
        const RunningThread note(L, coroutine);
        status = lua_resetthread(coroutine);
        lua_xmove(coroutine, L, 1);
    }
    if (status != LUA_ERRMEM && lua_type(L, -1) == LUA_TSTRING) {
        luaL_where(L, 1);
        lua_insert(L, -2);
        lua_concat(L, 2);
    }
    return lua_error(L);
}

int wrapped(lua_State* L) {
    lua_State* coroutine = lua_tothread(L, lua_upvalueindex(1));
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    const int results = resume(L);
    return lua_toboolean(L, -results) != 0 ? results - 1 : raise_error_of(L, coroutine);
}

int wrap(lua_State* L) {
    original_create.load()(L);
    lua_pushcclosure(L, wrapped, 1);
    return 1;
}

lua_CFunction original(lua_State* L, const char* name) {
    lua_getfield(L, -1, name);
    const lua_CFunction function = lua_tocfunction(L, -1);
    lua_pop(L, 1);
    return function;
}

}  // namespace

void open_coroutines(lua_State* L) {
    lua_getglobal(L, LUA_COLIBNAME);
    if (original(L, "resume") != resume) {
        original_resume = original(L, "resume");
        original_close = original(L, "close");
        original_create = original(L, "create");
        const luaL_Reg functions[] = {{"resume", resume}, {"close", close}, {"wrap", wrap}, {nullptr, nullptr}};
        luaL_setfuncs(L, functions, 0);
    }
    lua_pop(L, 1);
}

}  // namespace dinal::lua
