#include "lua/standard_globals.hpp"

#include <algorithm>
#include <string_view>

namespace dinal::lua {
namespace {

const char dinal_key = 0;     // in the registry, which a user's `dinal = nil` does not touch
const char standard_key = 0;  // registry key of a copy of _G as it was at the start

/// Copies all fields of one table to another.
void copy_fields(lua_State* L, int from, int to) {
    lua_pushnil(L);
    while (lua_next(L, from) != 0) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, to);
    }
}

}  // namespace

void make_dinal_table(lua_State* L) {
    lua_newtable(L);
    lua_pushvalue(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &dinal_key);
}

void push_dinal_table(lua_State* L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &dinal_key);
}

void copy_fields(lua_State* L) {
    lua_pushnil(L);
    while (lua_next(L, -3) != 0) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, -4);
    }
}

void note_standard_globals(lua_State* L) {
    lua_newtable(L);
    lua_pushglobaltable(L);
    copy_fields(L, lua_gettop(L), lua_gettop(L) - 1);
    lua_pop(L, 1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &standard_key);
}

void push_standard_globals(lua_State* L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &standard_key);
}

std::vector<std::string> users_globals(lua_State* L) {
    std::vector<std::string> names;
    const int top = lua_gettop(L);
    push_standard_globals(L);
    lua_pushglobaltable(L);
    lua_pushnil(L);
    while (lua_next(L, top + 2) != 0) {
        lua_pushvalue(L, -2);
        lua_rawget(L, top + 1);
        const bool ours = lua_rawequal(L, -1, -2) != 0;
        lua_pop(L, 2);
        if (!ours && lua_type(L, -1) == LUA_TSTRING) {
            names.emplace_back(lua_tostring(L, -1));
        }
    }
    lua_settop(L, top);
    // Of the program, but not there yet when the others were noted.
    std::erase_if(names, [](std::string_view name) { return name == "dinal" || name == "arg"; });
    std::sort(names.begin(), names.end());
    return names;
}

void reset_globals(lua_State* L) {
    const int top = lua_gettop(L);
    lua_pushglobaltable(L);
    for (const std::string& name : users_globals(L)) {
        lua_pushlstring(L, name.data(), name.size());
        lua_pushnil(L);
        lua_rawset(L, top + 1);
    }
    push_standard_globals(L);
    copy_fields(L, top + 2, top + 1);
    lua_pushliteral(L, "dinal");
    push_dinal_table(L);
    lua_rawset(L, top + 1);
    lua_settop(L, top);
}

}  // namespace dinal::lua
