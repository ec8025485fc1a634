// The Lua text of a system.
#pragma once

#include <string>

#include "model/oscillator.hpp"

namespace dinal {

/// "system{ I = 1, k = 39.5, C = 1.5, Rd = 2, Re = 3 }": makes the same system again; parts that are 0 are left out.
std::string lua_text(const Oscillator& system);

}  // namespace dinal
