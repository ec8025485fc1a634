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
    model::Oscillator system;
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

/// The lines that make a system and all that drives it. Without functions of a user Lua is not asked, and may be null.
std::vector<std::string> set_up_lines(lua_State* L, const model::Assembly& system, const model::Drive& drive);
/// These lines, and the one that runs it.
std::vector<std::string> repeat_lines(std::vector<std::string> set_up, const model::Assembly& system,
                                      const model::Drive& drive, const motion::Window& window, const motion::Grid& rows,
                                      const motion::Integrator& integrator);

}  // namespace dinal::source
