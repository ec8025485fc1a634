// friction.stribeck{...} etc.: friction laws as values, for `friction =` of a system.
#include <fmt/format.h>

#include <cmath>

#include "api/classes.hpp"
#include "api/system_options.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "lua/values.hpp"
#include "model/laws/bristle.hpp"
#include "model/laws/coulomb.hpp"
#include "model/laws/stribeck.hpp"
#include "model/laws/tabulated.hpp"
#include "model/laws/user_law.hpp"
#include "source/describe.hpp"

namespace dinal::api {

namespace {

namespace laws = model::laws;

int push_law(lua_State* L, const lua::Options& options, const model::Friction& law) {
    if (auto wrong = law.complaint()) {
        options.fail(*wrong);
    }
    lua::push<model::Friction>(L, law);
    return 1;
}

int coulomb_law(lua_State* L) {
    const lua::Options options(L, 1, laws::coulomb_call);
    laws::CoulombTorques torques;
    options.fill(torques);
    return push_law(L, options, torques.law());
}

/// Makes a law from its options alone.
template <class Law, const text::Call& call>
int law_of_options(lua_State* L) {
    const lua::Options options(L, 1, call);
    Law law;
    options.fill(law);
    if constexpr (&call == &laws::dahl_call) law.dahl = true;
    return push_law(L, options, law);
}

/// One direction of asymmetric friction: a table { Rd, Re }.
laws::Coulomb law_of_side(lua_State* L, const lua::Options& options, const char* name) {
    const std::string call = fmt::format("{}: {}", laws::asymmetric_call.name, name);
    const text::Call own{call.c_str(), "{ Rd = 0.3, Re = 0.4 }", laws::coulomb_options};
    const auto torques = asked_table<laws::CoulombTorques>(L, options, name, own);
    if (!torques) options.missing(name);
    return torques->law();
}

int asymmetric_law(lua_State* L) {
    const lua::Options options(L, 1, laws::asymmetric_call);
    const laws::Coulomb forward = law_of_side(L, options, "forward"), backward = law_of_side(L, options, "backward");
    return push_law(L, options, laws::AsymmetricCoulomb{.forward = forward, .backward = backward});
}

int law_of_function(lua_State* L) {
    if (!lua::is_callable(L, 1)) {
        lua::raise_got(L, 1, laws::user_law_call.name, "friction.law takes a function of the speed",
                       fmt::format(", for example {}", laws::user_law_call.example));
    }
    const lua::Options options(L, 2, laws::user_law_call);
    laws::UserLaw law;
    options.fill(law);
    law.function = std::make_shared<lua::LuaFunction>(L, 1,
                                                      lua::FunctionRole{.name = "friction",
                                                                        .argument = "speed",
                                                                        .may_be_negative = false,
                                                                        .motion = lua::FunctionRole::Motion::never});
    lua::CallState call(L);
    law.at_zero = law.function->value(0, {});
    call.check();
    return push_law(L, options, law);
}

double law_torque(lua_State* L, const model::Friction& law, double velocity) {
    lua::CallState call(L);
    const double torque =
        law.sliding(velocity < 0 ? model::Motion::backward : model::Motion::forward, std::fabs(velocity));
    call.check();
    return torque;
}

constexpr lua::Member friction_module_members[] = {
    {lua::a_function<coulomb_law>,
     {"friction.coulomb{ OPTIONS } -> law",
      "Coulomb's law: Rd while sliding at any speed, up to Re at rest. The same as system{ Rd, Re }.",
      "print(friction.coulomb{ Rd = 0.3 })  --> friction.coulomb{ Rd = 0.3, Re = 0.3 }",
      {&laws::coulomb_call}}},
    {lua::a_function<law_of_options<laws::Stribeck, laws::stribeck_call>>,
     {"friction.stribeck{ OPTIONS } -> law",
      "Friction that falls with the speed, as with a lubricant: Rd + (Re - Rd) exp(-(|velocity|/speed)^shape).",
      "law = friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 }\n"
      "print(law:torque(0), string.format(\"%.6f\", law:torque(0.1)))  --> 0.6\t0.410364",
      {&laws::stribeck_call}}},
    {lua::a_function<asymmetric_law>,
     {"friction.asymmetric{ OPTIONS } -> law",
      "Coulomb's law with different values in each direction. Re of a direction is the breakaway torque for a pull "
      "that way.",
      "law = friction.asymmetric{ forward = { Rd = 0.1 }, backward = { Rd = 0.3, Re = 0.5 } }\n"
      "print(law:torque(1), law:torque(-1))  --> 0.1\t0.3",
      {&laws::asymmetric_call}}},
    {lua::a_function<law_of_options<laws::Freewheel, laws::freewheel_call>>,
     {"friction.freewheel{ OPTIONS } -> law",
      "A one-way clutch: it turns forward (slip > 0) against Rd, and holds any torque backward. What would turn it "
      "backward at once, such as an impact, stops it.",
      "rig = system{ bodies = { motor = { I = 1 }, load = { I = 1 } },\n    links = { clutch = { \"load\", \"motor\", "
      "friction = friction.freewheel{} } } }\n"
      "run = rig:simulate{ M = { motor = 1 }, t_end = 2 }\nprint(run.load.velocity[#run])  --> 1.0",
      {&laws::freewheel_call}}},
    {lua::a_function<law_of_options<laws::Jenkins, laws::jenkins_call>>,
     {"friction.jenkins{ OPTIONS } -> law",
      "A spring in series with a dry slider: the torque is stiffness (x - s), at most Rd, relaxed at the start. Its "
      "slider has the events stick and slip; its spring counts as stored energy. Only system{ ... } takes it, also in "
      "a list of laws, which act side by side: Iwan's hysteresis.",
      "sys = system{ I = 1, k = 1, friction = { friction.jenkins{ stiffness = 9, Rd = 1 }, friction.coulomb{ Rd = 0.1 } "
      "} }\nprint(sys:simulate{ M = 2, t_end = 10 }.events.kind[1])  --> slip",
      {&laws::jenkins_call}}},
    {lua::a_function<law_of_options<laws::Tabulated, laws::tabulated_call>>,
     {"friction.table{ OPTIONS } -> law",
      "Measured friction: straight lines between torques at some speeds, the same in both directions.",
      "law = friction.table{ speed = { 0, 0.1, 1 }, torque = { 0.5, 0.3, 0.35 } }\n"
      "print(law:torque(0.05), law:torque(3), law.Re)  --> 0.4\t0.35\t0.5",
      {&laws::tabulated_call}}},
    {lua::a_function<law_of_options<laws::Bristle, laws::lugre_call>>,
     {"friction.lugre{ OPTIONS } -> law",
      "The LuGre law, bristles that bend before they slip: torque = stiffness z + damping z' + viscous v, z' = v - "
      "stiffness |v| z/g(v), g(v) = Rd + (Re - Rd) exp(-(v/speed)^2). It has no stick and slip events: a mass at "
      "rest creeps as far as its bristles bend. Only for system{...}.",
      "sys = system{ I = 1, k = 0, friction = friction.lugre{ Rd = 1, stiffness = 1e5, damping = 300 } }\n"
      "run = sys:simulate{ M = 0.5, t_end = 10 }\nprint(string.format(\"%.3g\", (run:at(10))))  --> 8.7e-06",
      {&laws::lugre_call}}},
    {lua::a_function<law_of_options<laws::Bristle, laws::dahl_call>>,
     {"friction.dahl{ OPTIONS } -> law",
      "Dahl's law, bristles without damping: torque' = stiffness (v - |v| torque/Rd). Only for system{...}.",
      "print(friction.dahl{ Rd = 1, stiffness = 100 })  --> friction.dahl{ Rd = 1, stiffness = 100 }",
      {&laws::dahl_call}}},
    {lua::a_function<law_of_function>,
     {"friction.law(function(speed), { OPTIONS }) -> law",
      "Friction as a Lua function of the speed (>= 0, rad per time unit), equal in both "
      "directions. It must not be negative; at speed 0 it may be lower than Re.",
      "law = friction.law(function(speed) return 0.3 + 0.1*speed end, { Re = 0.5 })\n"
      "print(law:torque(2), law.Re)  --> 0.5\t0.5",
      {&laws::user_law_call}}},
};

constexpr lua::Member friction_members[] = {
    {lua::a_typed_method<law_torque>,
     {"law:torque(velocity) -> number",
      "The friction torque at this velocity (rad per time unit); at 0 the limit from above.",
      "print(friction.coulomb{ Rd = 0.3, Re = 0.4 }:torque(-2))  --> 0.3"}},
    {lua::a_value<model::Friction, &model::Friction::greatest_holding>,
     {"law.Re -> number", "The breakaway torque; the greater one if the directions differ.",
      "print(friction.coulomb{ Rd = 0.3, Re = 0.4 }.Re)  --> 0.4"}},
    {lua::a_text<model::Friction, [](lua_State* L, const model::Friction& law) { return source::lua_text(L, law); }>,
     {"tostring(law) -> string", "The Lua text that recreates it.",
      "print(friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 })\n"
      "--> friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 }"}},
};

}  // namespace

const lua::Class friction_module = {
    "friction",
    {"friction.NAME{ ... } -> law",
     "Laws of dry friction, for `friction =` of system{...} and nondimensional{...}: the torque as a function of "
     "the speed, and the breakaway torque.",
     "sys = system{ I = 1, k = 4, friction = friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 } }\n"
     "print(sys.Re)  --> 0.6"},
    friction_module_members,
    lua::add_module};

const lua::Class friction_class = {"friction",
                                   {"friction.NAME{ ... } -> law", "A law of friction. It cannot be changed.",
                                    "print(friction.coulomb{ Rd = 0.3 }.Re)  --> 0.3"},
                                   friction_members,
                                   lua::add_class<model::Friction>};

}  // namespace dinal::api
