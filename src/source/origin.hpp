// Where a run came from: what was asked, and the Lua text that asks it again.
#pragma once

#include <string>
#include <vector>

#include "lua/lua_headers.hpp"
#include "motion/engine/run.hpp"
#include "motion/integrators.hpp"
#include "motion/simulate.hpp"

namespace dinal::source {

/// All that sys:simulate{...} was told, checked for kind but not yet for sense.
struct Task {
    model::SystemHandle system;
    model::Drive drive;
    motion::Window window;
    motion::Grid rows;
    motion::Integrator integrator;
};

/// What was simulated. A trajectory that was read from a file has none.
struct Origin : Task {
    /// Lua text that makes M and the system again, with the values that the variables of their functions had when the
    /// run was started; empty where there are no functions, and the text can be had at any time.
    std::vector<std::string> set_up;
};

Origin origin_of(lua_State* L, Task task);

/// Lua text that makes the same run again, as lines.
std::vector<std::string> repeat_lines(const Origin& origin);

}  // namespace dinal::source
