// Systems of bodies and links, and their drives, as specified in Lua.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "api/bind_simulate.hpp"
#include "api/drive_options.hpp"
#include "api/lua_run.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "model/system.hpp"

namespace dinal::api {

using model::SystemHandle;

/// The friction given by the options Rd, Re, friction and normal.
model::ContactFriction asked_friction(lua_State* L, const lua::Options& options, const std::string& call);

enum class Names { bodies, links, both };
/// Calls f for each name in an option's table with its joint and the value on the top of the stack.
void for_each_named(lua_State* L, const lua::Options& options, const char* option, const model::System& system,
                    Names which, const std::function<void(std::size_t)>& f);
/// The drive given by a call, with its start; by default from rest at 0.
model::Drive asked_drive(lua_State* L, const lua::Options& options, const model::System& system);
/// Sets the names by which users' functions receive angles, velocities and states.
void name_functions(lua::CallState& call, const model::System& system, const model::Drive& drive);

std::vector<std::string> body_names(const model::System& system);
/// Pushes the table of options that constructs the body or link.
void push_joint(lua_State* L, const model::System& system, std::size_t joint);
/// The single body as an oscillator. Fails for named bodies, and if friction varies.
text::Expected<model::Oscillator> oscillator_of(const model::System& system);
/// The joint of this name. Raises an error that `what`, with these members, has no such name.
std::size_t joint_named(lua_State* L, std::string_view name, const model::System& system, const char* what,
                        const lua::Class& of);

/// Returns whether all functions were read as formulas, so that only pulses reported by the engine may be missed.
/// `located`: conditions on the motion were located.
[[nodiscard]] bool reads_all_functions(const model::System& system, const model::Drive& drive, bool located);

/// Sentences on the evaluation of each function in M, belt and base. `native`: M was replaced by a sum of native terms.
[[nodiscard]] std::string readings_of(const model::System& system, const model::Drive& drive, bool located,
                                      bool native);

/// Returns whether a system with names has this field itself; other fields give way to a body or link of that name.
bool is_of_whole(std::string_view field);
/// Pushes the body or link as a separate system.
int push_alone(lua_State* L, std::string_view call, const model::System& system, std::size_t joint);
/// Pushes the system given by these options: of one body, or with `bodies` and `links`.
int push_body(lua_State* L, const lua::Options& options);
int push_bodies(lua_State* L, const lua::Options& options);

}  // namespace dinal::api
