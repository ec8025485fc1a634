// A Lua state with dinal in it for one script of benchmarks: what the script returns can be called again and again.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "help/library.hpp"

namespace bench {

class LuaState {
public:
    explicit LuaState(const char* script) : state_(luaL_newstate(), lua_close) {
        luaL_openlibs(state_.get());
        dinal::help::open_library(state_.get());
        kept(luaL_dostring(state_.get(), script) == LUA_OK);
        returned_ = lua_gettop(state_.get());
    }

    [[nodiscard]] lua_State* get() const { return state_.get(); }
    /// Why the script or a call failed; empty when none did.
    [[nodiscard]] const std::string& failure() const { return failure_; }
    /// Calls the function that the script returned in this place with one number; false when something has failed. The
    /// results are on the top of the stack until the next call.
    bool call(int place, double argument = 0, int results = 0) {
        if (!failure_.empty()) return false;
        lua_settop(state_.get(), returned_);
        lua_pushvalue(state_.get(), place);
        lua_pushnumber(state_.get(), argument);
        return kept(lua_pcall(state_.get(), 1, results, 0) == LUA_OK);
    }
    /// What the script returned in this place, or the last call did at -1, -2 and so on.
    [[nodiscard]] double number(int place) const { return lua_tonumber(state_.get(), place); }

private:
    bool kept(bool well) {
        if (!well) failure_ = lua_tostring(state_.get(), -1);
        return well;
    }

    std::unique_ptr<lua_State, decltype(&lua_close)> state_;
    int returned_ = 0;
    std::string failure_;
};

}  // namespace bench
