// Writes Lua that makes sense now and then, out of bytes that a fuzzer has chosen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

/// The same bytes always give the same text. Most of it calls what dinal offers, with values that are mostly of the
/// right kind, often at the edge and sometimes wrong.
std::string write_lua(std::span<const std::uint8_t> choices);
