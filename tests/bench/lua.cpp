// M(t) as a Lua function: rk4 and spectral through sys:simulate{...}, against nothing but the same number of calls.
#include <benchmark/benchmark.h>

#include <string>

#include "items.hpp"
#include "lua_state.hpp"
#include "workload.hpp"

namespace bench {
namespace {

// Returns M, a function that simulates W3 with it by rk4, one that counts (calls of M on W3, its events, calls in as
// many steps of a motion that no event interrupts, and calls by spectral on W3), and one that takes spectral.
constexpr const char* script = R"(
local w3 = nondimensional{ zeta = 0, friction_ratio = 0.836 }
local frictionless = nondimensional{ zeta = 0 }
local function M(t) return math.sin(2*math.pi*t) end
local function simulate(sys, load, t_end, h)
    return sys:simulate{ M = load, theta0 = 1, t_end = t_end, times = {}, integrator = integrator.rk4{ h = h } }
end
local function exact(load)
    return w3:simulate{ M = load, theta0 = 1, t_end = 1000, times = {} }
end
local function calls(sys, t_end, h)
    local n = 0
    local run = simulate(sys, function(t) n = n + 1; return M(t) end, t_end, h)
    return n, #run.events
end
local function count()
    local n, events = calls(w3, 1000, 1e-3)
    assert(events > 3900, "W3 stops in every half cycle")
    local n_quiet, no_events = calls(frictionless, 0.1, 1e-7)
    assert(no_events == 0, "nothing turns so early")
    local n_spectral = 0
    exact(function(t) n_spectral = n_spectral + 1; return M(t) end)
    return n, events, n_quiet, n_spectral
end
return M, function() simulate(w3, M, 1000, 1e-3) end, count, function() exact(M) end
)";

LuaState& the_script() {
    static LuaState one(script);
    return one;
}

/// False, and a failure, when it raises.
bool count(LuaCalls& calls) {
    LuaState& lua = the_script();
    if (!lua.call(3, 0, 4)) {
        return false;
    }
    calls = {.on_w3 = lua.number(-4),
             .events_on_w3 = lua.number(-3),
             .without_events = lua.number(-2),
             .spectral_on_w3 = lua.number(-1)};
    return true;
}

/// The bare cost: argument, call, result, and no more.
void call_bare(double count) {
    lua_State* L = the_script().get();
    for (double i = 0; i < count; ++i) {
        lua_pushvalue(L, 1);
        lua_pushnumber(L, i * 0.0005);
        lua_call(L, 1, 1);
        benchmark::DoNotOptimize(lua_tonumber(L, -1));
        lua_pop(L, 1);
    }
}

void register_script(const std::string& name, int function) {
    benchmark::RegisterBenchmark(name.c_str(), [function](benchmark::State& state) {
        for ([[maybe_unused]] auto iteration : state) {
            if (!the_script().call(function)) {
                state.SkipWithError(the_script().failure().c_str());
                break;
            }
        }
    });
}

}  // namespace

void register_lua(Results& results) {
    const std::string group(lua_group);
    Item& rk4 = results.of(group, "rk4 on W3, M in Lua");
    rk4.per = "step";
    rk4.count = workloads[2].length / 0.001;
    register_script(group + "/" + rk4.name, 2);
    const Item& spectral = results.of(group, "spectral on W3, M in Lua");
    register_script(group + "/" + spectral.name, 4);
    Item& bare = results.of(group, "the same number of bare calls");
    bare.per = "call";
    benchmark::RegisterBenchmark((group + "/" + bare.name).c_str(), [&results, &bare](benchmark::State& state) {
        if (bare.count == 0 && !count(results.lua_calls)) {
            state.SkipWithError(the_script().failure().c_str());
        }
        bare.count = results.lua_calls.on_w3;
        for ([[maybe_unused]] auto iteration : state) {
            call_bare(bare.count);
        }
    });
}

}  // namespace bench
