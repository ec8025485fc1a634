#include "help/tour.hpp"

#include <fmt/core.h>

#include <array>
#include <string_view>

namespace dinal::help {
namespace {

// Lines have at most 77 columns and pages 20 lines, for a terminal of 80 by 24. A test types all of them.
constexpr std::array<std::string_view, 6> pages = {
    R"(A mass on a spring, with viscous damping C and dry friction: Rd is the
torque while it slides, Re breakaway torque.

    > sys = system{ I = 1, k = 4*math.pi^2, C = 1.5, Rd = 16.5, Re = 18 }
    > sys

The names on the left are fields: sys.T0 is the natural period. Tab
completes names, and lists the options inside { }. The last value that was
computed is in ans; a name alone only shows what it holds.

help(sys) says more about it, help "dead zone" searches, ? is short for help,
and help "contents" lists all there is.
)",
    R"(The excitation is the torque M(t) on the mass: any function of Lua.

    > M = function(t) return 30*math.sin(2*math.pi*t) end

Ready-made terms add and scale, and know where they jump:

    > pulse = excitation.pulse{ at = 1.5, width = 0.2 }
    > 3*pulse + excitation.harmonic{ amplitude = 30, frequency = 1 }
)",
    R"(A run: the system, driven by M, from t = 0 to t_end, with a row every dt.

    > run = sys:simulate{ M = M, theta0 = 1, t_end = 20, dt = 0.01 }
    > run

Mind the colon. A wrong name is answered by the right one; try it:

    > sys:simulate{ M = M, theta_0 = 1, t_end = 20, dt = 0.01 }
)",
    R"(What is in a run: columns, events, and the motion between the rows.

    > run.theta
    > run.theta:max(), run.theta[1]
    > run.events
    > run:at(3.21)
    > run:plot()
    > run:explain()

turn: the motion reverses; stick: the mass stays; slip: it breaks away;
rest: it stops, and nothing can move it any more.
)",
    R"(Change one number and look again. A ; at the end hides the value.

    > for _, Rd in ipairs{ 5, 15, 25, 35 } do
    >   local s = sys:with{ Rd = Rd, Re = 1.1*Rd }
    >   local r = s:simulate{ M = M, theta0 = 1, t_end = 20, dt = 0.01 }
    >   print(Rd, #r.events, r.outcome)
    > end

A block goes on until its last end. The arrow up brings it back whole.
)",
    R"(Keep what you did:

    > run:save("run.csv")
    > :save "tour.lua"

run.csv begins with the Lua text that makes the run again, and tour.lua holds
what you typed as a script. :help lists such commands, :quit leaves.

That was all. Next: docs/tutorial.md, and examples/ with one idea each.
)"};

}  // namespace

std::size_t tour_pages() {
    return pages.size();
}

std::string tour_page(std::size_t page) {
    const std::string_view text = pages.at(page - 1);
    if (page == 1) {
        return fmt::format(
            "dinal, a laboratory for oscillators with dry friction. Here is a tour of two\n"
            "minutes: type the lines that stand after >, then help(2) for page 2 of {}.\n\n{}",
            pages.size(), text);
    }
    const std::string next = page < pages.size() ? fmt::format("\nhelp({}) is the next page.\n", page + 1) : "";
    return fmt::format("Page {} of {}\n\n{}{}", page, pages.size(), text, next);
}

}  // namespace dinal::help
