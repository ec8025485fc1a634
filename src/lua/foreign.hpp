// Functions of another language that Lua calls, such as those of Python: what dinal must know of one without a call.
#pragma once

#include <cstdint>
#include <memory>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// It is the first upvalue of the C function that makes the call, and belongs to the Lua state in which it was made.
struct Foreign {
    std::shared_ptr<void> function;
    int parameters = 1;         ///< that a call must have
    const char* language = "";  ///< "Python"
    std::uint64_t number = 0;   ///< another one for each that was made in this process
};

/// Pushes the C function `call` with that upvalue; gives it its number.
void push_foreign(lua_State* L, Foreign function, lua_CFunction call);

/// That of the function at `index`; nullptr for all others.
[[nodiscard]] const Foreign* foreign(lua_State* L, int index);

/// That of the C function that runs, which push_foreign() has pushed.
[[nodiscard]] inline const Foreign& foreign_here(lua_State* L) {
    return *static_cast<const Foreign*>(lua_touserdata(L, lua_upvalueindex(1)));
}

}  // namespace dinal::lua
