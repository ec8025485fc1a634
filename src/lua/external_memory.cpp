#include "lua/external_memory.hpp"

namespace dinal::lua {

// NOTE: not lua_gc(L, LUA_GCSTEP, kilobytes), which exists for this. In generational mode, the one of the program, each
// step ages the objects that are just being worked with; after two of them they are old, and old garbage is only
// collected once Lua's own memory has doubled.
void note_external_memory(lua_State* L, std::size_t bytes) {
    constexpr std::size_t limit = std::size_t{256} << 20U;  // takes longer to fill than a collection does
    thread_local std::size_t since_collection = 0;
    since_collection += bytes;
    if (since_collection > limit && lua_gc(L, LUA_GCISRUNNING) != 0) {
        since_collection = 0;
        lua_gc(L, LUA_GCCOLLECT);
    }
}

}  // namespace dinal::lua
