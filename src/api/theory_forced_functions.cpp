#include <fmt/format.h>

#include "api/theory_arguments.hpp"
#include "api/theory_functions.hpp"
#include "motion/integrator.hpp"
#include "theory/den_hartog.hpp"
#include "theory/theory_forced.hpp"
#include "theory/theory_steps.hpp"

namespace dinal::api::theory_functions {

namespace {

using namespace theory;

constexpr text::Range den_hartog_r{"be 0 or from 0.0001 to 1e6", [](double x) {
                                       return x == 0 || (x >= DenHartog::slowest && x <= DenHartog::fastest);
                                   }};
constexpr text::Range at_least_one{"be at least 1: breakaway takes no less than kinetic friction",
                                   [](double x) { return x >= 1; }};

template <double (*function)(double, double)>
int of_r_and_zeta(lua_State* L, const char* call, const char* example) {
    TheoryArguments arguments(L, call, example, {"r", "zeta"});
    const Quantity r = arguments.quantity("r", text::not_negative);
    const Quantity zeta = arguments.quantity("zeta", text::not_negative, 0);
    return arguments.push_result([&](std::size_t i) { return function(r[i], zeta[i]); });
}

/// The two results of den_hartog{...} and den_hartog_fundamental{...}.
template <class Select>
int sliding_motion(lua_State* L, const char* call, const char* example, Select select) {
    TheoryArguments arguments(L, call, example, {"r", "friction_ratio", "zeta", "breakaway_ratio"});
    const Quantity r = arguments.quantity("r", den_hartog_r);
    const Quantity friction_ratio = arguments.quantity("friction_ratio", text::not_negative);
    const Quantity zeta = arguments.quantity("zeta", text::not_negative, 0);
    const Quantity breakaway_ratio = arguments.options().has("breakaway_ratio")
                                         ? arguments.quantity("breakaway_ratio", text::not_negative)
                                         : friction_ratio;
    return arguments.push_results([&](std::size_t i) {
        if (breakaway_ratio[i] < friction_ratio[i]) {
            arguments.refuse("breakaway_ratio", i, breakaway_ratio[i],
                             fmt::format("must be at least friction_ratio = {:.6g}", friction_ratio[i]));
        }
        const auto motion = DenHartog(r[i], zeta[i]).motion(friction_ratio[i], breakaway_ratio[i]);
        return motion ? select(*motion) : std::array{no_value, no_value};
    });
}

}  // namespace

int magnification(lua_State* L) {
    return of_r_and_zeta<theory::magnification>(L, "theory.magnification",
                                                "theory.magnification{ r = 0.5, zeta = 0.1 }");
}

int phase_lag(lua_State* L) {
    return of_r_and_zeta<theory::phase_lag>(L, "theory.phase_lag", "theory.phase_lag{ r = 0.5, zeta = 0.1 }");
}

int transmissibility(lua_State* L) {
    return of_r_and_zeta<theory::transmissibility>(L, "theory.transmissibility",
                                                   "theory.transmissibility{ r = 0.5, zeta = 0.1 }");
}

int equivalent_damping(lua_State* L) {
    TheoryArguments arguments(L, "theory.equivalent_damping",
                              "theory.equivalent_damping{ Rd = 2, omega = 6.28, amplitude = 0.5 }",
                              {"Rd", "omega", "amplitude"});
    const Quantity Rd = arguments.quantity("Rd", text::not_negative);
    const Quantity omega = arguments.quantity("omega", text::positive);
    const Quantity amplitude = arguments.quantity("amplitude", text::positive);
    return arguments.push_result(
        [&](std::size_t i) { return theory::equivalent_damping(Rd[i], omega[i], amplitude[i]); });
}

int equivalent_zeta(lua_State* L) {
    TheoryArguments arguments(L, "theory.equivalent_zeta",
                              "theory.equivalent_zeta{ friction_ratio = 0.2, r = 0.5, magnification = 1.3 }",
                              {"friction_ratio", "r", "magnification"});
    const Quantity friction_ratio = arguments.quantity("friction_ratio", text::not_negative);
    const Quantity r = arguments.quantity("r", text::positive);
    const Quantity phi = arguments.quantity("magnification", text::positive);
    return arguments.push_result(
        [&](std::size_t i) { return equivalent_damping_ratio(friction_ratio[i], r[i], phi[i]); });
}

int linearised(lua_State* L) {
    TheoryArguments arguments(L, "theory.linearised", "theory.linearised{ r = 0.5, friction_ratio = 0.1 }",
                              {"r", "friction_ratio", "zeta"});
    const Quantity r = arguments.quantity("r", text::not_negative);
    const Quantity friction_ratio = arguments.quantity("friction_ratio", text::not_negative);
    const Quantity zeta = arguments.quantity("zeta", text::not_negative, 0);
    return arguments.push_results([&](std::size_t i) {
        const auto motion = linearised_friction(r[i], zeta[i], friction_ratio[i]);
        return motion ? std::array{motion->amplitude, motion->lag} : std::array{no_value, no_value};
    });
}

int friction_work(lua_State* L) {
    TheoryArguments arguments(L, "theory.friction_work", "theory.friction_work{ Rd = 2, amplitude = 0.5 }",
                              {"Rd", "amplitude"});
    const Quantity Rd = arguments.quantity("Rd", text::not_negative);
    const Quantity amplitude = arguments.quantity("amplitude", text::not_negative);
    return arguments.push_result([&](std::size_t i) { return theory::friction_work(Rd[i], amplitude[i]); });
}

int growth_at_resonance(lua_State* L) {
    TheoryArguments arguments(L, "theory.growth_at_resonance", "theory.growth_at_resonance{ friction_ratio = 0.2 }",
                              {"friction_ratio"});
    const Quantity friction_ratio = arguments.quantity("friction_ratio", text::not_negative);
    return arguments.push_result([&](std::size_t i) { return theory::growth_at_resonance(friction_ratio[i]); });
}

int den_hartog(lua_State* L) {
    return sliding_motion(L, "theory.den_hartog", "theory.den_hartog{ r = 0.75, friction_ratio = 0.5 }",
                          [](const SlidingMotion& y) {
                              return std::array{y.amplitude, y.lag};
                          });
}

int den_hartog_fundamental(lua_State* L) {
    return sliding_motion(L, "theory.den_hartog_fundamental",
                          "theory.den_hartog_fundamental{ r = 0.75, friction_ratio = 0.5 }",
                          [](const SlidingMotion& y) {
                              return std::array{y.fundamental_amplitude, y.fundamental_lag};
                          });
}

int stop_boundary(lua_State* L) {
    TheoryArguments arguments(L, "theory.stop_boundary", "theory.stop_boundary{ r = 0.75, zeta = 0.1 }",
                              {"r", "zeta", "Re_over_Rd"});
    const Quantity r = arguments.quantity("r", den_hartog_r);
    const Quantity zeta = arguments.quantity("zeta", text::not_negative, 0);
    const Quantity factor = arguments.quantity("Re_over_Rd", at_least_one, 1);
    return arguments.push_result([&](std::size_t i) { return DenHartog(r[i], zeta[i]).stop_boundary(factor[i]); });
}

int step_limit(lua_State* L) {
    TheoryArguments arguments(L, "theory.step_limit", "theory.step_limit{ system = sys, rule = \"rk4\" }",
                              {"system", "rule", "theta0", "velocity0", "Mc"});
    const model::Oscillator& system = arguments.system();
    const auto rule = arguments.options().choice("rule", {"rk4", "report", "corrected"}, 0);
    const Quantity theta0 = arguments.quantity("theta0", text::any_finite, 0);
    const Quantity velocity0 = arguments.quantity("velocity0", text::any_finite, 0);
    const bool own_torque = !arguments.options().has("Mc");
    const Quantity Mc = arguments.quantity("Mc", text::not_zero, 0);
    return arguments.push_result([&](std::size_t i) {
        if (rule == 0) return motion::rk4_stability_limit(system);
        const model::State initial{theta0[i], velocity0[i]};
        if (system.kinetic_friction() > 0 && initial.theta == 0 && initial.velocity == 0) {
            arguments.options().fail(
                "theta0 or velocity0 is needed, because this rule divides by the greatest velocity");
        }
        if (rule == 2) return euler_step_limit(system, initial);
        return printed_step_limit(system, initial, own_torque ? system.characteristic_torque(initial) : Mc[i]);
    });
}

}  // namespace dinal::api::theory_functions
