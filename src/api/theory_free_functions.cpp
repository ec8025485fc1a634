#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/theory_arguments.hpp"
#include "api/theory_functions.hpp"
#include "api/theory_options.hpp"
#include "theory/theory_free.hpp"

namespace dinal::api::theory_functions {

namespace {

using namespace theory;

namespace options = theory_options;

/// A system set off at t = 0: what time_to_rest{...} and its relatives take.
struct Start {
    const model::Oscillator& system;
    Quantity theta0;
    Quantity velocity0;

    explicit Start(TheoryArguments& arguments)
        : system(*arguments.system()),
          theta0(arguments.quantity("theta0")),
          velocity0(arguments.quantity("velocity0")) {}
    [[nodiscard]] FreeMotion motion(std::size_t i) const { return {system, {theta0[i], velocity0[i]}}; }
};

int free_response_of_system(TheoryArguments& arguments) {
    const Start start(arguments);
    const Quantity t = arguments.quantity("t");
    if (arguments.options().has("omega0") || arguments.options().has("zeta")) {
        arguments.options().fail("system", "system excludes omega0 and zeta, which it has of its own");
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
double asked_count(const lua::Options& options, std::optional<double> count, const FreeMotion& motion) {
    constexpr double most = 1e7;
    const double all = motion.extremes();
    if (!count && std::isinf(all)) {
        options.fail("count", "count is needed, because this motion never comes to rest");
    }
    if (!count && all > most) {
        options.fail("count", fmt::format("count is needed, because there are {:.6g} extremes until rest", all));
    }
    return std::min(count.value_or(all), all);
}

}  // namespace

int free_response(lua_State* L) {
    TheoryArguments arguments(L, options::free_response);
    if (arguments.system() != nullptr) {
        return free_response_of_system(arguments);
    }
    if (!arguments.options().has("omega0")) {
        arguments.options().missing("system, or omega0 and zeta");
    }
    const Quantity omega0 = arguments.quantity("omega0");
    const Quantity zeta = arguments.quantity("zeta");
    const Quantity theta0 = arguments.quantity("theta0");
    const Quantity velocity0 = arguments.quantity("velocity0");
    const Quantity t = arguments.quantity("t");
    return arguments.push_results([&](std::size_t i) {
        const model::State y = theory::free_response(omega0[i], zeta[i], {theta0[i], velocity0[i]}, t[i]);
        return std::array{y.theta, y.velocity};
    });
}

int extremes(lua_State* L) {
    const lua::Options table(L, 1, options::extremes);
    const auto& system = *table.object<model::Oscillator>("system");
    options::ExtremesOptions asked;
    table.fill(asked);
    const FreeMotion motion(system, {asked.theta0, asked.velocity0});
    const auto n = static_cast<std::size_t>(asked_count(table, asked.count, motion));
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
    TheoryArguments arguments(L, options::time_to_rest);
    const Start start(arguments);
    return arguments.push_result([&](std::size_t i) { return start.motion(i).time_to_rest(); });
}

int rest_position(lua_State* L) {
    TheoryArguments arguments(L, options::rest_position);
    const Start start(arguments);
    return arguments.push_result([&](std::size_t i) { return start.motion(i).rest_position().value_or(no_value); });
}

int half_cycle(lua_State* L) {
    TheoryArguments arguments(L, options::half_cycle);
    const model::Oscillator* system = arguments.system();
    for (const char* name : {"zeta", "x_f", "dead_zone"}) {
        if (system != nullptr && arguments.options().has(name)) {
            arguments.options().fail(name, fmt::format("system excludes {}, which it has of its own", name));
        }
    }
    if (system != nullptr && !system->damped_frequency()) {
        arguments.options().fail("system",
                                 fmt::format("the system has zeta = {:.6g}: without a swing there is no next extreme",
                                             system->damping_ratio()));
    }
    const Quantity X = arguments.quantity("X");
    const Quantity n = arguments.quantity("n");
    const auto quantity = [&](const char* name, auto of_system) {
        return system != nullptr ? Quantity(of_system(*system)) : arguments.quantity(name);
    };
    const Quantity zeta = quantity("zeta", [](const model::Oscillator& sys) { return sys.damping_ratio(); });
    const Quantity x_f =
        quantity("x_f", [](const model::Oscillator& sys) { return sys.kinetic_friction() / sys.stiffness(); });
    const Quantity dead_zone = quantity("dead_zone", [](const model::Oscillator& sys) { return sys.dead_zone(); });
    return arguments.push_result([&](std::size_t i) {
        if (dead_zone[i] < x_f[i]) {
            arguments.refuse("dead_zone", i, dead_zone[i], fmt::format("must be at least x_f = {}", x_f[i]));
        }
        const HalfCycles map(zeta[i], x_f[i]);
        return map.after(std::min(n[i], map.until_within(dead_zone[i], X[i])), X[i]);
    });
}

std::array<double, 2> identify(double X0, double X1, double X2) {
    const auto found = theory::identify(X0, X1, X2);
    return found ? std::array{found->zeta, found->friction_shift} : std::array{no_value, no_value};
}

}  // namespace dinal::api::theory_functions
