// Runs a piece of Lua as `dinal --safe` does, in a state of its own, with little time and memory.
#pragma once

#include <string_view>

/// Whatever the code does ends in a result or an error; anything else is a find.
void run_stranger(std::string_view code);
