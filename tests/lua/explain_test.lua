dofile "tests/lua/support.lua"

local nd = nondimensional { friction_ratio = 0.167 }
local free = nd:simulate { velocity0 = 2 * math.pi, t_end = 5, dt = 0.01 }

--- The story as one line.
local function told(run)
    return (run:explain():gsub("%s+", " "))
end

test("a run read from a file, one of 1989 and a failed one have a story, too", function()
    says(reloaded(free), "read from a file", "The velocity changes sign 3 times")
    says(nd:simulate { velocity0 = 2 * math.pi, t_end = 5, dt = 0.01, integrator = integrator.dinal1989 { h = 0.001 } },
        "integrated as in 1989")
    pcall(function()
        nd:simulate { M = function(t) assert(t < 3) return math.sin(t) end, theta0 = 1, t_end = 10, dt = 0.1 }
    end)
    says(dinal.partial, "The run stopped early, at t = 3: M failed")
end)

test("the story says whether a load grew beyond Re or jumped beyond it, down to the rounding of the torques", function()
    local block = system { I = 1, k = 0, Rd = 0.5, Re = 1 }
    for by, words in pairs { [1e-7] = "M jumped so that |M - k theta| = 1.0000001 > Re = 1", [1e-11] = "this torque exceeded Re" } do
        says(block:simulate { M = excitation.step { amplitude = 1 + by, at = 1 }, t_end = 2 }, words)
    end
end)

