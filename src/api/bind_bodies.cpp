// system{ bodies = ..., links = ... }: several bodies, their runs, and what these look like from one body.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "api/animate.hpp"
#include "api/bind_excitation.hpp"
#include "api/bind_simulate.hpp"
#include "api/bodies.hpp"
#include "api/classes.hpp"
#include "api/data.hpp"
#include "api/extras_options.hpp"
#include "api/picture.hpp"
#include "api/response.hpp"
#include "api/run.hpp"
#include "api/steady_answer.hpp"
#include "api/system_options.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "lua/standard_globals.hpp"
#include "lua/user_function.hpp"
#include "lua/vector.hpp"
#include "model/controller.hpp"
#include "model/laws/coulomb.hpp"
#include "motion/engine/modes.hpp"
#include "motion/engine/one_body.hpp"
#include "motion/engine/part.hpp"
#include "plots/run_figure.hpp"
#include "source/describe.hpp"
#include "terminal/progress.hpp"
#include "text/characters.hpp"
#include "text/sentences.hpp"

namespace dinal::api {

namespace {

namespace engine = motion::engine;

constexpr text::Option inertia_option[] = {model::mechanical_options[0]};
constexpr text::Option joint_options[] = {
    {"k", "torque per rad", text::its_own, text::not_negative, "stiffness of the spring",
     text::fills<&model::OscillatorParameters::stiffness>},
    model::mechanical_options[2],
    model::mechanical_options[6],
    model::mechanical_options[7],
};
constexpr auto body_options = text::joined(inertia_option, joint_options, friction_options);
constexpr auto link_options = text::joined(joint_options, friction_options);

std::vector<std::string> body_names(const model::Assembly& system) {
    std::vector<std::string> names;
    for (const model::Body& body : system.bodies) names.push_back(body.name);
    return names;
}

// ---- system{ bodies, links }

/// What everybody asks of a run of several bodies; all else gives way to a body or link of that name.
constexpr std::string_view names_in_runs[] = {"at",     "continue", "data",  "energy",  "events",    "explain",
                                              "plot",   "animate",  "save",  "states",  "status",    "outcome",
                                              "system", "t",        "t_end", "t_start", "integrator"};

/// The names under the option, each of a table; that stays on the top.
std::vector<std::string> tables_by_name(lua_State* L, const lua::Options& options, const char* option) {
    options.push(option);
    std::vector<std::string> names = names_in_table(L, options, option);
    for (const std::string& name : names) {
        if (std::find(std::begin(names_in_runs), std::end(names_in_runs), name) != std::end(names_in_runs)) {
            options.fail(
                {.sentence = fmt::format("{}: '{}' is a name that a run has already; take another", option, name),
                 .option = option,
                 .culprit = name});
        }
        check_name(options, option, name, rig_class);
        if (lua_getfield(L, -1, name.c_str()) != LUA_TTABLE) {
            options.fail(
                {.sentence = fmt::format("{}.{} must be a table such as {}, got {}", option, name,
                                         *option == 'l' ? "{ \"motor\", \"load\", k = 90 }" : "{ I = 1, Rd = 0.4 }",
                                         lua::describe(L, -1)),
                 .option = option,
                 .culprit = lua::written(L, -1)});
        }
        lua_pop(L, 1);
    }
    return names;
}

/// All of a joint but its bodies.
model::Joint asked_joint(lua_State* L, const lua::Options& options, double& inertia) {
    model::OscillatorParameters numbers;
    options.fill(numbers);
    inertia = numbers.inertia;
    model::Joint joint;
    joint.stiffness = numbers.stiffness, joint.damping = numbers.damping;
    joint.friction = asked_friction(L, options, options.call());
    joint.spring = asked_spring(L, options).value_or(model::Spring());
    joint.walls = asked_walls(L, options);
    if (const auto wrong = joint.walls ? joint.walls->complaint() : std::nullopt) options.fail(*wrong);
    return joint;
}

/// The same from the table on the top.
model::Joint read_joint(lua_State* L, const std::string& call, std::span<const text::Option> rows, double& inertia) {
    const text::Call own{call.c_str(), "{ I = 1, k = 4, Rd = 0.3 }", rows};
    return asked_joint(L, lua::Options(L, lua_gettop(L), own), inertia);
}

/// A body or link by itself. Of a link, whose bodies turn against each other, that is what both are when they are free.
model::OscillatorParameters alone(const model::Assembly& system, std::size_t joint) {
    const model::Joint& own = system.joints[joint];
    model::OscillatorParameters parameters = parameters_of(system, joint);
    if (own.second >= 0) {
        const double other = system.bodies[static_cast<std::size_t>(own.second)].inertia;
        parameters.inertia = parameters.inertia / (parameters.inertia + other) * other;
    }
    parameters.spring = own.spring, parameters.walls = own.walls;
    if (!own.friction.law.under(1).none()) parameters.friction = own.friction.law;
    parameters.normal = own.friction.law.normal();
    return parameters;
}

}  // namespace

int push_alone(lua_State* L, std::string_view call, const model::Assembly& system, std::size_t j) {
    const model::OscillatorParameters parameters = alone(system, j);
    const auto oscillator = lua::value_or_raise(L, call, model::Oscillator::make(parameters));
    if (system.joints[j].friction.is_constant()) {
        lua::push(L, oscillator);
        return 1;
    }
    model::Assembly one{
        .bodies = {{"", parameters.inertia}}, .joints = {system.joints[j]}, .named = false, .units = system.units};
    one.joints[0].name.clear(), one.joints[0].first = 0, one.joints[0].second = model::Joint::ground;
    lua::push<AssemblyHandle>(L, std::make_shared<const model::Assembly>(std::move(one)));
    return 1;
}

namespace {

int body_index(const lua::Options& options, const model::Assembly& system, const std::string& link, lua_State* L) {
    const std::string name = lua_type(L, -1) == LUA_TSTRING ? lua_tostring(L, -1) : "";
    for (std::size_t i = 0; i < system.bodies.size(); ++i) {
        if (system.bodies[i].name == name) return static_cast<int>(i);
    }
    const std::vector<std::string> names = body_names(system);
    options.fail({.sentence = name.empty() ? fmt::format("links.{} must begin with the names of two bodies, such as "
                                                         "{{ \"{}\", \"{}\", k = 90 }}",
                                                         link, names.front(), names.back())
                                           : fmt::format("links.{}: there is no body '{}'; there is {}", link, name,
                                                         fmt::join(names, ", ")),
                  .option = "links",
                  .culprit = name,
                  .cure = name.empty() ? "" : text::did_you_mean(name, names)});
}

}  // namespace

int push_bodies(lua_State* L, const lua::Options& options) {
    const std::vector<std::string> names = tables_by_name(L, options, "bodies");
    if (names.empty()) options.wrong("bodies");
    for (const char* alone : {"I", "k", "C", "Rd", "Re", "friction", "normal", "spring", "walls"}) {
        if (!options.has(alone)) continue;
        options.fail(alone, fmt::format("{} is an option of a body: bodies = {{ load = {{ {}{} = ... }} }}", alone,
                                        std::string_view(alone) == "I" ? "" : "I = 1, ", alone));
    }
    model::Assembly system;
    system.units = asked_units(L, options).value_or(model::Units());
    for (std::size_t i = 0; i < names.size(); ++i) {
        lua_getfield(L, -1, names[i].c_str());
        double inertia = 0;
        model::Joint joint =
            read_joint(L, fmt::format("{}: bodies.{}", options.call(), names[i]), body_options, inertia);
        joint.name = names[i], joint.first = static_cast<int>(i);
        system.bodies.push_back({names[i], inertia});
        system.joints.push_back(std::move(joint));
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    if (options.has("links")) {
        for (const std::string& name : tables_by_name(L, options, "links")) {
            if (std::find(names.begin(), names.end(), name) != names.end()) {
                options.fail("links", fmt::format("links: '{}' is the name of a body already; take another", name));
            }
            lua_getfield(L, -1, name.c_str());
            std::array<int, 2> ends{};
            for (int end = 0; end < 2; ++end) {
                lua_rawgeti(L, -1, end + 1);
                ends.at(static_cast<std::size_t>(end)) = body_index(options, system, name, L);
                lua_pop(L, 1);
            }
            if (ends[0] == ends[1]) {
                options.fail("links", fmt::format("links.{} must be between two different bodies", name));
            }
            if (lua_rawlen(L, -1) > 2) {
                options.fail("links",
                             fmt::format("links.{} is between two bodies, and names {}", name, lua_rawlen(L, -1)));
            }
            lua::push_copy(L, -1, 2);
            double none = 0;
            model::Joint joint = read_joint(L, fmt::format("{}: links.{}", options.call(), name), link_options, none);
            joint.name = name, joint.first = ends[0], joint.second = ends[1];
            system.joints.push_back(std::move(joint));
            lua_pop(L, 2);
        }
        lua_pop(L, 1);
    }
    lua::push<AssemblyHandle>(L, std::make_shared<const model::Assembly>(std::move(system)));
    return 1;
}

int push_body(lua_State* L, const lua::Options& options) {
    double inertia = 0;
    model::Assembly system{.bodies = {}, .joints = {asked_joint(L, options, inertia)}, .named = false};
    system.bodies.push_back({"", inertia});
    system.units = asked_units(L, options).value_or(model::Units());
    return push_alone(L, options.call(), system, 0);
}

model::ContactFriction asked_friction(lua_State* L, const lua::Options& options, const std::string& call) {
    model::ContactFriction friction;
    const auto varying = [&](const char* name) -> std::optional<model::Excitation> {
        if (!options.has(name)) return {};
        options.push(name);
        model::Excitation value = to_excitation(L, -1, fmt::format("{}: {}", call, name), name);
        lua_pop(L, 1);
        // Only controllers in M are asked at their instants.
        if (model::has_memory(value)) {
            options.fail(name,
                         fmt::format("{} must be {}; a controller with a memory acts in M", name, varying_wanted));
        }
        return value;
    };
    const auto number = [&](const char* name) -> std::optional<double> {
        options.push(name);
        const bool is = lua_type(L, -1) == LUA_TNUMBER;
        lua_pop(L, 1);
        return is ? std::optional(options.number(name)) : std::nullopt;
    };
    friction.normal = varying("normal");
    const auto normal = number("normal");
    // A constant load of a law is part of it, so that nobody else needs to know; of bristles it stretches the state.
    const auto of_law = [&](const model::Friction& law) {
        friction.law = law;
        if (!normal || friction.bristle() != nullptr) return friction;
        friction.law = law.under(*normal);
        friction.normal.reset();
        return friction;
    };
    options.push("friction");
    const bool function = lua::is_callable(L, -1) && lua::test<model::Friction>(L, -1) == nullptr;
    if (function) {
        friction.function =
            std::make_shared<lua::LuaFunction>(L, -1,
                                               lua::FunctionRole{.name = "friction",
                                                                 .may_be_negative = false,
                                                                 .motion = lua::FunctionRole::Motion::always,
                                                                 .of_speed = true});
        if (options.has("Rd")) options.fail("Rd", "friction and Rd exclude each other; give one of them");
    }
    lua_pop(L, 1);
    const auto Rd = number("Rd"), Re = number("Re");
    if (function) {
        if (auto holding = varying("Re")) friction.holding = {holding, holding};
        return friction;
    }
    if (const auto law = asked_law(L, options, {"Rd", "Re"}, true)) {
        return of_law(*law);
    }
    const bool numbers = (!options.has("Rd") || Rd) && (!options.has("Re") || Re);
    if (numbers) {
        const model::laws::Coulomb law{Rd.value_or(0), Re.value_or(Rd.value_or(0))};
        if (auto wrong = law.complaint()) options.fail(*wrong);
        return of_law(law.breakaway > 0 ? model::Friction(law) : model::Friction());
    }
    auto sliding = varying("Rd"), holding = varying("Re");
    if (!sliding) {  // nothing brakes, but something holds
        sliding = model::Excitation::make(model::Constant{0}).value();
    }
    friction.sliding = {sliding, sliding};
    if (holding) friction.holding = {holding, holding};
    return friction;
}

namespace {

// ---- simulate

constexpr text::Option rig_integrator_option[] = {
    {.name = "integrator",
     .otherwise = "spectral",
     .meaning = "the method: integrator.spectral or integrator.rk4; exact and dinal1989 are for one body with constant "
                "friction",
     .object = "integrator",
     .wanted = "an integrator such as integrator.rk4{ h = 0.001 }"},
};
constexpr auto bodies_simulate_options =
    text::joined(bodies_drive_rows, window_options, rig_integrator_option, dense_option);
constexpr text::Call bodies_simulate_call{"rig:simulate", "rig:simulate{ M = { load = 2 }, t_end = 20 }",
                                          bodies_simulate_options};

/// Calls f with the joint of each name in the table of this option, the value on the top of the stack.
enum class Names { bodies, links, both };
template <class F>
void for_each_named(lua_State* L, const lua::Options& options, const char* option, const model::Assembly& system,
                    Names which, F f) {
    if (!options.has(option)) return;
    options.push(option);
    if (!system.named) {
        f(0);
        lua_pop(L, 1);
        return;
    }
    if (lua_type(L, -1) != LUA_TTABLE) options.wrong(option);
    std::vector<std::string> known;
    const std::size_t first = which == Names::links ? system.bodies.size() : 0;
    const std::size_t end = which == Names::bodies ? system.bodies.size() : system.joints.size();
    for (std::size_t j = first; j < end; ++j) known.push_back(system.joints[j].name);
    for (lua_pushnil(L); lua_next(L, -2) != 0; lua_pop(L, 1)) {
        const std::string name = lua_type(L, -2) == LUA_TSTRING ? lua_tostring(L, -2) : lua::written(L, -2);
        const auto found = std::find(known.begin(), known.end(), name);
        if (found == known.end()) {
            const char* kind = which == Names::bodies ? "body" : which == Names::links ? "link" : "body or link";
            options.fail({.sentence = fmt::format("{}: there is no {} '{}'; there is {}", option, kind, name,
                                                  known.empty() ? "none" : fmt::format("{}", fmt::join(known, ", "))),
                          .option = option,
                          .culprit = name,
                          .cure = text::did_you_mean(name, known)});
        }
        f(first + static_cast<std::size_t>(found - known.begin()));
    }
    lua_pop(L, 1);
}

// ---- with

/// The number or the function, where it is nothing else.
void push_acting(lua_State* L, const model::Excitation& value) {
    const auto& parts = value.components();
    const auto* constant = parts.size() == 1 ? std::get_if<model::Constant>(&parts.front().term) : nullptr;
    const bool always = constant != nullptr && parts.front().from == -model::never && parts.front().to == model::never;
    if (const lua::LuaFunction* function = source::function_alone(value)) {
        function->push(L);
    } else if (always) {
        lua_pushnumber(L, parts.front().gain * constant->amplitude);
    } else {
        lua::push(L, value);
    }
}

/// Pushes the table of options that makes the body or link.
void push_options(lua_State* L, const model::Assembly& system, std::size_t j) {
    const model::Joint& joint = system.joints[j];
    const model::ContactFriction& friction = joint.friction;
    lua_newtable(L);
    if (system.is_link(j)) {
        for (const int end : {joint.first, joint.second}) {
            lua::push_text(L, system.bodies[static_cast<std::size_t>(end)].name);
            lua_rawseti(L, -2, end == joint.first ? 1 : 2);
        }
    } else {
        lua::set_number(L, "I", system.bodies[j].inertia);
    }
    lua::set_number(L, "k", joint.stiffness);
    lua::set_number(L, "C", joint.damping);
    const auto acting = [&](const char* name, const std::optional<model::Excitation>& value) {
        if (!value) return;
        push_acting(L, *value);
        lua_setfield(L, -2, name);
    };
    if (const auto* own = dynamic_cast<const lua::LuaFunction*>(friction.function.get())) {
        own->push(L);
        lua_setfield(L, -2, "friction");
    }
    const model::Friction law = friction.law.under(1);
    if (const auto* coulomb = law.as<model::laws::Coulomb>()) {
        lua::set_number(L, "Rd", coulomb->kinetic);
        lua::set_number(L, "Re", coulomb->breakaway);
    } else if (!law.none()) {
        lua::set_value(L, "friction", law);
    }
    if (friction.law.normal() != 1) lua::set_number(L, "normal", friction.law.normal());
    acting("Rd", friction.sliding[1]);
    acting("Re", friction.holding[1]);
    acting("normal", friction.normal);
    if (!joint.spring.none()) lua::set_value(L, "spring", joint.spring);
    lua::set_value(L, "walls", walls_by_name(joint.walls));
}

/// Writes what stands in the table on the top into that below it, the options of a body. A new Rd and Re make another
/// law one of Coulomb's again; Re goes with Rd where the two were one number.
void overwrite(lua_State* L, const lua::Options& options) {
    const int changes = lua_gettop(L), into = changes - 1;
    const auto has = [L](int table, const char* name) {
        const bool is = lua_getfield(L, table, name) != LUA_TNIL;
        lua_pop(L, 1);
        return is;
    };
    const auto remove = [&](const char* name) {
        lua_pushnil(L);
        lua_setfield(L, into, name);
    };
    const bool Rd = has(changes, "Rd"), Re = has(changes, "Re");
    if (has(changes, "friction")) {
        remove("Rd"), remove("Re");
    } else if (has(into, "friction")) {
        lua_getfield(L, into, "friction");
        const auto* law = lua::test<model::Friction>(L, -1);
        if (Rd != Re && (Rd || law != nullptr)) {
            options.fail(Rd ? "Rd" : "Re",
                         fmt::format("the friction of this system is {}: give both Rd and Re, or friction",
                                     law == nullptr ? "a function" : source::lua_text(L, *law)));
        }
        lua_pop(L, 1);
        if (Rd) remove("friction");
    } else if (Rd && !Re) {
        lua_getfield(L, into, "Rd");
        lua_getfield(L, into, "Re");
        const bool one_number = lua_rawequal(L, -1, -2) != 0;
        lua_pop(L, 2);
        if (one_number) remove("Re");
    }
    for (lua_pushnil(L); lua_next(L, changes) != 0; lua_pop(L, 1)) {
        lua_pushvalue(L, -2);
        lua_pushvalue(L, -2);
        lua_rawset(L, into);
    }
}

/// What relays can look at: theta.load, velocity.load and the states.
std::vector<std::string> names_for_relays(const model::Assembly& system, const engine::Drive& drive) {
    std::vector<std::string> known;
    if (!system.named) known = {"theta", "velocity"};
    for (const char* kind : {"theta.", "velocity."}) {
        for (const model::Body& each : system.bodies) {
            if (system.named) known.push_back(kind + each.name);
        }
    }
    for (const model::OwnState& state : drive.states) known.push_back(state.name);
    return known;
}

}  // namespace

int system_with(lua_State* L) {
    const auto* several = lua::test<AssemblyHandle>(L, 1);
    model::Assembly old =
        several != nullptr ? **several : engine::assembly_of(lua::self<model::Oscillator>(L, 1, with_call.example));
    const text::Call& call = old.named ? rig_with_call : with_call;
    const lua::Options options(L, 2, call);
    const int top = lua_gettop(L);
    if (old.named) {
        lua_newtable(L);
        for (const Names which : {Names::bodies, Names::links}) {
            lua_newtable(L);
            for (std::size_t j = 0; j < old.joints.size(); ++j) {
                if (old.is_link(j) != (which == Names::links)) continue;
                push_options(L, old, j);
                lua_setfield(L, -2, old.joints[j].name.c_str());
            }
            const char* option = which == Names::links ? "links" : "bodies";
            for_each_named(L, options, option, old, which, [&](std::size_t j) {
                const std::string& name = old.joints[j].name;
                if (!lua_istable(L, -1)) {
                    options.fail(option, fmt::format("{}.{} must be a table such as {{ k = 3 }}, got {}", option, name,
                                                     lua::describe(L, -1)));
                }
                lua_getfield(L, top + 2, name.c_str());
                lua_pushvalue(L, -2);
                overwrite(L, options);
                lua_pop(L, 2);
            });
            lua_setfield(L, top + 1, option);
        }
    } else {
        push_options(L, old, 0);
        lua_pushvalue(L, 2);
        overwrite(L, options);
        lua_pop(L, 1);
    }
    if (options.has("units")) {
        options.push("units");
        lua_setfield(L, top + 1, "units");
    } else {
        lua::set_value(L, "units", units_by_name(old.units));
    }
    lua_replace(L, 2);
    lua_settop(L, 2);
    const lua::Options all(L, 2, {call.name, call.example, system_options});
    return old.named ? push_bodies(L, all) : push_body(L, all);
}

engine::Drive asked_drive(lua_State* L, const lua::Options& options, const model::Assembly& system) {
    engine::Drive drive;
    const std::size_t n = system.bodies.size();
    drive.loads.resize(n), drive.belts.resize(system.joints.size());
    drive.theta0.assign(n, 0), drive.velocity0.assign(n, 0);
    const auto part = [&](const char* option, std::size_t joint) {
        return system.named ? fmt::format("{}.{}", option, system.joints[joint].name) : std::string(option);
    };
    const auto named = [&](const char* option, std::size_t joint) {
        return fmt::format("{}: {}", options.call(), part(option, joint));
    };
    for_each_named(L, options, "M", system, Names::bodies,
                   [&](std::size_t i) { drive.loads[i] = to_excitation(L, -1, named("M", i), "M"); });
    for_each_named(L, options, "belt", system, Names::both, [&](std::size_t j) {
        drive.belts[j] = to_excitation(L, -1, named("belt", j), "belt");
        if (drive.belts[j].has_feedback() || model::has_memory(drive.belts[j])) {
            options.fail("belt", "belt must be a number, an excitation or a function of t alone");
        }
    });
    for (const auto& [option, values] :
         {std::pair("theta0", &drive.theta0), std::pair("velocity0", &drive.velocity0)}) {
        for_each_named(L, options, option, system, Names::bodies, [&, name = option, to = values](std::size_t i) {
            if (lua_type(L, -1) != LUA_TNUMBER || !std::isfinite(lua_tonumber(L, -1))) {
                options.fail(name,
                             fmt::format("{} must be a finite number, got {}", part(name, i), lua::describe(L, -1)));
            }
            (*to)[i] = lua_tonumber(L, -1);
        });
    }
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        const model::Joint& joint = system.joints[j];
        if (!joint.walls) continue;
        const double angle = drive.theta0[static_cast<std::size_t>(joint.first)] -
                             (joint.second < 0 ? 0 : drive.theta0[static_cast<std::size_t>(joint.second)]);
        if (auto wrong = joint.walls->crossed_by(angle)) {
            if (system.is_link(j)) {
                wrong->sentence =
                    fmt::format("theta0: the angle {:.6g} of the link {} is beyond its walls from {:.6g} to {:.6g}",
                                angle, joint.name, joint.walls->lower, joint.walls->upper);
            } else if (system.named) {
                wrong->sentence = fmt::format("theta0.{}{}", joint.name, wrong->sentence.substr(sizeof "theta0" - 1));
            }
            options.fail(*wrong);
        }
    }
    drive.base = read_motion(L, options, "base");
    drive.states = read_states(L, options);
    drive.events = read_events(L, options);
    for (std::size_t i = 0; i < n; ++i)
        check_relays(options, drive.loads[i], names_for_relays(system, drive), part("M", i));
    return drive;
}

void name_functions(lua::CallState& call, const model::Assembly& system, const engine::Drive& drive) {
    if (system.named) call.name_bodies(body_names(system));
    std::vector<std::string> names;
    for (const model::OwnState& state : drive.states) names.push_back(state.name);
    if (!names.empty()) call.name_states(names);
}

namespace {

/// Whether it is known between the rows. A run that ended where it began has no stretch that takes memory.
bool keeps_motion(const engine::AssemblyRun& run) {
    return run.history != nullptr && (run.history->bytes() > 0 || run.t_stop == run.t_start);
}

/// The joint as a system of one body; none where the motion between the rows is not known.
std::optional<model::Oscillator> seen_alone(const BodiesRun& run, std::size_t joint) {
    if (!keeps_motion(run.run)) return {};
    const auto made = model::Oscillator::make(alone(*run.system, joint));
    return made ? std::optional(made.value()) : std::nullopt;
}

/// The run of all bodies: all columns and events, but no motion between the rows, which is that of its parts.
motion::Trajectory trajectory_of(const BodiesRun& run) {
    motion::Trajectory all = engine::part_of(*run.system, run.drive, run.run, 0, {});
    if (all.rough) all.rough->other_integrators = false;
    all.own_names = engine::column_names_of(*run.system, run.drive);
    all.rows = motion::Rows(run.run.table);
    std::vector<model::Event> events;
    std::copy_if(run.run.events.begin(), run.run.events.end(), std::back_inserter(events),
                 [](const model::Event& e) { return e.user < 0 || e.where == 0; });  // those of the user once
    all.events = motion::Growing<model::Event>(std::move(events));
    return all;
}

/// As seen from this body or link, or from all of them.
std::shared_ptr<Run> seen_from(const BodiesRunHandle& run, std::optional<std::size_t> joint) {
    auto seen = std::make_shared<Run>();
    seen->trajectory =
        joint ? engine::part_with_rows(*run->system, run->drive, run->run, *joint, seen_alone(*run, *joint))
              : trajectory_of(*run);
    seen->whole = run, seen->joint = joint;
    seen->units = run->system->units;
    return seen;
}

}  // namespace

model::OscillatorParameters parameters_of(const model::Assembly& system, std::size_t joint) {
    const model::Joint& own = system.joints[joint];
    model::OscillatorParameters parameters;
    parameters.inertia = system.bodies[static_cast<std::size_t>(own.first)].inertia;
    parameters.stiffness = own.stiffness, parameters.damping = own.damping, parameters.units = system.units;
    return parameters;
}

RunHandle part_of(const BodiesRunHandle& run, std::size_t joint) {
    run->parts.resize(run->system->joints.size());
    if (RunHandle known = run->parts[joint].lock()) return known;
    auto made = seen_from(run, joint);
    run->parts[joint] = made;
    return made;
}

std::size_t joint_named(lua_State* L, std::string_view name, const model::Assembly& system, const char* what,
                        const lua::Class& of) {
    std::vector<std::string> own;
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        if (system.joints[j].name == name) return j;
        own.push_back(system.joints[j].name);
    }
    raise_unknown_name(L, fmt::format("{} has no '{}'; its bodies and links are {}", what, name, fmt::join(own, ", ")),
                       name, own, of);
}

