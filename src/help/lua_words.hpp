// Keywords and standard functions of Lua, for users of other languages: `?for`, `?math.sin`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dinal::help {

/// An explanation and lines that run; empty if Lua has no such word.
std::string lua_word(std::string_view word);

/// All such words, including "math.cos" etc.
std::vector<std::string_view> lua_words();

}  // namespace dinal::help
