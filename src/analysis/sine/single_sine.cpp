#include "analysis/sine/single_sine.hpp"

#include <cmath>
#include <numbers>

#include "model/lowered.hpp"
#include "theory/den_hartog.hpp"

namespace dinal::analysis::sine {

std::optional<SingleSine> single_sine(const SteadyQuestion& question) {
    const auto components = question.excitation.components();
    const model::Oscillator& system = question.system;
    if (components.size() != 1 || !system.has_linear_spring() || system.walls()) return {};
    const model::Component& only = components.front();
    const auto* sine = std::get_if<model::Harmonic>(&only.term);
    if (sine == nullptr || std::isfinite(only.from) || std::isfinite(only.to)) return {};
    const model::Lowered lowered(system);
    const double Rd = lowered.braking(model::Motion::forward), Re = lowered.holding(model::Motion::forward);
    const bool even = Rd == -lowered.braking(model::Motion::backward) && Re == lowered.holding(model::Motion::backward);
    const double load = only.gain * sine->amplitude, M0 = std::fabs(load);
    SingleSine own{.zeta = system.damping_ratio(), .omega0 = system.natural_frequency()};
    own.r = sine->omega / own.omega0;
    if (!(M0 > 0) || !even || lowered.has_remainder() || !(own.r > theory::DenHartog::slowest) ||
        !(own.r < theory::DenHartog::fastest)) {
        return {};
    }
    own.sliding = Rd / M0, own.holding = Re / M0;
    own.spare = (M0 - Re) / M0;
    own.unit = M0 / system.stiffness();
    own.phase = sine->omega * question.drive.start + sine->phase + (load < 0 ? std::numbers::pi : 0);
    return own;
}

}  // namespace dinal::analysis::sine
