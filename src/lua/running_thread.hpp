// Which Lua thread runs, for the handler of Ctrl-C: interrupt.cpp sets its hook there.
#pragma once

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// While it lives, `callee` runs, called from `caller`.
class RunningThread {
public:
    RunningThread(lua_State* caller, lua_State* callee);
    ~RunningThread();
    RunningThread(const RunningThread&) = delete;
    RunningThread& operator=(const RunningThread&) = delete;

private:
    lua_State* caller_;
};

}  // namespace dinal::lua
