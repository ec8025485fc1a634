// Conversion of Lua values to excitations.
#pragma once

#include <optional>
#include <string_view>

#include "lua/bind.hpp"
#include "model/drive.hpp"
#include "model/system.hpp"

namespace dinal::api {

/// The excitation at `index`: nothing (M = 0), a number, a function or callable table, or an excitation. Raises an
/// error for anything else; it begins with `what` and names `option` if given.
model::Excitation to_excitation(lua_State* L, int index, std::string_view what, std::string_view option = "");

/// M with its functions replaced by native terms, equal to rounding in this time span. Empty if that is impossible for
/// some function, or if other Lua code runs during the run and may change variables of M.
std::optional<model::Excitation> terms_alone(lua_State* L, const model::System& system, const model::Drive& drive,
                                             double from, double to);
/// The same for M alone, if no other function runs.
std::optional<model::Excitation> terms_alone(lua_State* L, const model::Excitation& M, double from, double to);
/// M with the proven periods of its functions declared.
model::Excitation with_periods(lua_State* L, const model::Excitation& M);

/// Pushes the excitation of one term, or raises its error.
int push_term(lua_State* L, model::Term term);

}  // namespace dinal::api
