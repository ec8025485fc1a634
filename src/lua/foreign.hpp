// Functions of another language, such as Python, that Lua calls: data that dinal needs without calling them.
#pragma once

#include <cstdint>
#include <memory>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// The first upvalue of the C function that makes the call; owned by the Lua state in which it was made.
struct Foreign {
    std::shared_ptr<void> function;
    int parameters = 1;         ///< number of required parameters
    const char* language = "";  ///< "Python"
    std::uint64_t number = 0;   ///< unique in this process
};

/// Pushes the C function `call` with this upvalue and assigns its number.
void push_foreign(lua_State* L, Foreign function, lua_CFunction call);

/// The Foreign of the function at `index`, or nullptr.
[[nodiscard]] const Foreign* foreign(lua_State* L, int index);

/// The Foreign of the running C function; requires push_foreign().
[[nodiscard]] inline const Foreign& foreign_here(lua_State* L) {
    return *static_cast<const Foreign*>(lua_touserdata(L, lua_upvalueindex(1)));
}

}  // namespace dinal::lua
