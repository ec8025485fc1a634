// The memory limit of a script: Lua's own memory, and C++ memory from `new` on its behalf.
//
// Lua's allocator and operator new share one counter. Beyond the limit an allocation fails while a chunk runs, and the
// chunk is stopped, so that no pcall can swallow the failure. Without a limit nothing is counted.
// note_external_memory() serves the garbage collector, which only sees Lua's memory.
#pragma once

#include <cstddef>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// Allows `bytes` beyond what is allocated now, for the whole process. Call once.
void set_memory_limit(lua_State* L, std::size_t bytes);

/// Ends the chunk of this thread if Lua was refused memory and garbage collection did not help: no pcall may continue
/// from there. Called at the instruction after a refusal, and at the end of a chunk or coroutine.
void stop_after_refusal() noexcept;

/// The limit in bytes; 0: none.
[[nodiscard]] std::size_t memory_limit() noexcept;

/// Bytes left until the limit; the largest number without one.
[[nodiscard]] std::size_t memory_left() noexcept;

/// Collects garbage if less than `bytes` are left: objects that are small for Lua may own much memory.
void make_room(lua_State* L, std::size_t bytes);

/// Collects garbage if much of the limit is used. Every bound function calls this first.
void collect_when_tight(lua_State* L);

/// Counts memory not allocated with `new`, such as an Eigen matrix, during its lifetime.
class MemoryCharge {
public:
    MemoryCharge() = default;
    explicit MemoryCharge(std::size_t bytes);
    MemoryCharge(MemoryCharge&& other) noexcept;
    MemoryCharge& operator=(MemoryCharge&& other) noexcept;
    ~MemoryCharge();

private:
    std::size_t bytes_ = 0;
};

/// Reports an object that owns this much memory outside of Lua. Collects garbage when the sum is large: otherwise a
/// loop could fill the memory with dead long vectors, which Lua counts as 40 bytes each.
void note_external_memory(lua_State* L, std::size_t bytes);

}  // namespace dinal::lua
