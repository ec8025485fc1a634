// docs/manual.md and docs/manual/, generated from the documentation of everything that Lua can see.
#pragma once

#include <string>
#include <string_view>

#include "text/expected.hpp"

namespace dinal::help {

/// The page of that name: "" is docs/manual.md, which leads to the others by an index of all names; a topic is
/// docs/manual/TOPIC.md, where what has no options is a line of a list; "all" is every entry as help() prints it, with
/// its example, for the tests. Fails if there is no such page.
text::Expected<std::string> manual(std::string_view page = "");

}  // namespace dinal::help
