// M(t) as a Lua function: rk4 and spectral through sys:simulate{...}, against nothing but the same number of calls.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include "help/library.hpp"
#include "items.hpp"
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
constexpr int functions = 4;

class Script {
public:
    Script() {
        luaL_openlibs(state());
        dinal::help::open_library(state());
        if (luaL_dostring(state(), script) != LUA_OK) {
            failure_ = lua_tostring(state(), -1);
        }
    }
    [[nodiscard]] lua_State* state() const { return state_.get(); }
    [[nodiscard]] const std::string& failure() const { return failure_; }
    /// False, and a failure, when it raises.
    bool simulate_rk4() { return call(2, 0); }
    bool simulate_spectral() { return call(4, 0); }
    bool count(LuaCalls& calls) {
        if (!call(3, 4)) {
            return false;
        }
        calls = {.on_w3 = lua_tonumber(state(), -4),
                 .events_on_w3 = lua_tonumber(state(), -3),
                 .without_events = lua_tonumber(state(), -2),
                 .spectral_on_w3 = lua_tonumber(state(), -1)};
        return true;
    }
    /// The bare cost: argument, call, result, and no more.
    void call_bare(double count) {
        lua_settop(state(), functions);
        lua_State* L = state();
        for (double i = 0; i < count; ++i) {
            lua_pushvalue(L, 1);
            lua_pushnumber(L, i * 0.0005);
            lua_call(L, 1, 1);
            benchmark::DoNotOptimize(lua_tonumber(L, -1));
            lua_pop(L, 1);
        }
    }

private:
    bool call(int which, int results) {
        lua_settop(state(), functions);
        lua_pushvalue(state(), which);
        if (!failure_.empty() || lua_pcall(state(), 0, results, 0) == LUA_OK) {
            return failure_.empty();
        }
        failure_ = lua_tostring(state(), -1);
        return false;
    }

    std::unique_ptr<lua_State, decltype(&lua_close)> state_{luaL_newstate(), lua_close};
    std::string failure_;
};

Script& the_script() {
    static Script one;
    return one;
}

void register_script(const std::string& name, bool (Script::*simulate)()) {
    benchmark::RegisterBenchmark(name.c_str(), [simulate](benchmark::State& state) {
        for ([[maybe_unused]] auto iteration : state) {
            if (!(the_script().*simulate)()) {
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
    register_script(group + "/" + rk4.name, &Script::simulate_rk4);
    const Item& spectral = results.of(group, "spectral on W3, M in Lua");
    register_script(group + "/" + spectral.name, &Script::simulate_spectral);
    Item& bare = results.of(group, "the same number of bare calls");
    bare.per = "call";
    benchmark::RegisterBenchmark((group + "/" + bare.name).c_str(), [&results, &bare](benchmark::State& state) {
        if (bare.count == 0 && !the_script().count(results.lua_calls)) {
            state.SkipWithError(the_script().failure().c_str());
        }
        bare.count = results.lua_calls.on_w3;
        for ([[maybe_unused]] auto iteration : state) {
            the_script().call_bare(bare.count);
        }
    });
}

}  // namespace bench
