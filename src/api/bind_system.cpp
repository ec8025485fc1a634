// system{...}, nondimensional{...} and the class of systems. sys:simulate{...} is in bind_simulate.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "analysis/returns.hpp"
#include "api/bind_simulate.hpp"
#include "api/bodies.hpp"
#include "api/cards.hpp"
#include "api/classes.hpp"
#include "api/drive_options.hpp"
#include "api/lua_run.hpp"
#include "api/response.hpp"
#include "api/steady_answer.hpp"
#include "api/system_options.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "lua/values.hpp"
#include "model/controller.hpp"
#include "model/laws/bristle.hpp"
#include "motion/engine/modes.hpp"
#include "source/describe.hpp"
#include "text/words.hpp"

namespace dinal::api {

namespace {

constexpr text::Call system_call{"system", "system{ I = 1, k = 39.5, C = 1.5, Rd = 2, Re = 3 }", system_options, false,
                                 &simulate_call};

/// Ratios for k = 1 and characteristic torque Mc = 1.
struct Ratios {
    double zeta = 0;
    double friction = 0;
    std::optional<double> breakaway = {};
};
constexpr text::Option ratio_options[] = {
    text::option<&Ratios::zeta>("zeta", "viscous damping ratio", {.range = text::not_negative}),
    text::option<&Ratios::friction>("friction_ratio", "Rd/Mc", {.range = text::not_negative}),
    text::option<&Ratios::breakaway>("breakaway_ratio", "Re/Mc, at least friction_ratio",
                                     {.otherwise = "friction_ratio"}),
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
    if (breakaway_ratio < ratios.friction) {  // the model's error would name Rd and Re, which the user has not given
        options.fail("breakaway_ratio", "breakaway_ratio = {} must be at least friction_ratio = {}", breakaway_ratio,
                     ratios.friction);
    }
    // NOTE: no double is both I = 1/(4 pi^2), for which T0 is exactly 1, and a square, for which C/2 = sqrt(I k) can
    // hold exactly. zeta = 1 needs the square: then damping is exactly critical.
    constexpr double root = 1 / (2 * std::numbers::pi);
    model::OscillatorParameters parameters;
    parameters.inertia = ratios.zeta == 1 ? root * root : 1 / (4 * std::numbers::pi * std::numbers::pi);
    parameters.stiffness = 1;
    parameters.damping = 2 * ratios.zeta * std::sqrt(parameters.inertia);
    parameters.kinetic_friction = ratios.friction;
    parameters.breakaway = breakaway_ratio;
    parameters.friction = asked_law(L, options, {"friction_ratio", "breakaway_ratio"});
    parameters.units = asked_units(L, options).value_or(model::Units{.theta = "Mc/k", .t = "T0", .M = "Mc"});
    const model::Oscillator made = options.value_or_fail(model::Oscillator::make(parameters));
    lua::push<SystemHandle>(L, std::make_shared<const model::System>(model::as_system(made)));
    return 1;
}

/// The unnamed body whose field is read. Fields of named systems are handled by field_of_names().
model::Oscillator body_of(const SystemHandle& system) {
    return model::oscillator_at(*system, 0).value();
}

/// A fact about the unnamed body.
template <auto fact>
auto of_body(const SystemHandle& system) {
    return std::invoke(fact, body_of(system));
}

/// The same for a fact that requires k; nil without a spring.
template <auto fact>
auto of_spring(const SystemHandle& system) {
    const model::Oscillator body = body_of(system);
    return body.has_spring() ? std::optional(std::invoke(fact, body)) : std::nullopt;
}

text::Expected<double> friction_ratio(const SystemHandle& sys, double Mc) {
    const auto body = oscillator_of(*sys);
    if (!body) return body.error();
    if (Mc != 0) return body->friction_ratio(Mc);
    return text::Error{.sentence =
                           "Mc = 0 must not be zero; for a free motion it is "
                           "sys:characteristic_torque(theta0, velocity0)",
                       .culprit = "0"};
}

text::Expected<double> characteristic_torque(const SystemHandle& sys, double theta0, std::optional<double> velocity0) {
    const auto body = oscillator_of(*sys);
    if (!body) return body.error();
    return body->characteristic_torque({theta0, velocity0.value_or(0)});
}

template <bool links>
std::vector<std::string> joint_names(const SystemHandle& system) {
    std::vector<std::string> names;
    for (std::size_t j = 0; j < system->joints.size(); ++j) {
        if (system->named && system->is_link(j) == links) names.push_back(system->joints[j].name);
    }
    return names;
}

// sys:modes{...}: eigenvalues at an equilibrium or in steady sliding.

constexpr text::Option own_modes_options[] = {
    {.name = "M",
     .unit = "torque",
     .otherwise = "0",
     .meaning = "constant torques, or functions of the motion; of several bodies by body or link",
     .object = "excitation"},
    {.name = "belt",
     .unit = "rad per time unit",
     .otherwise = "0",
     .meaning = "constant velocities of surfaces, on which contacts slide; of several by body or link",
     .object = "excitation"},
    {.name = "theta0",
     .unit = "rad",
     .otherwise = "0",
     .meaning = "angles from which the rest is searched, and at which contacts hold that have no belt"},
};
constexpr auto modes_options = text::joined(own_modes_options, states_option);
constexpr text::Call modes_call{"sys:modes", "sys:modes{ belt = 0.2 }", modes_options, true};

void push_shape(lua_State* L, const model::System& system, const motion::engine::EigenMode& mode, bool quadrature) {
    lua_newtable(L);
    for (std::size_t i = 0; i < mode.shape.size(); ++i) {
        const double part = quadrature ? mode.shape[i].imag() : mode.shape[i].real();
        lua::set_number(L, system.named ? system.bodies[i].name.c_str() : "theta", part + 0.0);
    }
}

int modes_of_system(lua_State* L) {
    const SystemHandle handle = lua::self<SystemHandle>(L, 1, modes_call.example);
    const model::System& system = *handle;
    const lua::Options options(L, 2, modes_call);
    const model::Drive drive = asked_drive(L, options, system);
    for (const model::Excitation& load : drive.loads) {
        if (model::has_memory<model::SampledController>(load) || model::has_memory<model::DelayedController>(load))
            options.fail("M", "modes do not include controllers that sample or wait: sys:simulate shows their motion");
    }
    lua::CallState call(L);
    name_functions(call, system, drive);
    const std::string timed =
        analysis::timed_in({.system = handle, .drive = drive, .body = model::oscillator_at(system, 0).value()});
    call.check();
    if (!timed.empty()) {
        const bool is_option = timed == "M" || timed == "belt";
        options.fail(text::Error{.sentence = timed +
                                             " must be constant, or depend on the motion alone: modes are those of a "
                                             "rest or of an even sliding",
                                 .option = is_option ? timed : ""});
    }
    const auto modes = motion::engine::modes_beside(system, drive);
    call.check();
    if (!modes) options.fail(modes.error());
    lua_newtable(L);
    for (std::size_t k = 0; k < modes->size(); ++k) {
        const auto& mode = (*modes)[k];
        const double size = std::abs(mode.value);
        lua_newtable(L);
        lua::set_number(L, "re", mode.value.real() + 0.0);
        lua::set_number(L, "im", mode.value.imag());
        lua::set_number(L, "frequency", mode.value.imag() / (2 * std::numbers::pi));
        lua::set_number(L, "zeta", size > 0 ? -mode.value.real() / size + 0.0 : 0);
        push_shape(L, system, mode, false);
        lua_setfield(L, -2, "shape");
        push_shape(L, system, mode, true);
        lua_setfield(L, -2, "quadrature");
        lua_rawseti(L, -2, static_cast<lua_Integer>(k) + 1);
    }
    return 1;
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
    {lua::a_method<modes_of_system>,
     {"sys:modes{ OPTIONS } -> list",
      "The eigenvalues re + i im of small motions beside a rest, or beside an even sliding on a belt, per time unit: a "
      "list of { re, im, frequency, zeta, shape, quadrature }, one of each pair, sorted by im. frequency is im/(2 pi), "
      "zeta is -re/|re + i im|, negative where the motion grows. The rest is searched from theta0, and need not be stable; "
      "contacts with a belt slide, all others hold. shape has by body the part in phase with the body that moves most, "
      "which has 1, and quadrature the part a quarter of a period ahead.",
      "sys = system{ I = 1, k = 4, friction = friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 } }\n"
      "mode = sys:modes{ belt = 0.1 }[1]\nprint(string.format(\"%.4f %.4f\", mode.re, mode.zeta))  --> 1.1036 -0.5518\n"
      "rig = system{ bodies = { a = { I = 1, k = 1 }, b = { I = 1, k = 1 } }, links = { rod = { \"a\", \"b\", k = 4 } } }\n"
      "for _, mode in ipairs(rig:modes()) do\n    print(string.format(\"%.6f %.6f\", mode.im, mode.shape.b / mode.shape.a))\n"
      "end\n--> 1.000000 1.000000\n--> 3.000000 -1.000000",
      {&modes_call}}},
    {lua::a_method<simulate_system>, simulate_doc},
    {lua::a_method<system_with>,
     {"sys:with{ OPTIONS } -> system",
      "A copy of the system with some parameters changed: the options of system{...}, of named bodies and links by their "
      "names. Re changes with Rd if the two were equal; spring.polynomial{} removes a spring, and walls = {} the walls.",
      "sys = system{ I = 1, k = 4, Rd = 0.5 }\nprint(sys:with{ Rd = 1 })  --> system{ I = 1, k = 4, Rd = 1, Re = 1 }\n"
      "rig = system{ bodies = { load = { I = 3, Rd = 0.2 } } }\n"
      "print(rig:with{ bodies = { load = { Rd = 0.5 } } }.load.Rd)  --> 0.5",
      {&with_call}}},
    {lua::a_typed_method<friction_ratio>,
     {"sys:friction_ratio(Mc) -> number", "The dry friction ratio gamma = Rd/|Mc| for the characteristic torque Mc.",
      "print(system{ I = 1, k = 4, Rd = 0.5 }:friction_ratio(2))  --> 0.25"}},
    {lua::a_typed_method<characteristic_torque>,
     {"sys:characteristic_torque(theta0, velocity0 = 0) -> number",
      "The characteristic torque Mc = k sqrt(theta0^2 + (velocity0/omega0)^2) of the free motion that starts at theta0 "
      "(rad) with velocity0 (rad per time unit).",
      "print(system{ I = 1, k = 4 }:characteristic_torque(3, 8))  --> 20.0"}},
    {lua::a_value<SystemHandle, of_body<&model::Oscillator::inertia>>,
     {"sys.I -> number", "The moment of inertia.", "print(system{ I = 2, k = 4 }.I)  --> 2.0"}},
    {lua::a_value<SystemHandle, of_body<&model::Oscillator::stiffness>>,
     {"sys.k -> number", "The stiffness, torque per rad.", "print(system{ I = 2, k = 4 }.k)  --> 4.0"}},
    {lua::a_value<SystemHandle, of_body<&model::Oscillator::damping>>,
     {"sys.C -> number", "The viscous damping constant, torque per rad per time unit.",
      "print(system{ I = 2, k = 4 }.C)  --> 0.0"}},
    {lua::a_value<SystemHandle,
                  of_body<[](const model::Oscillator& system) { return system.friction().under(1).kinetic(); }>>,
     {"sys.Rd -> number", "The torque of dry friction while the mass moves, under a normal load of 1.",
      "print(system{ I = 2, k = 4, Rd = 0.5 }.Rd)  --> 0.5"}},
    {lua::a_value<SystemHandle, of_body<[](const model::Oscillator& system) {
                      return system.friction().under(1).greatest_holding();
                  }>>,
     {"sys.Re -> number", "The breakaway torque under a normal load of 1. Rd unless given.",
      "print(system{ I = 2, k = 4, Rd = 0.5 }.Re)  --> 0.5"}},
    {lua::a_value<SystemHandle, of_body<[](const model::Oscillator& system) { return system.friction().under(1); }>>,
     {"sys.friction -> law", "The law of friction, under a normal load of 1.",
      "print(system{ I = 2, k = 4, Rd = 0.5 }.friction)  --> friction.coulomb{ Rd = 0.5, Re = 0.5 }"}},
    {lua::a_value<SystemHandle, of_body<[](const model::Oscillator& system) { return system.friction().normal(); }>>,
     {"sys.normal -> number", "The constant normal load that multiplies the torques of friction.",
      "sys = system{ I = 1, k = 4, Rd = 1, normal = 2 }\nprint(sys.normal, sys.dead_zone)  --> 2.0\t0.5"}},
    {lua::a_value<SystemHandle, of_body<[](const model::Oscillator& system) {
                      const model::Spring& spring = system.spring();
                      return spring.none() ? std::nullopt : std::optional(spring);
                  }>>,
     {"sys.spring -> spring or nil", "The spring in addition to k theta; nil if there is none.",
      "print(system{ I = 1, k = 4, spring = spring.polynomial{ [3] = 2 } }.spring:torque(3))  --> 54.0"}},
    {lua::a_value<SystemHandle, of_body<[](const model::Oscillator& system) { return walls_by_name(system.walls()); }>>,
     {"sys.walls -> table or nil",
      "The end stops { lower, upper, restitution }, rad, or elastic ones { lower, upper, stiffness, damping }; nil if there "
      "are none.",
      "print(system{ I = 1, k = 4, walls = { upper = 0.5, restitution = 0.7 } }.walls.upper)  --> 0.5"}},
    {lua::a_value<SystemHandle, [](const SystemHandle& system) { return units_by_name(system->units); }>,
     {"sys.units -> table",
      "The names of the units of theta, t and M; nil without one. Cards, columns and axes show them; no number "
      "depends on them.",
      "print(system{ I = 1, k = 4, units = { theta = \"m\", t = \"s\" } }.units.theta)  --> m"}},
    {lua::a_value<SystemHandle, joint_names<false>>,
     {"sys.bodies -> table", "The names of the bodies, in alphabetical order; empty for one body without a name.",
      "rig = system{ bodies = { motor = { I = 1 }, load = { I = 3 } } }\n"
      "print(table.concat(rig.bodies, \" \"))  --> load motor"}},
    {lua::a_value<SystemHandle, joint_names<true>>,
     {"sys.links -> table", "The names of the links, in alphabetical order.",
      "rig = system{ bodies = { a = { I = 1 }, b = { I = 3 } }, links = { rod = { \"a\", \"b\", k = 2 } } }\n"
      "print(rig.links[1])  --> rod"}},
    {lua::a_value<SystemHandle, of_spring<&model::Oscillator::natural_frequency>>,
     {"sys.omega0 -> number", "The natural frequency sqrt(k/I) of k alone, rad per time unit; nil where k = 0.",
      "print(system{ I = 1, k = 4 }.omega0)  --> 2.0"}},
    {lua::a_value<SystemHandle, of_spring<&model::Oscillator::natural_period>>,
     {"sys.T0 -> number", "The natural period 2 pi/omega0, time units; nil where k = 0.",
      "print(system{ I = 1, k = 4*math.pi^2 }.T0)  --> 1.0"}},
    {lua::a_value<SystemHandle, of_body<&model::Oscillator::damped_frequency>>,
     {"sys.omega1 -> number or nil",
      "The frequency of the damped swing, omega0 sqrt(1 - zeta^2), rad per time unit; nil unless zeta < 1.",
      "print(system{ I = 1, k = 4 }.omega1, system{ I = 1, k = 4, C = 10 }.omega1)  --> 2.0\tnil"}},
    {lua::a_value<SystemHandle, of_spring<&model::Oscillator::damping_ratio>>,
     {"sys.zeta -> number", "The viscous damping ratio C/(2 I omega0); nil where k = 0.",
      "print(system{ I = 1, k = 4, C = 1 }.zeta)  --> 0.25"}},
    {lua::a_value<SystemHandle, of_spring<[](const model::Oscillator& body) { return model::name(body.regime()); }>>,
     {"sys.regime -> string",
      "How the free system without dry friction moves: \"undamped\", \"underdamped\", \"critical\" or \"overdamped\"; "
      "nil where k = 0.",
      "print(system{ I = 1, k = 4, C = 4 }.regime)  --> critical"}},
    {lua::a_value<SystemHandle, of_body<[](const model::Oscillator& system) {
                      return system.has_linear_spring() ? std::optional(system.dead_zone()) : std::nullopt;
                  }>>,
     {"sys.dead_zone -> number",
      "Re/k, rad: without excitation the mass can rest wherever |theta| is at most this; nil if "
      "k = 0 or with another spring. A normal load multiplies it.",
      "print(system{ I = 1, k = 4, Rd = 1, Re = 2 }.dead_zone)  --> 0.5"}},
    {lua::a_text<SystemHandle, [](lua_State* L, const SystemHandle& system) { return source::lua_text(L, *system); }>,
     {"tostring(sys) -> string", "The Lua text that recreates it.",
      "print(system{ I = 1, k = 4, Rd = 0.5 })  --> system{ I = 1, k = 4, Rd = 0.5, Re = 0.5 }"}},
};

}  // namespace

bool is_of_whole(std::string_view field) {
    return field == "units" || field == "bodies" || field == "links";
}

const lua::Class system_functions = {"system",
                                     {"system{ I, k, ... } or nondimensional{ ... } -> system",
                                      "Makes a system, in your own units or in the report's nondimensional form.",
                                      "print(system{ I = 1, k = 4 }.omega0)  --> 2.0"},
                                     system_module_members,
                                     lua::add_functions};

namespace {

/// The name of an option in the table on the top that is neither a number nor a law, or nullptr.
const char* varying_option(lua_State* L) {
    for (const char* name : {"friction", "Rd", "Re", "normal"}) {
        const bool given = lua_getfield(L, -1, name) != LUA_TNIL;
        const bool constant = lua_type(L, -1) == LUA_TNUMBER || lua::test<model::Friction>(L, -1) != nullptr;
        lua_pop(L, 1);
        if (given && !constant) return name;
    }
    return nullptr;
}

/// Pushes a field of a named system: a body or a link.
int field_of_names(lua_State* L, const model::System& system, std::string_view name) {
    if (const auto own = system.joint_named(name)) return push_alone(L, fmt::format("sys.{}", name), system, *own);
    const bool only_one_body = std::ranges::any_of(system_class.members, [&](const auto& member) {
        return member.name == name && member.kind == lua::Kind::field && !is_of_whole(name);
    });
    if (only_one_body) {
        lua::raise(L, {.sentence = fmt::format("{0} is of one body or link: sys.{1}.{0}", name, system.joints[0].name),
                       .culprit = std::string(name)});
    }
    return 0;
}

/// Pushes a field of a system with varying friction: what the user wrote.
int field_of_varying(lua_State* L, const model::System& system, std::string_view name) {
    constexpr std::array<std::string_view, 6> own{"Rd", "Re", "normal", "friction", "walls", "dead_zone"};
    if (!text::contains(own, name)) return 0;
    push_joint(L, system, 0);
    const char* varying = varying_option(L);
    if (system.joints.front().stops && name == "dead_zone") lua::raise(L, "with elastic walls a mass has no dead zone");
    if (!system.joints.front().friction.is_of_numbers()) varying = "friction";
    if (name != "dead_zone") {
        if (lua_getfield(L, -1, lua_tostring(L, 2)) != LUA_TNIL) return 1;
        if (name == "walls") return 1;
        lua_pop(L, 1);
        if (name == "Re" && lua_getfield(L, -1, "Rd") != LUA_TNIL) return 1;
        if (varying != nullptr && std::string_view(varying) == "normal") varying = nullptr;  // does not affect the law
    }
    if (varying != nullptr && name != "normal") {
        lua_getfield(L, 3, varying);
        const auto* law = lua::test<model::Friction>(L, -1);
        lua::raise(L, "this system has no constant {}: its {} is {}", name, varying,
                   law != nullptr            ? source::lua_text(L, *law)
                   : lua::is_callable(L, -1) ? "a function"
                   : lua_istable(L, -1)      ? "a list of laws"
                                             : lua::describe(L, -1));
    }
    lua_settop(L, 2);
    return 0;
}

int field_of_system(lua_State* L) {
    const auto* system = lua::test<SystemHandle>(L, 1);
    if (system == nullptr || (*system)->is_plain()) return 0;
    const SystemHandle kept = *system;
    const std::string_view name = lua_tostring(L, 2);
    return kept->named ? field_of_names(L, *kept, name) : field_of_varying(L, *kept, name);
}

int unknown_field(lua_State* L) {
    const auto* system = lua::test<SystemHandle>(L, 1);
    if (system != nullptr && (*system)->named && lua_type(L, 2) == LUA_TSTRING) {
        joint_named(L, lua_tostring(L, 2), **system, "this system", system_class);
    }
    return 0;
}

}  // namespace

const lua::Class system_class = {
    "system",
    {"system{ I, k, ... } or system{ bodies = { ... }, links = { ... } } -> system",
     "A system. It cannot be changed. Its parameters, and quantities that follow from them, are fields. Of several bodies "
     "sys.load is the body `load` as a system of its own, with all these fields: sys.load.omega0. For a link such as "
     "sys.shaft, I is I1 I2/(I1 + I2), which is what turns if both of its bodies are free.",
     "sys = system{ I = 1, k = 4, C = 1 }\nprint(sys.omega0, sys.zeta)  --> 2.0\t0.25\n"
     "rig = system{ bodies = { motor = { I = 1 }, load = { I = 3, k = 3 } }, links = { shaft = { \"motor\", \"load\", k = 9 } } }\n"
     "print(rig.load.omega0, rig.shaft.I)  --> 1.0\t0.75"},
    system_members,
    lua::add_class<SystemHandle>,
    unknown_field,
    system_card,
    field_of_system};

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
            options.fail(name, "friction and {} exclude each other; give one of them", name);
        }
    }
    const bool has_state = law->bending() != nullptr || law->as<model::laws::Jenkins>() != nullptr;
    if (!may_have_state && (has_state || law->is_one_way())) {
        options.fail("friction", "{} is a law that only system{{ ... }} supports", law->lua_text());
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

const model::Units& units_of(const LuaRun& run) {
    return run.origin ? run.system().units : run.units;
}

std::optional<lua::NamedNumbers> walls_by_name(const std::optional<model::Walls>& walls) {
    if (!walls) return {};
    lua::NamedNumbers numbers{{"lower", walls->lower}, {"upper", walls->upper}};
    if (walls->is_elastic()) {
        numbers.insert(numbers.end(), {{"stiffness", walls->stiffness}, {"damping", walls->damping}});
    } else {
        numbers.emplace_back("restitution", walls->restitution);
    }
    std::erase_if(numbers, [](const auto& one) { return std::isinf(one.second); });
    return numbers;
}

std::map<std::string, std::string> units_by_name(const model::Units& units) {
    std::map<std::string, std::string> named{{"theta", units.theta}, {"t", units.t}, {"M", units.M}};
    std::erase_if(named, [](const auto& one) { return one.second.empty(); });
    return named;
}

}  // namespace dinal::api
