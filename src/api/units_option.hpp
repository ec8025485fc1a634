// The option `units` of a system, a run and its pictures, and the units of what comes of them.
#pragma once

#include <optional>

#include "api/run.hpp"
#include "lua/options.hpp"
#include "model/units.hpp"

namespace dinal::api {

/// What it says; none when it is absent.
std::optional<model::Units> asked_units(lua_State* L, const lua::Options& options);

/// Those of its system, or those that stand in the file that it was read from.
const model::Units& units_of(const Run& run);

/// Pushes { theta, t, M }; what has none is nil.
int push_units(lua_State* L, const model::Units& units);

}  // namespace dinal::api
