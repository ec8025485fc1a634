-- Several events at one instant, exactly at a limit, or closer together than the time resolves.
dofile "tests/lua/support.lua"

local both_engines = { integrator.spectral {}, integrator.rk4 { h = 1e-3 } }
local dry = system { I = 1, k = 40, C = 0.4, Rd = 0.3, Re = 0.45 }

test("events at one instant are reported in the order written, and all their acts take effect", function()
    for _, engine in ipairs(both_engines) do
        local run = expect(dry, { theta0 = 1, t_end = 0.3, dt = 0.3, integrator = engine, events = {
            { name = "log", when = function(t) return t - 0.25 end, act = function() end },
            { name = "double", when = function(t) return 3 * (t - 0.25) end, act = function(t, theta, v) return theta, 2 * v end },
            { name = "more", when = function(t) return 7 * (t - 0.25) end, act = function(t, theta, v) return theta, v + 1 end },
        } }, { events = 3, user = { 0.25, 0.25, 0.25 } })
        equal(table.concat(run.events.name, " "), "log double more")
        near(run.events[3].velocity, 2 * run.events[1].velocity, 1e-9)
        local function at(name, factor) return { name = name, when = function(t, theta) return factor * theta - factor * 0.77 end } end
        run = dry:simulate { theta0 = 1, t_end = 0.2, integrator = engine, events = { at("b", 3), at("a", 1), at("c", 0.1) } }
        equal(table.concat(run.events.name, " "), "b a c")
    end
end)

