// Lua's own headers instead of <lua.hpp>, which adds extern "C". luaconf.h itself declares the linkage of the library's
// C++ build, which is C on Debian 12 and C++ on Debian 13.
#pragma once

#include <lua.h>
// must come after lua.h
#include <lauxlib.h>
#include <lualib.h>
