// The table that sweep and its like take: parameters with values, among options.
#pragma once

#include <vector>

#include "api/data.hpp"
#include "lua/options.hpp"

namespace dinal::api {

/// Takes the parameters out of the table at 1: all that is no option of the call. The options stay, in a new table
/// there.
std::vector<DataColumn> take_parameters(lua_State* L, const text::Call& call);

/// There must be one, their names must be different, and their points not too many.
void check_parameters(lua_State* L, const text::Call& call, const std::vector<DataColumn>& parameters);

/// Pushes the option run, a function; its index.
int push_run_function(lua_State* L, const lua::Options& options);

}  // namespace dinal::api
