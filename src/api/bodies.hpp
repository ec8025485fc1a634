// Systems of several bodies, and of one whose friction depends on more than its speed, as Lua sees them.
#pragma once

#include "lua/options.hpp"
#include "model/assembly.hpp"

namespace dinal::api {

using model::AssemblyHandle;

/// A number, an excitation or a function, where a system of one body takes a number.
inline constexpr const char* varying_wanted = "a number, an excitation or a function of t, theta, velocity, z";
inline constexpr text::Option friction_options[] = {
    {.name = "Rd",
     .unit = "torque",
     .otherwise = "0",
     .meaning = "dry friction while moving: a number, an excitation or a function of t, theta, velocity, z",
     .object = "excitation",
     .wanted = varying_wanted},
    {.name = "Re",
     .unit = "torque",
     .otherwise = "Rd",
     .meaning = "what sticking can hold: a number, at least Rd, an excitation or a function of t, theta, velocity, z",
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

/// What the options Rd, Re, friction and normal say.
model::ContactFriction asked_friction(lua_State* L, const lua::Options& options, const std::string& call);

/// Pushes the system of the options `bodies` and `links`.
int push_bodies(lua_State* L, const lua::Options& options);
/// Pushes a system of one body.
int push_varying_body(lua_State* L, model::Assembly assembly);

}  // namespace dinal::api
