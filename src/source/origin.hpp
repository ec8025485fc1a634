// The origin of a run: its task, and Lua text that repeats it.
#pragma once

#include <string>
#include <vector>

#include "lua/lua_headers.hpp"
#include "motion/integrators.hpp"
#include "motion/simulate.hpp"

namespace dinal::source {

/// The arguments of sys:simulate{...}, of the right types but not yet validated.
struct Task {
    model::SystemHandle system;
    model::Drive drive;
    motion::Window window;
    motion::Grid rows;
    motion::Integrator integrator;
};

/// The origin of a simulated run; one read from a file has none.
struct Origin : Task {
    /// Lua text that rebuilds M and the system, with upvalues as at the start of the run; empty without user functions,
    /// as the text can then be made later.
    std::vector<std::string> set_up;
};

Origin origin_of(lua_State* L, Task task);

/// Lua text that repeats the run, as lines.
std::vector<std::string> repeat_lines(const Origin& origin);

}  // namespace dinal::source
