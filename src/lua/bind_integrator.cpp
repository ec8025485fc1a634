// integrator.rk4{...}, integrator.dinal1989{...} and the objects they make.
#include <fmt/format.h>

#include "lua/bind_integrator.hpp"
#include "lua/library.hpp"
#include "lua/options.hpp"

namespace dinal {

namespace {

double step(const Options& options) {
    const double h = options.number("h");
    if (h <= 0) {
        options.fail(fmt::format("h = {:.6g} must be positive", h));
    }
    return h;
}

int rk4(lua_State* L) {
    const Options options(L, 1, "integrator.rk4", "integrator.rk4{ h = 0.001 }", {"h"});
    push<Integrator>(L, Rk4{step(options)});
    return 1;
}

int dinal1989(lua_State* L) {
    const Options options(L, 1, "integrator.dinal1989", "integrator.dinal1989{ h = 0.01 }", {"h", "stop", "slip"});
    Dinal1989 method;
    method.h = step(options);
    method.stop =
        options.choice("stop", {"listing", "text"}, 0) == 0 ? Dinal1989::Stop::listing : Dinal1989::Stop::text;
    method.slip = options.boolean("slip", false);
    push<Integrator>(L, method);
    return 1;
}

Integrator& integrator_self(lua_State* L) {
    return self<Integrator>(L, 1, "integrator.h");
}

int name(lua_State* L) {
    lua_pushstring(L, std::holds_alternative<Rk4>(integrator_self(L)) ? "rk4" : "dinal1989");
    return 1;
}

int h(lua_State* L) {
    lua_pushnumber(L, std::visit([](const auto& method) { return method.h; }, integrator_self(L)));
    return 1;
}

int to_string(lua_State* L) {
    lua_pushstring(L, lua_text(integrator_self(L)).c_str());
    return 1;
}

constexpr Member functions[] = {
    {"rk4",
     guarded<rk4>,
     Kind::function,
     {"integrator.rk4{ h } -> integrator",
      "The classical Runge-Kutta method of fourth order with step h (time units), which keeps its order through dry "
      "friction: a step is cut where the velocity becomes zero and where M jumps. h must not exceed the stability "
      "limit, "
      "0.45 T0 without damping.",
      "print(integrator.rk4{ h = 0.001 })  --> integrator.rk4{ h = 0.001 }"}},
    {"dinal1989",
     guarded<dinal1989>,
     Kind::function,
     {"integrator.dinal1989{ h, stop = \"listing\", slip = false } -> integrator",
      "The program DINAL as it was printed in 1989, with step h (time units) and its own rule for stops; a museum "
      "piece "
      "for comparison. stop = \"text\" takes the rule that the report's text states instead; slip = true repeats the "
      "wrong index with which the report's chapter 6 was computed.",
      "sys = nondimensional{}\n"
      "run = sys:simulate{ theta0 = 1, t_end = 0.5, dt = 0.5, integrator = integrator.dinal1989{ h = 0.1 } }\n"
      "print(string.format(\"%.6f\", run.theta[2]))  --> -0.997964"}},
};

constexpr Member members[] = {
    {"name",
     guarded<name>,
     Kind::field,
     {"integrator.name -> string", "The name of the method.", "print(integrator.rk4{ h = 0.001 }.name)  --> rk4"}},
    {"h",
     guarded<h>,
     Kind::field,
     {"integrator.h -> number", "The step, in time units.", "print(integrator.rk4{ h = 0.001 }.h)  --> 0.001"}},
    {"__tostring",
     guarded<to_string>,
     Kind::metamethod,
     {"tostring(integrator) -> string", "The Lua text that makes it again.",
      "print(integrator.dinal1989{ h = 0.01 })  --> integrator.dinal1989{ h = 0.01 }"}},
};

}  // namespace

std::string lua_text(const Integrator& integrator) {
    if (const auto* method = std::get_if<Rk4>(&integrator)) {
        return fmt::format("integrator.rk4{{ h = {} }}", method->h);
    }
    const auto& method = std::get<Dinal1989>(integrator);
    return fmt::format("integrator.dinal1989{{ h = {}{}{} }}", method.h,
                       method.stop == Dinal1989::Stop::text ? ", stop = \"text\"" : "",
                       method.slip ? ", slip = true" : "");
}

const Class integrator_module = {
    "integrator",
    {"integrator.NAME{ ... } -> integrator",
     "The methods a run can use. A run that names none takes rk4 with h = T0/1000.",
     "sys = nondimensional{ zeta = 0.1 }\n"
     "run = sys:simulate{ theta0 = 1, t_end = 2, dt = 0.5, integrator = integrator.rk4{ h = 0.01 } }\n"
     "print(run.integrator)  --> integrator.rk4{ h = 0.01 }"},
    functions};

const Class integrator_class = {
    "integrator",
    {"integrator.rk4{ h = 0.001 } -> integrator",
     "A method with its options, for `integrator =` in sys:simulate{...}. It can not be changed.",
     "print(integrator.rk4{ h = 0.001 }.h)  --> 0.001"},
    members};

void register_integrator(lua_State* L) {
    add_class<Integrator>(L, integrator_class);
    add_module(L, integrator_module);
}

}  // namespace dinal
