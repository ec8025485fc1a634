// What an expression that is being typed will be, found without running anything: raw tables, and documentation.
#pragma once

#include <span>

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

}  // namespace dinal::prompt
