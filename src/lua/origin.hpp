// Where a run came from: what was asked, and the Lua text that asks it again.
#pragma once

#include <lua.hpp>
#include <string>
#include <vector>

#include "core/simulate.hpp"

namespace dinal {

/// All that sys:simulate{...} was told, checked for kind but not yet for sense.
struct Task {
    Oscillator system;
    Excitation excitation;
    State initial;
    Window window;
    Grid rows;
    Integrator integrator;
};

/// What was simulated. A trajectory that was read from a file has none.
struct Origin {
    Oscillator system;
    Integrator integrator;
    Excitation excitation;
    /// Lua text that makes the same run again, as lines: with the values that its variables had when it was started.
    std::vector<std::string> lines;
};

Origin origin_of(lua_State* L, const Task& task);

}  // namespace dinal
