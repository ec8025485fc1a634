// docs/manual.md, generated from the documentation of everything that Lua can see.
#pragma once

#include <string>

namespace dinal::help {

std::string manual();

}  // namespace dinal::help
