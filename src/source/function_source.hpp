// The source text of Lua functions, to document simulations.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"

namespace dinal::source {

/// The function at `index` as a Lua expression: "function(t) return 1 end", "math.sin", "load(...)"; none if its text
/// is unavailable or ambiguous. Does not include values of upvalues.
std::optional<std::string> function_source(lua_State* L, int index);

/// Keeps the text of a chunk without a file (-e, stdin, prompt input) under its chunk name ("=stdin"). Several texts
/// may share a name.
void keep_source(lua_State* L, const char* chunk_name, std::string_view text);

std::optional<std::string> last_kept_source(lua_State* L, const std::string& chunk_name);

}  // namespace dinal::source
