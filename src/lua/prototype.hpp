// A compiled Lua function, taken apart: its instructions, constants and lines, as lua_dump writes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// Views are into the text that it was read from.
struct Prototype {
    struct Constant {
        std::uint8_t type;        ///< as Lua numbers them in a dump
        std::string_view number;  ///< eight bytes
        std::string_view text;
    };
    static constexpr std::uint8_t no = 1, yes = 17, integer_number = 3, float_number = 19;
    static constexpr std::uint8_t short_text = 4, long_text = 20;

    std::string_view frame;  ///< three bytes: parameters, whether there are more (...), registers
    std::string_view code;
    std::vector<Constant> constants;
    std::vector<std::string_view> variables;  ///< from outside, three bytes each
    std::vector<Prototype> inner;
    std::vector<int> lines;               ///< of each instruction
    std::vector<std::string_view> names;  ///< of the variables

    [[nodiscard]] std::size_t size() const { return code.size() / 4; }
    [[nodiscard]] std::uint32_t instruction(std::size_t at) const;
};

/// The Lua function at the index as lua_dump writes it, with its debug information.
std::string dumped_function(lua_State* L, int index);

/// None when it is not written as Lua 5.4 writes it.
std::optional<Prototype> prototype_in(std::string_view dumped);

}  // namespace dinal::lua
