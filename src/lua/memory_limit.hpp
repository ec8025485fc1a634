// How much memory a script may take: Lua's own, and all that C++ takes with `new` on its behalf.
//
// Lua's allocator and operator new count into one number. Past the limit an allocation fails while a chunk runs, and
// the chunk is stopped, so that no pcall can swallow that. Without a limit nothing is counted. Its last function is for
// the garbage collector, which sees no memory but Lua's.
#pragma once

#include <cstddef>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// From now on chunks may take so many bytes more than is taken already. Once, for the whole process.
void set_memory_limit(lua_State* L, std::size_t bytes);

/// Ends the chunk of this thread if Lua was refused memory and has not got it since, by collecting garbage: no pcall
/// shall go on from there. Called at the instruction after a refusal, and where a chunk or a coroutine ends.
void settle_refusal() noexcept;

/// 0 when there is none.
[[nodiscard]] std::size_t memory_limit() noexcept;

/// Bytes until the limit; the largest number when there is none.
[[nodiscard]] std::size_t memory_left() noexcept;

/// Collects garbage when less than `bytes` are left: objects that are small for Lua may hold much.
void make_room(lua_State* L, std::size_t bytes);

/// The same when much of what is allowed is taken. Every call of a bound function begins with it.
void collect_when_tight(lua_State* L);

/// Memory that is not taken with `new`, such as an Eigen matrix: counts while it lives.
class MemoryCharge {
public:
    MemoryCharge() = default;
    explicit MemoryCharge(std::size_t bytes);
    MemoryCharge(MemoryCharge&& other) noexcept;
    MemoryCharge& operator=(MemoryCharge&& other) noexcept;
    MemoryCharge(const MemoryCharge&) = delete;
    MemoryCharge& operator=(const MemoryCharge&) = delete;
    ~MemoryCharge();

private:
    std::size_t bytes_ = 0;
};

/// To be called after an object was pushed that holds so many bytes outside of Lua. Collects the garbage when that has
/// added up: otherwise a loop over long vectors would fill the memory with dead ones, 40 bytes each for Lua.
void note_external_memory(lua_State* L, std::size_t bytes);

}  // namespace dinal::lua
