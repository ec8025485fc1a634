// The words and standard functions of Lua, for those who know another language: `?for`, `?math.sin`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dinal::help {

/// A line that says what the word is, and lines that run; empty if Lua has no such word.
std::string lua_word(std::string_view word);

/// All such words, "math.cos" among them.
std::vector<std::string_view> lua_words();

}  // namespace dinal::help
