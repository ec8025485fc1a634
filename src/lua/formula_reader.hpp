// A user's function that is a formula, read from its compiled code into a program without Lua (model/formula.hpp).
//
// The reader follows the instructions with what is known of each register: a constant, or that it is a float or a whole
// number by now. What a function takes from outside (variables, fields of tables, the functions that it calls) is a
// constant; what it was is kept, to be compared later. A condition on what is not constant goes on both ways. Ways that
// come to the same instruction are one again, so a program is not much longer than the function. Calls are followed and
// loops unrolled. Whatever the reader does not know makes the function unread, all of it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lua/lua_headers.hpp"
#include "model/formula.hpp"

namespace dinal::lua {

/// A value outside of the function that the formula holds for constant.
struct OutsideValue {
    enum class Kind { variable, field, element, length } kind;
    int holder;        ///< a function or a table, in the list of values
    std::int64_t key;  ///< which variable or element, or the name of the field, in that list
    int value;         ///< likewise
};

/// The arguments of a function: the first `count` of t, theta, velocity and the table of these states. With `of_speed`
/// a speed precedes them; with `timeless` a speed is in the place of t. If there are bodies, theta and velocity are
/// tables of them. The speed, the angles and velocities of the bodies and the states are the states of its formula, in
/// this order.
struct Arguments {
    int count = 1;
    bool of_speed = false, timeless = false;
    std::vector<std::string> bodies = {}, states = {};
    bool operator==(const Arguments&) const = default;
    [[nodiscard]] std::size_t state_count() const { return (of_speed ? 1 : 0) + 2 * bodies.size() + states.size(); }
};

struct Reading {
    std::optional<model::Formula> formula;
    std::string obstacle;  ///< why there is none: "lab.lua:3: it assigns to a variable outside of it"
    Arguments arguments = {.count = 0};
    std::vector<OutsideValue> outside;
};

/// Reads the callable value at the index. All callers share one reading until a value outside of the function changes.
std::shared_ptr<Reading> reading_of(lua_State* L, int index, const Arguments& arguments);

}  // namespace dinal::lua
