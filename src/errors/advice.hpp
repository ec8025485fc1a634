// What was probably meant: names, for errors caused by a nil, and habits from other languages.
#pragma once

#include <optional>
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
Advice advice_on(lua_State* L, lua_Debug* frame, const text::Error& error, std::string_view statement);
Advice advice_on(lua_State* L, lua_Debug* frame, const lua::LuaMessage& message, std::string_view statement);

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

// Habits from other languages and decimal commas, with the Lua equivalents.

/// The end of a sentence about a chunk that does not compile, "; comparing is ==", or "". `statement` contains the
/// error.
std::string syntax_habit(lua_State* L, const lua::SyntaxMessage& message, std::string_view statement);

/// The situations in which words and signs of other languages are looked for: a chunk that does not compile (`first`;
/// `last` if nothing else explains the error; `between` two expressions); a run-time error (`running`; around a number,
/// a name or a function of safe mode at fault); a message of Lua (`said`); an unknown name, or one typed at the prompt;
/// an unfinished or a complete input that compiles.
enum class Seen { first, last, between, running, number, named, safe, said, unknown, typed, unfinished, complete };

/// The remark on such words and signs, whatever the message: v[1:3], f"{x}", lambda x, disp. If there is a culprit, it
/// must be one of them.
std::string foreign_tokens(std::string_view statement, Seen seen, std::optional<std::string_view> culprit = {});

/// The remark on a run-time error.
std::string running_habit(const text::Error& error, std::string_view statement);
std::string running_habit(lua_State* L, const lua::LuaMessage& message, std::string_view statement);

}  // namespace dinal::errors
