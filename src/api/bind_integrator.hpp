// The Lua text of an integrator.
#pragma once

#include <string>

#include "motion/integrator.hpp"

namespace dinal {

/// "integrator.rk4{ h = 0.001 }": makes the same integrator again.
std::string lua_text(const Integrator& integrator);

}  // namespace dinal
