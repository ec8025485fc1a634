#include "lua/memory_limit.hpp"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <new>
#include <thread>
#include <utility>

#include "lua/interrupt.hpp"

// The C library's functions: within this program, the linker redirects malloc, free and realloc to the end of this
// file.
extern "C" {
void* plain_malloc(std::size_t size) __asm__("__real_malloc");
void plain_free(void* block) __asm__("__real_free");
void* plain_realloc(void* block, std::size_t size) __asm__("__real_realloc");
void* counted_malloc(std::size_t size) __asm__("__wrap_malloc");
void counted_free(void* block) __asm__("__wrap_free");
void* counted_realloc(void* block, std::size_t size) __asm__("__wrap_realloc");
}

namespace dinal::lua {
namespace {

using Bytes = std::int64_t;

// Atomic: workers have their own Lua states but share the memory.
std::atomic<Bytes> limit = 0;  // 0: no limit
std::atomic<Bytes> taken = 0;  // since the limit was set; freeing older memory makes it negative

/// Extra memory for the unwinding of a stopped chunk: messages, closing of variables.
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

/// Returns whether this much more is allowed. Always true while no chunk runs: the program itself continues.
bool allowed(Bytes more) noexcept {
    const Bytes extra = interrupt_requested() ? slack : 0;
    return !chunk_runs() || now_taken() + more <= limit.load(std::memory_order_relaxed) + extra;
}

Bytes size_of(void* block) noexcept {
    return block == nullptr ? 0 : static_cast<Bytes>(malloc_usable_size(block));
}

/// Returns whether a refusal is final. Lua collects garbage after a refusal and asks for the same size again; so it is
/// final if that is also refused, or if another size is requested.
bool is_final(std::size_t refused_before, std::size_t size, bool fits) {
    return refused_before != 0 && (refused_before != size || !fits);
}

thread_local std::size_t refused = 0;  // size of Lua's last refused request; 0: satisfied meanwhile

void* allocate(void*, void* block, std::size_t, std::size_t size) {
    const Bytes before = size_of(block);
    if (size == 0) {
        count(-before);
        plain_free(block);
        return nullptr;
    }
    if (const Bytes more = static_cast<Bytes>(size) - before; more > 0) {
        const bool fits = allowed(more);
        if (is_final(std::exchange(refused, fits ? 0 : size), size, fits)) {
            stop_here(Stop::memory);
        }
        if (!fits) {
            look_at_next_instruction();
            return nullptr;
        }
    }
    void* result = plain_realloc(block, size);
    count(result == nullptr ? 0 : size_of(result) - before);
    return result;
}

/// Allocates or reallocates `block`, which may be null; returns null beyond the limit.
void* counted(std::size_t size, void* block) {
    if (!limited()) return plain_realloc(block, size);
    const Bytes before = size_of(block);
    if (!allowed(static_cast<Bytes>(std::min<std::size_t>(size, 1ULL << 62U)) - before)) {
        stop_here(Stop::memory);
        return nullptr;
    }
    void* result = plain_realloc(block, size);
    if (result != nullptr || size == 0) count(size_of(result) - before);
    return result;
}

// AddressSanitizer itself needs far more memory.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define DINAL_SANITIZED
#endif
#endif
#if defined(DINAL_SANITIZED) || defined(__SANITIZE_ADDRESS__)
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

/// Limits the data of the process (RLIMIT_DATA), as some memory is not counted, such as a picture: twice the limit plus
/// the program's and its threads' own needs.
void set_backstop(std::size_t bytes) {
    constexpr std::size_t own = std::size_t{128} << 20U, for_a_thread = std::size_t{16} << 20U;
    std::size_t pages = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
        if (std::fscanf(file, "%*u %*u %*u %*u %*u %zu", &pages) != 1) pages = 0;  // NOLINT(cert-err34-c)
        static_cast<void>(std::fclose(file));
    }
    const std::size_t threads = std::max(1U, std::thread::hardware_concurrency());
    const rlim_t most =
        pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + 2 * bytes + own + threads * for_a_thread;
    rlimit data{};
    if (::getrlimit(RLIMIT_DATA, &data) == 0 && most < data.rlim_cur) {
        data.rlim_cur = most;
        ::setrlimit(RLIMIT_DATA, &data);
    }
}

}  // namespace

void set_memory_limit(lua_State* L, std::size_t bytes) {
    taken = 0;
    limit = static_cast<Bytes>(std::min<std::size_t>(bytes, std::numeric_limits<Bytes>::max() / 2));
    lua_setallocf(L, allocate, nullptr);
    if (!is_sanitized) set_backstop(bytes);
}

void stop_after_refusal() noexcept {
    if (std::exchange(refused, 0) != 0 && chunk_runs()) stop_here(Stop::memory);
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
    thread_local Bytes after_last = 0;  // memory in use after the last collection, which need not be collected again
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

// NOTE: lua_gc(L, LUA_GCSTEP, kilobytes) is meant for this but fails in generational mode, which the program uses: each
// step ages the objects in use; after two of them they are old, and old garbage is only collected once Lua's own memory
// has doubled.
void note_external_memory(lua_State* L, std::size_t bytes) {
    constexpr std::size_t much = std::size_t{256} << 20U;  // allocating so much takes longer than a collection
    thread_local std::size_t since_collection = 0;
    since_collection += bytes;
    if (since_collection > much && lua_gc(L, LUA_GCISRUNNING) != 0) {
        since_collection = 0;
        lua_gc(L, LUA_GCCOLLECT);
    }
}

}  // namespace dinal::lua

// malloc outside of Lua, and operator new, which Eigen's matrices use: the linker redirects calls here (--wrap in
// CMakeLists.txt). Dynamically linked libraries keep the plain one.
void* counted_malloc(std::size_t size) {
    return dinal::lua::counted(size, nullptr);
}

void* counted_realloc(void* block, std::size_t size) {
    return dinal::lua::counted(size, block);
}

void counted_free(void* block) {
    if (dinal::lua::limited()) dinal::lua::count(-dinal::lua::size_of(block));
    plain_free(block);
}

// NOTE: the array forms end up here. Those for over-aligned types do not; nothing here has such a type.
// Never inlined: a memory checker replaces these functions, and would otherwise see half of a pair.
[[gnu::noinline]] void* operator new(std::size_t size) {
    const bool limited = dinal::lua::limited();
    if (limited && !dinal::lua::allowed(static_cast<dinal::lua::Bytes>(std::min<std::size_t>(size, 1ULL << 62U)))) {
        dinal::lua::stop_here(dinal::lua::Stop::memory);
        throw std::bad_alloc();
    }
    void* block = plain_malloc(std::max<std::size_t>(size, 1));
    if (block == nullptr) {
        if (limited) dinal::lua::stop_here(dinal::lua::Stop::memory);  // the backstop of the operating system
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
    plain_free(block);
}

[[gnu::noinline]] void operator delete(void* block, std::size_t) noexcept {
    operator delete(block);
}
