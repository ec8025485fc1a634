// A parsed Lua function: instructions, constants and lines, from lua_dump.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// A parsed function. Its views refer to the dumped text.
struct Prototype {
    struct Constant {
        std::uint8_t type;        ///< Lua's type tag in a dump
        std::string_view number;  ///< eight bytes
        std::string_view text;
    };
    static constexpr std::uint8_t no = 1, yes = 17, integer_number = 3, float_number = 19;
    static constexpr std::uint8_t short_text = 4, long_text = 20;

    std::string_view frame;  ///< three bytes: number of parameters, whether it has ..., number of registers
    std::string_view code;
    std::vector<Constant> constants;
    std::vector<std::string_view> variables;  ///< upvalues, three bytes each
    std::vector<Prototype> inner;
    std::vector<int> lines;               ///< source line of each instruction
    std::vector<std::string_view> names;  ///< names of the upvalues

    std::size_t size() const { return code.size() / 4; }
    std::uint32_t instruction(std::size_t at) const;
};

/// The output of lua_dump for the Lua function at the index; stripped: without debug information.
std::string dumped_function(lua_State* L, int index, bool stripped = false);

/// Parses a dump; none if it is not in the format of Lua 5.4.
std::optional<Prototype> prototype_in(std::string_view dumped);

}  // namespace dinal::lua
