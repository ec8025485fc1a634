// Systems, excitations and integrators as Lua text that constructs them.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"
#include "model/excitation.hpp"
#include "model/oscillator.hpp"
#include "model/system.hpp"
#include "motion/method.hpp"

namespace dinal::lua {
class LuaFunction;
}

namespace dinal::source {

class ValueText;

/// The function if the excitation is nothing else, otherwise nullptr.
const lua::LuaFunction* function_alone(const model::Excitation& excitation);

/// Lua text that constructs the excitation: "0.5 * excitation.pulse{ amplitude = 1, at = 1.5, width = 0.2 }". A comment
/// replaces parts that cannot be written (a long table, a function without source). `whole` includes the upvalues of
/// functions, and complete tables.
std::string describe(lua_State* L, const model::Excitation& excitation, ValueText* whole = nullptr);

/// "system{ I = 1, k = 39.5, C = 1.5, Rd = 2, Re = 3 }" or "system{ bodies = { a = { I = 1, k = 4 } } }" constructs the
/// system; options that are 0 are omitted. With `whole`, the functions of friction laws include their upvalues.
std::string lua_text(lua_State* L, const model::System& system, ValueText* whole = nullptr);

/// "friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 }".
std::string lua_text(lua_State* L, const model::Friction& law, ValueText* whole = nullptr);

/// "spring.polynomial{ [3] = 0.5 }", or a user's function.
std::string lua_text(lua_State* L, const model::Spring& spring, ValueText* whole = nullptr);

/// A user's function as text, or a comment that identifies it.
std::string function_text(lua_State* L, const model::UserFunction& function, ValueText* whole);

/// "integrator.rk4{ h = 0.001 }": constructs the integrator.
std::string lua_text(motion::MethodView method);

}  // namespace dinal::source
