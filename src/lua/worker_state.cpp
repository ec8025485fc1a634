#include "lua/worker_state.hpp"

#include <fmt/format.h>

#include <atomic>

#include "lua/bind.hpp"
#include "lua/interrupt.hpp"
#include "lua/safe_mode.hpp"

namespace dinal::lua {
namespace {

std::atomic<void (*)(lua_State*)> open_ours = nullptr;

int refuse_exit(lua_State* L) {
    raise(L, {.sentence = "os.exit is not possible within a sweep: the other points are still to be done",
              .call = "os.exit"});
}

/// Receives the state to be copied.
int open_worker(lua_State* L) {
    auto* like = static_cast<lua_State*>(lua_touserdata(L, 1));
    lua_settop(L, 0);
    lua_getfield(like, LUA_REGISTRYINDEX, "LUA_NOENV");
    lua_pushboolean(L, lua_toboolean(like, -1));
    lua_pop(like, 1);
    lua_setfield(L, LUA_REGISTRYINDEX, "LUA_NOENV");
    safe_mode() ? open_safe_libraries(L) : luaL_openlibs(L);
    open_ours.load()(L);
    lua_gc(L, LUA_GCGEN, 0, 0);  // generational, as in the program
    return 0;
}

int take_paths(lua_State* L) {
    auto* like = static_cast<lua_State*>(lua_touserdata(L, 1));
    luaL_checkstack(like, 3, "too many values");
    if (lua_getglobal(L, LUA_LOADLIBNAME) == LUA_TTABLE && lua_getglobal(like, LUA_LOADLIBNAME) == LUA_TTABLE) {
        for (const char* name : {"path", "cpath"}) {
            if (lua_getfield(like, -1, name) == LUA_TSTRING) {
                lua_pushstring(L, lua_tostring(like, -1));
                lua_setfield(L, -2, name);
            }
            lua_pop(like, 1);
        }
    }
    lua_settop(L, 1);
    return 0;
}

}  // namespace

void set_library(void (*open)(lua_State* L)) noexcept {
    open_ours = open;
}

OwnedState new_state_like(lua_State* like) {
    OwnedState state(luaL_newstate());
    lua_State* L = state.get();
    bool good = L != nullptr;
    if (good) {
        void* of_allocator = nullptr;
        lua_Alloc allocator = lua_getallocf(like, &of_allocator);  // the parent's: counts bytes if limited
        lua_setallocf(L, allocator, of_allocator);
        for (const lua_CFunction step : {guarded<open_worker>, guarded<take_paths>}) {
            lua_pushcfunction(L, step);
            lua_pushlightuserdata(L, like);
            good = good && lua_pcall(L, 1, 0, 0) == LUA_OK;
        }
    }
    if (!good) {
        state.reset();
        raise(like, "not enough memory for another worker");
    }
    return state;
}

void forbid_exit(lua_State* L) {
    if (lua_getglobal(L, LUA_OSLIBNAME) == LUA_TTABLE) {
        lua_pushcfunction(L, guarded<refuse_exit>);
        lua_setfield(L, -2, "exit");
    }
    lua_pop(L, 1);
}

void refuse_in_worker(lua_State* L, const char* call) {
    if (in_worker()) {
        raise(L, {.sentence = fmt::format("{} is not possible within the function of a sweep, which several threads "
                                          "run at once; return numbers, and do it when the sweep is done",
                                          call),
                  .call = call});
    }
}

}  // namespace dinal::lua
