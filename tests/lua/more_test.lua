-- Runs with states, events, belts, bases and controllers with a memory.
dofile "tests/lua/support.lua"

local block = system { I = 1, k = 0, Rd = 0.3, Re = 0.5 }
local function pid(more)
    return merged({
        M = function(t, theta, velocity, z) return 8 * (1 - theta) - 2 * velocity + 3 * z.e end,
        states = { e = { start = 0, rate = function(t, theta) return 1 - theta end } },
        t_end = 10,
        dt = 0.5,
    }, more)
end

test("states are columns of the run, of its file, of run:at, and of plots", function()
    local run = block:simulate(pid())
    equal(#run.states.e, #run)
    equal(run.states.e[1], 0.0)
    equal(run.e, run.states.e)
    refused { { "run.states.E", "run.states has no 'E', only e; did you mean 'e'?" } }
    equal(table.concat(run.names, " "), "t theta velocity M friction damping e")
    local theta, velocity, z = run:at(run.t[7])
    near(z.e, run.e[7], 1e-13)
    near(theta, run.theta[7], 1e-13)
    near(run.M[7], 8 * (1 - run.theta[7]) - 2 * run.velocity[7] + 3 * run.e[7], 1e-12)
    local again = reloaded(run)
    equal(again.e[7], run.e[7])
    equal(again.states.e, run.states.e)
    refused { { "again.states.E", "run.states has no 'E', only e; did you mean 'e'?" } }
    assert(run:plot { y = "e", show = false })
    says(run, "feedback")
    assert(run:energy().total.closure < 1e-11)
end)

test("a continued run calls a sampled function once at each instant, as the whole run does", function()
    local calls = 0
    local function task(t_end)
        return { M = excitation.sampled(function(t, theta) calls = calls + 1 return 1 - theta + 0.01 * calls end, { every = 0.1 }), t_end = t_end, dt = 0.1 }
    end
    local whole = block:simulate(task(3))
    equal(calls, 31)
    calls = 0
    local both = block:simulate(task(1.23)):continue { t_end = 3 }
    equal(calls, 31)
    near(both.theta, whole.theta, 1e-12)
end)

test("events have names, are reported once, and stop the run or act", function()
    local swing = system { I = 1, k = 1 }
    local bounces = 0
    local run = swing:simulate {
        velocity0 = 1, t_end = 20, dt = 0.1,
        events = {
            { when = function(t, theta) return theta - 0.5 end, name = "wall", direction = "up",
                act = function(t, theta, velocity) bounces = bounces + 1 return theta, -velocity end },
            { when = function(t) return t - 15 end, stop = true, name = "enough" },
        },
    }
    equal(run.outcome, "stopped at an event")
    near(run.t_end, 15, 1e-13)
    equal(run.events[#run.events].name, "enough")
    local first = run.events[1]
    equal(first.kind, "user")
    equal(first.name, "wall")
    near(first.t, math.asin(0.5), 1e-13)
    near(first.velocity, math.cos(math.asin(0.5)), 1e-12)
    -- Half a swing below the wall between two of them: pi + 2 asin 0.5.
    equal(bounces, 1 + math.floor((15 - math.asin(0.5)) / (math.pi + 2 * math.asin(0.5))))
    near(run:energy().total.error, 0, 1e-12)
    assert(run.theta:max() <= 0.5)
end)

test("the header of a file repeats the direction of events, and which of them stops the run", function()
    for _, direction in ipairs { "up", "down", "both" } do
        local run = system { I = 1, k = 1 }:simulate { theta0 = 1, t_end = 20, dt = 0.5, events = {
            { when = function(t, theta) return theta - 0.5 end, direction = direction, name = "seen" },
            { when = function(t) return t - 15 end, stop = true } } }
        same_events(repeated(run), run, 0)
    end
end)

test("an act changes states through z", function()
    local run = block:simulate {
        states = { n = { rate = function() return 0 end } }, velocity0 = 1, t_end = 3, dt = 1,
        events = { { when = function(t, theta) return theta - 0.5 end, act = function(t, theta, velocity, z) z.n = z.n + 7 end } },
    }
    equal(run.n[#run], 7.0)
end)

test("errors in a rate, an event or a sampled function name it, and the rows are kept", function()
    local function fails(task, pattern)
        local ok, problem = pcall(block.simulate, block, task)
        assert(not ok and tostring(problem):find(pattern), problem)
        return dinal.partial
    end
    local rate = function(t) return t < 4 and 1 or nil end
    local partial = fails(pid { states = { e = { rate = rate } } }, "states%.e%.rate returned nil at t = 4")
    assert(#partial >= 8)
    fails(pid { states = { e = { rate = function() error "no rate" end } } }, "no rate")
    fails(pid { states = { e = { rate = coroutine.yield } } }, "states%.e%.rate")
    partial = fails({ M = excitation.sampled(function(t) return t < 0.95 and 1 or "x" end, { every = 0.1 }), t_end = 2, dt = 0.1 },
        "the sampled function returned the string \"x\" at t = 1")
    assert(#partial >= 9)
    fails({ t_end = 1, dt = 0.1, velocity0 = 1, events = { { when = function(t) return t > 0.5 and {} or 1 end } } }, "events%[1%]%.when returned a table")
    fails({ t_end = 1, dt = 0.1, velocity0 = 1, events = { { when = function(t) return t - 0.5 end, act = function() return 1 end } } },
        "events%[1%]%.act returned 1 and nil at t = 0%.5; it must return theta and velocity")
    local states, act = { e = { rate = function() return 0 end } }, function(t, theta, velocity, z) z.e = 1 / 0 end
    fails({ t_end = 1, states = states, events = { { when = function(t) return t - 0.5 end, act = act } } }, "act gave a state a value that is not a finite number at t = 0%.5")
end)

test("each mistake is one sentence with the name of the option", function()
    refuses(function(more) block:simulate(pid(more)) end, {
        { { states = 3 }, "states must be a table such as" },
        { { states = { e = 3 } }, "states.e must be a table such as" },
        { { states = { theta = { rate = math.sin } } }, "'theta' is a name that a run has already" },
        { { states = { ["a b"] = { rate = math.sin } } }, "'a b' is not a name" },
        { { states = { e = { start = 1 } } }, "states.e needs rate" },
        { { states = { e = { rate = 3 } } }, "states.e: rate must be a function of t, theta, velocity, z, got 3" },
        { { states = { e = { start = "x", rate = math.sin } } }, "states.e: start must be a finite number" },
        { { states = { e = { rat = math.sin } } }, "states.e has no option 'rat' among start and rate; did you mean 'rate'?" },
        { { events = 3 }, "events must be a list such as" },
        { { events = { {} } }, "events[1] needs when" },
        { { events = { when = math.sin } }, "each event has braces of its own" },
        { { events = { { when = math.sin, direction = "left" } } }, "events[1]: direction must be 'up', 'down' or 'both'" },
        { { events = { { when = math.sin, stop = 1 } } }, "events[1]: stop must be true or false" },
        { { events = { { when = math.sin, act = 1 } } }, "events[1]: act must be a function" },
        { { belt = function(t, theta) return theta end }, "belt must be a number, an excitation or a function of t alone" },
        { { integrator = integrator.dinal1989 { h = 0.1 }, belt = 1 }, "integrator.dinal1989" },
        { { M = excitation.relay { on = 1, off = 2, amplitude = { 1, 2 }, of = "heat" } }, "M: the relay looks at 'heat'; in this run it may look at theta, velocity" },
    })
    refused { { "excitation.sampled(3, { every = 1 })", "excitation.sampled takes a function of t, theta, velocity, z, got 3" } }
    refuses(excitation.relay, {
        { { on = 1, off = 1, amplitude = { 1, 2 } }, "on = 1 and off = 1 must differ" },
        { { on = 1, off = 2, amplitude = { 1 } }, "amplitude must be a number, or two: { on, off }, got 1" },
    })
    local sampled = excitation.sampled(math.sin, { every = 1 })
    refused {
        { "sampled(1)", "a controller with a memory has values in a run only" },
        { "sampled:delay(1)", "cannot be delayed" },
    }
end)

test("an error in the function of a belt or a base arrives unchanged, with the rows until then", function()
    for _, what in ipairs { "belt", "base" } do
        for _, method in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.01 } } do
            for _, late in ipairs { 0, 2 } do
                local options = { theta0 = 1, t_end = 5, dt = 0.1, integrator = method }
                options[what] = function(t) if t >= late then error("no " .. what) end return 0.1 end
                local sys = nondimensional { zeta = 0.05, friction_ratio = 0.1 }
                raises(function() sys:simulate(options) end, "no " .. what)
                assert(#dinal.partial >= 8 * late and #dinal.partial <= 10 * late + 1, what .. " " .. #dinal.partial)
            end
        end
    end
end)

test("belts and states behave far from t = 0 as near it", function()
    local sys = nondimensional { zeta = 0.05, friction_ratio = 0.1 }
    local function of(t0, options)
        options.t_start, options.t_end, options.dt, options.theta0 = t0, t0 + 10, 0.5, 0.5
        return sys:simulate(options)
    end
    for _, options in ipairs {
        { belt = excitation.harmonic { amplitude = 0.4, frequency = 0.25 } },
        { belt = function(t) return 0.4 * math.sin(math.pi * t / 2) end },
        { M = excitation.harmonic { frequency = 0.75 },
            states = { z = { start = 0, rate = function(t) return math.cos(math.pi * t) end } } },
    } do
        local here, there = of(0, options), of(1e6, options)
        equal(#here.events, #there.events)
        for _, name in ipairs { "theta", options.states and "z" } do near(here[name], there[name], 1e-7) end -- 1e6 has 1e-10 to the next number
    end
end)

test("a mass at rest is released by a support, however fast, when I a = Re", function()
    local sys = system { I = 1, k = 1, Rd = 0.05, Re = 0.1 }
    for _, omega in ipairs { 3, 5, 10, 20, 50, 1000 } do
        local shake = 0.5 * excitation.harmonic { omega = omega }
        local run, loaded = expect(sys, { base = shake, t_end = 5, dt = 0.5 }), sys:simulate { M = -shake, t_end = 5, dt = 0.5 } -- closed forms
        near(run.events[1].t, math.asin(0.2) / omega, 1e-14)
        equal(run.outcome, loaded.outcome)
        alike(run, loaded, 1e-13)
    end
    -- one that is shaken too little comes to rest for good
    equal(sys:simulate { base = 0.02 * excitation.harmonic { omega = 1.3 }, theta0 = 0.9, t_end = 40 }.outcome, "at rest")
    local bump = 3 * excitation.gaussian { at = 2.123, sigma = 0.1 }
    -- The flank where 3 exp(-((t - 2.123)/0.1)^2/2) = Re.
    near(sys:simulate { base = bump, t_end = 5, dt = 5 }.events[1].t, 2.123 - 0.1 * math.sqrt(2 * math.log(30)), 1e-12)
end)

-- Steps of rk4 on which nothing happens are made in blocks, whatever else a run has.

local steps = integrator.rk4 { h = 0.002 }
local stick_slip = system { I = 1, k = 40, C = 0.3, Rd = 4, Re = 5 }
local loads = {
    ["of the time"] = function(t) return 8 * math.sin(5 * t) end,
    ["of the motion"] = function(t, theta, velocity) return 8 * math.sin(5 * t) - 0.2 * velocity * theta end,
    ["with a condition"] = function(t, theta)
        if theta > 0.1 then return 8 * math.sin(5 * t) - 1 end
        return 8 * math.sin(5 * t)
    end,
}

local function same(run, plain, what)
    same_events(run, plain, 1e-9, what)
    for i = 1, #plain do near(run.theta[i], plain.theta[i], 1e-9) end
end

test("states and events without effect leave the motion of rk4 unchanged", function()
    local far = merged({ walls = { lower = -50, upper = 50 } }, { I = 1, k = 40, C = 0.3, Rd = 4, Re = 5 })
    for name, M in pairs(loads) do
        local own = { M = M, theta0 = 0.7, t_end = 9.9, dt = 0.0371, integrator = steps }
        local plain = stick_slip:simulate(merged(own, { events = { { when = function(t) return t - 100 end } } }))
        assert(#plain.events > 8)
        local idle = {
            ["an event far away"] = { events = { { when = function(_, theta) return theta - 50 end } } },
            ["a state"] = { states = { z = { start = 3, rate = function() return 0 end } } },
            ["a state that moves"] = { states = { z = { start = 3, rate = function(_, theta) return theta end } } },
            ["a belt that stands"] = { belt = 0 },
        }
        for what, more in pairs(idle) do
            local run = stick_slip:simulate(merged(own, more))
            same(run, plain, name .. " " .. what)
        end
        same(system(far):simulate(own), plain, name .. " walls far away")
    end
end)

test("rk4 locates events and conditions among steps that it makes in blocks", function()
    local wanted = {
        { when = function(_, theta) return theta - 0.12 end, name = "place" },
        { when = function(_, _, velocity) return velocity - 0.5 end, direction = "up", name = "speed" },
    }
    for name, M in pairs(loads) do
        local runs = {}
        for i, method in ipairs { steps, integrator.spectral {} } do
            runs[i] = stick_slip:simulate { M = M, theta0 = 0.7, t_end = 6, integrator = method, events = wanted }
        end
        local found, expected = runs[1].events, runs[2].events
        equal(#found, #expected, name)
        for i = 1, #found do
            equal(found[i].kind, expected[i].kind)
            near(found[i].t, expected[i].t, 1e-7)
        end
        near(runs[1]:energy().total.error, 0, 1e-7)
    end
end)

finish()
