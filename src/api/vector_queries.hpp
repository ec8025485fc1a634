// Methods of vectors that look for something, put together or add up, with their documentation; the list of all methods
// is in bind_vector.cpp.
#pragma once

#include "lua/bind.hpp"

namespace dinal::api::vector_functions {

int map(lua_State* L);
int find(lua_State* L);
int deviation(lua_State* L);
int place_of_maximum(lua_State* L);
int place_of_minimum(lua_State* L);
int cumulated(lua_State* L);
int differences(lua_State* L);
int interpolated(lua_State* L);
int joined(lua_State* L);
int pick(lua_State* L);    ///< v[w]
int masked(lua_State* L);  ///< v[v > 0]
int dot(lua_State* L);
int arctangent(lua_State* L);
int sorted(lua_State* L);
int quantile(lua_State* L);

}  // namespace dinal::api::vector_functions

namespace dinal::api {

inline constexpr lua::Member vector_query_members[] = {
    {lua::a_method<vector_functions::map>,
     {"v:map(f) -> vector", "f(x, i) of every element x, i its place: a number, or true for 1 and false for 0.",
      "print(vector{ 1, 2, 3 }:map(function(x) return 10 * x end))  --> vector{ 10, 20, 30 }"}},
    {lua::a_method<vector_functions::find>,
     {"v:find(f) -> vector", "The places, from 1, of the elements x for which f(x, i) is true; v[v:find(f)] has them.",
      "print(vector{ 5, 1, 7 }:find(function(x) return x > 3 end))  --> vector{ 1, 3 }"}},
    {lua::a_method<vector_functions::deviation>,
     {"v:std() -> number", "The standard deviation: the root of the sum of squares about the mean over #v - 1.",
      "print(vector{ 1, 2, 3 }:std())  --> 1.0"}},
    {lua::a_method<vector_functions::quantile>,
     {"v:quantile(p) -> number",
      "The value below which the part p of the elements lies, p from 0 to 1: 0.5 is the median. Linear between the sorted "
      "elements, of which the first is at p = 0 and the last at p = 1.",
      "print(vector{ 4, 1, 3, 2 }:quantile(0.5), vector{ 1, 2, 6 }:quantile(1))  --> 2.5\t6.0"}},
    {lua::a_method<vector_functions::place_of_maximum>,
     {"v:argmax() -> integer", "The place, from 1, of the greatest element, the first of equal ones.",
      "print(vector{ 1, 3, 2 }:argmax())  --> 2"}},
    {lua::a_method<vector_functions::place_of_minimum>,
     {"v:argmin() -> integer", "The place, from 1, of the least element, the first of equal ones.",
      "print(vector{ 1, 3, -2 }:argmin())  --> 3"}},
    {lua::a_method<vector_functions::cumulated>,
     {"v:cumsum() -> vector", "The sums of the first, the first two, ... of all elements.",
      "print(vector{ 1, 2, 3 }:cumsum())  --> vector{ 1, 3, 6 }"}},
    {lua::a_method<vector_functions::differences>,
     {"v:diff() -> vector", "Each element less the one before it: one number fewer.",
      "print(vector{ 1, 4, 9 }:diff())  --> vector{ 3, 5 }"}},
    {lua::a_method<vector_functions::interpolated>,
     {"v:interp(x, y) -> vector",
      "At each element the value of straight lines through the points x, y; x must increase, and beyond its ends the "
      "first and the last y hold.",
      "print(vector{ 0.5, 1.5, 9 }:interp(vector{ 0, 1, 2 }, vector{ 0, 10, 30 }))  --> vector{ 5, 20, 30 }"}},
    {lua::a_method<vector_functions::dot>,
     {"v:dot(w) -> number", "The sum of the products of elements in the same place.",
      "print(vector{ 1, 2 }:dot(vector{ 3, 4 }))  --> 11.0"}},
    {lua::a_method<vector_functions::arctangent>,
     {"v:atan(w = 1) -> vector", "The angle of each point (w, v), rad, from -pi to pi; w is a vector or a number.",
      "print(vector{ 1, 1 }:atan(vector{ 1, -1 }))  --> vector{ 0.785398, 2.35619 }"}},
    {lua::a_method<vector_functions::sorted>,
     {"v:sort() -> vector", "The elements from the least to the greatest, nan last.",
      "print(vector{ 3, 1, 2 }:sort())  --> vector{ 1, 2, 3 }"}},
    {lua::a_metamethod<vector_functions::joined>("__concat"),
     {"v .. w, v .. number -> vector", "The elements of v, then those of w.",
      "print(vector{ 1, 2 } .. vector{ 3 } .. 4)  --> vector{ 1, 2, 3, 4 }"}},
    {lua::a_metamethod<vector_functions::pick>("__index"),
     {"v[w], v[v > 0] -> vector",
      "Some of the elements. A comparison (< <= > >=) in the brackets picks those for which it holds, also of another "
      "vector of the same length: run.t[run.theta > 0.5]. A vector w of 0 and 1 as long as v picks those with 1; any "
      "other w has their places, such as v:find(function(x) return x > 0 and x < 1 end).",
      "v = vector{ 5, -1, 7 }\nprint(v[v > 0], v[vector{ 3, 1 }])  --> vector{ 5, 7 }\tvector{ 7, 5 }"}},
};

}  // namespace dinal::api
