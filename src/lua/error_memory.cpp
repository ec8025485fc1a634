#include "lua/error_memory.hpp"

#include <algorithm>
#include <deque>
#include <memory>

namespace dinal::lua {
namespace {

const char memory_key = 0;  // registry key of the ErrorMemory; false once lua_close has taken it

constexpr std::size_t most_facts =
    20;  // an error that was kept while so many others were raised is told without a mark

struct ErrorMemory {
    std::deque<text::Error> facts;  // the latest first
};

/// The finalizer. What the registry has is taken, and not the argument, which is a user's when he calls it by hand.
int forget(lua_State* L) {
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &memory_key) == LUA_TUSERDATA) {
        std::destroy_at(static_cast<ErrorMemory*>(lua_touserdata(L, -1)));
        lua_pushboolean(L, 0);
        lua_rawsetp(L, LUA_REGISTRYINDEX, &memory_key);
    }
    return 0;
}

/// Pushes the memory of this Lua state. nullptr (and false on the stack) while the state is being closed.
ErrorMemory* push_memory(lua_State* L) {
    luaL_checkstack(L, LUA_MINSTACK, "for what is known about an error");
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &memory_key) == LUA_TNIL) {
        lua_pop(L, 1);
        auto* memory = std::construct_at(static_cast<ErrorMemory*>(lua_newuserdatauv(L, sizeof(ErrorMemory), 1)));
        lua_createtable(L, 0, 1);
        lua_pushcfunction(L, forget);
        lua_setfield(L, -2, "__gc");
        lua_setmetatable(L, -2);
        lua_pushvalue(L, -1);
        lua_rawsetp(L, LUA_REGISTRYINDEX, &memory_key);
        return memory;
    }
    return static_cast<ErrorMemory*>(lua_touserdata(L, -1));
}

}  // namespace

void remember_facts(lua_State* L, const text::Error& error) {
    if (ErrorMemory* memory = push_memory(L)) {
        memory->facts.push_front(error);
        memory->facts.resize(std::min(memory->facts.size(), most_facts));
    }
    lua_pop(L, 1);
}

const text::Error* facts_of(lua_State* L, std::string_view message) {
    const ErrorMemory* memory = push_memory(L);
    lua_pop(L, 1);  // the registry keeps it
    if (memory == nullptr) {
        return nullptr;
    }
    const auto told = std::find_if(memory->facts.begin(), memory->facts.end(), [message](const text::Error& error) {
        return message.find(error.message()) != std::string_view::npos;
    });
    return told == memory->facts.end() ? nullptr : &*told;
}

}  // namespace dinal::lua
