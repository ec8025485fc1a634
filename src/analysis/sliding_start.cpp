#include "analysis/sliding_start.hpp"

#include <cmath>
#include <numbers>

#include "model/lowered.hpp"
#include "theory/den_hartog.hpp"
#include "theory/theory_forced.hpp"
#include "theory/theory_modes.hpp"

namespace dinal::analysis {

std::optional<model::State> sliding_start(const SteadyQuestion& question) {
    constexpr double half_turn = std::numbers::pi;
    const auto components = question.excitation.components();
    if (components.size() != 1 || !question.system.has_linear_spring()) return {};
    const model::Component& only = components.front();
    const auto* sine = std::get_if<model::Harmonic>(&only.term);
    if (sine == nullptr || std::isfinite(only.from) || std::isfinite(only.to)) return {};
    const model::Oscillator& system = question.system;
    const model::Lowered lowered(system);
    const double Rd = lowered.braking(model::Motion::forward), load = only.gain * sine->amplitude;
    const double M0 = std::fabs(load), omega0 = system.natural_frequency(), r = sine->omega / omega0;
    const bool even = Rd == -lowered.braking(model::Motion::backward);
    if (!(M0 > 0) || !even || lowered.has_remainder() || !(r > theory::DenHartog::slowest) ||
        !(r < theory::DenHartog::fastest)) {
        return {};
    }
    const double zeta = system.damping_ratio(), unit = M0 / system.stiffness();
    const auto motion = theory::DenHartog(r, zeta).without_stops(Rd / M0);
    if (!motion || !(motion->amplitude > 0)) return {};
    // The load is greatest at a phase of pi/2, theta by its lag later; half a period after that all is the opposite.
    const double crest = half_turn / 2 + motion->lag, half = half_turn / sine->omega;
    const double phase = sine->omega * question.drive.start + sine->phase + (load < 0 ? half_turn : 0) - crest;
    const double halves = std::floor(phase / half_turn);
    const double since = (phase / half_turn - halves) * half;  // the last turn
    const double sign = std::fmod(halves, 2) == 0 ? 1 : -1;
    const double phi = unit * theory::magnification(r, zeta), lag = theory::phase_lag(r, zeta),
                 shift = Rd / system.stiffness();
    const auto forced = [&](double t) {
        const double angle = sine->omega * t + crest - lag;
        return theory::Motion2{phi * std::sin(angle), phi * r * std::cos(angle)};
    };
    const theory::Motion2 at_turn = forced(0), now = forced(since);
    const theory::Motion2 free = theory::free_motion(
        theory::Modes(zeta), {motion->amplitude * unit - at_turn.y - shift, -at_turn.dy}, omega0 * since);
    const model::State start{sign * (now.y + shift + free.y), sign * omega0 * (now.dy + free.dy)};
    if (!std::isfinite(start.theta) || !std::isfinite(start.velocity)) return {};
    return start;
}

}  // namespace dinal::analysis
