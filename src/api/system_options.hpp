// What system{...}, nondimensional{...} and sys:with{...} share.
#pragma once

#include <initializer_list>
#include <optional>

#include "lua/options.hpp"
#include "model/oscillator.hpp"

namespace dinal::api {

/// Pushes the system, or raises what is wrong with it.
int push_system(lua_State* L, const lua::Options& options, const model::OscillatorParameters& parameters);

/// The law that the option `friction` names, which excludes the options that are Coulomb's. One with a state of its own
/// is refused unless it may be one.
std::optional<model::Friction> asked_law(lua_State* L, const lua::Options& options,
                                         std::initializer_list<const char*> instead_of, bool may_have_state = false);

/// What the option `spring` says; none when it is absent.
std::optional<model::Spring> asked_spring(lua_State* L, const lua::Options& options);

/// What an option says that is a table of options; none when it is absent.
template <class T>
std::optional<T> asked_table(lua_State* L, const lua::Options& options, const char* name, const text::Call& call) {
    if (!options.has(name)) return {};
    options.push(name);
    if (!lua_istable(L, -1)) options.wrong(name);
    auto read = lua::read<T>(L, lua_gettop(L), call);
    lua_pop(L, 1);
    return read;
}

/// What the option `walls` says; none when it is absent, or an empty table.
std::optional<model::Walls> asked_walls(lua_State* L, const lua::Options& options);

inline constexpr text::Option law_option[] = {
    {.name = "friction",
     .meaning = "another law of friction, for example friction.stribeck",
     .object = "friction",
     .wanted = "a law such as friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 }"},
};

/// What sys:with changes.
struct SystemChanges {
    std::optional<double> inertia = {}, stiffness = {}, damping = {}, kinetic = {}, breakaway = {};
};
inline constexpr text::Option number_changes[] = {
    {"I", "torque time^2 per rad", text::its_own, text::positive, "moment of inertia",
     text::fills<&SystemChanges::inertia>},
    {"k", "torque per rad", text::its_own, text::not_negative, "stiffness of the spring",
     text::fills<&SystemChanges::stiffness>},
    {"C", "torque time per rad", text::its_own, text::not_negative, "viscous damping",
     text::fills<&SystemChanges::damping>},
    {"Rd", "torque", text::its_own, text::not_negative,
     "dry friction while sliding; Re changes with it if the two were equal", text::fills<&SystemChanges::kinetic>},
    {"Re", "torque", text::its_own, text::not_negative, "breakaway torque, at least Rd",
     text::fills<&SystemChanges::breakaway>},
};
inline constexpr text::Option spring_change[] = {
    {.name = "spring",
     .unit = "torque",
     .meaning = "another spring in addition to k theta; spring.polynomial{} removes it",
     .object = "spring",
     .wanted = "a function of theta, or a spring such as spring.polynomial{ [3] = 0.5 }"},
    {.name = "walls",
     .unit = "rad",
     .meaning = "other end stops; {} removes them",
     .wanted = "a table such as { lower = -0.8, upper = 0.8, restitution = 0.7 }",
     .fields = {&model::walls_call}},
};
inline constexpr auto change_options = text::joined(number_changes, law_option, spring_change, model::units_option);
inline constexpr text::Call with_call{"sys:with", "sys:with{ Rd = 1 }", change_options};

/// sys:with{ OPTIONS }.
int system_with(lua_State* L);

}  // namespace dinal::api
