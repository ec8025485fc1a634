-- What rounding decides is the same whether or not a run has something idle in it: an event that never comes.
dofile "tests/lua/support.lua"

local never = { { when = function(_, theta) return theta - 1e6 end } }

--- The run as it is, and with the idle event.
local function both(sys, options)
    options.integrator = integrator.spectral {}
    local plain = sys:simulate(options)
    options.events = never
    return plain, sys:simulate(options)
end

test("theta0 = Re/k stays, for any k", function()
    for i = 1, 500 do
        local Re, k = 0.1 + 0.9 * i / 500, 1 + 0.0137 * i
        local run = system { I = 1, k = k, Rd = Re }:simulate { theta0 = (i % 2 == 0 and 1 or -1) * Re / k, t_end = 1, dt = 1, events = never }
        equal(#run.events, 0, i)
        equal(run.theta[2], run.theta[1], i)
    end
end)

test("a decay whose last extreme is Re/k ends there", function()
    for _, k in ipairs { 1, 4, 2.5 } do
        for _, ratio in ipairs { 1, 1.5, 3 } do
            for n = 1, 4 do
                local Rd = 0.1
                local Re = ratio * Rd
                local sys = system { I = 1, k = k, Rd = Rd, Re = Re }
                local run = sys:simulate { theta0 = (Re + 2 * n * Rd) / k, t_end = 10 * sys.T0, events = never }
                equal(#run.events, n, ("k = %g, Re = %g"):format(k, Re))
                near(run.events[n].t / sys.T0, 0.5 * n, 1e-12)
            end
        end
    end
end)

test("a block drawn with Re = Rd only touches velocity zero", function()
    for _, k in ipairs { 4000, 1, 37.5 } do
        local sys = system { I = 10, k = k, Rd = 0.3 }
        local starts = 0.3 / (k / 3)
        local plain, idle = both(sys, { M = excitation.ramp { slope = k / 3 }, t_end = starts + 9.4 * sys.T0 })
        equal(#plain.events, 1, k)
        same_events(idle, plain, 1e-12 * (starts + sys.T0))
    end
end)

test("a jump of M at the very end is not asked for, and is when the run goes on", function()
    local sys = nondimensional { friction_ratio = 0.2, breakaway_ratio = 0.3 }
    local plain, idle = both(sys, { M = excitation.step { amplitude = 0.9, at = 5 }, theta0 = 1, t_end = 5 })
    equal(idle.events[#idle.events].kind, "stick")
    same_events(idle, plain, 1e-12)
    same_events(idle:continue { t_end = 7 }, plain:continue { t_end = 7 }, 1e-12)
end)

test("of a feedback that chatters the first events are told", function()
    local M = unread(function(t, _, velocity) return 0.2 * math.sin(t) - 0.5 * (velocity > 0 and 1 or velocity < 0 and -1 or 0) end)
    local run = nondimensional { zeta = 0.05 }:simulate { M = M, theta0 = 1, t_end = 20, events = never }
    has(run.outcome, "switched endlessly")
    assert(#run.events <= 4, #run.events)
end)

finish()
