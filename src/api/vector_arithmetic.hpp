// What Lua's operators and mathematics do with whole vectors: the functions behind v + w, v < 3, v:sin().
#pragma once

#include "lua/lua_headers.hpp"

namespace dinal::api::vector_functions {

int sine(lua_State* L);
int cosine(lua_State* L);
int tangent(lua_State* L);
int absolute(lua_State* L);
int square_root(lua_State* L);
int exponential(lua_State* L);
int logarithm(lua_State* L);
int negated(lua_State* L);

int add(lua_State* L);
int subtract(lua_State* L);
int multiply(lua_State* L);
int divide(lua_State* L);
int power(lua_State* L);

int less(lua_State* L);
int less_or_equal(lua_State* L);
int equal(lua_State* L);

}  // namespace dinal::api::vector_functions
