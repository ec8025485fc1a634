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

test("a run may end where a function jumps, at t = 0, too", function()
    local run = system { I = 1, k = 0 }:simulate {
        M = function(t) return t / 4 % 1 < 0.5 and 1 or -1 end, velocity0 = 2.5, t_start = -1, t_end = 0, dt = 0.5,
    }
    near(run.velocity[#run], 1.5, 1e-13)
    near(run.theta[#run], 2, 1e-13)
end)

support.finish()