void push_bodies_run(lua_State* L, BodiesRunHandle run) {
    lua::note_external_memory(L, run->run.table.own_bytes());
    push_run(L, seen_from(run, run->system->named ? std::nullopt : std::optional<std::size_t>(0)));
}

namespace {

std::size_t columns_of_run(const BodiesRun& run) {
    return engine::column_names_of(*run.system, run.drive).size();
}

/// The rows in this window, of which memory can hold all.
motion::Grid grid_within(const lua::Options& options, const BodiesRun& run, const motion::Grid& rows,
                         const motion::Window& window, const motion::Limits& limits) {
    motion::Grid grid = options.value_or_fail(rows.within(window));
    if (auto wrong = motion::wrong_rows(grid, columns_of_run(run), limits)) options.fail(*wrong);
    return grid;
}

/// How the integrator cuts the run into stretches.
engine::Cut cut_of(const motion::Integrator& integrator) {
    if (const auto* rk4 = std::get_if<motion::Rk4>(&integrator)) return {.longest = rk4->h, .step = rk4->h};
    const auto* spectral = std::get_if<motion::Spectral>(&integrator);
    return {.tolerance = spectral->tolerance, .longest = std::min(spectral->max_panel, spectral->widest_looks())};
}

/// The integrator asked for, which suits each mode of the bodies. Contacts that hold make none of them faster.
motion::Integrator asked_integrator(const lua::Options& options, const model::Assembly& system,
                                    const engine::Drive& drive, const motion::Window& window) {
    const auto* asked = options.object<motion::Integrator>("integrator");
    if (asked == nullptr) return motion::Spectral{};
    const motion::MethodView method = *asked;
    if (!method.knows_more()) {
        options.fail("integrator",
                     fmt::format("{} is for one body with constant friction: use integrator.spectral or rk4",
                                 method.about().call.name));
    }
    for (const model::Oscillator& mode : engine::modes_of(system)) {
        for (const model::Excitation& load : drive.loads) {
            if (const auto wrong = motion::wrong_method(method, mode, load, window)) options.fail(*wrong);
        }
    }
    return *asked;
}

/// Runs what `problem` says, under the limits of the script.
int run_bodies(lua_State* L, const lua::Options& options, const std::shared_ptr<BodiesRun>& run,
               const motion::Window& window, const motion::Grid& rows, const motion::Limits& limits,
               std::shared_ptr<const engine::Carry> before = {}) {
    const motion::Grid grid = grid_within(options, *run, rows, window, limits);
    model::Excitation all;
    for (const model::Excitation& load : run->drive.loads) all = all + load;
    const auto note = watched_memories(L, options, all, before != nullptr);
    lua::CallState call(L);
    name_functions(call, *run->system, run->drive);
    call.set_span(window.end - window.start);
    terminal::Progress progress = terminal::Progress::of_time(window.start, window.end);
    const motion::Monitor monitor = [&progress](double t) {
        progress.advance(t);
        return !lua::interrupt_requested();
    };
    const engine::Cut cut = cut_of(run->integrator);
    run->run = engine::run({.system = *run->system,
                            .drive = run->drive,
                            .window = window,
                            .rows = grid,
                            .monitor = monitor,
                            .limits = limits,
                            .before = std::move(before),
                            .tolerance = cut.tolerance,
                            .longest = cut.longest,
                            .step = cut.step,
                            .keeps_torques = true});
    if (call.failed() && lua::interrupt_requested()) run->run.outcome = model::Outcome::interrupted;
    if (sees_all(*run->system, run->drive, run->run.located)) run->run.gap = 0;
    const bool interrupted = run->run.outcome == model::Outcome::interrupted;
    push_bodies_run(L, run);
    note(run.get());
    if (call.failed() || interrupted) {
        set_partial(L);
        call.failed() ? call.raise_error() : lua::raise_interrupted(L);
    }
    return 1;
}

int simulate_bodies(lua_State* L) {
    const AssemblyHandle system = lua::self<AssemblyHandle>(L, 1, bodies_simulate_call.example);
    const lua::Options options(L, 2, bodies_simulate_call);
    RunOptions asked;
    options.fill(asked);
    if (!asked.t_end && asked.times.empty()) options.missing("t_end");
    auto run = std::make_shared<BodiesRun>();
    run->system = system;
    run->drive = asked_drive(L, options, *system);
    const motion::Window window{asked.t_start,
                                asked.t_end ? *asked.t_end : *std::max_element(asked.times.begin(), asked.times.end())};
    if (const auto wrong = window.complaint()) options.fail(*wrong);
    run->integrator = asked_integrator(options, *system, run->drive, window);
    run->dt = asked.dt.value_or(usual_dt(window, system->shortest_natural_period()));
    run->t_end = window.end, run->spaced = !options.has("times");
    run->set_up = source::set_up_lines(L, *system, run->drive);  // before the functions change what they refer to
    const motion::Grid grid = run->spaced ? motion::Grid::every(run->dt) : motion::Grid::at(asked.times);
    return run_bodies(L, options, run, window, grid, limits_of_run(asked.dense));
}

// ---- rig

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
    push_options(L, *rig, 0);
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
    lua::push(L, lua::value_or_raise(L, "rig", model::Oscillator::make(alone(*rig, 0))));
    lua_call(L, 1, 1);
    return 1;
}

