#include "lua/error_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <memory>

namespace dinal::lua {
namespace {

const char memory_key = 0;  // registry key of the ErrorMemory; false after lua_close

constexpr std::size_t most_facts = 20;  // number of errors whose facts are kept

struct ErrorMemory {
    std::deque<text::Error> facts;  // the latest first
    Witness witness = nullptr;
    Remarks remarks;            // about the error value stored as the userdata's user value
    bool is_witnessed = false;  // whether an error value is stored, which may be nil
    bool raised_again = false;
};

/// The finalizer. Uses the registry's object, because a user who calls this function passes an arbitrary argument.
int forget(lua_State* L) {
    if (lua_rawgetp(L, LUA_REGISTRYINDEX, &memory_key) == LUA_TUSERDATA) {
        std::destroy_at(static_cast<ErrorMemory*>(lua_touserdata(L, -1)));
        lua_pushboolean(L, 0);
        lua_rawsetp(L, LUA_REGISTRYINDEX, &memory_key);
    }
    return 0;
}

/// Pushes the memory of this Lua state; nullptr, and false on the stack, while the state is being closed.
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

ErrorMemory* memory_of(lua_State* L) {
    ErrorMemory* memory = push_memory(L);
    lua_pop(L, 1);  // the registry keeps it
    return memory;
}

/// The memory if its remarks belong to the error value at the index, otherwise nullptr.
ErrorMemory* memory_about(lua_State* L, int index) {
    index = lua_absindex(L, index);
    ErrorMemory* memory = push_memory(L);
    bool same = false;
    if (memory != nullptr && memory->is_witnessed) {
        lua_getiuservalue(L, -1, 1);
        same = lua_rawequal(L, -1, index) != 0;
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return same ? memory : nullptr;
}

/// Stores the witness's remarks on the error value.
void witness(lua_State* L, int error, int function) {
    error = lua_absindex(L, error);
    function = function == 0 ? 0 : lua_absindex(L, function);
    ErrorMemory* memory = push_memory(L);
    if (memory != nullptr) {
        memory->remarks = memory->witness != nullptr ? memory->witness(L, error, function) : Remarks();
        memory->is_witnessed = true;
        memory->raised_again = false;
        lua_pushvalue(L, error);
        lua_setiuservalue(L, -2, 1);
    }
    lua_pop(L, 1);
}

}  // namespace

void remember_facts(lua_State* L, const text::Error& error) {
    if (ErrorMemory* memory = memory_of(L)) {
        memory->facts.push_front(error);
        memory->facts.resize(std::min(memory->facts.size(), most_facts));
    }
}

const text::Error* facts_of(lua_State* L, std::string_view message) {
    const ErrorMemory* memory = memory_of(L);
    if (memory == nullptr) {
        return nullptr;
    }
    const auto fact = std::ranges::find_if(memory->facts, [message](const text::Error& error) {
        return message.find(error.message()) != std::string_view::npos;
    });
    return fact == memory->facts.end() ? nullptr : &*fact;
}

void set_witness(lua_State* L, Witness witness) {
    if (ErrorMemory* memory = memory_of(L)) {
        memory->witness = witness;
    }
}

int witness_error(lua_State* L) {
    lua_settop(L, 1);
    // NOTE: equal texts may be two errors; it is the same one only if it has been raised again.
    ErrorMemory* memory = memory_about(L, 1);
    if (memory != nullptr && memory->raised_again) {
        memory->raised_again = false;
    } else {
        witness(L, 1, 0);
    }
    return 1;
}

void witness_result(lua_State* L, int function) {
    witness(L, -1, function);
}

void remember_argument(lua_State* L, const char* function, const char* argument, double value) {
    if (ErrorMemory* memory = memory_about(L, -1)) {
        memory->remarks.during += fmt::format("\n  in {} at {} = {:.14g}", function, argument, value);
    }
}

void keep_remarks(lua_State* L) {
    if (ErrorMemory* memory = memory_of(L)) {
        memory->raised_again = true;
    }
}

void forget_remarks(lua_State* L) {
    if (ErrorMemory* memory = memory_of(L)) {
        memory->is_witnessed = false;
        memory->raised_again = false;
    }
}

const Remarks* remembered_remarks(lua_State* L, int index) {
    const ErrorMemory* memory = memory_about(L, index);
    return memory == nullptr ? nullptr : &memory->remarks;
}

}  // namespace dinal::lua
