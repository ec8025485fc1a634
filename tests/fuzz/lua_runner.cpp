#include "fuzz/lua_runner.hpp"

#include <sys/time.h>
#include <unistd.h>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <filesystem>
#include <string>

#include "help/library.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_headers.hpp"
#include "lua/safe_mode.hpp"

namespace {

constexpr std::size_t memory = std::size_t{32} << 20U;
constexpr int milliseconds = 100;  // processor time of this process, as the machine may be busy

extern "C" void on_time(int) {
    dinal::lua::request_stop(dinal::lua::Stop::time);
}

/// An empty folder, in which the code may write. Its output is of no interest.
void prepare() {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / ("dinal-fuzz-" + std::to_string(getpid()));
    fs::create_directories(folder);
    fs::current_path(folder);
    std::atexit([] { fs::remove_all(fs::current_path()); });
    // Not standard error, on which a find is told.
    if (std::getenv("DINAL_FUZZ_PRINT") == nullptr && std::freopen("/dev/null", "w", stdout) == nullptr) {
        std::abort();
    }
    struct sigaction action {};
    action.sa_handler = on_time;
    sigaction(SIGVTALRM, &action, nullptr);
}

void set_timer(int interval) {
    const itimerval timer{{0, 0}, {0, interval * 1000}};
    setitimer(ITIMER_VIRTUAL, &timer, nullptr);
}

int open(lua_State* L) {
    dinal::lua::open_safe_libraries(L);
    dinal::help::open_library(L);
    dinal::lua::set_limits(L, {.memory = memory, .seconds = 0});
    return 0;
}

}  // namespace

void run_stranger(std::string_view code) {
    [[maybe_unused]] static const bool prepared = (prepare(), true);
    if (std::getenv("DINAL_FUZZ_PRINT") != nullptr) {
        std::fprintf(stderr, "%.*s\n", static_cast<int>(code.size()), code.data());
    }
    lua_State* L = luaL_newstate();
    lua_pushcfunction(L, open);
    if (lua_pcall(L, 0, 0, 0) != LUA_OK) {
        std::abort();
    }
    {
        const dinal::lua::InterruptScope armed(L);
        set_timer(milliseconds);
        int status = luaL_loadbufferx(L, code.data(), code.size(), "=fuzz", dinal::lua::load_mode());
        status = status == LUA_OK ? lua_pcall(L, 0, 0, 0) : status;
        set_timer(0);
        if (status < 0) {
            std::abort();  // a C++ exception that no binding caught
        }
    }
    lua_close(L);
}
