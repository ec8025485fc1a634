-- sys:steady of runs with states, belts and acts, and of limit cycles, whose period is found. Run by dinal.
dofile "tests/lua/support.lua"

local function extent(theta) return (theta:max() - theta:min()) / 2 end

test("stick-slip on a belt has the stick time, period and amplitude of the closed form", function()
    for _, case in ipairs{ { 1, 4, 0.3, 0.6, 0.1 }, { 2.5, 9, 0.1, 0.8, 0.05 }, { 0.4, 1, 0, 0.5, 0.2 } } do
        local I, k, Rd, Re, belt = table.unpack(case)
        local omega, a = (k / I) ^ 0.5, (Re - Rd) / k
        local phi = math.atan(belt / omega, a)
        local slip, stick = (math.pi + 2 * phi) / omega, 2 * a / belt
        local s = finds({ I = I, k = k, Rd = Rd, Re = Re }, { belt = belt, velocity0 = belt }, { status = "steady", period = slip + stick, stops = 1, periods = 1, stable = true,
            amplitude = math.sqrt(a ^ 2 + (belt / omega) ^ 2), stuck = stick / (slip + stick), mean = Rd / k, -- the motion is symmetric about it
            ["multipliers.1.abs"] = 0, within = 1e-9, story = { "limit cycle" } })
        near(s.period, slip + stick, 1e-11 * s.period)
        equal(#s.multipliers, 1) -- without the one along the motion
        equal(tostring(s):match("^steady: period"), "steady: period")
        near(s.run:at(s.run.t_end), s.run:at(0), 1e-11)
    end
end)

test("a free motion ends at rest, and the range of rest is known", function()
    local s = finds({ I = 1, k = 4, Rd = 1, Re = 1.2 }, { theta0 = 3.1 }, { status = "rest", ["rest.lower"] = -0.3, ["rest.upper"] = 0.3, amplitude = 0,
        none = { "period", "stops", "multipliers", "run", "growth" }, story = { "dies out" }, within = 1e-12 })
    equal(tostring(s):match("^rest: the motion ends at theta = "), "rest: the motion ends at theta = ")
    finds({ I = 1, k = 4, C = 0.3, Rd = 1 }, { belt = 0.4 }, { status = "rest", mean = 0.25, stuck = 0 }) -- slides for good
    equal(system{ I = 1, k = 1 }:steady{ M = function(_, _, velocity) return 0.1 * velocity end, theta0 = 1 }.status, "grows")
    equal(nondimensional{}:steady{}.status, "rest")
    near(nondimensional{}:steady{ theta0 = 0.5 }.period, 1, 1e-12) -- nothing damps it
end)

test("van der Pol's cycle has its known period and amplitude, from starts inside and outside of it", function()
    for _, theta0 in ipairs{ 0.1, 4 } do
        local s = finds({ I = 1, k = 1 }, { M = function(_, theta, velocity) return (1 - theta ^ 2) * velocity end, theta0 = theta0 },
            { period = 6.6632868593231301897, amplitude = 2.0086198608748431, stops = 0, within = 1e-11 })
        near(s.multipliers[1].abs, 8.5979e-4, 1e-7) -- exp of the integral of 1 - theta^2
    end
end)

test("an oscillator kicked at each passage has the amplitude at which kick and damping balance", function()
    local C, kick = 0.1, 0.05
    local damped = (1 - C ^ 2 / 4) ^ 0.5
    local period = 2 * math.pi / damped
    local s = system{ I = 1, k = 1, C = C }:steady{ velocity0 = 0.5, events = {
        { when = function(_, theta) return theta end, direction = "up",
            act = function(_, theta, velocity) return theta, velocity + kick end } } }
    near(s.period, period, 1e-10)
    local speed = kick / (1 - math.exp(-C / 2 * period)) -- after the kick
    local function at(t) return speed / damped * math.exp(-C / 2 * t) * math.sin(damped * t) end
    local top = math.atan(damped, C / 2) / damped
    near(s.amplitude, (at(top) - at(top + period / 2)) / 2, 1e-10)
    near(s.multipliers[1].abs, math.exp(-C / 2 * period), 1e-7)
end)

test("dead times and sampled controllers have the cycles that long runs reach", function()
    local sys = system{ I = 1, k = 4, C = 0.1, Rd = 0.02 }
    local M = excitation.delayed(function(_, theta) return -3 * math.sin(theta) end, { by = 0.5 })
    local s = sys:steady{ M = M, theta0 = 0.5 }
    local run = sys:simulate{ M = M, theta0 = 0.5, t_end = 1500, times = vector.linspace(1500 - 2 * s.period, 1500, 20001) }
    near(run.theta[20001], run.theta[10001], 1e-8)
    near(s.amplitude, extent(run.theta), 1e-6)
    equal(s.multipliers, nil)
    assert(s.stable)
    local function sampled() return excitation.sampled(function(_, theta) return theta > 0 and -0.5 or 0.5 end, { every = 0.1 }) end
    s = sys:steady{ M = sampled(), theta0 = 0.5 }
    near(s.period / 0.1, math.floor(s.period / 0.1 + 0.5), 1e-9) -- on the grid
    run = sys:simulate{ M = sampled(), theta0 = 0.5, t_end = 1000, times = vector.linspace(1000 - 2 * s.period, 1000, 2001) }
    near(run.theta[2001], run.theta[1001], 1e-9)
end)

test("two sampled controllers have a cycle of whole common intervals, the shortest that a long run repeats", function()
    local sys = system{ I = 1, k = 4, C = 0.1, Rd = 0.02 }
    -- 3 x 0.2 is not 0.6, but one rounding more: of the common instants, some come before and some after both have sampled
    for _, case in ipairs{ { 0.375, 0.25, 0.75 }, { 0.3, 0.2, 0.6 }, { 0.15, 0.1, 0.3 } } do
        local relay, damper, common = table.unpack(case)
        local function both()
            return excitation.sampled(function(_, theta) return theta > 0 and -0.5 or 0.5 end, { every = relay })
                + excitation.sampled(function(_, _, velocity) return -0.2 * velocity end, { every = damper })
        end
        local times = vector.linspace(1200 - 20 * common, 1200, 21) + common / 7
        local run = sys:simulate{ M = both(), theta0 = 0.5, t_end = 1201, times = times }
        local fewest = 1
        while math.abs(run.theta[21 - fewest] - run.theta[21]) > 1e-9 do fewest = fewest + 1 end
        near(sys:steady{ M = both(), theta0 = 0.5 }.period, fewest * common, 1e-12)
    end
end)

test("a motion that dies out under a sampled controller ends at rest, where the springs balance", function()
    local sys = system{ I = 1.23, k = 5.58, C = 0.64, spring = spring.polynomial{ [3] = 0.88 } }
    for _, aim in ipairs{ 0, 1 } do
        local M = excitation.sampled(function(_, theta, velocity) return 0.3 * (aim - theta) - 0.1 * velocity end, { every = 0.486 })
        local s = sys:steady{ M = M, theta0 = -0.23 }
        equal(s.status, "rest")
        near(5.58 * s.rest[1] + 0.88 * s.rest[1]^3, 0.3 * (aim - s.rest[1]), 1e-10)
    end
end)

test("a periodic M may be combined with belt, base, states and acts", function()
    local sys = system{ I = 1, k = 8, C = 0.6, Rd = 0.15 }
    local wave = excitation.harmonic{ amplitude = 1.2, omega = 4 }
    local s = sys:steady{ M = wave, belt = 0.35 }
    near(s.amplitude, 0.136905, 1e-6)
    local shaken, pushed = sys:steady{ base = wave }, sys:steady{ M = -1 * wave } -- the same but for its sign
    near(shaken.amplitude, pushed.amplitude, 1e-10)
    near(shaken.stuck, pushed.stuck, 1e-8)
    for _, more in ipairs{
        { M = function(t, _, _, z) return 0.8 * math.sin(t) - z.e end, period = 2 * math.pi,
            states = { e = { rate = function(_, theta, _, z) return 2 * (theta - z.e) end } } },
        { belt = function(t) return 0.3 * math.cos(2 * t) end, period = math.pi },
        { M = excitation.harmonic{ amplitude = 2, omega = 2 }, belt = 0.05, states = {
            e = { rate = function(_, theta, velocity, z) return velocity - z.e end } } },
    } do
        s = sys:steady(more)
        equal(s.status, "steady")
        more.period = nil
        local run = sys:simulate(merged(more, { t_end = 400 * s.period, times = vector.linspace(399 * s.period, 400 * s.period, 4001) }))
        near(s.amplitude, extent(run.theta), 2e-6 * s.amplitude)
        near(s.run:at(s.run.t_end), s.run:at(s.run.t_start), 1e-9)
    end
end)

test("a limit cycle and the rest beside it are each reported as the only other motion beside the other", function()
    local sys = system{ I = 1, k = 4, C = 0.1, Rd = 0.3, Re = 0.6 }
    local squeal, slides = sys:steady{ belt = 0.2, theta0 = 0.15, velocity0 = 0.2 }, sys:steady{ belt = 0.2 }
    equal(squeal.status, "steady")
    equal(slides.status, "rest")
    for _, pair in ipairs{ { squeal, slides }, { slides, squeal } } do
        local one, other = table.unpack(pair)
        equal(one.unique, false)
        equal(#one.others, 1)
        equal(one.others, one.others)
        equal(one.others[1].status, other.status)
        near(one.others[1].amplitude, other.amplitude, 1e-9)
    end
    near(squeal.others[1].mean, 0.075, 1e-9)
    near(slides.others[1].period, squeal.period, 1e-9)
    says(squeal, "From another start the mass comes to rest at theta = 0.075.")
    says(slides, "Another start leads to another motion: amplitude")
    equal(system{ I = 1, k = 1 }:steady{ theta0 = 1 }.unique, false) -- one of a family
end)

test("a function of the time needs a period, and one that does not depend on it needs none", function()
    local sys = system{ I = 1, k = 4, Rd = 0.1 }
    refused { { "sys:steady{ belt = function(t) return math.sin(t^2) end }", "the period of M is not known" } }
    near(sys:steady{ belt = function(t) return math.sin(t) end }.period, 2 * math.pi, 1e-12)
    refused {
        { "sys:steady{ states = { e = { rate = function(t) return math.sin(t) end } } }", "the period of M is not known" },
        { "sys:steady{ belt = function(t) return math.sin(t) end, period = 3 }", "belt does not repeat itself after period = 3" },
        { "sys:steady{ states = { e = { rate = 3 } } }", "sys:steady: states.e: rate must be" },
    }
    equal(sys:steady{ belt = function() return 0 end, theta0 = 2 }.status, "rest")
    refused { { 'sys:steady{ M = excitation.relay{ on = 1, off = 2, amplitude = { 1, 2 }, of = "x" } }', "the relay looks at 'x'" } }
end)

test("an event without an act changes neither the cycle nor its story", function()
    local sys = system { I = 1, k = 4, Rd = 0.3, Re = 0.6 }
    local options = { belt = 0.1, t_end = 60 }
    local watched = merged(options, { events = { { when = function(t, theta) return theta - 0.1 end } } })
    local plain, seen = sys:simulate(options), sys:simulate(watched)
    for name, value in pairs(plain:cycle()) do
        if type(value) == "number" then near(seen:cycle()[name], value, 1e-7) else equal(seen:cycle()[name], value) end
    end
    equal(seen:explain(), plain:explain())
end)

test("a machine that is driven faster and faster grows, and has no limit cycle", function()
    local sine = excitation.harmonic { amplitude = 1, omega = 1 }
    for _, case in ipairs { { { Rd = 0.5 }, 0.2 }, { { k = 0.5, C = 0.1 }, 0 } } do
        local link, C = table.unpack(case)
        local rig = system { bodies = { m = { I = 1 }, l = { I = 2, C = C } }, links = { c = merged(link, { "m", "l" }) } }
        for _, M in ipairs { excitation.constant { amplitude = 2 }, sine + 2 } do
            has(rig:steady { M = { m = M } }, "grows: without bound")
        end
        equal(rig:steady { M = { m = sine } }.status, "steady")
    end
end)

finish()
