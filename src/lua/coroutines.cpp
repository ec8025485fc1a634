// coroutine.resume, wrap and close: Lua's own functions, framed by a note of which thread runs.
//
// A C function may call another one directly, on its own frame: arguments, results, upvalues and errors are the same.
// So what is called here is what Lua itself provides, and nothing about coroutines is written a second time.
#include "lua/interrupt.hpp"
#include "lua/running_thread.hpp"

namespace dinal {

namespace {

// Set once, before any user code runs, and the same in every lua_State of the process.
lua_CFunction original_resume = nullptr;
lua_CFunction original_close = nullptr;
lua_CFunction original_create = nullptr;
lua_CFunction original_wrapped = nullptr;  // what coroutine.wrap returns; its upvalue is the coroutine

int tracked(lua_State* L, lua_State* coroutine, lua_CFunction original) {
    if (coroutine == nullptr) {
        return original(L);  // raises its own sentence about the argument
    }
    const RunningThread note(L, coroutine);
    return original(L);
}

int resume(lua_State* L) {
    return tracked(L, lua_tothread(L, 1), original_resume);
}

int close(lua_State* L) {
    return tracked(L, lua_tothread(L, 1), original_close);
}

int wrapped(lua_State* L) {
    return tracked(L, lua_tothread(L, lua_upvalueindex(1)), original_wrapped);
}

int wrap(lua_State* L) {
    original_create(L);
    lua_pushcclosure(L, wrapped, 1);
    return 1;
}

lua_CFunction original(lua_State* L, const char* name) {
    lua_getfield(L, -1, name);
    const lua_CFunction function = lua_tocfunction(L, -1);
    lua_pop(L, 1);
    return function;
}

int nothing(lua_State*) {
    return 0;
}

}  // namespace

void open_coroutines(lua_State* L) {
    lua_getglobal(L, LUA_COLIBNAME);
    if (original(L, "resume") != resume) {
        original_resume = original(L, "resume");
        original_close = original(L, "close");
        original_create = original(L, "create");
        lua_getfield(L, -1, "wrap");
        lua_pushcfunction(L, nothing);
        lua_call(L, 1, 1);
        original_wrapped = lua_tocfunction(L, -1);
        lua_pop(L, 1);
        const luaL_Reg functions[] = {{"resume", resume}, {"close", close}, {"wrap", wrap}, {nullptr, nullptr}};
        luaL_setfuncs(L, functions, 0);
    }
    lua_pop(L, 1);
}

}  // namespace dinal
