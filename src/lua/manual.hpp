// The documentation of everything that Lua can see, as text: for help() and for docs/manual.md.
#pragma once

#include <string>
#include <string_view>

#include "lua/library.hpp"

namespace dinal {

/// How a user writes a member: "sys:simulate", "sys.omega0", "excitation.harmonic", "system".
std::string written_name(const Section& section, const Member& member);

/// Signature, summary and example.
std::string member_text(const Section& section, const Member& member);

/// The same for a class or module, and one line for each member.
std::string class_text(const Section& section);

/// Help about a name ("simulate", "sys.omega0", "excitation"), else about a word in names and summaries, else a hint.
std::string help_about(std::string_view words);

/// Where to begin.
std::string start_page();

/// docs/manual.md.
std::string manual();

}  // namespace dinal
