// Values, functions, systems, excitations and integrators as Lua text that constructs them, so that a file of results
// can state how to repeat the run.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lua/bind.hpp"
#include "lua/lua_headers.hpp"
#include "lua/lua_text.hpp"
#include "model/excitation.hpp"
#include "model/oscillator.hpp"
#include "model/system.hpp"
#include "motion/method.hpp"

namespace dinal::lua {
class LuaFunction;
}

namespace dinal::source {

/// Converts values to Lua expressions. Functions include their upvalues; globals that they use become separate lines.
class ValueText {
public:
    /// `most_values` limits the number of values; larger data belong in a file.
    explicit ValueText(lua_State* L, int most_values = 10'000) : L_(L), budget_(most_values) {}

    /// Returns a variable for a value that is transferred separately: a vector, a function of another language, an
    /// object without text; empty for others. Size is then unlimited.
    using Aside = std::function<std::string(int index)>;
    ValueText(lua_State* L, Aside aside) : L_(L), aside_(std::move(aside)), budget_(std::numeric_limits<int>::max()) {}

    /// An expression that constructs the value at `index`. If none exists, returns `nil` and adds to remarks().
    std::string expression(int index);

    /// The variable for the numbers, if vectors are transferred separately.
    std::optional<std::string> aside(const std::vector<double>& numbers);

    /// Lines such as "w = 3" that must precede the expressions.
    const std::vector<std::string>& globals() const { return globals_; }
    /// Comments on values that could not be written.
    const std::vector<std::string>& remarks() const { return remarks_; }

private:
    std::string table(int index);
    std::string function(int index);
    std::string object(int index);
    std::string with_locals(int index, const std::string& source);
    void note_globals(int function_index, std::string_view source);
    void note_global(int environment, const std::string& name);
    std::string nothing(std::string_view what);

    lua_State* L_;
    Aside aside_ = {};
    std::vector<std::string> globals_;
    std::vector<std::string> names_;  // globals finished or in progress
    std::vector<const void*> open_;   // tables and functions in progress: a cycle has no text
    std::vector<std::string> remarks_;
    int budget_;  // number of values that may still be written
};

/// Returns the function if the excitation is this function alone, otherwise nullptr.
const lua::LuaFunction* function_alone(const model::Excitation& excitation);

/// Lua text that constructs the excitation: "0.5 * excitation.pulse{ amplitude = 1, at = 1.5, width = 0.2 }". A comment
/// replaces parts that cannot be written (a long table, a function without source). `whole` includes the upvalues of
/// functions, and complete tables.
std::string lua_text(lua_State* L, const model::Excitation& excitation, ValueText* whole = nullptr);

/// "system{ I = 1, k = 39.5, C = 1.5, Rd = 2, Re = 3 }" or "system{ bodies = { a = { I = 1, k = 4 } } }" constructs the
/// system; options that are 0 are omitted. With `whole`, the functions of friction laws include their upvalues.
std::string lua_text(lua_State* L, const model::System& system, ValueText* whole = nullptr);
inline std::string lua_text(lua_State* L, const model::SystemHandle& system, ValueText* whole = nullptr) {
    return lua_text(L, *system, whole);
}

/// Calls visit(object) if the value at `index` is an excitation, a system, a law of friction or a spring; returns
/// whether it is.
template <class Visit>
bool visit_object(lua_State* L, int index, const Visit& visit) {
    const auto visited = [&visit](const auto* own) {
        if (own != nullptr) visit(*own);
        return own != nullptr;
    };
    return visited(lua::test<model::Excitation>(L, index)) || visited(lua::test<model::SystemHandle>(L, index)) ||
           visited(lua::test<model::Friction>(L, index)) || visited(lua::test<model::Spring>(L, index));
}

/// "friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 }".
std::string lua_text(lua_State* L, const model::Friction& law, ValueText* whole = nullptr);

/// "spring.polynomial{ [3] = 0.5 }", or a user's function.
std::string lua_text(lua_State* L, const model::Spring& spring, ValueText* whole = nullptr);

/// A user's function as text, or a comment that identifies it.
std::string function_text(lua_State* L, const model::UserFunction& function, ValueText* whole);

/// "integrator.rk4{ h = 0.001 }": constructs the integrator.
std::string lua_text(motion::MethodView method);

}  // namespace dinal::source
