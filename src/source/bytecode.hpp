// What a compiled Lua function says about itself: which globals it names, and what its code is, whatever lines it
// stands on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::source {

struct CodeFacts {
    std::vector<std::string> globals;  ///< names that it, or a function within it, looks up or sets in its environment
    std::vector<std::string> perhaps;  ///< texts in a function that may look up such names in a way that is not seen
    std::uint64_t digest = 0;          ///< of instructions and constants
};

/// Of what lua_dump has written, with its debug information; `environment` is the number (from 0) of the upvalue that
/// is the table of globals, -1 when none is. None when it is not written as Lua 5.4 writes it.
std::optional<CodeFacts> facts_of_code(std::string_view dumped, int environment);

/// FNV-1a, 64 bits: of `bytes` after what `before` is of.
constexpr std::uint64_t digest_start = 0xcbf29ce484222325U;
std::uint64_t digest_of(std::string_view bytes, std::uint64_t before = digest_start);

}  // namespace dinal::source
