// The function help() and its texts: entries, searches, the list of everything, words of Lua, the tour.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "help/library.hpp"
#include "terminal/display.hpp"
#include "text/expected.hpp"

namespace dinal::help {

/// A member's name as users write it: "sys:simulate", "sys.omega0", "excitation.harmonic", "system".
std::string written_name(const Section& section, const lua::Member& member);

/// The name as it is listed, with operators as they are used: "v + w, v + number".
std::string listed_name(const Section& section, const lua::Member& member);

/// Signature, summary, example, and related entries.
std::string member_text(const Section& section, const lua::Member& member, const terminal::Display& screen);

/// Text about a class or module, and one line for each member.
std::string class_text(const Section& section, const terminal::Display& screen);

/// A line with a name and the first sentence of its summary.
std::string line_about(std::string_view name, std::string_view summary, const terminal::Display& screen);

/// Help on a name ("simulate", "sys.omega0", "excitation"), otherwise on words in names and summaries, otherwise a
/// hint.
std::string help_about(std::string_view words, const terminal::Display& screen);

/// All names that help_about() knows, as a user writes them.
std::vector<std::string> help_names();

/// The names of all options, which help_about() knows as well. Several calls may share a name.
std::vector<std::string> help_option_names();

/// Related entries: at most five names that help_about() knows.
std::vector<std::string> see_also(const Section& section, const lua::Member& member);

extern const lua::Class help_functions;  // help

// docs/manual.md and docs/manual/, generated from the documentation of the API.

/// Returns a page. "" is docs/manual.md, which links to the others by an index of all names. A topic is
/// docs/manual/TOPIC.md, with entries without options listed in one line each. "all" has every entry as help() prints
/// it, with its example, for the tests. Fails if there is no such page.
text::Expected<std::string> manual(std::string_view page = "");

std::size_t tour_pages();

/// Page 1, 2, ... Lines to be typed begin with four blanks and "> ".
std::string tour_page(std::size_t page);

/// An explanation and lines that run; empty if Lua has no such word.
std::string lua_word(std::string_view word);

/// All such words, including "math.cos" etc.
std::vector<std::string_view> lua_words();

}  // namespace dinal::help
