// What an expression that is being typed will be, found without running anything: raw tables, and documentation.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "help/library.hpp"
#include "lua/lua_headers.hpp"
#include "lua/tokens.hpp"

namespace dinal::prompt {

struct Meaning {
    enum class Kind {
        unknown,
        value,   ///< it is on the top of the stack
        object,  ///< it will be an object of the class `section`
        member,  ///< it is the method or field `member` of `section`, or one of our functions
    };
    Kind kind = Kind::unknown;
    const help::Section* section = nullptr;
    const lua::Member* member = nullptr;
};

/// Pushes exactly one value: that of Kind::value, else nil.
Meaning meaning(lua_State* L, std::span<const lua::Token> expression);

/// The section that describes a class, nullptr when none does.
const help::Section* section_of(const lua::Class* description);

/// Replaces the object of ours on the top by what is in its field; nil when that fails. No code of the user runs.
void go_to_field(lua_State* L, std::string_view name);

/// Adds the names that the object on the top has besides the members of its class: the columns of data, the values of a
/// fit.
void add_own_names(lua_State* L, std::vector<std::string>& names);

/// The columns of the object whose method is called, run:plot: of a run its vectors, of data what it has.
std::vector<std::string> columns_of_owner(lua_State* L, std::span<const lua::Token> function);

}  // namespace dinal::prompt
