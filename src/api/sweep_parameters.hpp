// The table that sweep and its like take: parameters with values, among options.
#pragma once

#include <vector>

#include "api/data.hpp"
#include "lua/options.hpp"

namespace dinal::api {

/// The parameters that the option `over` of the table at 1 names, with their values.
std::vector<DataColumn> take_parameters(lua_State* L, const text::Call& call);

/// Those of the table at this index: { r = values }, in the order of their names, or { { "r", values } }, as listed.
std::vector<DataColumn> parameters_in(lua_State* L, int table, const text::Call& call);

/// There must be one, their names must be different, and their points not too many.
void check_parameters(lua_State* L, const text::Call& call, const std::vector<DataColumn>& parameters);

/// Pushes the option of this name, a function, and returns its index.
int push_function(lua_State* L, const lua::Options& options, const char* name);

}  // namespace dinal::api
