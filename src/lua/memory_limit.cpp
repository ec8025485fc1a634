#include "lua/memory_limit.hpp"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <new>
#include <utility>

#include "lua/interrupt.hpp"

namespace dinal::lua {
namespace {

using Bytes = std::int64_t;

// Atomic: workers have Lua states of their own, and take from the same memory.
std::atomic<Bytes> limit = 0;  // 0: none
std::atomic<Bytes> taken = 0;  // since there is a limit; what was there before counts negative when it goes

/// What the unwinding of a chunk that is stopped may take on top: messages, closing of variables.
constexpr Bytes slack = Bytes{4} << 20;

bool limited() noexcept {
    return limit.load(std::memory_order_relaxed) != 0;
}

Bytes now_taken() noexcept {
    return taken.load(std::memory_order_relaxed);
}

void count(Bytes bytes) noexcept {
    taken.fetch_add(bytes, std::memory_order_relaxed);
}

/// So much more can be had. Always, when no chunk runs: the program itself goes on.
bool allowed(Bytes more) noexcept {
    const Bytes extra = interrupt_requested() ? slack : 0;
    return !chunk_runs() || now_taken() + more <= limit.load(std::memory_order_relaxed) + extra;
}

Bytes size_of(void* block) noexcept {
    return block == nullptr ? 0 : static_cast<Bytes>(malloc_usable_size(block));
}

/// Lua collects its garbage when it is refused memory, and asks again. So a refusal is final when the same is refused
/// twice, or when something else is asked for.
bool is_final(std::size_t refused_before, std::size_t size, bool fits) {
    return refused_before != 0 && (refused_before != size || !fits);
}

void* allocate(void*, void* block, std::size_t, std::size_t size) {
    thread_local std::size_t refused = 0;
    const Bytes before = size_of(block);
    if (size == 0) {
        count(-before);
        std::free(block);  // NOLINT: Lua's blocks are those of realloc
        return nullptr;
    }
    if (const Bytes more = static_cast<Bytes>(size) - before; more > 0) {
        const bool fits = allowed(more);
        if (is_final(std::exchange(refused, fits ? 0 : size), size, fits)) {
            stop_here(Stop::memory);
        }
        if (!fits) {
            return nullptr;
        }
    }
    void* result = std::realloc(block, size);  // NOLINT
    count(result == nullptr ? 0 : size_of(result) - before);
    return result;
}

}  // namespace

void set_memory_limit(lua_State* L, std::size_t bytes) {
    taken = 0;
    limit = static_cast<Bytes>(std::min<std::size_t>(bytes, std::numeric_limits<Bytes>::max() / 2));
    lua_setallocf(L, allocate, nullptr);
}

std::size_t memory_limit() noexcept {
    return static_cast<std::size_t>(limit.load(std::memory_order_relaxed));
}

std::size_t memory_left() noexcept {
    if (!limited()) {
        return std::numeric_limits<std::size_t>::max();
    }
    return static_cast<std::size_t>(std::max<Bytes>(limit.load(std::memory_order_relaxed) - now_taken(), 0));
}

void make_room(lua_State* L, std::size_t bytes) {
    if (bytes > memory_left()) {
        lua_gc(L, LUA_GCCOLLECT);
    }
}

void collect_when_tight(lua_State* L) {
    if (!limited()) {
        return;
    }
    thread_local Bytes after_last = 0;  // what is taken by what is in use cannot be collected again and again
    const Bytes all = limit.load(std::memory_order_relaxed);
    after_last = std::min(after_last, now_taken());
    if (now_taken() > all / 2 && now_taken() - after_last > all / 8) {
        lua_gc(L, LUA_GCCOLLECT);
        after_last = now_taken();
    }
}

MemoryCharge::MemoryCharge(std::size_t bytes) : bytes_(limited() ? bytes : 0) {
    count(static_cast<Bytes>(bytes_));
}

MemoryCharge::MemoryCharge(MemoryCharge&& other) noexcept : bytes_(std::exchange(other.bytes_, 0)) {}

MemoryCharge& MemoryCharge::operator=(MemoryCharge&& other) noexcept {
    std::swap(bytes_, other.bytes_);
    return *this;
}

MemoryCharge::~MemoryCharge() {
    count(-static_cast<Bytes>(bytes_));
}

// NOTE: not lua_gc(L, LUA_GCSTEP, kilobytes), which exists for this. In generational mode, the one of the program, each
// step ages the objects that are just being worked with; after two of them they are old, and old garbage is only
// collected once Lua's own memory has doubled.
void note_external_memory(lua_State* L, std::size_t bytes) {
    constexpr std::size_t much = std::size_t{256} << 20U;  // takes longer to fill than a collection does
    thread_local std::size_t since_collection = 0;
    since_collection += bytes;
    if (since_collection > much && lua_gc(L, LUA_GCISRUNNING) != 0) {
        since_collection = 0;
        lua_gc(L, LUA_GCCOLLECT);
    }
}

}  // namespace dinal::lua

// NOTE: the forms for arrays lead here. Those for over-aligned types do not, which nothing here has.
// Never inlined: a checker of memory puts its own in their places, and would see half of a pair.
[[gnu::noinline]] void* operator new(std::size_t size) {
    const bool limited = dinal::lua::limited();
    if (limited && !dinal::lua::allowed(static_cast<dinal::lua::Bytes>(std::min<std::size_t>(size, 1ULL << 62U)))) {
        dinal::lua::stop_here(dinal::lua::Stop::memory);
        throw std::bad_alloc();
    }
    void* block = std::malloc(std::max<std::size_t>(size, 1));  // NOLINT
    if (block == nullptr) {
        throw std::bad_alloc();
    }
    if (limited) {
        dinal::lua::count(dinal::lua::size_of(block));
    }
    return block;
}

[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    try {
        return operator new(size);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}

[[gnu::noinline]] void operator delete(void* block) noexcept {
    if (dinal::lua::limited()) {
        dinal::lua::count(-dinal::lua::size_of(block));
    }
    std::free(block);  // NOLINT
}

[[gnu::noinline]] void operator delete(void* block, std::size_t) noexcept {
    operator delete(block);
}
