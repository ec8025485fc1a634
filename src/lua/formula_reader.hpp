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

struct Reading {
    std::optional<model::Formula> formula;
    std::string obstacle;  ///< why there is none: "lab.lua:3: it assigns to a variable outside of it"
    int arguments = 0;
    std::vector<std::string> states;
    std::vector<OutsideValue> outside;
};

/// How the callable value at the index is read when it is called with the first `arguments` of t, theta, velocity and
/// the table of these states. All who ask share one reading, until something outside is no longer as it was.
std::shared_ptr<Reading> reading_of(lua_State* L, int index, int arguments, const std::vector<std::string>& states);

}  // namespace dinal::lua
