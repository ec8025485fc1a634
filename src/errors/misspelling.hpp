// Names that were probably meant, for errors caused by a nil.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"
#include "lua/lua_message.hpp"
#include "text/expected.hpp"

namespace dinal::errors {

/// A hint for an error.
struct Advice {
    std::string end_of_sentence;  ///< "; did you mean 'system'?", or ""
    std::string culprit = {};     ///< the cause found: "; 'tend' is nil"
};

/// Returns the hint for an error. `frame` is the function of the error, or nullptr; `statement` is its text as far as
/// known.
Advice help_with(lua_State* L, lua_Debug* frame, const text::Error& error, std::string_view statement);
Advice help_with(lua_State* L, lua_Debug* frame, const lua::LuaMessage& message, std::string_view statement);

/// Pushes the value of a variable in the frame: a local one (the innermost of that name), an upvalue, or a global.
void push_variable(lua_State* L, lua_Debug* frame, std::string_view wanted);

/// Replaces a value and a key on the top by the field, also of __index tables; nil without one. Runs no user code.
void go_to_field(lua_State* L);

/// The end of a sentence with similar global names.
std::string similar_global(lua_State* L, std::string_view name);

/// The names that may follow a variable and a dot: raw keys, keys of __index tables, and members, for the value on the
/// top of the stack. Runs no user code.
std::vector<std::string> member_names(lua_State* L);

/// "'theta_0' is nil, so theta0 is not given": for an undefined global, or a field, that is the whole value of an
/// option in the text. A field counts only if another one has a similar name, as it may be missing on purpose. With
/// `assignments` also "'rk4' is nil; did you mean 'integrator.rk4'?" for x = rk4, if there is a hint.
std::string nil_value(lua_State* L, lua_Debug* frame, std::string_view text, bool assignments);

// Methods called as functions, and missing elements: max(v) for v:max(), and the length of a list.

/// The method of an argument that was called as a function: "; did you mean 'run.theta:max()'?", or "". Call while the
/// call is still on the stack.
std::string meant_method(lua_State* L, const lua::LuaMessage& message, std::string_view statement);

/// For an index beyond a list: "; 'run.events' has 6 elements, and n is 7", and the word to be marked.
Advice missing_element(lua_State* L, lua_Debug* frame, const lua::LuaMessage& message, std::string_view statement);

}  // namespace dinal::errors
