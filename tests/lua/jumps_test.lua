-- Jumps during a run: of a belt that is a function, and of the velocity at a wall; and rows at the instant of a jump.
dofile "tests/lua/support.lua"

-- An unannounced jump is located to 1e-13 of a run of some time units.
local found = 1e-11

test("a belt with kinks where it is zero is followed quickly", function()
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

moves("without dry friction a belt has no effect, and the start is not reported as a turn", { I = 1, k = 1 }, { belt = 0.5, theta0 = -0.5, t_end = 4, dt = 1 },
    { events = 1, turn = { math.pi } })

test("a belt that begins to move along a wall takes a mass off it, by sliding or by sticking", function()
    local own = { I = 2, k = 0, Rd = 0.5, Re = 0.75, walls = { lower = 0, upper = 1, restitution = 0.5 } }
    for rate, theta in pairs { [1] = 0.125, [0.1] = 0.05 } do -- slower than the belt, or as it goes
        for _, belt in ipairs { function(t) return rate * t end, excitation.ramp { slope = rate } } do
            expect(own, { belt = belt, t_end = 1, dt = 1 }, { events = 0, theta = theta }, rate)
        end
    end
end)

test("a belt that begins to move from rest carries the mass until spring, inertia and load need Re", function()
    local I, k, Rd, Re, rate = 2, 3, 2.6, 4, 1.25 -- Rd alone, with a load of -0.25, would give less than I rate
    for _, case in ipairs {
        { 0, function(t) return rate * t end }, { 0, excitation.ramp { slope = rate } }, { 0.5, excitation.ramp { slope = rate, at = 0.5 } },
        { 0.5, function(t) return rate * math.max(0, t - 0.5) end },
    } do
        local start, belt = table.unpack(case)
        for _, M in ipairs { 0, -0.25 } do
            for _, walls in ipairs { {}, { lower = 0 } } do
                local run = expect({ I = I, k = k, Rd = Rd, Re = Re, walls = walls }, { M = M, belt = belt, t_end = 2, dt = 2 })
                local slip = run.events[#run.events] -- the only one, or behind that which takes it from the wall
                equal(slip.kind, "slip")
                -- I rate + k rate s^2/2 - M = Re, a time s after the belt set off
                near(slip.t, start + math.sqrt(2 * (Re - I * rate + M) / (k * rate)), 1e-12)
            end
        end
    end
end)

test("an event at the time of a row is included in the row, and in the motion at that time", function()
    for _, stop in ipairs { true, false } do
        local run = system { I = 1, k = 0 }:simulate {
            velocity0 = 1, t_end = 2, dt = 0.25,
            events = { { when = function(t) return t - 1.5 end, act = function(_, theta) return theta, -3 end, stop = stop } },
        }
        equal(run.events[1].t, 1.5)
        equal(run.t[7], 1.5)
        equal(run.velocity[7], -3)
        equal(select(2, run:at(1.5)), -3)
        near(run.theta[#run], stop and 1.5 or 0, 1e-14)
    end
end)

-- At the wall at 2 (sqrt 2 - 1), with sqrt 2.
local hit = 2 * (math.sqrt(2) - 1)
moves("an impact that moves a user's value past zero causes an event there, and so does its return", { I = 1, k = 0, walls = { upper = 1, restitution = 0.5 } },
    { velocity0 = 1, M = 0.5, t_end = 2.5, dt = 1, events = { { when = function(_, _, v) return v - 0.1 end, name = "slow" } } },
    { impact = { hit }, user = { hit, hit + 2 * (math.sqrt(0.5) + 0.1) }, turn = 1 })

moves("a run may end at a jump of a function, also at t = 0", { I = 1, k = 0 }, { M = function(t) return t / 4 % 1 < 0.5 and 1 or -1 end, velocity0 = 2.5, t_start = -1, t_end = 0, dt = 0.5 },
    { velocity = 1.5, theta = 2 })

-- Evenly spaced levels, alternating or any, on a swing or not; the belt tells its jumps, or it does not.
local function unannounced(size, period, phase, alternate)
    local a, levels = math.random() < 0.5 and 0 or size * (math.random() - 0.5), {}
    for i = 0, 100 do
        levels[i] = alternate and i > 1 and levels[i - 2] or size * (math.random() - 0.5)
    end
    local told = excitation.harmonic { amplitude = a, omega = 1 } + levels[0]
    for i = 1, 100 do
        told = told + excitation.step { amplitude = levels[i] - levels[i - 1], at = (i - phase) * period }
    end
    return told, function(t) return a * math.sin(t) + levels[math.floor(t / period + phase)] end
end

--- What does not tell its jumps moves the mass as what does.
local function moves_alike(sys, told, untold, methods)
    local expected = sys:simulate(told)
    for _, method in ipairs(methods) do
        local run = sys:simulate(merged(merged(told, untold), { integrator = method }))
        equal(run.outcome, expected.outcome)
        equal(#run.events, #expected.events)
        near(run.theta, expected.theta, 1e-9)  -- Runge-Kutta's own is 1e-10, and a jump is located to some 1e-13 of a period
    end
end

test("an unannounced jump of a belt moves the mass like an announced one, stuck or sliding", function()
    math.randomseed(5)
    for trial = 1, lots(24) do
        local Rd, k, C = 0.3, math.random() < 0.2 and 0 or 1, math.random() < 0.5 and 0 or 0.1
        local sys = system { I = 1, k = k, C = C, Rd = Rd, Re = math.random() < 0.5 and Rd or 0.5 }
        -- The steps of rk4 end at jumps of 0.2, but for an ulp. Some even jumps in a piece cancel in its last coefficients.
        local period = trial % 4 == 0 and 0.2 or trial % 2 == 0 and 0.3 + 0.4 * math.random() or 0.25 + 3 * math.random()
        local told, f = unannounced(1, period, trial % 4 == 0 and 0 or math.random(), trial % 2 == 0)
        local M = excitation.harmonic { amplitude = 0.4 * math.random(), omega = 1 + math.random() }
        moves_alike(sys, { M = M, velocity0 = math.random() - 0.5, t_end = 15, dt = 0.5, belt = told }, { belt = f },
            { integrator.spectral {}, integrator.rk4 { h = 0.005 }, integrator.dopri5 { tolerance = 1e-10 } })
    end
end)

test("unannounced jumps have the effect of announced ones, in any system", function()
    math.randomseed(1)
    local function any(size)
        return unannounced(size, 0.3 + 2 * math.random(), math.random(), math.random() < 0.4)
    end
    for _ = 1, lots(50) do
        local Rd, Re = 0.2 + 0.2 * math.random(), 1 + math.random()
        local laws = {
            friction.coulomb { Rd = Rd },
            friction.coulomb { Rd = Rd, Re = Rd * Re },
            friction.stribeck { Rd = Rd, Re = Rd * 1.5, speed = 0.2 + math.random() },
            friction.asymmetric { forward = { Rd = Rd, Re = Rd * 1.2 }, backward = { Rd = Rd * 0.7, Re = Rd } },
            friction.table { speed = { 0, 0.3, 1 }, torque = { Rd * 1.2, Rd * 0.7, Rd } },
        }
        local walls = math.random() < 0.35 and { lower = -0.5 - math.random(), upper = 0.5 + math.random(), restitution = math.random() } or nil
        local sys = system { I = 1, k = math.random() < 0.1 and 0 or 1, C = math.random() < 0.5 and 0 or 0.1 * math.random(), friction = laws[math.random(5)], walls = walls }
        local told = { theta0 = 0.4 * math.random() - 0.2, velocity0 = math.random() - 0.5, t_end = 15, dt = 0.5 }
        local not_told = {}
        local M, f = any(1.6)
        if math.random() < 0.5 then told.belt, not_told.belt = any(1) end
        if math.random() < 0.3 then told.base, not_told.base = any(1) end
        if math.random() < 0.4 then
            local gain = 0.2 * math.random()
            told.states = { e = { start = 0, rate = function(t, theta) return theta end } }
            told.M, not_told.M = M + function(t, theta, v, z) return gain * z.e end, function(t, theta, v, z) return f(t) + gain * z.e end
        else
            told.M, not_told.M = M, f
        end
        moves_alike(sys, told, not_told, { integrator.spectral {} })
    end
end)

test("a jump of a belt past a sliding body turns its slip", function()
    -- The slip is 0.9 before the jump and -1.1 after it.
    for _, belt in ipairs { excitation.step { at = 1, amplitude = 2 }, function(t) return t < 1 and 0 or 2 end } do
        expect({ I = 1, k = 0, Rd = 0.1 }, { belt = belt, velocity0 = 1, t_end = 14, dt = 1 }, { turn = { 1 }, stick = { 12 }, events = 2,
            velocity = function(t) return t < 1 and 1 - 0.1 * t or math.min(2, 0.9 + 0.1 * (t - 1)) end })
    end
end)

test("a belt may jump right after the start", function()
    local sys = system { I = 1, k = 1, C = 0.1, Rd = 0.3, Re = 0.5 }
    for _, v0 in ipairs { 0, 0.1, 0.5 } do
        for _, method in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.01 } } do
            local task = { M = 0.2, velocity0 = v0, t_end = 10, dt = 0.5, integrator = method, belt = 0.5 }
            local expected = sys:simulate(task)
            task.belt = function(t) return t > 0 and 0.5 or 0 end
            local run = sys:simulate(task)
            equal(run.outcome, expected.outcome)
            assert(#run.events - #expected.events <= 1) -- it may stand or slide the other way for that moment
            near(run.theta, expected.theta, 1e-12)
        end
    end
end)

test("a feedback that jumps at velocity 0 and cannot be read holds where both sides drive the mass back", function()
    local function f(_, _, v) local _ = select("#") if v < 0 then return 5 end return 0 end
    local run = system { I = 1, k = 4, Rd = 0.1 }:simulate { M = f, t_end = 3, theta0 = 0.3 }
    equal(run.status, "stuck")
    equal(run:at(3), 0.3)
    -- Without dry friction that would be a slide, for which the function must be read.
    run = system { I = 1, k = 4 }:simulate { M = f, t_end = 3, theta0 = 0.3 }
    has(run.outcome, "switched endlessly")
    near(run.t_end, 0, 1e-8)
end)

finish()
