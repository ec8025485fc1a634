-- Functions of t whose pieces are sums of native terms.
package.path = "tests/lua/?.lua;" .. package.path
local support = require "support"
local test, near, equal, unread = support.test, support.near, support.equal, support.unread

test("pieces that are sums of native terms run by exact, and what repeats knows its period", function()
    local sys = system { I = 1, k = 5, Rd = 0.3, Re = 0.35 }
    local cases = {
        { function(t) return t % 2 < 1 and 1 or -1 end, 2 },
        { function(t) return t % 2 < 0.7 and 2 or t % 2 < 1.1 and 0.5 or -1 end, 2 },
        { function(t) return math.floor(t / 0.5) % 3 end, 1.5 },
        { function(t) return math.max(0, math.sin(3 * t)) end, 2 * math.pi / 3 },
        { function(t) return math.abs(math.sin(t)) + (t % 1 < 0.5 and 0.5 or 0) * 0 end },
        { function(t) if t < 1 then return t elseif t < 3 then return math.sin(t) end return 2 * math.exp(3 - t) end },
        { function(t) return t < 0.5 and 1 or 0 end },
    }
    for i, case in ipairs(cases) do
        local f, period = case[1], case[2]
        local function run(M, t_end) return sys:simulate { M = M, t_start = -1, t_end = t_end or 20, dt = 0.1, theta0 = 0.5 } end
        local found, sampled = run(f), run(unread(f))
        equal(tostring(found.integrator), "integrator.exact{}")
        equal(#found.events, #sampled.events, "function " .. i)
        near(found.theta, sampled.theta, 1e-9)
        near((run(f, 8):continue { t_end = 20 }:at(20)), (found:at(20)), 1e-13)
        if period then
            local s = sys:steady { M = f }
            near(s.period / period - math.floor(s.period / period + 0.5), 0, 1e-12)
            near(s.amplitude, sys:steady { M = unread(f), period = period }.amplitude, 1e-8)
        end
    end
end)

support.finish()
