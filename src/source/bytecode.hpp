// Facts in the bytecode of a Lua function: the globals it names, and a digest independent of its lines.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::source {

struct CodeFacts {
    std::vector<std::string> globals;  ///< names that the function, or an inner one, reads or sets in its environment
    std::vector<std::string> perhaps;  ///< texts that may be such names, used in a way that cannot be traced
    std::uint64_t digest = 0;          ///< hash of instructions and constants
};

/// Analyses the output of lua_dump with debug information; `environment` is the upvalue (from 0) that is the table of
/// globals, -1 for none. None if the format is not that of Lua 5.4.
std::optional<CodeFacts> facts_of_code(std::string_view dumped, int environment);

/// FNV-1a, 64 bits: continues the hash `before` with `bytes`.
constexpr std::uint64_t digest_start = 0xcbf29ce484222325U;
std::uint64_t digest_of(std::string_view bytes, std::uint64_t before = digest_start);

}  // namespace dinal::source
