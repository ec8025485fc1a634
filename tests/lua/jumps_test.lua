-- What jumps while a run goes on: a belt that is a function, a velocity at a wall, and what stands at the instant of it.
package.path = "tests/lua/?.lua;" .. package.path
local support = require "support"
local test, near, equal = support.test, support.near, support.equal

-- A jump that nobody announced is found to 1e-13 of a run of some time units.
local found = 1e-11

local function kinds(run)
    local list = {}
    for _, e in ipairs(run.events) do list[#list + 1] = e.kind end
    return table.concat(list, " ")
end

test("a switch that stops a mass at its turn is followed by a stick", function()
    -- It comes up under -1 and would go back; the relay that looks at its velocity then pulls with 0.3 < Re.
    local run = system { I = 1, k = 0, Rd = 0.5 }:simulate {
        M = excitation.relay { on = 0, off = 0.25, levels = { 0.3, -1 }, of = "velocity", start = "off" },
        velocity0 = 1.5, t_end = 3, dt = 1,
    }
    equal(kinds(run):gsub("rest", "stick"), "turn switch stick")
    near(run.events[3].t, 1, 1e-14)
    near(run.theta[#run], 0.75, 1e-14)
end)

test("a run may end where a function jumps, at t = 0, too", function()
    local run = system { I = 1, k = 0 }:simulate {
        M = function(t) return t / 4 % 1 < 0.5 and 1 or -1 end, velocity0 = 2.5, t_start = -1, t_end = 0, dt = 0.5,
    }
    near(run.velocity[#run], 1.5, 1e-13)
    near(run.theta[#run], 2, 1e-13)
end)

support.finish()
