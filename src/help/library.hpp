// The map of the Lua API: everything that Lua can see is registered, and listed in the manual, from here.
#pragma once

#include <span>

#include "lua/bind.hpp"

namespace dinal::help {

/// Makes the table `dinal` (also for require "dinal"), copies its members into _G and tracks coroutines for Ctrl-C.
void open_library(lua_State* L);

/// Everything that Lua can see, in the order of the manual. A section is a module, a class of objects, or functions.
struct Section {
    const char* title;   ///< "excitation", "An excitation"
    const char* prefix;  ///< what stands before a member: "excitation.", "e:", ""
    const lua::Class* description;
};
std::span<const Section> sections();

}  // namespace dinal::help
