#include "lua/foreign.hpp"

#include <atomic>
#include <span>
#include <utility>

#include "lua/bind.hpp"

namespace dinal::lua {
namespace {

const Class foreign_class = {"function of another language", {"", "", ""}, std::span<const Member>()};

}  // namespace

void push_foreign(lua_State* L, Foreign function, lua_CFunction call) {
    static std::atomic<std::uint64_t> last_number = 0;
    luaL_checkstack(L, 4, "too many values");
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &detail::type_key<Foreign>) == LUA_TNIL) {
        add_class<Foreign>(L, foreign_class);
    }
    lua_pop(L, 1);
    function.number = ++last_number;
    push(L, std::move(function));
    lua_pushcclosure(L, call, 1);
}

const Foreign* foreign(lua_State* L, int index) {
    if (lua_iscfunction(L, index) == 0 || lua_getupvalue(L, index, 1) == nullptr) return nullptr;
    const auto* found = test<Foreign>(L, -1);
    lua_pop(L, 1);
    return found;
}

}  // namespace dinal::lua
