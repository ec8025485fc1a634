#include <fmt/format.h>

#include "api/theory_arguments.hpp"
#include "api/theory_functions.hpp"
#include "api/theory_options.hpp"
#include "motion/rk4/rk4.hpp"
#include "theory/den_hartog.hpp"
#include "theory/theory_forced.hpp"
#include "theory/theory_steps.hpp"

namespace dinal::api::theory_functions {

namespace {

using namespace theory;
namespace options = theory_options;

/// The two results of den_hartog{...} and den_hartog_fundamental{...}.
template <class Select>
int sliding_motion(lua_State* L, const text::Call& call, Select select) {
    TheoryArguments arguments(L, call);
    const Quantity r = arguments.quantity("r");
    const Quantity friction_ratio = arguments.quantity("friction_ratio");
    const Quantity zeta = arguments.quantity("zeta");
    const Quantity breakaway_ratio = arguments.quantity("breakaway_ratio");
    return arguments.push_results([&](std::size_t i) {
        if (breakaway_ratio[i] < friction_ratio[i]) {
            arguments.refuse("breakaway_ratio", i, breakaway_ratio[i],
                             fmt::format("must be at least friction_ratio = {}", friction_ratio[i]));
        }
        const auto motion = DenHartog(r[i], zeta[i]).motion(friction_ratio[i], breakaway_ratio[i]);
        return motion ? select(*motion) : std::array{no_value, no_value};
    });
}

}  // namespace

std::array<double, 2> linearised(double r, double friction_ratio, double zeta) {
    const auto motion = linearised_friction(r, zeta, friction_ratio);
    return motion ? std::array{motion->amplitude, motion->lag} : std::array{no_value, no_value};
}

int den_hartog(lua_State* L) {
    return sliding_motion(L, options::den_hartog, [](const SlidingMotion& y) {
        return std::array{y.amplitude, y.lag};
    });
}

int den_hartog_fundamental(lua_State* L) {
    return sliding_motion(L, options::den_hartog_fundamental, [](const SlidingMotion& y) {
        return std::array{y.fundamental_amplitude, y.fundamental_lag};
    });
}

double stop_boundary(double r, double zeta, double factor) {
    return DenHartog(r, zeta).stop_boundary(factor);
}

int step_limit(lua_State* L) {
    TheoryArguments arguments(L, options::step_limit);
    const model::Oscillator& system = *arguments.system();
    options::StepRule asked;
    arguments.options().fill(asked);
    const Quantity theta0 = arguments.quantity("theta0");
    const Quantity velocity0 = arguments.quantity("velocity0");
    const bool own_torque = !arguments.options().has("Mc");
    const Quantity Mc = arguments.quantity("Mc", Quantity(0));
    return arguments.push_result([&](std::size_t i) {
        if (asked.rule == options::StepRule::Name::rk4) return motion::rk4::stability_limit(system);
        const model::State initial{theta0[i], velocity0[i]};
        if (system.kinetic_friction() > 0 && initial.theta == 0 && initial.velocity == 0) {
            arguments.options().fail(
                "theta0", "theta0 or velocity0 is needed, because this rule divides by the greatest velocity");
        }
        if (asked.rule == options::StepRule::Name::corrected) return euler_step_limit(system, initial);
        return printed_step_limit(system, initial, own_torque ? system.characteristic_torque(initial) : Mc[i]);
    });
}

}  // namespace dinal::api::theory_functions
