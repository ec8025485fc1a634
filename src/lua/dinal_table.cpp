#include "lua/dinal_table.hpp"

namespace dinal::lua {

namespace {
const char key = 0;  // in the registry, which a user's `dinal = nil` does not touch
}

void make_dinal_table(lua_State* L) {
    lua_newtable(L);
    lua_pushvalue(L, -1);
    lua_rawsetp(L, LUA_REGISTRYINDEX, &key);
}

void push_dinal_table(lua_State* L) {
    lua_rawgetp(L, LUA_REGISTRYINDEX, &key);
}

}  // namespace dinal::lua
