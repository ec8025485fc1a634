// The function help() itself.
#pragma once

#include "lua/bind.hpp"

namespace dinal::help {

extern const lua::Class help_functions;
void register_help(lua_State* L);

}  // namespace dinal::help
