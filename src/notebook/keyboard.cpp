#include "notebook/keyboard.hpp"

#include <string>
#include <string_view>

#include "lua/bind.hpp"

namespace dinal::notebook {
namespace {

void refuse_keyboard(lua_State* L, const char* call) {
    lua::raise(L, {.sentence = std::string(call) +
                               ": a notebook has no keyboard to read from; put the value into a variable, as in x = 3",
                   .call = call});
}

/// Upvalues of all that stand for a function of Lua's own: that function, io.stdin, its name, io.input.
int original_with_arguments(lua_State* L) {
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    lua_call(L, lua_gettop(L) - 1, LUA_MULTRET);
    return lua_gettop(L);
}

/// io.read and io.lines: of the keyboard where no file was named.
int read_input(lua_State* L) {
    const char* name = lua_tostring(L, lua_upvalueindex(3));
    const bool names_file = std::string_view(name) == "io.lines" && !lua_isnoneornil(L, 1);
    if (!names_file) {
        lua_pushvalue(L, lua_upvalueindex(4));
        lua_call(L, 0, 1);
        const bool keyboard = lua_rawequal(L, -1, lua_upvalueindex(2)) != 0;
        lua_pop(L, 1);
        if (keyboard) refuse_keyboard(L, name);
    }
    return original_with_arguments(L);
}

/// file:read and file:lines
int read_file_handle(lua_State* L) {
    if (lua_rawequal(L, 1, lua_upvalueindex(2)) != 0) refuse_keyboard(L, lua_tostring(L, lua_upvalueindex(3)));
    return original_with_arguments(L);
}

/// In the table on the top of the stack; io lies at the index.
void stand_for(lua_State* L, int io, const char* key, const char* name, lua_CFunction ours) {
    if (lua_getfield(L, -1, key) != LUA_TFUNCTION) {
        lua_pop(L, 1);
        return;
    }
    lua_getfield(L, io, "stdin");
    lua_pushstring(L, name);
    lua_getfield(L, io, "input");
    lua_pushcclosure(L, ours, 4);
    lua_setfield(L, -2, key);
}

}  // namespace

void take_keyboard_away(lua_State* L) {
    const int top = lua_gettop(L);
    if (lua_getglobal(L, "io") == LUA_TTABLE && lua_getfield(L, -1, "stdin") == LUA_TUSERDATA) {
        lua_pop(L, 1);
        const int io = lua_gettop(L);
        stand_for(L, io, "read", "io.read", lua::guarded<read_input>);
        stand_for(L, io, "lines", "io.lines", lua::guarded<read_input>);
        if (luaL_getmetatable(L, LUA_FILEHANDLE) == LUA_TTABLE && lua_getfield(L, -1, "__index") == LUA_TTABLE) {
            stand_for(L, io, "read", "io.stdin:read", lua::guarded<read_file_handle>);
            stand_for(L, io, "lines", "io.stdin:lines", lua::guarded<read_file_handle>);
        }
    }
    lua_settop(L, top);
}

}  // namespace dinal::notebook
