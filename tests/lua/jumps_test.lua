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

test("a belt that is a function and jumps past the mass turns the sliding round, and moves nothing at once", function()
    local run = system { I = 1, k = 0, Rd = 0.25 }:simulate {
        belt = function(t) return t < 1 and 1 or -1 end, t_end = 3, dt = 0.5,
    }
    equal(kinds(run), "turn")
    near(run.events[1].t, 1, found)
    near(run.theta[#run], 0.125, found)
    near(run.velocity[#run], -0.25, found)
    near(select(2, run:at(1)), 0.25, found)
    assert(run:energy().total.closure < 1e-11)
end)

test("a belt that is a function and jumps leaves behind what stood on it", function()
    local run = system { I = 1, k = 0, Rd = 0.25 }:simulate {
        belt = function(t) return t < 1 and 0.5 or -0.5 end, velocity0 = 0.5, t_end = 2, dt = 0.5,
    }
    equal(kinds(run), "slip")
    near(run.velocity[#run], 0.25, found)
    near(run.theta[#run], 0.5 + 0.5 - 0.125, found)
    assert(run:energy().total.closure < 1e-11)
end)

test("a jump of a belt that is still ahead lets nothing go", function()
    local run = system { I = 1, k = 0, Rd = 0.25 }:simulate {
        belt = function(t) return t < 2.1 and 0.5 or -0.5 end, t_end = 3, dt = 0.5,
    }
    equal(kinds(run), "stick slip")
    near(run.events[1].t, 2, 1e-12)
    near(run.events[2].t, 2.1, found)
    near(run.velocity[#run], 0.5 - 0.25 * 0.9, found)
end)

test("a belt with kinks where it is zero is followed in no time", function()
    local asked = 0
    local run = system { I = 1, k = 0, Rd = 0.1 }:simulate {
        belt = function(t)
            asked = asked + 1
            assert(asked < 1e5)
            return 0.5 * math.abs(math.sin(math.pi * t))
        end,
        velocity0 = 2, t_start = 1, t_end = 8, dt = 1,
    }
    near(run.theta[#run], 2 * 7 - 0.05 * 49, found)
end)

test("without dry friction a belt is as none, and no turn is told where the mass starts", function()
    local run = system { I = 1, k = 1 }:simulate { belt = 0.5, theta0 = -0.5, t_end = 4, dt = 1 }
    equal(kinds(run), "turn")
    near(run.events[1].t, math.pi, 1e-14)
end)

test("a belt that sets off along a wall takes a mass from it, by sliding or by sticking", function()
    local sys = system { I = 2, k = 0, Rd = 0.5, Re = 0.75, walls = { lower = 0, upper = 1, restitution = 0.5 } }
    for rate, theta in pairs { [1] = 0.125, [0.1] = 0.05 } do -- slower than the belt, or as it goes
        for _, belt in ipairs { function(t) return rate * t end, excitation.ramp { slope = rate } } do
            local run = sys:simulate { belt = belt, t_end = 1, dt = 1 }
            equal(#run.events, 0)
            near(run.theta[#run], theta, 1e-12)
        end
    end
    -- Towards the wall it lets go what only sticking held: 0.6 - 0.5 pulls 2.
    local into = sys:simulate { belt = function(t) return -t end, M = 0.6, t_end = 1, dt = 1 }
    near(into.theta[#into], 0.1 / 2 / 2, 1e-12)
    equal(sys:simulate { belt = function(t) return -t end, M = 0.4, t_end = 1, dt = 1 }.theta[2], 0)
end)

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
