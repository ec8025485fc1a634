// docs/manual.md and docs/manual/, generated from the documentation of the API.
#pragma once

#include <string>
#include <string_view>

#include "text/expected.hpp"

namespace dinal::help {

/// Returns a page. "" is docs/manual.md, which links to the others by an index of all names. A topic is
/// docs/manual/TOPIC.md, with entries without options listed in one line each. "all" has every entry as help() prints
/// it, with its example, for the tests. Fails if there is no such page.
text::Expected<std::string> manual(std::string_view page = "");

}  // namespace dinal::help
