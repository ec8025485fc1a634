// system{...}, nondimensional{...} and the systems they make. sys:simulate{...} is in bind_simulate.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "api/bind_simulate.hpp"
#include "api/bodies.hpp"
#include "api/cards.hpp"
#include "api/classes.hpp"
#include "api/response.hpp"
#include "api/run.hpp"
#include "api/steady_answer.hpp"
#include "api/system_options.hpp"
#include "lua/options.hpp"
#include "lua/values.hpp"
#include "model/laws/bristle.hpp"
#include "model/laws/coulomb.hpp"
#include "motion/engine/part.hpp"
#include "source/describe.hpp"

namespace dinal::api {

namespace {

constexpr text::Call system_call{"system", "system{ I = 1, k = 39.5, C = 1.5, Rd = 2, Re = 3 }", system_options, false,
                                 &simulate_call};

/// Ratios to k = 1 and to the characteristic torque Mc = 1.
struct Ratios {
    double zeta = 0;
    double friction = 0;
    std::optional<double> breakaway = {};
};
constexpr text::Option ratio_options[] = {
    {"zeta", "", text::its_own, text::not_negative, "viscous damping ratio", text::fills<&Ratios::zeta>},
    {"friction_ratio", "", text::its_own, text::not_negative, "Rd/Mc", text::fills<&Ratios::friction>},
    {"breakaway_ratio", "", "friction_ratio", text::any_finite, "Re/Mc, at least friction_ratio",
     text::fills<&Ratios::breakaway>},
};
constexpr auto nondimensional_options = text::joined(ratio_options, law_option, model::units_option);
constexpr text::Call nondimensional_call{"nondimensional", "nondimensional{ zeta = 0.1, friction_ratio = 0.2 }",
                                         nondimensional_options, true, &simulate_call};

int system(lua_State* L) {
    const lua::Options options(L, 1, system_call);
    if (options.has("bodies")) return push_bodies(L, options);
    if (options.has("links")) {
        options.push("links");
        if (lua_type(L, -1) != LUA_TTABLE) options.wrong("links");
        options.fail("links", "links connect bodies: give bodies = { ... } as well");
    }
    if (!options.has("I")) options.missing("I");
    return push_body(L, options);
}

int nondimensional(lua_State* L) {
    const lua::Options options(L, 1, nondimensional_call);
    Ratios ratios;
    options.fill(ratios);
    const double breakaway_ratio = ratios.breakaway.value_or(ratios.friction);
    if (breakaway_ratio < ratios.friction) {  // the core would speak of Rd and Re, which the user has not typed
        options.fail("breakaway_ratio", fmt::format("breakaway_ratio = {} must be at least friction_ratio = {}",
                                                    breakaway_ratio, ratios.friction));
    }
    // NOTE: no double is both I = 1/(4 pi^2), for which T0 is 1 to the last bit, and a square, so that C/2 = sqrt(I k)
    // can hold to the last bit, too. zeta = 1 needs the square: it is critical damping then, and not nearly so.
    constexpr double root = 1 / (2 * std::numbers::pi);
    model::OscillatorParameters parameters;
    parameters.inertia = ratios.zeta == 1 ? root * root : 1 / (4 * std::numbers::pi * std::numbers::pi);
    parameters.stiffness = 1;
    parameters.damping = 2 * ratios.zeta * std::sqrt(parameters.inertia);
    parameters.kinetic_friction = ratios.friction;
    parameters.breakaway = breakaway_ratio;
    parameters.friction = asked_law(L, options, {"friction_ratio", "breakaway_ratio"});
    parameters.units = asked_units(L, options).value_or(model::Units{.theta = "Mc/k", .t = "T0", .M = "Mc"});
    return push_system(L, options, parameters);
}

/// What a spring gives: nil without one.
template <auto get>
std::optional<double> with_spring(const model::Oscillator& system) {
    return system.has_spring() ? std::optional((system.*get)()) : std::nullopt;
}

text::Expected<double> friction_ratio(const model::Oscillator& sys, double Mc) {
    if (Mc != 0) return sys.friction_ratio(Mc);
    return text::Error{.sentence =
                           "Mc = 0 must not be zero; for a free motion it is "
                           "sys:characteristic_torque(theta0, velocity0)",
                       .culprit = "0"};
}

double characteristic_torque(const model::Oscillator& sys, double theta0, std::optional<double> velocity0) {
    return sys.characteristic_torque({theta0, velocity0.value_or(0)});
}

constexpr lua::Member system_module_members[] = {
    {lua::a_function<system>,
     {"system{ OPTIONS } -> system",
      "A mass on a spring with viscous damping and dry friction: I theta'' + C theta' + Rd sgn(theta') + k theta = "
      "M(t), stuck while the velocity is zero and |M - k theta| <= Re. SI or any consistent units.",
      "sys = system{ I = 1, k = 4*math.pi^2, C = 1.5, Rd = 16.5, Re = 18 }\n"
      "print(sys.T0, sys.regime)  --> 1.0\tunderdamped",
      {&system_call}}},
    {lua::a_function<nondimensional>,
     {"nondimensional{ OPTIONS } -> system",
      "The system with k = 1 and I = 1/(4 pi^2): T0 is 1, and torques are in units of the "
      "characteristic torque Mc, so M is M* of the report. Angles are in Mc/k, as its units say unless you give "
      "others.",
      "sys = nondimensional{ zeta = 0.119, friction_ratio = 0.418 }\n"
      "print(sys.k, sys.Rd, string.format(\"%.3f\", sys.zeta))  --> 1.0\t0.418\t0.119",
      {&nondimensional_call}}},
};

constexpr lua::Member system_members[] = {
    {lua::a_method<response_of_system>, response_doc},
    {lua::a_method<steady_of_system>, steady_doc},
    {lua::a_method<simulate_system>, simulate_doc},
    {lua::a_method<system_with>,
     {"sys:with{ OPTIONS } -> system",
      "A copy of the system with some parameters changed: the options of system{...}. Re changes with Rd if the two were "
      "equal; spring.polynomial{} removes a spring, and walls = {} the walls.",
      "sys = system{ I = 1, k = 4, Rd = 0.5 }\nprint(sys:with{ Rd = 1 })  --> system{ I = 1, k = 4, Rd = 1, Re = 1 }",
      {&with_call}}},
    {lua::a_typed_method<friction_ratio>,
     {"sys:friction_ratio(Mc) -> number", "The dry friction ratio gamma = Rd/|Mc| for the characteristic torque Mc.",
      "print(system{ I = 1, k = 4, Rd = 0.5 }:friction_ratio(2))  --> 0.25"}},
    {lua::a_typed_method<characteristic_torque>,
     {"sys:characteristic_torque(theta0, velocity0 = 0) -> number",
      "The characteristic torque Mc = k sqrt(theta0^2 + (velocity0/omega0)^2) of the free motion that starts at theta0 "
      "(rad) with velocity0 (rad per time unit).",
      "print(system{ I = 1, k = 4 }:characteristic_torque(3, 8))  --> 20.0"}},
    {lua::a_value<model::Oscillator, &model::Oscillator::inertia>,
     {"sys.I -> number", "The moment of inertia.", "print(system{ I = 2, k = 4 }.I)  --> 2.0"}},
    {lua::a_value<model::Oscillator, &model::Oscillator::stiffness>,
     {"sys.k -> number", "The stiffness, torque per rad.", "print(system{ I = 2, k = 4 }.k)  --> 4.0"}},
    {lua::a_value<model::Oscillator, &model::Oscillator::damping>,
     {"sys.C -> number", "The viscous damping constant, torque per rad per time unit.",
      "print(system{ I = 2, k = 4 }.C)  --> 0.0"}},
    {lua::a_value<model::Oscillator,
                  [](const model::Oscillator& system) { return system.friction().under(1).kinetic(); }>,
     {"sys.Rd -> number", "The torque of dry friction while the mass moves, under a normal load of 1.",
      "print(system{ I = 2, k = 4, Rd = 0.5 }.Rd)  --> 0.5"}},
    {lua::a_value<model::Oscillator,
                  [](const model::Oscillator& system) { return system.friction().under(1).greatest_holding(); }>,
     {"sys.Re -> number", "The breakaway torque under a normal load of 1. Rd unless given.",
      "print(system{ I = 2, k = 4, Rd = 0.5 }.Re)  --> 0.5"}},
    {lua::a_value<model::Oscillator, [](const model::Oscillator& system) { return system.friction().under(1); }>,
     {"sys.friction -> law", "The law of friction, under a normal load of 1.",
      "print(system{ I = 2, k = 4, Rd = 0.5 }.friction)  --> friction.coulomb{ Rd = 0.5, Re = 0.5 }"}},
    {lua::a_value<model::Oscillator, [](const model::Oscillator& system) { return system.friction().normal(); }>,
     {"sys.normal -> number", "The constant normal load that multiplies the torques of friction.",
      "sys = system{ I = 1, k = 4, Rd = 1, normal = 2 }\nprint(sys.normal, sys.dead_zone)  --> 2.0\t0.5"}},
    {lua::a_value<model::Oscillator,
                  [](const model::Oscillator& system) {
                      const model::Spring& spring = system.spring();
                      return spring.none() ? std::nullopt : std::optional(spring);
                  }>,
     {"sys.spring -> spring or nil", "The spring in addition to k theta; nil if there is none.",
      "print(system{ I = 1, k = 4, spring = spring.polynomial{ [3] = 2 } }.spring:torque(3))  --> 54.0"}},
    {lua::a_value<model::Oscillator, [](const model::Oscillator& system) { return walls_by_name(system.walls()); }>,
     {"sys.walls -> table or nil", "The end stops { lower, upper, restitution }, rad; nil if there are none.",
      "print(system{ I = 1, k = 4, walls = { upper = 0.5, restitution = 0.7 } }.walls.upper)  --> 0.5"}},
    {lua::a_value<model::Oscillator, [](const model::Oscillator& system) { return units_by_name(system.units()); }>,
     {"sys.units -> table",
      "The names of the units of theta, t and M; nil without one. Cards, columns and axes show them; no number "
      "depends on them.",
      "print(system{ I = 1, k = 4, units = { theta = \"m\", t = \"s\" } }.units.theta)  --> m"}},
    {lua::a_value<model::Oscillator, with_spring<&model::Oscillator::natural_frequency>>,
     {"sys.omega0 -> number", "The natural frequency sqrt(k/I) of k alone, rad per time unit; nil where k = 0.",
      "print(system{ I = 1, k = 4 }.omega0)  --> 2.0"}},
    {lua::a_value<model::Oscillator, with_spring<&model::Oscillator::natural_period>>,
     {"sys.T0 -> number", "The natural period 2 pi/omega0, time units; nil where k = 0.",
      "print(system{ I = 1, k = 4*math.pi^2 }.T0)  --> 1.0"}},
    {lua::a_value<model::Oscillator, &model::Oscillator::damped_frequency>,
     {"sys.omega1 -> number or nil",
      "The frequency of the damped swing, omega0 sqrt(1 - zeta^2), rad per time unit; nil unless zeta < 1.",
      "print(system{ I = 1, k = 4 }.omega1, system{ I = 1, k = 4, C = 10 }.omega1)  --> 2.0\tnil"}},
    {lua::a_value<model::Oscillator, with_spring<&model::Oscillator::damping_ratio>>,
     {"sys.zeta -> number", "The viscous damping ratio C/(2 I omega0); nil where k = 0.",
      "print(system{ I = 1, k = 4, C = 1 }.zeta)  --> 0.25"}},
    {lua::a_value<model::Oscillator,
                  [](const model::Oscillator& system) {
                      return system.has_spring() ? std::optional(model::name(system.regime())) : std::nullopt;
                  }>,
     {"sys.regime -> string",
      "How the free system without dry friction moves: \"undamped\", \"underdamped\", \"critical\" or \"overdamped\"; "
      "nil where k = 0.",
      "print(system{ I = 1, k = 4, C = 4 }.regime)  --> critical"}},
    {lua::a_value<model::Oscillator,
                  [](const model::Oscillator& system) {
                      return system.has_linear_spring() ? std::optional(system.dead_zone()) : std::nullopt;
                  }>,
     {"sys.dead_zone -> number",
      "Re/k, rad: without excitation the mass can rest wherever |theta| is at most this; nil if "
      "k = 0 or with another spring. A normal load multiplies it.",
      "print(system{ I = 1, k = 4, Rd = 1, Re = 2 }.dead_zone)  --> 0.5"}},
    {lua::a_text<model::Oscillator,
                 [](lua_State* L, const model::Oscillator& system) { return source::lua_text(L, system); }>,
     {"tostring(sys) -> string", "The Lua text that recreates it.",
      "print(system{ I = 1, k = 4, Rd = 0.5 })  --> system{ I = 1, k = 4, Rd = 0.5, Re = 0.5 }"}},
};

}  // namespace

const lua::Class system_functions = {"system",
                                     {"system{ I, k, ... } or nondimensional{ ... } -> system",
                                      "Makes a system, in your own units or in the report's nondimensional form.",
                                      "print(system{ I = 1, k = 4 }.omega0)  --> 2.0"},
                                     system_module_members};

const lua::Class system_class = {
    "system",
    {"system{ I, k, ... } -> system", "A system. Its parameters, and quantities that follow from them, are fields.",
     "sys = system{ I = 1, k = 4, C = 1 }\nprint(sys.omega0, sys.zeta)  --> 2.0\t0.25"},
    system_members,
    nullptr,
    system_card};

namespace {

// ---- several bodies

template <bool links>
std::vector<std::string> joint_names(const model::Assembly& system) {
    std::vector<std::string> names;
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        if (system.is_link(j) == links) names.push_back(system.joints[j].name);
    }
    return names;
}

int rig_with(lua_State* L) {
    static_cast<void>(lua::self<AssemblyHandle>(L, 1, rig_with_call.example));
    return system_with(L);
}

/// That which is no number or law of the options in the table on the top.
const char* varying_option(lua_State* L) {
    for (const char* name : {"friction", "Rd", "Re", "normal"}) {
        const bool given = lua_getfield(L, -1, name) != LUA_TNIL;
        const bool constant = lua_type(L, -1) == LUA_TNUMBER || lua::test<model::Friction>(L, -1) != nullptr;
        lua_pop(L, 1);
        if (given && !constant) return name;
    }
    return nullptr;
}

/// rig.load is the body or link as a system. One body without a name has the fields of a system.
int field_of_rig(lua_State* L) {
    if (lua_type(L, 2) != LUA_TSTRING) return 0;
    const AssemblyHandle rig = lua::self<AssemblyHandle>(L, 1, "rig.load");
    const std::string_view name = lua_tostring(L, 2);
    const auto& members = system_class.members;
    const auto member = std::find_if(members.begin(), members.end(), [&](const lua::Member& one) {
        return one.name == name && one.kind == lua::Kind::field;
    });
    const bool own = std::any_of(rig->joints.begin(), rig->joints.end(), [&](const auto& j) { return j.name == name; });
    if (rig->named && !own && member != members.end()) {
        lua::raise(L, {.sentence = fmt::format("{0} is of one body or link: rig.{1}.{0}", name, rig->joints[0].name),
                       .culprit = std::string(name)});
    }
    if (rig->named) {
        return push_alone(L, fmt::format("rig.{}", name), *rig, joint_named(L, name, *rig, "this system", rig_class));
    }
    if (member == members.end()) return 0;
    push_joint(L, *rig, 0);
    const char* varying = varying_option(L);
    if (member->name == "Rd" || member->name == "Re" || member->name == "normal" || member->name == "friction") {
        if (lua_getfield(L, -1, lua_tostring(L, 2)) != LUA_TNIL) return 1;
        lua_pop(L, 1);
        if (name == "Re" && lua_getfield(L, -1, "Rd") != LUA_TNIL) return 1;
        if (varying != nullptr && std::string_view(varying) == "normal") varying = nullptr;  // of no matter to the law
    } else if (name != "dead_zone") {
        varying = nullptr;
    }
    if (varying != nullptr && name != "normal") {
        lua_getfield(L, 3, varying);
        lua::raise(L, fmt::format("this system has no constant {}: its {} is {}", name, varying,
                                  lua::is_callable(L, -1) ? "a function" : lua::describe(L, -1)));
    }
    lua_pushcfunction(L, member->call);
    lua::push(L, lua::value_or_raise(L, "rig", motion::engine::seen_alone(*rig, 0)));
    lua_call(L, 1, 1);
    return 1;
}

std::string rig_text(lua_State* L, const AssemblyHandle& rig) {
    return source::lua_text(L, *rig);
}

#define DINAL_RIG                                                                 \
    "rig = system{ bodies = { motor = { I = 1 }, load = { I = 3, Rd = 0.2 } },\n" \
    "    links = { clutch = { \"motor\", \"load\", Rd = 2 } } }\n"

constexpr lua::Member rig_members[] = {
    {lua::a_method<simulate_bodies>,
     {"rig:simulate{ OPTIONS } -> run",
      "Runs a system of several bodies, or one whose friction depends on more than its speed: by polynomials "
      "between located events, as integrator.spectral does. All sticking contacts are decided together.",
      DINAL_RIG "run = rig:simulate{ velocity0 = { motor = 3 }, t_end = 10 }\n"
                "print(string.format(\"%.6f\", run.events[1].t), run.events[1].kind, run.events[1].where)  --> "
                "1.153846\tstick\tclutch",
      {&bodies_simulate_call}}},
    {lua::a_method<steady_of_rig>,
     {"rig:steady{ OPTIONS } -> steady",
      "The motion that remains when transients have died out, as sys:steady finds it for one body. s.load is the "
      "motion of the body `load`: amplitude, mean, lag, stops, run. Angles of rotating bodies are measured "
      "relative to each other.",
      "rig = system{ bodies = { a = { I = 1, k = 4, Rd = 0.3, Re = 0.6 }, b = { I = 0.5, C = 0.05 } },\n"
      "    links = { rod = { \"a\", \"b\", k = 2, C = 0.1 } } }\n"
      "s = rig:steady{ belt = { a = 0.1 }, theta0 = { a = 0.3 } }\n"
      "print(s.status, string.format(\"%.6f %.6f\", s.period, s.b.amplitude))  --> steady\t4.627741 0.114468",
      {&rig_steady_call}}},
    {lua::a_method<response_of_rig>,
     {"rig:response{ OPTIONS } -> data",
      "The steady motion over a list of values, as sys:response has it for one body: branches are followed round their "
      "folds, and c.points and c.jumps tell of the body or link `of`. Columns: the varied parameters; amplitude, lag, "
      "peak, stops and stuck of each body and link, as in \"load.amplitude\"; stable, branch and status. Under controllers "
      "that sample or wait, and where `of` goes round, each value is searched from the one before.",
      "rig = system{ bodies = { a = { I = 1, k = 1, C = 0.1 }, b = { I = 1, k = 1 } }, links = { rod = { \"a\", \"b\", k = 4 "
      "} } }\n"
      "c = rig:response{ over = { omega = { 0.5, 2 } }, at = function(p)\n"
      "    return { M = { a = excitation.harmonic{ omega = p.omega } } }\n"
      "end }\n"
      "print(c[\"b.amplitude\"])  --> vector{ 0.609125, 0.266643 }",
      {&rig_response_call}}},
    {lua::a_method<rig_with>,
     {"rig:with{ OPTIONS } -> rig",
      "A copy of the system with some parameters of its bodies and links changed, each by the options of system{...}.",
      DINAL_RIG "print(rig:with{ bodies = { load = { Rd = 0.5 } } }.load.Rd)  --> 0.5",
      {&rig_with_call}}},
    {lua::a_value<AssemblyHandle, [](const AssemblyHandle& rig) { return units_by_name(rig->units); }>,
     {"rig.units -> table", "The names of the units of theta, t and M; nil without one.",
      DINAL_RIG "print(rig.units.theta)  --> rad"}},
    {lua::a_value<AssemblyHandle, joint_names<false>>,
     {"rig.bodies -> table", "The names of the bodies, in alphabetical order.",
      DINAL_RIG "print(table.concat(rig.bodies, \" \"))  --> load motor"}},
    {lua::a_value<AssemblyHandle, joint_names<true>>,
     {"rig.links -> table", "The names of the links, in alphabetical order.", DINAL_RIG "print(#rig.links)  --> 1"}},
    {lua::a_text<AssemblyHandle, rig_text>,
     {"tostring(rig) -> string", "The system as Lua text.",
      "print(system{ bodies = { a = { I = 1 }, b = { I = 2, k = 4 } } })  --> system{ bodies = { a = { I = 1 }, b "
      "= { I "
      "= 2, k = 4 } } }"}},
};

#undef DINAL_RIG

}  // namespace

