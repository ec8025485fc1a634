// Options shared by system{...}, nondimensional{...} and sys:with{...}.
#pragma once

#include <initializer_list>
#include <optional>

#include "lua/options.hpp"
#include "model/oscillator.hpp"

namespace dinal::api {

/// The law in the option `friction`, which excludes the options of Coulomb's law. A law with internal state is refused
/// unless `may_have_state`.
std::optional<model::Friction> asked_law(lua_State* L, const lua::Options& options,
                                         std::initializer_list<const char*> instead_of, bool may_have_state = false);

/// The spring in the option `spring`; none if absent.
std::optional<model::Spring> asked_spring(lua_State* L, const lua::Options& options);

/// An option that is a table of options; none if absent.
template <class T>
std::optional<T> asked_table(lua_State* L, const lua::Options& options, const char* name, const text::Call& call) {
    if (!options.has(name)) return {};
    options.push(name);
    if (!lua_istable(L, -1)) options.wrong(name);
    auto read = lua::read<T>(L, lua_gettop(L), call);
    lua_pop(L, 1);
    return read;
}

/// The walls in the option `walls`; none if absent or an empty table.
std::optional<model::Walls> asked_walls(lua_State* L, const lua::Options& options);

inline constexpr text::Option law_option[] = {
    {.name = "friction",
     .meaning = "another law of friction, for example friction.stribeck",
     .object = "friction",
     .wanted = "a law such as friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 }"},
};

/// The kinds of values accepted for variable friction.
inline constexpr const char* varying_wanted = "a number, an excitation or a function of t, theta, velocity, z";
inline constexpr text::Option friction_options[] = {
    {.name = "Rd",
     .unit = "torque",
     .otherwise = "0",
     .range = text::not_negative,
     .meaning = "dry friction while sliding: a number, an excitation or a function of t, theta, velocity, z",
     .object = "excitation",
     .wanted = varying_wanted},
    {.name = "Re",
     .unit = "torque",
     .otherwise = "Rd",
     .range = text::not_negative,
     .meaning = "breakaway torque: a number, at least Rd, an excitation or a function of t, theta, velocity, z",
     .object = "excitation",
     .wanted = varying_wanted},
    {.name = "friction",
     .meaning = "another law of friction, instead of Rd and Re: a law, or a function of speed, t, theta, velocity, z",
     .object = "friction",
     .wanted = "a law such as friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 }, or a function of speed, t, theta, "
               "velocity, z"},
    {.name = "normal",
     .otherwise = "1",
     .meaning = "normal load, a factor of the torques of friction: a number, an excitation or a function "
                "of t, theta, velocity, z; a negative one counts as 0",
     .object = "excitation",
     .wanted = varying_wanted},
};

inline constexpr text::Option body_numbers[] = {
    {"I", "torque time^2 per rad", text::its_own, text::positive, "moment of inertia; needed unless bodies is given",
     text::fills<&model::OscillatorParameters::inertia>},
    model::mechanical_options[1],
    model::mechanical_options[2],
};
inline constexpr text::Option spring_and_walls[] = {model::mechanical_options[6], model::mechanical_options[7]};
inline constexpr text::Option inertia_option[] = {
    {"I", "torque time^2 per rad", text::its_own, text::positive,
     "moment of inertia; needed unless the body is moved by theta or velocity",
     text::fills<&model::OscillatorParameters::inertia>},
};
inline constexpr text::Option moved_body_options[] = {
    {.name = "theta",
     .unit = "rad",
     .meaning = "moves the body to these angles: a number, an excitation or a function of t; the column torque is what "
                "that takes",
     .object = "excitation",
     .wanted = "a number, an excitation or a function of t"},
    {.name = "velocity",
     .unit = "rad per time unit",
     .meaning = "moves the body at this velocity, from theta0 on: a number, an excitation or a function of t",
     .object = "excitation",
     .wanted = "a number, an excitation or a function of t"},
};
inline constexpr text::Option joint_options[] = {
    {"k", "torque per rad", text::its_own, text::not_negative, "stiffness of the spring",
     text::fills<&model::OscillatorParameters::stiffness>},
    model::mechanical_options[2],
    model::mechanical_options[6],
    model::mechanical_options[7],
};
inline constexpr auto body_options = text::joined(inertia_option, moved_body_options, joint_options, friction_options);
inline constexpr text::Option link_numbers[] = {
    {.name = "ratio",
     .otherwise = "1",
     .range = text::not_zero,
     .meaning =
         "of an ideal gear between two bodies: the angle is that of the first less ratio times that of the second",
     .wanted = "a number other than 0"},
    {.name = "rigid",
     .otherwise = "false",
     .meaning = "true: the link keeps the angle that it has at the start, and carries whatever torque that takes",
     .wanted = "true or false"},
};
inline constexpr auto link_options = text::joined(link_numbers, joint_options, friction_options);
inline constexpr text::Call body_call{"bodies", "{ I = 1, k = 4, Rd = 0.3 }", body_options};
inline constexpr text::Call link_call{"links", "{ \"motor\", \"load\", k = 90 }", link_options};
inline constexpr text::Option bodies_and_links[] = {
    {.name = "bodies",
     .meaning = "several bodies by name: { load = { I = 0.3, Rd = 0.4 }, ... }, each with the options of a "
                "system of one body, against the ground",
     .wanted = "a table of bodies by name, such as { motor = { I = 0.02 }, load = { I = 0.3, Rd = 0.4 } }",
     .fields = {&body_call, text::Fields::Place::by_name}},
    {.name = "links",
     .meaning = "connections between bodies: { shaft = { \"motor\", \"load\", k = 90 }, ... }, with "
                "the options of a body except I; the angle of a link is that of the first body minus ratio (1) times "
                "that of the second, or of { sun = 1, ring = 1.5, carrier = -2.5, ... } the weighted sum; with rigid = "
                "true the link keeps its angle: an ideal gear, or a coupling",
     .wanted = "a table of links by name, such as { shaft = { \"motor\", \"load\", k = 90, C = 0.01 } }",
     .fields = {&link_call, text::Fields::Place::by_name}},
};
inline constexpr auto system_options =
    text::joined(body_numbers, friction_options, spring_and_walls, bodies_and_links, model::units_option);

/// The rows for a change of a system, in which nothing is required or has a default.
constexpr auto none_needed(auto rows) {
    for (text::Option& row : rows) row.otherwise = text::its_own, row.filled.initial = nullptr;
    return rows;
}
inline constexpr auto change_options =
    none_needed(text::joined(body_numbers, friction_options, spring_and_walls, bodies_and_links, model::units_option));
inline constexpr text::Call with_call{"sys:with", "sys:with{ Rd = 1 }", change_options};

/// sys:with{ OPTIONS }.
int system_with(lua_State* L);

}  // namespace dinal::api
