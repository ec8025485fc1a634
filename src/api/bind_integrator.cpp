// integrator.rk4{...}, integrator.dinal1989{...} and the objects they make.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

#include "api/cards.hpp"
#include "api/classes.hpp"
#include "lua/options.hpp"
#include "motion/integrators.hpp"
#include "source/describe.hpp"

namespace dinal::api {

namespace {

double step(const lua::Options& options) {
    const double h = options.number("h");
    if (h <= 0) {
        options.fail(fmt::format("h = {:.6g} must be positive", h));
    }
    return h;
}

int spectral(lua_State* L) {
    const lua::Options options(L, 1, "integrator.spectral", "integrator.spectral{ tolerance = 1e-12 }",
                               {"tolerance", "max_panel"});
    motion::Spectral method;
    method.tolerance = options.number("tolerance", method.tolerance);
    if (method.tolerance <= 0 || method.tolerance >= 1) {
        options.fail(fmt::format("tolerance = {:.6g} must be between 0 and 1", method.tolerance));
    }
    if (options.has("max_panel")) {
        method.max_panel = options.number("max_panel");
        if (method.max_panel <= 0) {
            options.fail(fmt::format("max_panel = {:.6g} must be positive", method.max_panel));
        }
    }
    lua::push<motion::Integrator>(L, method);
    return 1;
}

int rk4(lua_State* L) {
    const lua::Options options(L, 1, "integrator.rk4", "integrator.rk4{ h = 0.001 }", {"h"});
    lua::push<motion::Integrator>(L, motion::Rk4{step(options)});
    return 1;
}

int dinal1989(lua_State* L) {
    const lua::Options options(L, 1, "integrator.dinal1989", "integrator.dinal1989{ h = 0.01 }", {"h", "stop", "slip"});
    motion::Dinal1989 method;
    method.h = step(options);
    method.stop = options.choice("stop", {"listing", "text"}, 0) == 0 ? motion::Dinal1989::Stop::listing
                                                                      : motion::Dinal1989::Stop::text;
    method.slip = options.boolean("slip", false);
    lua::push<motion::Integrator>(L, method);
    return 1;
}

motion::Integrator& integrator_self(lua_State* L) {
    return lua::self<motion::Integrator>(L, 1, "integrator.h");
}

int name(lua_State* L) {
    constexpr std::array names{"spectral", "rk4", "dinal1989"};  // in the order of the variant
    static_assert(std::variant_size_v<motion::Integrator> == names.size());
    lua_pushstring(L, names.at(integrator_self(L).index()));
    return 1;
}

/// A number, or nil where there is none or it is without limit.
int push_finite(lua_State* L, std::optional<double> value) {
    if (value && std::isfinite(*value)) {
        lua_pushnumber(L, *value);
    } else {
        lua_pushnil(L);
    }
    return 1;
}

int h(lua_State* L) {
    const motion::Integrator& integrator = integrator_self(L);
    const auto* rk4 = std::get_if<motion::Rk4>(&integrator);
    const auto* listing = std::get_if<motion::Dinal1989>(&integrator);
    return push_finite(L, rk4 != nullptr       ? std::optional(rk4->h)
                          : listing != nullptr ? std::optional(listing->h)
                                               : std::nullopt);
}

int tolerance(lua_State* L) {
    const auto* method = std::get_if<motion::Spectral>(&integrator_self(L));
    return push_finite(L, method != nullptr ? std::optional(method->tolerance) : std::nullopt);
}

int max_panel(lua_State* L) {
    const auto* method = std::get_if<motion::Spectral>(&integrator_self(L));
    return push_finite(L, method != nullptr ? std::optional(method->max_panel) : std::nullopt);
}

int integrator_text(lua_State* L) {
    lua_pushstring(L, source::lua_text(integrator_self(L)).c_str());
    return 1;
}

constexpr lua::Member integrator_module_members[] = {
    {"spectral",
     lua::guarded<spectral>,
     lua::Kind::function,
     {"integrator.spectral{ tolerance = 1e-12, max_panel = 0.6 T0 } -> integrator",
      "The default: the motion as polynomials on panels between events and breaks of M, right to rounding for any M, "
      "with every event in its place. tolerance is relative, for each panel. A pulse of a scripted M that falls "
      "between the 17 samples of a panel is not seen: announce it by excitation.scripted(f, { breaks = {...} }), or "
      "take max_panel (time units) a few times as long as the shortest pulse.",
      "sys = nondimensional{ friction_ratio = 0.167 }\n"
      "run = sys:simulate{ velocity0 = 2*math.pi, t_end = 3, dt = 0.5, integrator = integrator.spectral{} }\n"
      "print(string.format(\"%.9f\", (run:at(3))))  --> 0.155151392"}},
    {"rk4",
     lua::guarded<rk4>,
     lua::Kind::function,
     {"integrator.rk4{ h } -> integrator",
      "The classical Runge-Kutta method of fourth order with step h (time units), which keeps its order through dry "
      "friction: a step is cut where the velocity becomes zero and where M jumps. h must not exceed the stability "
      "limit, 0.45 T0 without damping.",
      "print(integrator.rk4{ h = 0.001 })  --> integrator.rk4{ h = 0.001 }"}},
    {"dinal1989",
     lua::guarded<dinal1989>,
     lua::Kind::function,
     {"integrator.dinal1989{ h, stop = \"listing\", slip = false } -> integrator",
      "The program DINAL as it was printed in 1989, with step h (time units) and its own rule for stops; a museum "
      "piece for comparison. stop = \"text\" takes the rule that the report's text states instead; slip = true repeats "
      "the wrong index with which the report's chapter 6 was computed.",
      "sys = nondimensional{}\n"
      "run = sys:simulate{ theta0 = 1, t_end = 0.5, dt = 0.5, integrator = integrator.dinal1989{ h = 0.1 } }\n"
      "print(string.format(\"%.6f\", run.theta[2]))  --> -0.997964"}},
};

constexpr lua::Member integrator_members[] = {
    {"name",
     lua::guarded<name>,
     lua::Kind::field,
     {"integrator.name -> string", "The name of the method.", "print(integrator.rk4{ h = 0.001 }.name)  --> rk4"}},
    {"h",
     lua::guarded<h>,
     lua::Kind::field,
     {"integrator.h -> number", "The step, in time units; nil for spectral.",
      "print(integrator.rk4{ h = 0.001 }.h)  --> 0.001"}},
    {"tolerance",
     lua::guarded<tolerance>,
     lua::Kind::field,
     {"integrator.tolerance -> number", "The relative tolerance of spectral; nil for the others.",
      "print(integrator.spectral{}.tolerance)  --> 1e-12"}},
    {"max_panel",
     lua::guarded<max_panel>,
     lua::Kind::field,
     {"integrator.max_panel -> number", "The longest panel of spectral that was asked for, in time units, or nil.",
      "print(integrator.spectral{ max_panel = 0.02 }.max_panel)  --> 0.02"}},
    {"__tostring",
     lua::guarded<integrator_text>,
     lua::Kind::metamethod,
     {"tostring(integrator) -> string", "The Lua text that makes it again.",
      "print(integrator.dinal1989{ h = 0.01 })  --> integrator.dinal1989{ h = 0.01 }"}},
};

}  // namespace

const lua::Class integrator_module = {
    "integrator",
    {"integrator.NAME{ ... } -> integrator",
     "The methods a run can use. A run that names none takes integrator.spectral{}.",
     "sys = nondimensional{ zeta = 0.1 }\n"
     "run = sys:simulate{ theta0 = 1, t_end = 2, dt = 0.5, integrator = integrator.rk4{ h = 0.01 } }\n"
     "print(run.integrator)  --> integrator.rk4{ h = 0.01 }"},
    integrator_module_members};

const lua::Class integrator_class = {
    "integrator",
    {"integrator.rk4{ h = 0.001 } -> integrator",
     "A method with its options, for `integrator =` in sys:simulate{...}. It can not be changed.",
     "print(integrator.rk4{ h = 0.001 }.h)  --> 0.001"},
    integrator_members,
    nullptr,
    integrator_card};

void register_integrator(lua_State* L) {
    lua::add_class<motion::Integrator>(L, integrator_class);
    lua::add_module(L, integrator_module);
}

}  // namespace dinal::api