const lua::Class rig_class = {
    "rig",
    {"system{ bodies = { ... }, links = { ... } } -> rig",
     "A system of several bodies, or of one whose friction depends on more than its speed. It cannot be changed. rig.load "
     "is the body `load` as a system of its own, with all fields of a system: rig.load.omega0. For a link such as "
     "rig.shaft, I is I1 I2/(I1 + I2), which is what turns if both of its bodies are free. One body without a name has "
     "the fields of a system except for dead_zone.",
     "rig = system{ I = 1, k = 4, Rd = 0.3, normal = function(t) return 1 + t end }\n"
     "print(rig:simulate{ theta0 = 1, t_end = 20 }.outcome)  --> stuck at the end"},
    rig_members,
    field_of_rig};

void register_system(lua_State* L) {
    lua::add_class<model::Oscillator>(L, system_class);
    lua::add_functions(L, system_functions);
    lua::add_class<AssemblyHandle>(L, rig_class);
}

int push_system(lua_State* L, const lua::Options& options, const model::OscillatorParameters& parameters) {
    lua::push(L, options.value_or_fail(model::Oscillator::make(parameters)));
    return 1;
}

std::optional<model::Friction> asked_law(lua_State* L, const lua::Options& options,
                                         std::initializer_list<const char*> instead_of, bool may_have_state) {
    options.push("friction");
    if (lua_type(L, -1) == LUA_TNUMBER) {
        options.fail({.sentence = fmt::format("friction must be {}, got {}", options.row("friction").wanted,
                                              lua::describe(L, -1)),
                      .option = "friction",
                      .culprit = lua::written(L, -1),
                      .cure = fmt::format("; did you mean '{}'?", *instead_of.begin())});
    }
    lua_pop(L, 1);
    const auto* law = options.object<model::Friction>("friction");
    if (law == nullptr) {
        return std::nullopt;
    }
    for (const char* name : instead_of) {
        if (options.has(name)) {
            options.fail(name, fmt::format("friction and {} exclude each other; give one of them", name));
        }
    }
    if (!may_have_state && law->as<model::laws::Bristle>() != nullptr) {
        options.fail("friction", "a law of bristles has a state of its own, which only system{ ... } supports");
    }
    return *law;
}

