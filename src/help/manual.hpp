// docs/manual.md, generated from the documentation of everything that Lua can see.
#pragma once

#include <string>

namespace dinal::help {

enum class Extent {
    page,  ///< docs/manual.md: what has no options is a row of a table; options of several calls stand in one place
    all,   ///< every entry as help() prints it, with its example: for the tests
};

std::string manual(Extent extent = Extent::page);

}  // namespace dinal::help