test("motion that begins after an act has left the mass at rest does not begin with a turn", function()
    local run = expect(dry, { theta0 = 1, t_end = 0.2, dt = 0.2, events = { { when = function(t) return t - 0.05 end, act = function() return -0.5, 0 end } } }, { events = 1 })
    assert(run.velocity[#run] > 0)
end)

test("rk4 treats an instant that differs from the end of its step by rounding as that end", function()
    local M = excitation.sampled(function(t, theta, v) return -8 * theta - 2 * v + 3 end, { every = 0.05, delay = 0.05 })
    local task = { M = M, theta0 = 0.5, t_end = 3, dt = 3 }
    local right = dry:simulate(task) -- arcs between the instants, right to rounding
    for _, h in ipairs { 1e-3, 2e-4 } do
        task.integrator = integrator.rk4 { h = h }
        local steps = dry:simulate(task)
        same_events(steps, right, 20 * h ^ 2) -- a step's cubic, where M jumps within it
        near(steps.theta[2], right.theta[2], h ^ 2)
    end
end)

test("bounces between walls without a gap end the run", function()
    local caught = system { I = 1, k = 0, walls = { lower = 0, upper = 1e-15, restitution = 1 } }:simulate { velocity0 = 1, t_end = 1, dt = 1 }
    has(caught.outcome, "endlessly at one time")
end)

test("a belt or a prescribed velocity that jumps at the end of a run has not yet moved what sticks to it", function()
    local function speed(t) return t % 3 < 1.5 and 0.2 or -0.1 end
    local body = { I = 2, k = 0.1, C = 1, Rd = 2 }
    local cases = {
        { system(body), { belt = speed, velocity0 = 0.2 }, function(run) return run.velocity end },
        { system { bodies = { a = { velocity = speed }, b = body }, links = { l = { "a", "b", rigid = true } } },
            { velocity0 = { b = 0.2 } }, function(run) return run.b.velocity end },
    }
    for _, case in ipairs(cases) do
        local sys, task, velocity = table.unpack(case)
        local begun = sys:simulate(merged(task, { t_end = 1.5 }))
        near(velocity(begun)[#begun.t], 0.2, 1e-15)
        near(begun:energy().total.error, 0, 1e-14)
        local whole, rest = sys:simulate(merged(task, { t_end = 4 })), begun:continue { t_end = 4 }
        near(velocity(rest)[#rest.t], velocity(whole)[#whole.t], 1e-13)
        equal(#rest.events, #whole.events)
    end
end)

test("a belt that requires exactly the torque that sticking holds carries the mass", function()
    for _, belt in ipairs { excitation.ramp { slope = 0.5 }, function(t) return 0.5 * t end } do
        for _, engine in ipairs(both_engines) do
            expect({ I = 1, k = 0, Rd = 0.3, Re = 0.5 }, { belt = belt, t_end = 3, dt = 3, integrator = engine }, { events = 0, theta = 2.25 })
        end
    end
    -- it slides from the start
    expect({ I = 1, k = 0, Rd = 0.3, Re = 0.499999 }, { belt = excitation.ramp { slope = 0.5 }, t_end = 3, dt = 3 }, { theta = 0.3 * 4.5 })
end)

test("events in intervals below the resolution of time are refused", function()
    local function refused(task, option)
        task.t_end, task.dt = 1, 1
        local ok, problem = pcall(dry.simulate, dry, task)
        assert(not ok and tostring(problem):find(option .. " = 1e%-300 is lost in the rounding of times near 1: use at least"), problem)
    end
    local function one() return 1 end
    refused({ M = excitation.sampled(one, { every = 1e-300 }) }, "every")
    refused({ M = excitation.delayed(function(t, theta) return theta end, { by = 1e-300 }) }, "by")
    refused({ M = excitation.square { period = 1e-300 } }, "period")
    refused({ belt = excitation.square { period = 1e-300 } }, "period")
end)

test("a sine that oscillates between two representable times is refused, by every integrator", function()
    for _, engine in ipairs { integrator.exact {}, integrator.spectral {}, integrator.rk4 { h = 0.01 } } do
        for _, M in ipairs { excitation.harmonic { omega = 1e22 }, excitation.half_sine { width = 1 } + excitation.harmonic { frequency = 1e15 } } do
            local ok, problem = pcall(dry.simulate, dry, { M = M, t_end = 10, dt = 1, integrator = engine })
            assert(not ok, problem)
            has(problem, "is lost in the rounding of times near 10: use at most omega = 2.5e+15 (frequency = 4.1e+14), or start nearer to t = 0")
        end
    end
end)

test("a motion that has decayed to nothing does not slow a run down", function()
    local free = system { I = 1, k = 1, Rd = 0.1 }
    local function last(M) return free:simulate { M = M, theta0 = 1, t_end = 10, dt = 10 }.theta[2] end
    near(last(excitation.exponential { tau = 1e-20 }), last(excitation.constant { amplitude = 0 }), 1e-15)
end)

moves("a mass at rest waits for a slow load as long as necessary", { I = 1, k = 1, Rd = 1 }, -- to a few roundings of such a time
    { M = excitation.harmonic { amplitude = 2, omega = 1e-12 }, t_end = math.pi / 6 * 1e12 + 10, dt = 1e12 }, { events = 1, slip = { math.pi / 6 * 1e12 }, within = 2e-15 })

test("a state that does not exist is neither read nor written", function()
    local function states() return { n = { rate = function() return 0 end } } end
    refused { { "dry:simulate { M = function(t, theta, v, z) return z.m end, states = states(), t_end = 1, dt = 1 }", "there is no state 'm'; there is n" } }
    raises(function()
        dry:simulate { theta0 = 1, states = states(), t_end = 1, dt = 1, events = { { when = function(t) return t - 0.5 end, act = function(t, theta, v, z) z.nn = 1 end } } }
    end, "there is no state 'nn'; there is n; did you mean 'n'?")
end)

test("an exponential that outgrows the motion costs few stretches", function()
    local sys = nondimensional { zeta = 0.1, friction_ratio = 0.3 }
    local M = excitation.exponential { tau = -0.02, amplitude = 1e-3 }
    -- All but the forced part is e^-100 of it; friction and the rounding of t in the exponent: 100 eps.
    local forced = 1e-3*math.exp(100)/(sys.I/0.02^2 + sys.C/0.02 + sys.k)
    for _, method in ipairs { integrator.exact {}, integrator.spectral {} } do
        local run = sys:simulate { M = M, t_end = 2, dt = 2, integrator = method }
        near(run.theta[2]/forced, 1, 1e-12)
    end
    -- The exponential itself is a number where exp(x) is none, and nothing times any of them is nothing.
    near(excitation.exponential { amplitude = 1e-300, tau = -1 }(750)/(math.exp(375)*1e-300*math.exp(375)), 1, 1e-14)
    -- It comes to an end where M does.
    local run = sys:simulate { M = M, t_end = 1e9, dt = 1e8 }
    assert(#run == 1, run.outcome)
    has(run.outcome, "finite")

end)

test("a turn within the rounding of the start is no event", function()
    for _, by in ipairs { integrator.exact {}, integrator.spectral {}, integrator.rk4 { h = 0.01 }, integrator.dopri5 { tolerance = 1e-9 } } do
        for t_start, velocity0 in pairs { [1] = 1e-17, [1e9] = 1e-9 } do
            local run = system { I = 1, k = 1 }:simulate { theta0 = 1, velocity0 = velocity0, t_start = t_start, t_end = t_start + 3, integrator = by }
            equal(#run.events, 0, tostring(by))
        end
    end
end)

test("a step of M at the end of a step of rk4 acts from there on", function()
    local sys, options = system { I = 1, k = 4, C = 0.1, Rd = 0.1 }, { M = excitation.step { at = 1, amplitude = 2 }, theta0 = 0.5, t_end = 5, dt = 0.5 }
    local exact = sys:simulate(options)
    near(sys:simulate(merged(options, { integrator = integrator.rk4 { h = 0.01 } })).theta, exact.theta, 1e-7)
end)

test("an event right at the end of a run is reported once, by every integrator, and not again by the continued run", function()
    local function kinds(run, from)
        local told = {}
        for _, event in ipairs(run.events) do
            if event.t >= from then told[#told + 1] = event.kind end
        end
        return table.concat(told, " ")
    end
    local function go(sys, task, methods, wanted, later)
        for _, method in ipairs(methods) do
            local run = sys:simulate(merged(task, { integrator = method }))
            equal(kinds(run, 0), wanted, tostring(method))
            equal(kinds(run:continue { t_end = task.t_end + 0.1 }, task.t_end + 1e-6), later or "", tostring(method))
        end
    end
    local general = { integrator.rk4 { h = 0.01 }, integrator.spectral {} }
    local all = { integrator.exact {}, table.unpack(general) }
    local still, flat = system { I = 1, k = 1, Rd = 0.2 }, system { I = 1, k = 0, Rd = 0.5 }
    -- These are exact in each: constant torques. A time such as 0.3 is rounded, so that the stop may be behind it.
    for _, t in ipairs { 2, 0.3, 1 / 3, 0.7 } do
        go(flat, { velocity0 = t / 2, t_end = t }, general, "rest")
        go(flat, { velocity0 = t * 1.25, M = -0.75, t_end = t }, general, "turn")
        local user = { { when = function(at) return at - t end } }
        go(flat, { velocity0 = t / 2, t_end = t, events = user }, general, "rest user")
        go(still, { theta0 = 0.9, t_end = t, events = user }, general, "user")
        go(still, { theta0 = 0.9, t_end = t, events = { { when = user[1].when, stop = true } } }, general, "user")
        for direction, told in pairs { up = "user", down = "" } do
            go(still, { theta0 = 0.9, t_end = t, events = { { when = user[1].when, direction = direction } } }, general, told)
        end
        -- A release is the first moment of a slip: the run that goes on tells it.
        go(flat, { M = function(at) return 0.5 / t * at end, t_end = t, events = user }, general, "user")
    end
    go(still, { theta0 = 0.5, t_end = math.pi }, { integrator.exact {}, integrator.spectral {} }, "rest")
    go(still, { theta0 = 0.9, t_end = math.pi }, { integrator.exact {}, integrator.spectral {} }, "turn")
    go(still, { M = excitation.step { at = 2, amplitude = 1 }, t_end = 2 }, all, "")
    -- One that stays at zero has not passed it.
    go(flat, { velocity0 = 1, t_end = 2, events = { { when = function(_, _, v) return v end } } }, general, "rest")
end)

test("the last row shows the contacts after a jump of M at t_end, and nothing is reported of later times", function()
    local own, jump = { I = 1, k = 1, Rd = 0.3, Re = 0.5 }, function(t) return t < 2 and 0 or 5 end
    local one, several = system(own), system { bodies = { a = own, b = { I = 2 } }, links = { l = { "a", "b", Rd = 1 } } }
    for _, method in ipairs { integrator.exact {}, integrator.spectral {}, integrator.rk4 { h = 0.01 } } do
        for _, M in ipairs { excitation.step { at = 2, amplitude = 5 }, jump } do
            local run = one:simulate { M = M, t_end = 2, integrator = method }
            equal(run.friction[#run], -0.3, tostring(method))
            near(run.acceleration[#run], 4.7, 1e-14)
            equal(run.status, "stuck")
        end
    end
    -- The link still holds 2/3 of 5 - 0.3.
    several = several:with { links = { l = { Rd = 4 } } }
    local run = several:simulate { M = { a = jump }, t_end = 2 }
    equal(run.a.friction[#run], -0.3)
    near(run.l.torque[#run], -2 / 3 * 4.7, 1e-14)
    -- A function of Lua that has not jumped yet is not constant.
    for T, status in pairs { [1.5] = "stuck", [2] = "stuck" } do equal(one:simulate { M = jump, t_end = T }.status, status) end
    has_not(one:simulate { M = jump, t_end = 1.5 }:explain(), "constant", "stays at rest")
end)

test("a run that ends within rounding of a release does not report that the contact stopped again", function()
    local rig = system { bodies = { a = { I = 1 }, b = { I = 1, k = 0.4, Rd = 0.1, Re = 0.2 } }, links = { l = { "a", "b", Rd = 0.2, Re = 0.4 } } }
    local M = { a = excitation.harmonic { amplitude = 0.8, omega = 0.8 } }
    local events, tried = rig:simulate { M = M, t_end = 20 }.events, 0
    for i, event in ipairs(events) do
        while events[i + 1] and events[i + 1].t == event.t do i = i + 1 end
        for roundings = 1, event.kind == "slip" and 16 or 0 do
            local run = rig:simulate { M = M, t_end = event.t * (1 + roundings * 2.2e-16), times = {} }
            assert(#run.events <= i, roundings)
            tried = tried + 1
        end
    end
    assert(tried > 20, tried)
end)

finish()
