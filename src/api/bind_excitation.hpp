// Excitations from Lua: what may stand for M, and the functions that make one.
#pragma once

#include <string_view>

#include "lua/bind.hpp"
#include "model/excitation.hpp"

namespace dinal::api {

/// What stands at `index` as an excitation: nothing (M = 0), a number, a function or callable table, an excitation.
/// Raises a sentence headed by `what` for anything else, about that option if it is one.
model::Excitation to_excitation(lua_State* L, int index, std::string_view what, std::string_view option = "");

/// Pushes the excitation of one term, or raises what is wrong with it.
int push_term(lua_State* L, model::Term term);

}  // namespace dinal::api
