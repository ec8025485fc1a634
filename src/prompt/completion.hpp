// Tab: what may follow the text before the cursor. Never runs code of the user.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::prompt {

struct Completion {
    std::vector<std::string> names;  ///< whole words, with what comes next: "simulate{", "theta0 = "
    bool files = false;              ///< names of files may follow
};

/// `before` is all that was typed of the chunk up to the cursor.
Completion complete(lua_State* L, std::string_view before);

/// The signature of the call whose brackets are open at the cursor, without the options that are there already; empty
/// when no such call is known.
std::string signature_hint(lua_State* L, std::string_view before);

}  // namespace dinal::prompt
