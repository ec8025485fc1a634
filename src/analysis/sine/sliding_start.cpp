#include "analysis/sine/sliding_start.hpp"

#include <cmath>
#include <numbers>

#include "analysis/sine/sine_arcs.hpp"
#include "theory/den_hartog.hpp"
#include "theory/theory_forced.hpp"

namespace dinal::analysis::sine {

std::optional<model::State> sliding_start(const SingleSine& sine) {
    constexpr double half_turn = std::numbers::pi;
    const double r = sine.r, half = half_turn / r;
    const auto motion = theory::DenHartog(r, sine.zeta).without_stops(sine.sliding);
    if (!motion || !(motion->amplitude > 0)) return {};
    // The load is greatest at a phase of pi/2, theta by its lag later; half a period after that all is the opposite.
    const double crest = half_turn / 2 + motion->lag;
    if (sine.sliding > 0 && SineArcs::applies_to(sine)) {
        SineArcs slide(sine);
        slide.leave(crest, motion->amplitude, -1);
        constexpr double nearly = 1e-6;  // a stop just before the turn is one for the search
        const auto end = slide.first_zero(half * (1 + nearly));
        if (!end || *end < half * (1 - nearly)) return {};
    }
    const double phase = sine.phase - crest;
    const double halves = std::floor(phase / half_turn);
    const double since = (phase / half_turn - halves) * half;  // the last turn
    const double sign = std::fmod(halves, 2) == 0 ? 1 : -1;
    const double phi = theory::magnification(r, sine.zeta), lag = theory::phase_lag(r, sine.zeta);
    const auto forced = [&](double x) {
        const double angle = r * x + crest - lag;
        return theory::Motion2{phi * std::sin(angle), phi * r * std::cos(angle)};
    };
    const theory::Motion2 at_turn = forced(0), now = forced(since);
    const theory::Motion2 free = theory::free_motion(
        theory::Modes(sine.zeta), {motion->amplitude - at_turn.y - sine.sliding, -at_turn.dy}, since);
    const model::State start = sine.state({sign * (now.y + sine.sliding + free.y), sign * (now.dy + free.dy)});
    if (!std::isfinite(start.theta) || !std::isfinite(start.velocity)) return {};
    return start;
}

}  // namespace dinal::analysis::sine
