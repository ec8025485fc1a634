#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/theory_arguments.hpp"
#include "api/theory_functions.hpp"
#include "theory/theory_free.hpp"

namespace dinal::api::theory_functions {

namespace {

using namespace theory;

constexpr text::Range swinging{"be from 0 to less than 1: without a swing there is no next extreme",
                               [](double x) { return x >= 0 && x < 1; }};
constexpr text::Range whole{"be a whole number, 0 or more",
                            [](double x) { return x >= 0 && x == std::floor(x) && std::isfinite(x); }};

/// A system set off at t = 0: what time_to_rest{...} and its relatives take.
struct Start {
    const model::Oscillator& system;
    Quantity theta0;
    Quantity velocity0;

    explicit Start(TheoryArguments& arguments)
        : system(arguments.system()),
          theta0(arguments.quantity("theta0", text::any_finite, 0)),
          velocity0(arguments.quantity("velocity0", text::any_finite, 0)) {}
    [[nodiscard]] FreeMotion motion(std::size_t i) const { return {system, {theta0[i], velocity0[i]}}; }
};

int free_response_of_system(TheoryArguments& arguments) {
    const Start start(arguments);
    const Quantity t = arguments.quantity("t", text::any_finite);
    if (arguments.options().has("omega0") || arguments.options().has("zeta")) {
        arguments.options().fail("system excludes omega0 and zeta, which it has of its own");
    }
    return arguments.push_results([&](std::size_t i) {
        if (t[i] < 0 && !start.system.friction().none()) {
            arguments.refuse("t", i, t[i], "must not be negative: dry friction does not tell where the mass came from");
        }
        const model::State y = start.motion(i).at(t[i]);
        return std::array{y.theta, y.velocity};
    });
}

/// How many extremes extremes{...} returns.
double asked_count(const lua::Options& options, const FreeMotion& motion) {
    constexpr double most = 1e7;
    const double all = motion.extremes();
    if (!options.has("count")) {
        if (std::isinf(all)) {
            options.fail("count is needed, because this motion never comes to rest");
        }
        if (all > most) {
            options.fail(fmt::format("count is needed, because there are {:.6g} extremes until rest", all));
        }
        return all;
    }
    const double count = options.number("count");
    if (!whole.holds(count) || count > most) {
        options.fail(fmt::format("count = {:.6g} must be a whole number from 0 to {:.0e}", count, most));
    }
    return std::min(count, all);
}

}  // namespace

int free_response(lua_State* L) {
    TheoryArguments arguments(L, "theory.free_response",
                              "theory.free_response{ system = sys, theta0 = 1, t = vector.linspace(0, 5, 501) }",
                              {"t", "theta0", "velocity0", "system", "omega0", "zeta"});
    if (arguments.optional_system() != nullptr) {
        return free_response_of_system(arguments);
    }
    if (!arguments.options().has("omega0")) {
        arguments.options().missing("system, or omega0 and zeta");
    }
    const Quantity omega0 = arguments.quantity("omega0", text::positive);
    const Quantity zeta = arguments.quantity("zeta", text::not_negative, 0);
    const Quantity theta0 = arguments.quantity("theta0", text::any_finite, 0);
    const Quantity velocity0 = arguments.quantity("velocity0", text::any_finite, 0);
    const Quantity t = arguments.quantity("t", text::any_finite);
    return arguments.push_results([&](std::size_t i) {
        const model::State y = theory::free_response(omega0[i], zeta[i], {theta0[i], velocity0[i]}, t[i]);
        return std::array{y.theta, y.velocity};
    });
}

int extremes(lua_State* L) {
    const lua::Options options(L, 1, "theory.extremes", "theory.extremes{ system = sys, theta0 = 1 }",
                               {"system", "theta0", "velocity0", "count"});
    options.push("system");
    const auto* system = lua::test<model::Oscillator>(L, -1);
    if (system == nullptr) {
        options.has("system") ? options.wrong("system", "a system such as system{ I = 1, k = 39.5 }")
                              : options.missing("system");
    }
    const FreeMotion motion(*system, {options.number("theta0", 0), options.number("velocity0", 0)});
    const auto n = static_cast<std::size_t>(asked_count(options, motion));
    std::vector<double> times(n), angles(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Extreme extreme = motion.extreme(static_cast<double>(i));
        times[i] = extreme.t;
        angles[i] = extreme.theta;
    }
    lua::push_vector(L, std::move(times));
    lua::push_vector(L, std::move(angles));
    return 2;
}

int time_to_rest(lua_State* L) {
    TheoryArguments arguments(L, "theory.time_to_rest", "theory.time_to_rest{ system = sys, theta0 = 1 }",
                              {"system", "theta0", "velocity0"});
    const Start start(arguments);
    return arguments.push_result([&](std::size_t i) { return start.motion(i).time_to_rest(); });
}

int rest_position(lua_State* L) {
    TheoryArguments arguments(L, "theory.rest_position", "theory.rest_position{ system = sys, theta0 = 1 }",
                              {"system", "theta0", "velocity0"});
    const Start start(arguments);
    return arguments.push_result([&](std::size_t i) { return start.motion(i).rest_position().value_or(no_value); });
}

int half_cycle(lua_State* L) {
    TheoryArguments arguments(L, "theory.half_cycle", "theory.half_cycle{ X = 1, zeta = 0.1, x_f = 0.05 }",
                              {"X", "zeta", "x_f", "dead_zone", "system", "n"});
    const model::Oscillator* system = arguments.optional_system();
    for (const char* name : {"zeta", "x_f", "dead_zone"}) {
        if (system != nullptr && arguments.options().has(name)) {
            arguments.options().fail(fmt::format("system excludes {}, which it has of its own", name));
        }
    }
    if (system != nullptr && !system->damped_frequency()) {
        arguments.options().fail(fmt::format("the system has zeta = {:.6g}: without a swing there is no next extreme",
                                             system->damping_ratio()));
    }
    const Quantity X = arguments.quantity("X", text::any_finite);
    const Quantity zeta = arguments.quantity("zeta", swinging, system != nullptr ? system->damping_ratio() : 0);
    const Quantity x_f = arguments.quantity("x_f", text::not_negative,
                                            system != nullptr ? system->kinetic_friction() / system->stiffness() : 0);
    const bool own_zone = system == nullptr && !arguments.options().has("dead_zone");
    const Quantity dead_zone =
        own_zone ? x_f
                 : arguments.quantity("dead_zone", text::not_negative, system != nullptr ? system->dead_zone() : 0);
    const Quantity n = arguments.quantity("n", whole, 1);
    return arguments.push_result([&](std::size_t i) {
        if (dead_zone[i] < x_f[i]) {
            arguments.refuse("dead_zone", i, dead_zone[i], fmt::format("must be at least x_f = {:.6g}", x_f[i]));
        }
        const HalfCycles map(zeta[i], x_f[i]);
        return map.after(std::min(n[i], map.until_within(dead_zone[i], X[i])), X[i]);
    });
}

int logarithmic_decrement(lua_State* L) {
    TheoryArguments arguments(L, "theory.logarithmic_decrement", "theory.logarithmic_decrement{ zeta = 0.1 }",
                              {"zeta"});
    const Quantity zeta = arguments.quantity("zeta", swinging);
    return arguments.push_result([&](std::size_t i) { return theory::logarithmic_decrement(zeta[i]); });
}

int zeta_from_decrement(lua_State* L) {
    TheoryArguments arguments(L, "theory.zeta_from_decrement", "theory.zeta_from_decrement{ decrement = 0.3 }",
                              {"decrement"});
    const Quantity decrement = arguments.quantity("decrement", text::not_negative);
    return arguments.push_result([&](std::size_t i) { return zeta_of_decrement(decrement[i]); });
}

int friction_decrement(lua_State* L) {
    TheoryArguments arguments(L, "theory.friction_decrement", "theory.friction_decrement{ Rd = 2, k = 40 }",
                              {"Rd", "k"});
    const Quantity Rd = arguments.quantity("Rd", text::not_negative);
    const Quantity k = arguments.quantity("k", text::positive);
    return arguments.push_result([&](std::size_t i) { return theory::friction_decrement(Rd[i], k[i]); });
}

int identify(lua_State* L) {
    TheoryArguments arguments(L, "theory.identify", "theory.identify{ X0 = 1, X1 = -0.7, X2 = 0.45 }",
                              {"X0", "X1", "X2"});
    const Quantity X0 = arguments.quantity("X0", text::not_zero);
    const Quantity X1 = arguments.quantity("X1", text::any_finite);
    const Quantity X2 = arguments.quantity("X2", text::any_finite);
    return arguments.push_results([&](std::size_t i) {
        const auto found = theory::identify(X0[i], X1[i], X2[i]);
        return found ? std::array{found->zeta, found->friction_shift} : std::array{no_value, no_value};
    });
}

}  // namespace dinal::api::theory_functions
