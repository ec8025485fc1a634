// Systems with states, belts and several bodies, and the cost of an M as a Lua function that is not smooth: a row is
// one script.
#include <benchmark/benchmark.h>

#include <memory>
#include <string>

#include "items.hpp"
#include "lua_state.hpp"

namespace bench {

// A script returns the function that is timed and how many of what `per` names it does. Where calls are counted, the
// function returns their number.
const std::vector<LuaRow>& lua_rows() {
    static const std::vector<LuaRow> rows = {
        {"a PID's integral as a state", "T0", 40, Figure::microseconds, R"(
local sys = system{ I = 1, k = 4*math.pi^2, C = 1, Rd = 1, Re = 1.2 }
local function error_of(t, theta) return math.sin(3*t) - theta end
local function M(t, theta, velocity, z) return 40*(math.sin(3*t) - theta) - 4*velocity + 30*z.e end
local states = { e = { start = 0, rate = error_of } }
return function() sys:simulate{ M = M, states = states, t_end = 100, times = {} } end, 100)"},
        {"a belt under Stribeck's law", "T0", 100, Figure::microseconds, R"(
local sys = system{ I = 1, k = 4*math.pi^2, C = 0.1, friction = friction.stribeck{ Rd = 2, Re = 4, speed = 0.5 } }
return function() sys:simulate{ belt = 0.3, t_end = 100, times = {} } end, 100)"},
        {"asymmetric friction", "T0", 100, Figure::microseconds, R"(
local sys = system{ I = 1, k = 4*math.pi^2, C = 0.1,
    friction = friction.asymmetric{ forward = { Rd = 1, Re = 1.5 }, backward = { Rd = 2, Re = 2 } } }
local M = excitation.harmonic{ amplitude = 20, frequency = 0.7 }
return function() sys:simulate{ M = M, t_end = 100, times = {} } end, 100)"},
        {"a friction law as a table", "T0", 100, Figure::microseconds, R"(
local sys = system{ I = 1, k = 4*math.pi^2, C = 0.1,
    friction = friction.table{ speed = { 0, 1, 3, 10 }, torque = { 2, 1.5, 1.8, 4 }, Re = 2.5 } }
local M = excitation.harmonic{ amplitude = 20, frequency = 0.7 }
return function() sys:simulate{ M = M, t_end = 100, times = {} } end, 100)"},
        {"a controller of 100 samples", "T0", 150, Figure::microseconds, R"(
local sys = system{ I = 1, k = 4*math.pi^2, C = 1, Rd = 1, Re = 1.2 }
local sum = 0
local function law(t, theta)
    local e = math.sin(3*t) - theta
    sum = sum + 0.01*e
    return 40*e + 30*sum
end
return function()
    sum = 0
    sys:simulate{ M = excitation.sampled(law, { every = 0.01 }), t_end = 100, times = {} }
end, 100)"},
        {"a relay", "switch", 3, Figure::microseconds, R"(
local sys = system{ I = 1, k = 4*math.pi^2, C = 1, Rd = 1, Re = 1.2 }
local M = excitation.relay{ on = -0.01, off = 0.01, amplitude = { 10, -10 } }
local function run() return sys:simulate{ M = M, t_end = 100, times = {} } end
local switches = 0
for _, event in ipairs(run().events) do if event.kind == "switch" then switches = switches + 1 end end
assert(switches > 100, "a relay that switches")
return run, switches)"},
        {"a run of three rows (W2)", "run", 3, Figure::microseconds, R"(
local sys = nondimensional{ zeta = 0, friction_ratio = 0.167 }
return function()
    for _ = 1, 1000 do sys:simulate{ velocity0 = 2*math.pi, t_end = 3, dt = 1.5 } end
end, 1000)"},
        {"a sine of 16 bits over 10 T0", "run", 1, Figure::seconds, R"(
local sys = nondimensional{ zeta = 0.05, friction_ratio = 0.2 }
local function M(t) return math.floor(math.sin(2*math.pi*0.7*t)*32768 + 0.5)/32768 end
return function() sys:simulate{ M = M, t_end = 10, times = {} } end, 1)"},
        {"a jump unannounced against announced", "jump", 70, Figure::calls, R"(
local sys = nondimensional{ zeta = 0.05, friction_ratio = 0.2 }
local function calls_of(at, breaks)
    local calls = 0
    local function M(t)
        calls = calls + 1
        return 0.9*math.sin(2*t) + (t < at and 0 or 0.3)
    end
    sys:simulate{ M = excitation.scripted(M, { breaks = breaks }), t_end = 10, times = {} }
    return calls
end
return function()
    local more = 0
    for i = 1, 20 do
        local at = 0.5 + 0.4317*i
        more = more + calls_of(at, {}) - calls_of(at, { at })
    end
    return more
end, 20)"},
        {"a staircase of equal steps", "step", 40, Figure::calls, R"(
local sys = nondimensional{ zeta = 0.05, friction_ratio = 0.2 }
return function()
    local calls = 0
    local function M(t)
        calls = calls + 1
        return math.floor(t/0.0371)*0.0371
    end
    sys:simulate{ M = M, t_end = 10, times = {} }
    return calls
end, 10 // 0.0371)"},
    };
    return rows;
}

void register_systems(Results& results) {
    for (const LuaRow& row : lua_rows()) {
        Item& item = results.of(std::string(systems_group), std::string(row.name));
        const auto own = std::make_shared<LuaState>(row.script);
        item.per = row.per;
        item.count = own->failure().empty() ? own->number(2) : 1;
        benchmark::RegisterBenchmark((item.group + "/" + item.name).c_str(),
                                     [own, &item, &row](benchmark::State& state) {
                                         for ([[maybe_unused]] auto iteration : state) {
                                             if (!own->call(1, 0, 1))
                                                 return state.SkipWithError(own->failure().c_str());
                                         }
                                         if (row.figure == Figure::calls) item.calls = own->number(-1);
                                     });
    }
}

}  // namespace bench