std::optional<model::Walls> asked_walls(lua_State* L, const lua::Options& options) {
    const int top = lua_gettop(L);
    options.push("walls");
    lua_pushnil(L);
    const bool is_empty = lua_istable(L, -2) && lua_next(L, -2) == 0;
    lua_settop(L, top);
    return is_empty ? std::nullopt : asked_table<model::Walls>(L, options, "walls", model::walls_call);
}

std::optional<model::Units> asked_units(lua_State* L, const lua::Options& options) {
    auto units = asked_table<model::Units>(L, options, "units", model::units_call);
    if (const auto wrong = units ? units->complaint() : std::nullopt) options.fail(*wrong);
    return units;
}

const model::Units& units_of(const Run& run) {
    return run.origin ? run.origin->system.units() : run.units;
}

std::optional<lua::NamedNumbers> walls_by_name(const std::optional<model::Walls>& walls) {
    if (!walls) return {};
    lua::NamedNumbers numbers{{"lower", walls->lower}, {"upper", walls->upper}, {"restitution", walls->restitution}};
    std::erase_if(numbers, [](const auto& one) { return std::isinf(one.second); });
    return numbers;
}

std::map<std::string, std::string> units_by_name(const model::Units& units) {
    std::map<std::string, std::string> named{{"theta", units.theta}, {"t", units.t}, {"M", units.M}};
    std::erase_if(named, [](const auto& one) { return one.second.empty(); });
    return named;
}

}  // namespace dinal::api