std::string rig_text(lua_State* L, const AssemblyHandle& rig) {
    return source::lua_text(L, *rig);
}

// ---- a run that goes on

}  // namespace

int continue_bodies(lua_State* L, const lua::Options& options, const BodiesRunHandle& first, const MoreTime& asked) {
    if (asked.times) options.fail("times", "this run goes on with a row every dt; times are for other runs");
    const double from = first->run.t_stop;
    const double end = asked_end(options, asked, from, first->t_end);
    if (!(end > from)) {
        options.fail("t_end", fmt::format("t_end = {} must be after t = {}, where the run ended", end, from));
    }
    auto run = std::make_shared<BodiesRun>();
    run->system = first->system, run->drive = first->drive, run->dt = first->dt;
    run->t_end = end, run->spaced = first->spaced, run->set_up = first->set_up;
    run->integrator = first->integrator;
    // The last row of the first run stands in the second one only where the spacing puts it there.
    const motion::Limits limits = limits_of_run(keeps_motion(first->run));
    const double start = first->run.t_start;
    const motion::Grid grid = grid_within(options, *run, motion::Grid::every(run->dt), {start, end}, limits);
    std::vector<double> times;
    for (auto row = static_cast<std::size_t>((from - start) / run->dt * (1 - 1e-12)); row < grid.count(); ++row) {
        if (grid.time(row) > from + 1e-15 * std::fabs(from)) times.push_back(grid.time(row));
    }
    run_bodies(L, options, run, {from, end}, motion::Grid::at(std::move(times)), limits, first->run.carry);
    std::size_t kept = first->run.table.size();
    const double last = kept == 0 ? start : first->run.table(kept - 1, 0);
    const double nearest = start + std::round((last - start) / run->dt) * run->dt;
    if (kept > 0 && std::fabs(last - nearest) > 1e-12 * std::max(1.0, std::fabs(last))) --kept;
    run->run.table =
        first->run.table.followed_by(kept, run->run.table, limits.memory / (columns_of_run(*run) * sizeof(double)));
    run->run.events.insert(run->run.events.begin(), first->run.events.begin(), first->run.events.end());
    run->run.t_start = start;
    lua_pop(L, 1);  // it was made of the second part
    push_bodies_run(L, run);
    return 1;
}

namespace {

#define DINAL_RIG                                                                 \
    "rig = system{ bodies = { motor = { I = 1 }, load = { I = 3, Rd = 0.2 } },\n" \
    "    links = { clutch = { \"motor\", \"load\", Rd = 2 } } }\n"

constexpr lua::Member rig_members[] = {
    {lua::a_method<simulate_bodies>,
     {"rig:simulate{ OPTIONS } -> rig_run",
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

void register_bodies(lua_State* L) {
    lua::add_class<AssemblyHandle>(L, rig_class);
}

}  // namespace dinal::api
