// Systems of several bodies, and of one whose friction depends on more than its speed, as Lua sees them.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "api/bind_simulate.hpp"
#include "api/drive_options.hpp"
#include "api/run.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "model/assembly.hpp"
#include "motion/engine/run.hpp"

namespace dinal::api {

using model::AssemblyHandle;

/// What the options Rd, Re, friction and normal say.
model::ContactFriction asked_friction(lua_State* L, const lua::Options& options, const std::string& call);

inline constexpr const char* by_body_wanted = "a table by body, such as { load = 1 }";
/// What drives a run, and from where it starts.
inline constexpr text::Option bodies_drive_rows[] = {
    {.name = "M",
     .unit = "torque",
     .otherwise = "0",
     .meaning =
         "the excitations by body: { load = M }, each a number, an excitation or a function of t, or of t, theta, "
         "velocity, z, where theta.load and velocity.load are those of a body",
     .object = "excitation",
     .wanted = by_body_wanted},
    {.name = "theta0",
     .unit = "rad",
     .otherwise = "0",
     .meaning = "initial angles: { load = 0.1 }",
     .wanted = by_body_wanted},
    {.name = "velocity0",
     .unit = "rad per time unit",
     .otherwise = "0",
     .meaning = "initial velocities",
     .wanted = by_body_wanted},
    {.name = "belt",
     .unit = "rad per time unit",
     .otherwise = "0",
     .meaning = "velocities of the surface under a body or link, by name: numbers, functions of t or excitations",
     .wanted = by_body_wanted},
    more_drive_options[3],
    {.name = "states",
     .meaning =
         "variables that are integrated with the motion: { NAME = { start = 0, rate = function(t, theta, velocity, "
         "z) ... end } }",
     .wanted =
         "a table such as { e = { start = 0, rate = function(t, theta, velocity, z) return 1 - theta.load end } }",
     .fields = {&state_call, text::Fields::Place::by_name}},
    {.name = "events",
     .meaning =
         "events to locate: a list of { when = function(t, theta, velocity, z), ... }; act may assign to theta.NAME, "
         "velocity.NAME and z.NAME",
     .wanted = "a list such as { { when = function(t, theta) return theta.load - 1 end, name = \"limit\" } }",
     .fields = {&event_call, text::Fields::Place::listed}},
};
inline constexpr text::Option rig_integrator_option[] = {
    {.name = "integrator",
     .otherwise = "spectral",
     .meaning = "the method: integrator.spectral or integrator.rk4; exact and dinal1989 are for one body with constant "
                "friction",
     .object = "integrator",
     .wanted = "an integrator such as integrator.rk4{ h = 0.001 }"},
};
inline constexpr auto bodies_simulate_options =
    text::joined(bodies_drive_rows, window_options, rig_integrator_option, dense_option);
inline constexpr text::Call bodies_simulate_call{"rig:simulate", "rig:simulate{ M = { load = 2 }, t_end = 20 }",
                                                 bodies_simulate_options};
int simulate_bodies(lua_State* L);

/// Calls f with the joint of each name in the table of this option, the value on the top of the stack.
enum class Names { bodies, links, both };
void for_each_named(lua_State* L, const lua::Options& options, const char* option, const model::Assembly& system,
                    Names which, const std::function<void(std::size_t)>& f);
/// Those of the call, by the names of the bodies.
model::Drive asked_drive(lua_State* L, const lua::Options& options, const model::Assembly& system);
/// The same from rest at 0.
model::Drive asked_acting(lua_State* L, const lua::Options& options, const model::Assembly& system);
std::vector<std::string> names_of_states(const model::Drive& drive);
/// What users' functions get as theta, velocity and z.
void name_functions(lua::CallState& call, const model::Assembly& system, const model::Drive& drive);

/// A run of several bodies.
struct BodiesRun {
    AssemblyHandle system;
    model::Drive drive;
    motion::engine::AssemblyRun run;
    double dt = 0;
    double t_end = 0;    ///< that was asked for
    bool spaced = true;  ///< a row every dt, not at times of the user
    motion::Integrator integrator = motion::Spectral{};
    std::string readings = {};             ///< which functions were read as formulas: sentences
    std::vector<std::string> set_up = {};  ///< Lua text that makes all that was run, as it was at the start
    // Of each joint, made when it is asked for. Not kept: they keep this run.
    mutable std::vector<std::weak_ptr<const Run>> parts = {};
};
using BodiesRunHandle = std::shared_ptr<const BodiesRun>;
std::vector<std::string> body_names(const model::Assembly& system);
/// Pushes the table of options that makes the body or link.
void push_joint(lua_State* L, const model::Assembly& system, std::size_t joint);
/// As of one mass on the ground, with the linear spring and damping of the joint alone.
model::OscillatorParameters parameters_of(const model::Assembly& system, std::size_t joint);
/// The run as seen from the body or link of this joint.
RunHandle part_of(const BodiesRunHandle& run, std::size_t joint);
/// Goes on with a run that is not one of an Oscillator.
int continue_bodies(lua_State* L, const lua::Options& options, const BodiesRunHandle& first, const MoreTime& asked);
/// Pushes it; of one body without a name as seen from that.
void push_bodies_run(lua_State* L, const BodiesRunHandle& run);
/// The joint of this name; raises that `what`, which has these members, has none of that name.
std::size_t joint_named(lua_State* L, std::string_view name, const model::Assembly& system, const char* what,
                        const lua::Class& of);

/// Whether a pulse of a function can only hide where the engine says so: all were read as formulas, whose changes were
/// `located` if they depend on the motion.
[[nodiscard]] bool sees_all(const model::Assembly& system, const model::Drive& drive, bool located);

/// Sentences that say of each function of M, belt and base how it was evaluated; `native`: M as a sum of native terms.
[[nodiscard]] std::string readings_of(const model::Assembly& system, const model::Drive& drive, bool located,
                                      bool native);

/// Pushes the body or link as a system of its own.
int push_alone(lua_State* L, std::string_view call, const model::Assembly& system, std::size_t joint);
/// Pushes the system of one body of these options, or that of the options `bodies` and `links`.
int push_body(lua_State* L, const lua::Options& options);
int push_bodies(lua_State* L, const lua::Options& options);

}  // namespace dinal::api
