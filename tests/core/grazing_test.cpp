// Velocities that dip to zero and come back within one step: two events or none, never one.

#include <cmath>

#include "support/catch.hpp"
#include "support/kinds.hpp"
#include "support/measure.hpp"
#include "support/reference_systems.hpp"

namespace dinal::grazing_test {

namespace {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

/// Drawn along by a ramp with a sine on top: in the long run the velocity is slope (1 - (1 + depth) sin(...)) / k,
/// which passes zero twice in every period when depth > 0, and not at all when depth < 0.
ReferenceSystem grazing(double friction, double depth) {
    const double zeta = 0.5, omega = 9, slope = 0.3;
    const double r = omega / resonance;
    const double magnification = 1 / std::hypot(1 - r * r, 2 * zeta * r);
    const double amplitude = slope * (1 + depth) / (omega * magnification);
    return {"grazing",
            nondimensional(zeta, friction),
            *Excitation::make(Ramp{.slope = slope}) + harmonic(amplitude, omega),
            {{0, {.slope = slope, .amplitude = amplitude, .omega = omega}}},
            {0, slope},
            {0, 12},
            4};
}

}  // namespace

TEST_CASE("a velocity that passes zero and returns within a step makes two turns", "[exact][spectral][rk4][grazing]") {
    const Integrator integrator = GENERATE(as<Integrator>{}, Exact{}, Spectral{}, Rk4{0.005});
    const bool spectral = !std::holds_alternative<Rk4>(integrator);  // or exact
    for (const double friction : {0.0, 0.01}) {
        // At 1e-5 the velocity is on the wrong side for 1/1000 of T0, a fifth of a step.
        for (const double depth : {1e-2, 1e-3, 1e-4, 1e-5, -1e-5, -1e-4, -1e-3}) {
            const ReferenceSystem s = grazing(friction, depth);
            const ExactMotion exact = s.exact();
            const Run run = must_run(s, Grid::none(), integrator);
            CAPTURE(spectral, friction, depth, exact.events().size());
            REQUIRE((depth > 0) == (exact.events().size() > 20));
            REQUIRE(run.events.size() == exact.events().size());
            for (std::size_t i = 0; i < run.events.size(); ++i) {
                CHECK(as_stop(run.events[i].kind) == exact.events()[i].kind);
                // A velocity error e moves a zero of curvature 2 by e / (distance between the two zeros): here
                // 1e-9 from h^4, or a few roundings of 1e-16 in spectral, against 1e-3 T0.
                const double late = static_cast<double>(run.events[i].t - exact.events()[i].t);
                CHECK(std::fabs(late) <= (spectral ? 1e-11 : 1e-5));
            }
        }
    }
}

}  // namespace dinal::grazing_test
