// What help() says: entries, searches, the list of all there is.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "help/library.hpp"
#include "terminal/display.hpp"

namespace dinal::help {

/// How a user writes a member: "sys:simulate", "sys.omega0", "excitation.harmonic", "system".
std::string written_name(const Section& section, const lua::Member& member);

/// The same; operators as they are used: "v + w, v + number".
std::string listed_name(const Section& section, const lua::Member& member);

/// Signature, summary, example, and what to look at next.
std::string member_text(const Section& section, const lua::Member& member, const terminal::Display& screen);

/// The same for a class or module, and one line for each member.
std::string class_text(const Section& section, const terminal::Display& screen);

/// A name and the first sentence about it.
std::string line_about(std::string_view name, std::string_view summary, const terminal::Display& screen);

/// Help about a name ("simulate", "sys.omega0", "excitation"), else about words in names and summaries, else a hint.
std::string help_about(std::string_view words, const terminal::Display& screen);

/// All names that help_about() knows, as a user writes them.
std::vector<std::string> help_names();

/// The names of all options, which help_about() knows, too. More than one call may have an option of one name.
std::vector<std::string> help_option_names();

/// Where to look next: at most five names that help_about() knows.
std::vector<std::string> see_also(const Section& section, const lua::Member& member);

}  // namespace dinal::help
