// Systems of any bodies and links, and what drives them, as Lua writes them.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "api/bind_simulate.hpp"
#include "api/drive_options.hpp"
#include "api/run.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "model/system.hpp"
#include "motion/engine/run.hpp"

namespace dinal::api {

using model::SystemHandle;

/// What the options Rd, Re, friction and normal say.
model::ContactFriction asked_friction(lua_State* L, const lua::Options& options, const std::string& call);

/// Calls f with the joint of each name in the table of this option, the value on the top of the stack.
enum class Names { bodies, links, both };
void for_each_named(lua_State* L, const lua::Options& options, const char* option, const model::System& system,
                    Names which, const std::function<void(std::size_t)>& f);
/// Everything that the call says of what acts on the system, and from where it starts: by default from rest at 0.
model::Drive asked_drive(lua_State* L, const lua::Options& options, const model::System& system);
/// What users' functions get as theta, velocity and z.
void name_functions(lua::CallState& call, const model::System& system, const model::Drive& drive);

std::vector<std::string> body_names(const model::System& system);
/// Pushes the table of options that makes the body or link.
void push_joint(lua_State* L, const model::System& system, std::size_t joint);
/// The one body as an oscillator, with the formulas of it. Fails for named bodies, and where its friction varies.
text::Expected<model::Oscillator> oscillator_of(const model::System& system);
/// The joint of this name; raises that `what`, which has these members, has none of that name.
std::size_t joint_named(lua_State* L, std::string_view name, const model::System& system, const char* what,
                        const lua::Class& of);

/// Whether a pulse of a function can only hide where the engine says so: all were read as formulas, whose changes were
/// `located` if they depend on the motion.
[[nodiscard]] bool sees_all(const model::System& system, const model::Drive& drive, bool located);

/// Sentences that say of each function of M, belt and base how it was evaluated; `native`: M as a sum of native terms.
[[nodiscard]] std::string readings_of(const model::System& system, const model::Drive& drive, bool located,
                                      bool native);

/// A system with names has this field; others are of one body, and give way to a body or link of that name.
bool is_of_whole(std::string_view field);
/// Pushes the body or link as a system of its own.
int push_alone(lua_State* L, std::string_view call, const model::System& system, std::size_t joint);
/// Pushes the system of one body of these options, or that of the options `bodies` and `links`.
int push_body(lua_State* L, const lua::Options& options);
int push_bodies(lua_State* L, const lua::Options& options);

}  // namespace dinal::api
