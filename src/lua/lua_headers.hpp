// Lua's own headers. Not <lua.hpp>, which says extern "C" around them: luaconf.h itself knows how the C++ build of the
// library names its functions, on Debian 12 as in C and on Debian 13 as in C++.
#pragma once

#include <lua.h>
// after lua.h
#include <lauxlib.h>
#include <lualib.h>
