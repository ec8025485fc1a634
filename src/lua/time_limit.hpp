// How long a chunk may run, by the clock on the wall.
//
// A timer watches the clock. When the time is over it stops what runs, as Ctrl-C would. What cannot be
// stopped so (a search for a pattern that never ends, a finalizer) is ended with the whole program a second later.
#pragma once

namespace dinal::lua {

/// From now on. Once, for the whole process, from the thread that runs Lua.
void set_time_limit(double seconds);

/// 0 when there is none.
[[nodiscard]] double time_limit() noexcept;

/// While it lives, the time runs. One within another changes nothing.
class TimeAllowance {
public:
    TimeAllowance();
    ~TimeAllowance();
    TimeAllowance(const TimeAllowance&) = delete;
    TimeAllowance& operator=(const TimeAllowance&) = delete;
};

}  // namespace dinal::lua
