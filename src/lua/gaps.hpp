// Numbers with gaps: nan where nothing was measured.
#pragma once

#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// The numbers of a table or a vector at `index`, which is that option of the call; nan is one, infinity is not.
std::vector<double> numbers_with_gaps_at(lua_State* L, int index, std::string_view call, std::string_view option);

}  // namespace dinal::lua
