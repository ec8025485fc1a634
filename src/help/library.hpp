// The map of the Lua API, from which everything is registered and listed in the manual.
#pragma once

#include <span>

#include "lua/bind.hpp"

namespace dinal::help {

/// Makes the table `dinal` (also for require "dinal"), copies its members to _G and tracks coroutines for Ctrl-C.
void open_library(lua_State* L);

/// All sections of the API in the order of the manual. A section is a module, a class or a set of functions.
struct Section {
    const char* title;   ///< "excitation", "An excitation"
    const char* prefix;  ///< prefix of a member: "excitation.", "e:", ""
    const lua::Class* description;
};
std::span<const Section> sections();

}  // namespace dinal::help
