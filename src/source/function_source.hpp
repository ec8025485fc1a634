// The source text of a Lua function, for whoever writes down what was simulated.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"

namespace dinal::source {

/// The function at `index` as a Lua expression: "function(t) return 1 end", "math.sin", "load(...)"; none when its text
/// is not at hand or it cannot be told from others on its lines. Values of upvalues are not in the text.
std::optional<std::string> function_source(lua_State* L, int index);

/// Remembers the text of a chunk that is in no file (-e, stdin, an input at the prompt), by the name it was loaded
/// with ("=stdin"). Many texts may have the same name.
void keep_source(lua_State* L, const char* chunk_name, std::string_view text);

/// The text that was kept last under that name.
std::optional<std::string> last_kept_source(lua_State* L, const std::string& chunk_name);

}  // namespace dinal::source
