// The Lua text of values and functions, so that a file of results can say how to repeat the run.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lua/lua_headers.hpp"
#include "lua/lua_text.hpp"

namespace dinal::source {

/// Turns values into Lua expressions, with everything that the functions among them take from outside: local variables
/// go into the expression, global ones become lines of their own.
class ValueText {
public:
    /// At most so many values are written down; what is larger belongs into a file of its own.
    explicit ValueText(lua_State* L, int most_values = 10'000) : L_(L), budget_(most_values) {}

    /// A variable that stands for the value at `index`, which travels by itself: a vector, a function of another
    /// language, an object that has no text; empty when there is none. Then nothing is too large.
    using Aside = std::function<std::string(int index)>;
    ValueText(lua_State* L, Aside aside) : L_(L), aside_(std::move(aside)), budget_(std::numeric_limits<int>::max()) {}

    /// An expression that gives the value at `index` again; `nil` and one of the remarks() when there is none.
    std::string expression(int index);

    /// Returns the variable that stands for the numbers, if vectors travel by themselves.
    std::optional<std::string> aside(const std::vector<double>& numbers);

    /// "w = 3": what must stand before the expressions.
    [[nodiscard]] const std::vector<std::string>& globals() const { return globals_; }
    /// Comment lines about what could not be written down.
    [[nodiscard]] const std::vector<std::string>& remarks() const { return remarks_; }

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
    std::vector<std::string> names_;  // of globals that are done or being done
    std::vector<const void*> open_;   // tables and functions being written: a cycle has no text
    std::vector<std::string> remarks_;
    int budget_;  // values that may still be written down
};

}  // namespace dinal::source
