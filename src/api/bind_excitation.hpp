// Excitations from Lua: what may stand for M, and the functions that make one.
#pragma once

#include <string_view>

#include "lua/bind.hpp"
#include "model/excitation.hpp"

namespace dinal::api {

/// What stands at `index` as an excitation: nothing (M = 0), a number, a function or callable table, an excitation.
/// Raises a sentence headed by `what` for anything else, about that option if it is one.
model::Excitation to_excitation(lua_State* L, int index, std::string_view what, std::string_view option = "");

/// The functions of the module `excitation`, in two files by what they take; each returns the new object.
namespace excitation_functions {
int constant(lua_State* L);
int harmonic(lua_State* L);
int step(lua_State* L);
int pulse(lua_State* L);
int half_sine(lua_State* L);
int gaussian(lua_State* L);
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
int push_term(lua_State* L, model::Term term);
}  // namespace excitation_functions

}  // namespace dinal::api
