#include "lua/state_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "lua/bind.hpp"

namespace dinal::lua {

namespace {
/// Any other name than those in the table of the states.
int no_such_state(lua_State* L) {
    std::vector<std::string> names;
    for (lua_pushnil(L); lua_next(L, 1) != 0; lua_pop(L, 1)) {
        if (lua_type(L, -2) == LUA_TSTRING) names.emplace_back(lua_tostring(L, -2));
    }
    std::sort(names.begin(), names.end());
    const std::vector<std::string_view> known(names.begin(), names.end());
    lua_settop(L, 2);
    const std::string wanted = written(L, 2);
    raise(L, {.sentence = fmt::format("there is no {} '{}'; there is {}", lua_tostring(L, lua_upvalueindex(1)), wanted,
                                      fmt::join(names, ", ")),
              .culprit = wanted,
              .cure = text::did_you_mean(wanted, known)});
}
}  // namespace

void push_state_table(lua_State* L, std::span<const std::string> names, const char* what) {
    lua_createtable(L, 0, static_cast<int>(names.size()));
    lua_createtable(L, 0, 2);
    for (const char* other : {"__index", "__newindex"}) {
        lua_pushstring(L, what);
        lua_pushcclosure(L, guarded<no_such_state>, 1);
        lua_setfield(L, -2, other);
    }
    lua_setmetatable(L, -2);
    for (const std::string& name : names) {
        lua_pushlstring(L, name.data(), name.size());
        lua_pushnumber(L, 0);
        lua_rawset(L, -3);
    }
}

}  // namespace dinal::lua