test("the story of a function says how closely it was sampled, and never that nothing moved the mass", function()
    local sys = nondimensional { friction_ratio = 0.3 }
    local function pulse(t) return ({ t > 3.001 and t < 3.002 and 500 or 0 })[1] end -- the table: not read
    local unseen = sys:simulate { M = pulse, t_end = 10, dt = 1 }
    says(unseen, "Nothing that was seen moved it until the end of the run", "A pulse of a Lua function that is shorter than 0.056")
    assert(unseen.gap > 0.05 and unseen.gap < 0.0585, unseen.gap)
    local seen = sys:simulate { M = pulse, t_end = 10, dt = 1, integrator = integrator.spectral { narrowest = 0.001 } }
    assert(#seen.events > 0 and seen.gap <= 0.001, seen.gap)
    local native = sys:simulate { M = excitation.pulse { at = 3, width = 0.001, amplitude = 0.1 }, t_end = 10, dt = 1 }
    equal(native.gap, nil)
    says(native, "Nothing moved it")
    has_not(native:explain(), "seen", "formula")
end)

test("the story says once whether the formula of M was read, and otherwise which line prevented it", function()
    local sys = nondimensional { friction_ratio = 0.3 }
    local function run(task)
        task.t_end, task.dt = 10, 1
        return sys:simulate(task)
    end
    local function on_theta(t, theta) return theta > 0 and 1 or 30 * math.cos(t) end
    local pulse = run { M = function(t) return t > 3.001 and t < 3.002 and 500 or 0 end }
    says(pulse, "M is read as a sum of native terms: the times at which its conditions change are events.")
    assert(#pulse.events > 0 and pulse.gap == nil)
    has_not(pulse:explain(), "seen")
    equal(select(2, told(pulse):gsub("native terms", "")), 1)
    says(run { M = function(t) return 30 * math.sin(t) end }, "M is read as a sum of native terms.")
    says(run { M = on_theta }, "change, also those on theta, velocity or states, are located.")
    equal(run { M = on_theta }.gap, nil)
    says(run { M = on_theta, integrator = integrator.rk4 { h = 0.01 } }, "except for conditions on theta, velocity or states, which are sampled.")
    local line = debug.getinfo(1, "l").currentline + 2
    local unread = run { belt = 0.5, M = function(t)
        local points = { t, 2 * t }
        return points[1] < 2 and 3 or 0
    end }
    says(unread, "explain_test.lua:" .. line .. ": it makes a table).")
    assert(unread.gap > 0)
    says(run { M = 3, belt = function(t) return t < 1 and 0.1 or 0.2 end, base = function(t) return #"x" + t end },
        "The belt is read", "The base is evaluated in Lua")
end)

test("an M that is rough on every scale is reported once each in the outcome, the summary and the story", function()
    local function single(x) return (string.unpack("f", string.pack("f", x))) end
    local run = nondimensional { zeta = 0.1 }:simulate { M = function(t) return single(math.sin(5 * t)) end, t_end = 10, dt = 1 }
    assert(run.outcome:find("^reached the end, within the noise of the torques, %d"), run.outcome)
    has(run, "noise of the torques")
    says(run, "The torques are noisy (about")
end)

test("the cost of a very fine encoder is reported in the summary and the story", function()
    local function encoder(step)
        return function(t, theta, v) return math.sin(t) - math.floor(theta / step) * step end
    end
    local sys = nondimensional { zeta = 0.1 }
    local run = sys:simulate { M = encoder(2e-5), theta0 = 0.1, t_end = 2, dt = 1 }
    local jumps = tonumber(tostring(run):match "M jumped (%d+) times")
    assert(jumps and jumps > 1e4 and jumps < 1e5, tostring(run))
    says(run, "M jumps " .. jumps .. " times along the motion.")
    has_not(sys:simulate { M = encoder(1e-2), theta0 = 0.1, t_end = 2, dt = 1 }, "jumped")
end)

test("the torques of a support and a belt are part of the pull, and named", function()
    local free = system { I = 2, k = 0, Rd = 0.3, Re = 0.5 }:simulate { base = excitation.half_sine { width = 1 }, t_end = 5, dt = 1 }
    -- 2 sin(pi t) = Re at asin(.25)/pi
    says(free, "The support accelerates", "until t = 0.080431, when this torque exceeded Re and it slipped backward.")
    has_not(told(free), "jumped", "free")
    -- C vb + k theta = .1 + .2 t is Re at t = 2
    says(system { I = 1, k = 1, Rd = 0.3, Re = 0.5, C = 0.5 }:simulate { belt = 0.2, velocity0 = 0.2, t_end = 10, dt = 1 },
        "belt that moves with velocity vb = 0.2", "stuck to the belt until t = 2, when |M - C vb - k theta| exceeded Re and it slipped backward.")
    local block = system { I = 1, k = 0, Rd = 0.3, Re = 0.5 } -- I vb' = .8 at the start
    says(block:simulate { belt = excitation.harmonic { amplitude = 1, omega = 0.8 }, t_end = 20, dt = 1 },
        "moved off because |M - I vb' - k theta| = 0.8 > Re = 0.5.")
    says(block:simulate { base = excitation.step { at = 1 }, t_end = 1.5, dt = 0.5 },
        "until t = 1, when the pull jumped so that |M - I a - k theta| = 1 > Re = 0.5, and it slipped backward.")
end)

test("the story warns of a hidden pulse for a delayed comparison, but not for held outputs and relays", function()
    local sys = system { I = 1, k = 1, Rd = 0.1 }
    for M, hides in pairs {
        [excitation.sampled(function(_, theta) return -theta end, { every = 0.5 })] = false,
        [excitation.relay { of = "theta", on = -0.1, off = 0.1, amplitude = { 1, -1 } }] = false,
        [excitation.delayed(function(_, theta) return -theta end, { by = 0.5 })] = false,
        [excitation.delayed(function(_, theta) return theta > 0.5 and 1 or 0 end, { by = 0.5 })] = true,
    } do
        local text = sys:simulate { M = M, theta0 = 1, t_end = 10, dt = 1 }:explain()
        equal(text:find("A pulse of a Lua function", 1, true) ~= nil, hides)
    end
end)

test("a mass that a belt carries all the time is not said to be unmoved", function()
    local carried = system { I = 2, k = 0.1, C = 1, Rd = 2 }:simulate { belt = 0.2, velocity0 = 0.2, t_end = 1.5, dt = 1 }
    says(carried, "stuck to the belt. Nothing made it slip until the end of the run, t = 1.5.")
end)

test("a belt under a body without dry friction is said to have no effect", function()
    local smooth = system { I = 1, k = 4 }:simulate { theta0 = 1, t_end = 5, belt = 1 }
    says(smooth, "The belt has no effect, as there is no dry friction.", "It turned at theta = -1")
    has_not(told(smooth), "rubs", "smooth")
end)

test("the story describes each law of friction and each spring", function()
    local function story(own, options) return system(own):simulate(merged({ theta0 = 1, t_end = 3, M = math.sin }, options)) end
    says(story { I = 1, k = 0, C = 0.5 }, "The system is a block without a spring, with viscous damping C = 0.5 and no dry friction")
    says(story({ I = 1, k = 4, C = 0.5, units = { theta = "mm", M = "N" } }), "Units: theta in mm, M in N.")
    local function linked(link)
        return system { bodies = { a = { I = 1, k = 1 }, b = { I = 1, k = 2 } }, links = { w = merged({ "a", "b" }, link) } }:simulate { M = { a = math.sin }, t_end = 9 }
    end
    says(linked { friction = friction.freewheel { Rd = 0.1 } }, "w links a and b. It has a freewheel with Rd = 0.1.")
    says(linked { spring = spring.polynomial { [3] = 1 } }, "It has a nonlinear spring and no dry friction.")
    local moved = system { bodies = { a = { velocity = math.sin }, b = { I = 1, k = 2 } }, links = { w = { "a", "b", k = 4 } } }
    says(moved:simulate { t_end = 9 }, "a is moved by its velocity, which takes torques from")
end)

test("a belt that jumps, announced or not, is named as the cause of a slip, with its direction", function()
    local sys = system { I = 1, k = 1, C = 0.1, Rd = 0.3, Re = 0.5 }
    for _, belt in ipairs { 0.2 + excitation.step { amplitude = -0.7, at = 1 }, function(t) return t < 1 and 0.2 or -0.5 end } do
        says(sys:simulate { velocity0 = 0.1, t_end = 10, dt = 0.5, belt = belt },
            "|M - I vb' - C vb - k theta| = 0.078872 <= Re = 0.5", "until vb jumped to -0.5 and it slipped forward")
    end
end)

test("on a belt the extremes of theta are reported, not where the sliding reverses", function()
    local sys = system { I = 1, k = 8, C = 0.6, Rd = 0.15 }
    for _, dt in ipairs { 0.01, 60 } do
        local run = sys:simulate { M = excitation.harmonic { amplitude = 1.2, omega = 4 }, belt = 0.35, t_end = 60, dt = dt }
        says(run, "The mass started at t = 0 from theta = 0 with velocity 0.", "it repeats itself every 1.5708 (the period of M). The amplitude is 0.1369 about theta = 0.0066314.")
    end
    -- Friction from a belt that is always faster is the constant 0.2: it swings by 3 about 0.2, and no event tells so.
    local far = { belt = 50, theta0 = 0.2, velocity0 = 3, t_end = 30, dt = 1 }
    local swinging = system { I = 1, k = 1, Rd = 0.2 }
    says(swinging:simulate(far), "It made 11 half cycles with 10 turns and 0 stops.", "The motion is steady: it repeats itself every 6.2832 (1 T0). The amplitude is 3 about theta = 0.2.")
    far.dense = false
    has_not(told(swinging:simulate(far)), "one way")
end)

test("a beat on a shaking base is not called growth", function()
    local run = system{ I = 1, k = 1, Rd = 0.01 }:simulate{ base = excitation.harmonic{ amplitude = 0.2, omega = 1.05 }, t_end = 40, dt = 0.1 }
    says(run, "The motion is not periodic so far")
    has_not(told(run), "The motion grows")
end)

test("the story has the numbers of a contact that is open at first, of the hardest impact and of both sides of a law", function()
    local function normal(t) return t - 1 end
    says(system { I = 1, k = 1, Rd = 0.1, normal = normal }:simulate { theta0 = 1, t_end = 4 }, "It was open for 25 % of the time")
    local walls = { lower = -0.3, upper = 0.5, restitution = 0.9 }
    local run = system { I = 1, k = 1, C = 0.1, walls = walls }:simulate { theta0 = 0.45, velocity0 = 0.6, M = -3, t_end = 6 }
    local impacts = of_kind(run, "impact")
    local at = impacts.velocity:abs():argmax()
    local hit = impacts[at]
    assert(at > 1)
    says(run, ("the hardest impact had velocity %.5g, at t = %.5g"):format(hit.velocity, hit.t))
    local law = friction.asymmetric { forward = { Rd = 0.1, Re = 0.2 }, backward = { Rd = 0.3, Re = 0.5 } }
    local uneven = system { I = 1, k = 1, friction = law }:simulate { theta0 = 1, t_end = 9 }
    says(uneven, "Rd = 0.1 while sliding forward and 0.3 backward; breakaway takes Re = 0.2 forward and 0.5 backward")
    has_not(told(uneven), "2 Rd/k") -- by which the extremes of one Rd shrink
end)

test("a mass that is at the limit of friction at the start, and pulled off at once, did not stick", function()
    for _, method in ipairs { integrator.spectral {}, integrator.dopri5 { tolerance = 1e-9 } } do
        local M = excitation.polynomial { coefficients = { .2, .1 } }
        local run = system { I = 1, k = 1, Rd = .2 }:simulate { M = M, t_end = 6, integrator = method }
        local text = run:explain():gsub("%s+", " ")
        assert(text:find("with velocity 0 and moved off because |M - k theta| exceeded Re = 0.2.", 1, true), text)
        assert(text:find("It moved in one direction all the time.", 1, true), text)
        local energy, dry = run:energy(), 0
        for _, half in ipairs(energy.half_cycles) do dry = dry + half.dry end
        near(dry, energy.total.dry, 1e-12)
    end
    -- A base that begins to pull just then.
    local shaken = system { I = 1, k = 1, Rd = .2 }:simulate { base = excitation.harmonic { amplitude = .5, omega = 1 }, theta0 = .2, t_end = 10 }
    local dry = 0
    for _, half in ipairs(shaken:energy().half_cycles) do dry = dry + half.dry end
    near(dry, shaken:energy().total.dry, 1e-12)
end)

-- ---- one body, by the story of each motion

local pi = math.pi
local function sine(amplitude, frequency, phase) return excitation.harmonic { amplitude = amplitude, frequency = frequency, phase = phase } end
local function of(zeta, gamma, Re) return nondimensional { zeta = zeta, friction_ratio = gamma, breakaway_ratio = Re } end
local steady = { M = sine(1, 1), theta0 = 1, t_end = 20, dt = 0.01 }
local unmoved = { M = sine(0.1, 12 / (2 * pi)), t_end = 50 }
local function with(task, more) return merged(task, more) end

-- What is simulated, what the story must say, and what it must not.
local stories = {
    ["a free decay has half cycles, the law of the extremes, and the reason for the rest"] = { of(0, 0.167), { velocity0 = 2 * pi, t_end = 5 },
        { "There is no M: the motion is free.", "It made 4 half cycles with 3 turns and 1 stop",
            "theta = 0.84685 (t = 0.22366), -0.51285 (t = 0.72366), 0.17885 (t = 1.2237).", "2 Rd/k = 0.334",
            "It stopped at t = 1.7237 at theta = 0.15515 because |M - k theta| = 0.15515 <= Re = 0.167. M is constant from then on, so it stays at rest." },
        { "At the end" }, both = true },
    ["viscous decay"] = { of(0.119), { theta0 = 1, t_end = 5 }, { "Each extreme is 0.68624 =" } },
    ["decay by both frictions"] = { of(0.119, 0.06), { theta0 = 1, t_end = 5 }, { "q = exp(-pi zeta/sqrt(1 - zeta^2)) = 0.68624 and Rd/k = 0.06" } },
    ["no decay"] = { of(), { theta0 = 1, t_end = 5 }, { "Without damping and friction", "repeats itself every 1 (1 T0)" } },
    ["a throw that creeps back"] = { of(2.387), { velocity0 = 6, t_end = 5 }, { "then creeps" } },
    ["creep"] = { of(2.387), { theta0 = 1, t_end = 5 }, { "moved in one direction" } },
    ["nothing"] = { of(), { t_end = 5 }, { "It stayed there" } },
    -- From t = n/2 + 0.45017942 to (n + 1)/2 + 0.12493764 it is stuck: 0.34951644 of the time.
    ["a steady motion has its period, amplitude, lag, stops and the time stuck"] = { of(0, 0.836), steady,
        { "the motion is steady: it repeats itself every 1 (the period of M).", "The amplitude is 0.12917 about theta = 0.",
            "It stops twice in each period and is stuck for 35 % of the time.",
            "It stopped at t = 19.4502 at theta = 0.12917 because |M - k theta| = 0.17877 <= Re = 0.836; it stuck for 0.17476, until this torque exceeded Re and it slipped backward.",
            "... 35 more ...", "was still stuck when the run ended at t = 20", "lags behind that of M by 2.002 rad" }, both = true },
    -- A function tells no period; the motion does.
    ["Den Hartog's motion"] = { of(0, 0.5), { M = function(t) return ({ math.sin(2.7 * pi * t) })[1] end, theta0 = 1, t_end = 100, dt = 0.005 },
        { "every 0.74074 (0.74074 T0)", "lags behind that of M by 2.455 rad", "It does not stop." } },
    ["linear growth, pi - 4 gamma a period"] = { of(0, 0.167), with(steady, { t_end = 10 }), { "The motion grows: amplitudes of", "periods of M, 2.4736 more each time." } },
    ["growth by feedback"] = { of(), { M = function(_, _, v) return 0.1 * v end, theta0 = 1, t_end = 10 }, { "M is a feedback", "The motion grows", "times as much each time" } },
    -- Beats of a lightly damped system last 1/(2 pi zeta) = 160 periods.
    ["beats"] = { of(0.001), { M = sine(1, 0.93), t_end = 40.7 }, {}, { "is steady" } },
    ["too short"] = { of(0.119, 0.418), with(steady, { t_end = 2 }), { "too short to tell" } },
    ["settling"] = { of(0.119, 0.418), with(steady, { t_end = 7 }), { "is settling" } },
    ["on the way to nothing"] = { of(0.001), { theta0 = 1, t_end = 50 }, {}, { "is settling" } },
    ["stick-slip under a ramp"] = { system { I = 10, k = 4000, Rd = 19.62, Re = 29.43 }, { M = excitation.ramp { slope = 40 }, t_end = 10 },
        { "The mass started at t = 0 from theta = 0 with velocity 0 and stuck there because |M - k theta| = 0 <= Re = 29.43, until t = 0.73575, when this torque exceeded Re and it slipped forward.",
            "It advances by 0.0066769 in each period: stick-slip.", "It stops once in each period" } },
    ["a slip at a jump of M"] = { of(0, 0.167), { M = excitation.pulse { amplitude = 2.95, at = 20, width = 0.125 }, t_end = 40 },
        { "M is constant from t = 20.125 on.", "until t = 20, when M jumped so that |M - k theta| = 2.95 > Re = 0.167, and it slipped forward.", "stays at rest" } },
    ["never moved"] = { of(0, 0.5), with(unmoved, { theta0 = 0.1 }),
        { "Nothing moved it until the end of the run, t = 50.", "|M| never exceeds 0.1, which is too little to move it: it stays at rest." } },
    -- 0.3 (cos 2x - cos x) is between -0.34 and 0.6: at 0.4 no harm comes of it, though 0.6 the other way were too much.
    ["not moved in a period"] = { of(0, 0.8), { M = sine(-0.3, 6 / pi, pi / 2) + sine(0.3, 12 / pi, pi / 2), theta0 = 0.4, t_end = 50 },
        { "A whole period of M did not move it, so it stays at rest." } },
    ["not moved any more"] = { of(0, 0.5), with(unmoved, { theta0 = 3 }), { "was still stuck when the run ended at t = 50. |M| never exceeds 0.1" }, { "steady" } },
    ["a limit cycle"] = { of(0, 0.05), { M = function(_, theta, v) return 0.1 * (1 - theta ^ 2) * v end, theta0 = 0.5, t_end = 60 }, { "This is a limit cycle" } },
    ["chatter"] = { of(0, 0.1), { M = unread(function(_, _, v) return v == 0 and 0.5 or -5 end), t_end = 5 }, { "The run stopped early", "no jump was located" } },
    ["far from t = 0 a load that grows"] = { of(0.05, 0.3), with(steady, { t_start = 1e9, t_end = 1e9 + 2 }), { "exceeded Re" }, { "jumped" } },
    ["viscous damping and breakaway"] = { of(0.05, 0, 0.3), { theta0 = 1, t_end = 40 }, { "until friction holds the" }, { "never quite ends" } },
    ["no dense output and no rows"] = { of(0, 0.836), with(steady, { t_end = 1000.2, dt = 1000.2, dense = false }),
        { "The amplitude is 0.12917 about theta = 0. It stops twice", "It stopped at t = 999.4502 at" } },
    ["a wall"] = { system { I = 1, k = 0, walls = { lower = 0, restitution = 0.5 } }, { M = excitation.ramp { slope = 1, at = 8 } - 2, theta0 = 1, t_end = 12, dt = 0.5 },
        { "There is a wall at theta = 0; an impact keeps 50 % of the speed.", "It hit the wall", "first at t = 1;",
            "the hardest impact had velocity -2, at t = 1.", "It came to rest at the wall, theta = 0, at t = 3;", "pulled it off the wall forward" } },
    ["a second spring"] = { system { I = 1, k = 0.7, Rd = 0.05, Re = 0.08, spring = spring.polynomial { [3] = 0.4 } }, { theta0 = 1.7, t_end = 200, dt = 1 },
        { "a second spring besides k theta", "|M - k theta - spring| =" }, { "2 Rd/k" } },
    ["a spring alone"] = { system { I = 1, k = 0, Rd = 0.05, Re = 0.08, spring = spring.polynomial { [3] = 0.4 } }, { theta0 = 1.7, t_end = 200, dt = 1 },
        { "a block on a nonlinear spring", "|M - spring| =" } },
}
for name, u in pairs { ["tiny"] = { 1e-6, 1e3, 1e-6 }, ["huge"] = { 1e5, 1, 1e6 } } do -- I, k and the torque of M
    local I, k, M0 = table.unpack(u)
    local omega = math.sqrt(k / I)
    stories[name .. " units"] = { system { I = I, k = k, Rd = 0.836 * M0 }, { M = excitation.harmonic { amplitude = M0, omega = omega }, theta0 = M0 / k, t_end = 40 * pi / omega },
        { "the period of M", "twice in each period and is stuck for 35 %" } }
end

test("the story of each motion says what happened and why, in at most 25 lines of 80 characters", function()
    for name, case in pairs(stories) do
        for _, by in ipairs { integrator.spectral {}, case.both and integrator.rk4 { h = 0.001 } or nil } do
            local task = merged(case[2], { integrator = by, dt = case[2].dt or 0.01 })
            local run = case[1]:simulate(task)
            local ok, problem = pcall(says, run, table.unpack(case[3]))
            if ok and case[4] then ok, problem = pcall(has_not, told(run), table.unpack(case[4])) end
            if not ok then error(("%s, %s: %s"):format(name, tostring(by), problem)) end
            local lines = 0
            for line in run:explain():gmatch "[^\n]+" do
                lines = lines + 1
                assert(utf8.len(line) < 80, line)
            end
            assert(lines <= 25, name)
        end
    end
end)

test("the story of a run that failed before anything moved the mass says that it was stuck", function()
    pcall(function() of(0, 0.3):simulate { M = function(t) return t > 2 and 0 / 0 or 1 end, theta0 = 1, t_end = 10, dt = 0.01 } end)
    says(dinal.partial, "stuck there because |M - k theta| = 0 <= Re = 0.3.", "The run stopped early, at t = 2: M failed")
    has_not(told(dinal.partial), "moved off", "in balance")
end)

test("the story counts the slips of a slider behind a spring beside the stops of the mass", function()
    local sys = system { I = 1, k = 1, friction = friction.jenkins { stiffness = 4, Rd = 0.5 } }
    local function run(amplitude) return sys:simulate { M = excitation.harmonic { amplitude = amplitude, omega = 0.7 }, t_end = 20 } end
    says(run(2), "4 turns and 0 stops. Its slider slipped 5 times and stuck again 4 times.")
    says(run(0.1), "Its slider never slipped.")
end)

test("a mass that a feedback holds at its jump stands from beginning to end", function()
    local run = system { I = 1, k = 1 }:simulate { theta0 = 0.1, t_end = 20, M = function(_, _, v)
        return 0.2 * v - 0.5 * (v > 0 and 1 or v < 0 and -1 or 0)
    end }
    has(run, "velocity 0 at the end")
    says(run, "It stayed there", "velocity = 0.")
end)

test("the story does not say that a body behind an open clutch moved, nor that a run with a brake is too short", function()
    local later = function(t) return t >= 0.4 and 1 or 0 end
    local run = system { bodies = { a = { I = 1 }, b = { I = 1 } }, links = { clutch = { "a", "b", Rd = 1, normal = later } } }
        :simulate { velocity0 = { a = 1 }, t_end = 1.5 }
    says(run.b, "It moved in one direction. theta")
    says(run.a, "It moved in one direction all the time. theta")
    local brake = system { I = 1, k = 0, Rd = 3, normal = later }:simulate { velocity0 = 1, M = 0.5, t_end = 2 }
    says(brake, "is a block without a spring, with dry friction that varies.")
    has_not(brake:explain(), "too short")
    says(system { I = 1, k = 1, walls = { lower = 0, stiffness = 9 } }:simulate { velocity0 = 1, t_end = 4 }, "a wall at theta = 0 that pushes back")
end)

finish()
