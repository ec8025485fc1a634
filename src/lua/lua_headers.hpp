// Lua's own headers rather than <lua.hpp>, which adds extern "C": luaconf.h itself knows how the C++ build of the
// library names its functions, as in C on Debian 12 and as in C++ on Debian 13.
#pragma once

#include <lua.h>
// must come after lua.h
#include <lauxlib.h>
#include <lualib.h>
