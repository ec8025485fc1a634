// The options of sys:simulate{...} for the drive: M, states, events, belt, base.
#pragma once

#include <string>
#include <vector>

#include "lua/options.hpp"
#include "model/drive.hpp"

namespace dinal::api {

inline constexpr text::Option state_options[] = {
    text::option<&model::OwnState::start>("start", "value at t_start"),
    {.name = "rate",
     .otherwise = text::needed,
     .meaning = "a function of t, theta, velocity, z",
     .wanted = "a function of t, theta, velocity, z"},
};
inline constexpr text::Call state_call{
    "states.e", "e = { start = 0, rate = function(t, theta, velocity, z) return 1 - theta end }", state_options};

inline constexpr const char* crossing_names[] = {"up", "down", "both"};
inline constexpr text::Option event_options[] = {
    {.name = "when",
     .otherwise = text::needed,
     .meaning = "a function of t, theta, velocity, z: the event is where it passes zero",
     .wanted = "a function of t, theta, velocity, z"},
    text::option<&model::WantedEvent::direction>("direction", "direction of the crossing", {.choices = crossing_names}),
    text::option<&model::WantedEvent::stop>("stop", "true ends the run there"),
    text::option<&model::WantedEvent::name>("name", "name in run.events"),
    {.name = "act",
     .meaning = "a function of t, theta, velocity, z that returns the new theta and velocity, and may assign to z",
     .wanted = "a function of t, theta, velocity, z"},
};
inline constexpr text::Call event_call{
    "events[1]", "{ when = function(t, theta, velocity, z) return theta - 1 end, name = \"limit\" }", event_options};

inline constexpr const char* by_body_wanted = "a table by body, such as { load = 1 }";
/// States defined by a user, and the motion of surfaces and support.
inline constexpr text::Option states_option[] = {
    {.name = "states",
     .meaning = "variables that are integrated with the motion: { NAME = { start = 0, rate = function(t, "
                "theta, velocity, z) ... end } }; z.NAME has their values, the fourth argument of M, rates "
                "and events",
     .wanted = "a table such as { e = { start = 0, rate = function(t, theta, velocity, z) return 1 - theta end } }",
     .fields = {&state_call, text::Fields::Place::by_name}},
};
inline constexpr text::Option moved_options[] = {
    {.name = "belt",
     .unit = "rad per time unit",
     .otherwise = "0",
     .meaning = "velocity of the surface under the mass, against which dry friction acts: a number, a "
                "function of t, or an excitation; of named bodies and links a table by name",
     .object = "excitation"},
    {.name = "base",
     .unit = "rad per time unit^2",
     .otherwise = "0",
     .meaning = "acceleration of the support, to which theta is relative: a number, a function of t, or an excitation",
     .object = "excitation"},
};
/// The drive of a system and its start; more_drive_options has the rest.
inline constexpr text::Option drive_options[] = {
    {.name = "M",
     .unit = "torque",
     .otherwise = "0",
     .meaning = "the excitation: a number, an excitation or a function of t, or of t, theta, velocity, z; of named "
                "bodies and links a table by name, { load = M }. A function then gets theta.load and velocity.load",
     .object = "excitation"},
    {.name = "theta0",
     .unit = "rad",
     .otherwise = "0",
     .meaning = "initial angle; of named bodies a table by name, { load = 0.1 }"},
    {.name = "velocity0",
     .unit = "rad per time unit",
     .otherwise = "0",
     .meaning = "initial velocity; of named bodies a table by name"},
};
inline constexpr text::Option events_option[] = {
    {.name = "events",
     .meaning = "events to locate: a list of { when = function(t, theta, velocity, z), direction = \"up\" "
                "or \"down\", stop = true, name = \"...\", act = function(t, theta, velocity, z) return "
                "theta, velocity end }, reported where `when` passes zero; act may also set a state: "
                "z.NAME = 0, and sets theta.NAME and velocity.NAME of named bodies",
     .wanted = "a list such as { { when = function(t, theta) return theta - 1 end, name = \"limit\" } }",
     .fields = {&event_call, text::Fields::Place::listed}},
};
inline constexpr auto more_drive_options = text::joined(states_option, events_option, moved_options);

std::vector<model::OwnState> read_states(lua_State* L, const lua::Options& options);
std::vector<model::WantedEvent> read_events(lua_State* L, const lua::Options& options);
/// Reads a function of time alone.
model::Excitation read_motion(lua_State* L, const lua::Options& options, const char* name);

/// Raises an error if a relay in M observes an unknown name. `M` is the user's name of the excitation.
void check_relays(const lua::Options& options, const model::Excitation& excitation, std::vector<std::string> known,
                  const std::string& M = "M");

/// Raises an error if the name in the option is not a Lua name, or is a member of runs.
void check_name(const lua::Options& options, const char* option, const std::string& name, const lua::Class& of);

/// The names in the table on the top, sorted, since tables are unordered.
std::vector<std::string> names_in_table(lua_State* L, const lua::Options& options, const char* option);

/// Pushes the option, a function, and returns its index.
int push_function(lua_State* L, const lua::Options& options, const char* name);

/// Sets dinal.partial to the value on the top and pops it.
void set_partial(lua_State* L);

}  // namespace dinal::api
