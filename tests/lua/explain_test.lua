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

test("a load that grows exceeds Re, and one that jumps beyond it jumps, however little beyond", function()
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

test("the story says once whether M was read, and which line was the reason where it was not", function()
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

test("an M that is rough on every scale is reported once, in the outcome, the summary and the story", function()
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

test("outputs that are held, and relays of the motion, cannot hide a pulse", function()
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

test("a belt under a body without dry friction is said to have no effect", function()
    local smooth = system { I = 1, k = 4 }:simulate { theta0 = 1, t_end = 5, belt = 1 }
    says(smooth, "The belt has no effect, as there is no dry friction.", "It turned at theta = -1")
    has_not(told(smooth), "rubs", "smooth")
end)

test("each friction and spring has its words", function()
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

finish()
