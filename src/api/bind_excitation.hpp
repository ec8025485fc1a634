// Excitations from Lua: what may stand for M, and the functions that make one.
#pragma once

#include <optional>
#include <string_view>

#include "lua/bind.hpp"
#include "model/drive.hpp"

namespace dinal::api {

/// What stands at `index` as an excitation: nothing (M = 0), a number, a function or callable table, an excitation.
/// Raises a sentence headed by `what` for anything else, about that option if it is one.
model::Excitation to_excitation(lua_State* L, int index, std::string_view what, std::string_view option = "");

/// The functions in M as native terms, to rounding, from one time to another. None where one is no such sum on each of
/// its pieces, or where something else runs in Lua meanwhile, which may change what M depends on.
std::optional<model::Excitation> terms_alone(lua_State* L, const model::System& system, const model::Drive& drive,
                                             double from, double to);
/// The same of M alone, if no other function runs.
std::optional<model::Excitation> terms_alone(lua_State* L, const model::Excitation& M, double from, double to);
/// The same M, whose functions have the periods that they are proven to have.
model::Excitation with_periods(lua_State* L, const model::Excitation& M);

/// Pushes the excitation of one term, or raises what is wrong with it.
int push_term(lua_State* L, model::Term term);

}  // namespace dinal::api
