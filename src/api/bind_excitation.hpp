// Excitations between Lua and C++: what may stand for M, and the Lua text of one.
#pragma once

#include <string>
#include <string_view>

#include "model/excitation.hpp"
#include "lua/bind.hpp"

namespace dinal {

class ValueText;

/// What stands at `index` as an excitation: nothing (M = 0), a number, a function or callable table, an excitation.
/// Raises a sentence headed by `what` for anything else.
Excitation to_excitation(lua_State* L, int index, std::string_view what = "M");

/// Lua text that makes the excitation again: "0.5 * excitation.pulse{ amplitude = 1, at = 1.5, width = 0.2 }". Where
/// that is not possible (a long table, a function whose source is not at hand), a comment stands in its place.
/// With `whole`, functions come with the variables that they take from outside, and tables whole.
std::string describe(lua_State* L, const Excitation& excitation, ValueText* whole = nullptr);

/// The functions of the module `excitation`, in two files by what they take; each returns the new object.
namespace excitation_functions {
int constant(lua_State* L);
int harmonic(lua_State* L);
int step(lua_State* L);
int pulse(lua_State* L);
int half_sine(lua_State* L);
int ramp(lua_State* L);
int square(lua_State* L);
int sawtooth(lua_State* L);
int triangle(lua_State* L);
int chirp(lua_State* L);
int exponential(lua_State* L);
int polynomial(lua_State* L);
int samples(lua_State* L);
int scripted(lua_State* L);
/// Pushes the excitation of one term, or raises what is wrong with it.
int push_term(lua_State* L, Term term);
}  // namespace excitation_functions

}  // namespace dinal
