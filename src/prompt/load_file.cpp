#include "prompt/load_file.hpp"

#include <fmt/core.h>

#include <string>

#include "files/confinement.hpp"
#include "lua/safe_mode.hpp"
#include "prompt/call.hpp"

namespace dinal::prompt {
namespace {

/// As a function that Lua can call; returns the chunk or the message, and the status.
int load_named(lua_State* L) {
    lua_pushinteger(L, luaL_loadfilex(L, lua_tostring(L, 1), lua::load_mode()));
    return 2;
}

}  // namespace

int load_file(lua_State* L, const char* file) {
    if (const auto why = files::outside(file, files::Access::read)) {
        const std::string text = fmt::format("cannot open {}: {}", file, *why);
        lua_pushlstring(L, text.data(), text.size());
        return LUA_ERRFILE;
    }
    lua_pushcfunction(L, load_named);
    lua_pushstring(L, file);
    int status = call(L, 1, 2);
    if (status == LUA_OK) {
        status = static_cast<int>(lua_tointeger(L, -1));
        lua_pop(L, 1);
    }
    return status;
}

}  // namespace dinal::prompt
