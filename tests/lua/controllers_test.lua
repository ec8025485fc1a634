-- Controllers with a held output: between their instants and switches the motion is a damped oscillation about a place.
dofile "tests/lua/support.lua"

test("between the instants of a sampled controller exact and spectral agree, at every damping", function()
    local hair = 1e-12
    for name, p in pairs{
        dry = {}, undamped = { C = 0 }, late = { every = 0.25, delay = 0.1 }, later = { every = 0.2, delay = 0.31, P = 0.2 },
        below = { C = 2 - 2*hair, P = 3 }, critical = { C = 2, P = 3 }, above = { C = 2 + 2*hair, P = 3 }, far = { C = 9, P = 3 },
        block = { k = 0, every = 0.21 }, glider = { k = 0, C = 0 }, even = { Rd = 0.1, Re = 0.1 }, free = { Rd = 0, Re = 0 },
        slow = { every = 5.3, delay = 1.1 }, beside = { M = excitation.harmonic{ omega = 0.7, amplitude = 0.8 } },
    } do
        local P, D = p.P or 0.5, 0.2
        local sys = system{ I = 1, k = p.k or 1, C = p.C or 0.1, Rd = p.Rd or 0.05, Re = p.Re or 0.08 }
        local function run(states)
            local M = excitation.sampled(function(t, theta, v) return -P*theta - D*v end, { every = p.every or 0.17, delay = p.delay })
            return sys:simulate{ M = p.M and p.M + M or M, theta0 = 1, velocity0 = -0.6, t_end = 15, dt = 0.0917, states = states }
        end
        local arcs, panels = run(), run{ idle = { rate = function() return 0 end } }
        equal(arcs.outcome, panels.outcome, name)
        same_events(panels, arcs, 1e-9, name)
        near(arcs.theta, panels.theta, 1e-11)
    end
end)

test("a sampled controller is called once an instant, in order, and its output is delayed", function()
    local asked = {}
    local M = excitation.sampled(function(t) asked[#asked + 1] = t return t < 3 and 0.2*(1 + t) or -0.9 end, { every = 1, delay = 0.25 })
    -- 0.6, which passes Re, comes at t = 2.25; -0.9 at 3.25, when the velocity is 0.5.
    local run = expect({ I = 1, k = 0, Rd = 0.1, Re = 0.5 }, { M = M, t_end = 4.5, dt = 0.5 }, { slip = { 2.25 }, turn = { 3.75 }, within = 1e-14, parts = false })
    equal(table.concat(asked, " "), "0.0 1.0 2.0 3.0 4.0")
    near(run.events[2].theta, 0.375, 1e-14)
end)

test("outputs that are delayed by several intervals arrive one after the other", function()
    expect({ I = 1, k = 1 }, { M = excitation.sampled(function(t) return t end, { every = 0.5, delay = 1.2 }), t_end = 4, times = vector.range(0.1, 3.9, 0.25) },
        { M = function(t) return math.max(0, (t - 1.2) // 0.5 * 0.5) end })
end)

test("a stiff state, the lag of an actuator, costs no accuracy", function()
    -- On the motion cos(t) the lagged -velocity/2 is u = sin(t)/2, and the sine beside it closes the equation of motion.
    local lag = 6e-4  -- 1e-4 T0
    expect({ I = 1, k = 1, C = 0.1 }, { theta0 = 1, t_end = 20, dt = 0.5, M = function(t, theta, velocity, z) return z.u - 0.6*math.sin(t) end,
        states = { u = { rate = function(t, theta, velocity, z) return (-0.5*velocity - z.u)/lag + 0.5*math.cos(t) end } } },
        { theta = math.cos, u = function(t) return math.sin(t) / 2 end, within = 1e-10 })
end)

test("after a very short transient the run continues at normal speed", function()
    for _, lag in ipairs { 1e-3, 1e-6, 1e-9 } do
        local calls = 0
        -- u = cos t + exp(-t/lag)
        expect({ I = 1, k = 0 }, { t_end = 3, dt = 3, M = function(_, _, _, z) return z.u end,
            states = { u = { start = 2, rate = unread(function(t, _, _, z) calls = calls + 1 return (math.cos(t) - z.u)/lag - math.sin(t) end) } } },
            { u = math.cos(3), velocity = math.sin(3) + lag, theta = 1 - math.cos(3) + 3*lag - lag^2, within = 1e-14, closes = false, parts = false })
        assert(calls < 6000, calls)
    end
end)

test("a run that begins later meets the instants that follow, and a relay switches at the start only beyond its threshold", function()
    local at = {}
    local M = excitation.sampled(function(t) at[#at + 1] = t return 0 end, { every = 0.3, at = 0.1 })
    system { I = 1, k = 1 }:simulate { M = M, t_start = 0.65, t_end = 1.5 }
    near(vector(at), vector { 0.7, 1, 1.3 }, 1e-12)
    for _, start in ipairs { "on", "off" } do
        local relay = excitation.relay { on = -0.1, off = 0.1, amplitude = 1, of = "theta", start = start }
        local run = system { I = 1, k = 4 }:simulate { M = relay, theta0 = 1, t_end = 0.1, dt = 0.1 }
        equal(run.M[1], -1.0)
        equal(#run.events, 0)
        equal(system { I = 1, k = 4 }:simulate { M = relay, theta0 = 0.05, t_end = 0.01 }.M[1], start == "on" and 1.0 or -1.0)
    end
end)

test("a relay whose level is the place of a wall is switched by every impact there", function()
    for start = 0, 40 do -- at other times, other roundings of the impact
        local run = system { I = 1, k = 0.7, Rd = 0.05, walls = { upper = 0.3, restitution = 0.8 } }
            :simulate { M = excitation.relay { on = -0.2, off = 0.3, amplitude = 1, of = "theta" }, theta0 = -0.1, t_start = start / 7, t_end = start / 7 + 12 }
        local met = 0
        for i, event in ipairs(run.events) do
            if event.kind == "impact" then
                met = met + 1
                equal(run.events[i - 1].kind, "switch")
                equal(run.events[i - 1].t, event.t)
            end
        end
        assert(met > 2)
    end
end)

finish()
