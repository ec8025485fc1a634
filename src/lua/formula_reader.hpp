// Translates a user's Lua function into a formula, a program that runs without Lua (model/formula.hpp), by symbolic
// execution of its bytecode.
//
// For each register the reader knows a constant, or whether it holds a float or a whole number. Values from outside of
// the function (variables, fields of tables, called functions) count as constants; the reader keeps them for later
// comparison. At a condition that is not constant both branches are followed; they are merged at the next common
// instruction, so a program is not much longer than the function. Calls are followed and loops unrolled. Anything
// unsupported makes the whole function unreadable.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lua/lua_headers.hpp"
#include "model/formula.hpp"

namespace dinal::lua {

/// A value outside of the function that the formula treats as constant.
struct OutsideValue {
    enum class Kind { variable, field, element, length } kind;
    int holder;        ///< index of a function or table in the list of values
    std::int64_t key;  ///< index of the variable or element, or index of the field's name in that list
    int value;         ///< index in that list
};

/// The arguments of a function: the first `count` of t, theta, velocity and the table of states. With `of_speed` a
/// speed precedes them; with `timeless` a speed replaces t. For several bodies, theta and velocity are tables. The
/// formula receives the speed, the angles and velocities of the bodies, and the states in this order as its states.
struct Arguments {
    int count = 1;
    bool of_speed = false, timeless = false;
    std::vector<std::string> bodies = {}, states = {};
    bool operator==(const Arguments&) const = default;
    std::size_t state_count() const { return (of_speed ? 1 : 0) + 2 * bodies.size() + states.size(); }
};

struct Reading {
    std::optional<model::Formula> formula;
    std::string obstacle;  ///< why there is no formula: "lab.lua:3: it assigns to a variable outside of it"
    Arguments arguments = {.count = 0};
    std::vector<OutsideValue> outside;
};

/// Reads the callable value at the index as a formula. All callers share one reading until a value outside of the
/// function changes.
std::shared_ptr<Reading> reading_of(lua_State* L, int index, const Arguments& arguments);

}  // namespace dinal::lua
