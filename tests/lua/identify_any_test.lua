-- Identification from a guess: any parameter, any measured quantity. Run by dinal.
dofile "tests/lua/support.lua"

local function noise(n, std, seed) return vector.normal { n = n, std = std, seed = seed } end

--- Every fitted value lies within five of its errors, and the errors say something.
local function found(fit, truth, most)
    fits(fit, truth, 5)
    for name, value in pairs(truth) do
        local error = fit.error_if_right[name]
        assert(error > 0 and error < (most or 0.1) * math.abs(value), name .. " " .. error)
    end
end

local sys = system { I = 1, k = 4, C = 0.1, Rd = 0.1, Re = 0.15 }
local M = excitation.harmonic { amplitude = 1.3, omega = 1.1 }
local run = sys:simulate { M = M, theta0 = 0.3, t_end = 40, dt = 0.05 }
local guess = system { I = 1.2, k = 3, C = 0.05, Rd = 0.2, Re = 0.2 }
local function uneven(a, b) return system { I = 1, k = 4, friction = friction.asymmetric { forward = { Rd = a }, backward = { Rd = b } } } end

test("velocities alone identify the system, with gaps in them", function()
    local v = {}
    for i, x in ipairs(run.velocity + noise(#run, 0.01, 1)) do v[i] = i % 7 == 0 and 0 / 0 or x end
    local fit = identify { data = { t = run.t, velocity = v }, M = M, system = guess, free = { "I", "k", "C", "Rd" }, measured = "velocity" }
    found(fit, { I = 1, k = 4, C = 0.1, Rd = 0.1 })
    fits(fit, { theta0 = 0.3 }, 5)
    near(fit.noise, 0.01, 0.001)
    equal(fit.system.k, fit.k)
    equal(#fit.residual, 801 - 801 // 7)
end)

test("angles and accelerations of unequal noise are weighted", function()
    local d = data { t = run.t, x = run.theta + noise(#run, 0.02, 2), a = run.acceleration + noise(#run, 0.05, 3) }
    local fit = identify { data = d, M = M, system = guess:with { I = 1 }, free = { "k", "C", "Rd", "offset" }, measured = { theta = "x", acceleration = "a" } }
    found(fit, { k = 4, C = 0.1, Rd = 0.1 })
    fits(fit, { offset = 0 }, 5)
    local alone = identify { data = d, M = M, system = guess:with { I = 1 }, free = { "k", "C", "Rd", "offset" }, measured = { theta = "x" } }
    assert(fit.std_error.k < alone.std_error.k)
end)

test("a coast-down without a spring is identified", function()
    local fly = system { I = 1, k = 0, C = 0.1, Rd = 0.2 }
    local r = fly:simulate { velocity0 = 3, t_end = 12, dt = 0.05 }
    local fit = identify { data = { t = r.t, velocity = r.velocity + noise(#r, 0.01, 4) },
        system = system { I = 1, k = 0, C = 0.2, Rd = 0.1 }, free = { "C", "Rd" }, measured = "velocity" }
    found(fit, { C = 0.1, Rd = 0.2, velocity0 = 3 })
end)

test("laws of friction on a belt are identified: stribeck, asymmetric, and lugre in its sliding", function()
    local function law(Rd, Re, speed) return system { I = 1, k = 4, C = 0.05, friction = friction.stribeck { Rd = Rd, Re = Re, speed = speed } } end
    local b = law(0.3, 0.6, 0.2):simulate { belt = 0.15, t_end = 30, dt = 0.05 }
    local belt_record = record(b, 5, 0.003)
    local fit = identify { data = belt_record, belt = 0.15, system = law(0.2, 0.5, 0.3), free = { "friction.Rd", "friction.Re", "friction.speed" },
        theta0 = 0, velocity0 = 0 }
    found(fit, { ["friction.Rd"] = 0.3, ["friction.Re"] = 0.6, ["friction.speed"] = 0.2 })
    has_not(fit, "correlated")
    -- with another law the residual is no noise
    fit = identify { data = belt_record, belt = 0.15, system = sys:with { C = 0.05, Rd = 0.3, Re = 0.6 }, free = { "k", "Rd", "Re" }, theta0 = 0, velocity0 = 0 }
    equal(fit.misfit, "velocity")
    has(fit, "standard errors are left out")

    local r = uneven(0.05, 0.15):simulate { M = M, t_end = 30, dt = 0.05 }
    fit = identify { data = record(r, 6, 0.003), M = M, system = uneven(0.1, 0.1),
        free = { "friction.forward.Rd", "friction.backward.Rd", "k" } }
    found(fit, { ["friction.forward.Rd"] = 0.05, ["friction.backward.Rd"] = 0.15, k = 4 })

    local function bristles(Rd) return system { I = 1, k = 4, friction = friction.lugre { Rd = Rd, Re = 0.3, speed = 0.1, stiffness = 50, damping = 1 } } end
    r = bristles(0.2):simulate { theta0 = 1, t_end = 10, dt = 0.05 }
    fit = identify { data = record(r, 7, 0.003), system = bristles(0.3), free = { "friction.Rd" } }
    found(fit, { ["friction.Rd"] = 0.2 })
    equal(fit.misfit, nil)
    has(fit.system, "lugre")
end)

test("numbers in a table that M uses are identified, and the table is restored; a spring and a shaking base are, too", function()
    local p = { Kp = 2, Kd = 0.5 }
    local function F(t, theta, velocity) return -p.Kp * (theta - 1) - p.Kd * velocity end
    local plant = system { I = 1, k = 1, Rd = 0.05 }
    local r = plant:simulate { M = F, t_end = 15, dt = 0.05 }
    p.Kp, p.Kd = 1, 0.2
    for _, M in ipairs { F, excitation.scripted(F) } do
        local fit = identify { data = record(r, 8, 0.003), M = M, system = plant, free = { "p.Kp", "p.Kd", "Rd" } }
        found(fit, { ["p.Kp"] = 2, ["p.Kd"] = 0.5, Rd = 0.05 })
        assert(p.Kp == 1 and p.Kd == 0.2)
    end
    local base = excitation.harmonic { amplitude = 2, omega = 1.7 }
    local function duffing(c) return system { I = 1, k = 2, C = 0.2, spring = spring.polynomial { [3] = c } } end
    r = duffing(0.8):simulate { base = base, t_end = 25, dt = 0.05 }
    local fit = identify { data = record(r, 9, 0.005), base = base, system = duffing(0.5), free = { "spring.3", "C" } }
    found(fit, { ["spring.3"] = 0.8, C = 0.2 })
end)

test("exact data give errors of at least some ulps, and over many records the errors cover the true values as often as promised", function()
    local fit = identify { data = run, M = M, system = guess:with { I = 1 }, free = { "k", "C", "Rd" } }
    for name, value in pairs { k = 4, C = 0.1, Rd = 0.1 } do
        near(fit[name], value, 1e-6)
        assert(fit.std_error[name] >= 1e-15 * value)
    end
    local judged, part, ratio = judge()
    local records = lots(40)
    for seed = 1, records do
        local v = run.velocity + noise(#run, 0.03, seed)
        part, ratio = judged(identify { data = { t = run.t, velocity = v }, M = M, system = sys, free = { "k", "C", "Rd" }, measured = "velocity" },
            { k = 4, C = 0.1, Rd = 0.1 })
    end
    assert(records < 10 or part > 0.88 and ratio > 0.75 and ratio < 1.25, part .. " " .. ratio)
end)

local function drive_train(Rd, k)
    return system { bodies = { motor = { I = 1, C = 0.05 }, load = { I = 2, k = 1, Rd = Rd } },
        links = { shaft = { "motor", "load", k = k, C = 0.1 }, clutch = { "motor", "load", Rd = 0.2 } } }
end
local turned = { motor = excitation.harmonic { amplitude = 3, omega = 1.3 } }
local turning = drive_train(0.4, 6):simulate { M = turned, t_end = 30, dt = 0.05 }
local of_both = { "load.theta", ["motor.velocity"] = "w" }
local function measured_both(seed)
    return { t = turning.t, ["load.theta"] = turning["load.theta"] + noise(#turning, 0.01, seed),
        w = turning["motor.velocity"] + noise(#turning, 0.02, 100 + seed) }
end

test("numbers of bodies and links are found from a guess that is wrong by 30 %, within their errors", function()
    local judged, part, ratio = judge()
    for seed = 1, lots(10) do
        local fit = identify { data = measured_both(seed), system = drive_train(0.52, 4.2), M = turned,
            free = { "load.Rd", "shaft.k" }, measured = of_both }
        found(fit, { ["load.Rd"] = 0.4, ["shaft.k"] = 6 }, 0.01)
        fits(fit, { ["motor.theta0"] = 0, ["load.velocity0"] = 0 })
        equal(fit.system.load.Rd, fit["load.Rd"])
        equal(fit.system.shaft.k, fit["shaft.k"])
        equal(fit.system.clutch.Rd, 0.2)
        equal(#fit.silent, 0)
        near(fit.noise, 0.01, 0.001)
        equal(#fit.residual, #turning)
        part, ratio = judged(fit, { ["load.Rd"] = 0.4, ["shaft.k"] = 6 })
    end
    assert(part > 0.8 and ratio < 1.4, part .. " " .. ratio)
end)

test("starts and offsets of bodies are given by name, a run of several bodies is a record, and undetermined values are reported", function()
    local at_rest = { load = 0, motor = 0 }
    local fit = identify { data = turning, system = drive_train(0.5, 6), M = turned, free = { "load.Rd", "load.Re", "load.offset" },
        measured = { "load.theta", "shaft.theta" }, theta0 = at_rest, velocity0 = at_rest, offset = { shaft = 0 } }
    equal(table.concat(fit.names, " "), "load.Rd load.Re load.offset")
    near(fit["load.Rd"], 0.4, 1e-6)
    near(fit["load.offset"], 0, 1e-6)
    local slides = system { bodies = { a = { I = 1, Rd = 0.1 } } }
    local r = slides:simulate { velocity0 = { a = 3 }, t_end = 8, dt = 0.05 }
    fit = identify { data = r, system = slides, free = { "a.Rd", "a.Re" }, measured = "a.velocity", theta0 = { a = 0 } }
    equal(table.concat(fit.silent, " "), "a.Re")
    has(fit, ">= 0.1, not determined by this record")
    local zero, decay = 0.3, system { I = 1, k = 4, C = 0.2 }
    r = decay:simulate { theta0 = 1, t_end = 10, dt = 0.05 }
    fit = identify { data = { t = r.t, theta = r.theta + zero }, system = decay, free = { "k", "Rd" }, offset = zero }
    near(fit.k, 4, 1e-6)
    near(fit.theta0, 1, 1e-6)
    for _, Rd in ipairs { 0, 0.05 } do
        equal(identify { data = r, system = decay:with { Rd = Rd, Re = Rd }, free = { "Re" } }.bounds.Re[1], Rd)
    end
    -- Rd moves a sliding block by Rd t^2/2: bounds are two standard errors of that line at least.
    local slide = system { I = 1, k = 0, Rd = 0.1 }
    r = slide:simulate { velocity0 = 1, t_end = 5, dt = 0.01 }
    fit = identify { data = { t = r.t, theta = noisy(r, 2, 100) }, system = slide, free = { "Rd" }, theta0 = 0, velocity0 = 1, offset = 0 }
    local least = 2 * fit.noise / (r.t ^ 4):sum() ^ 0.5 * 2
    assert(fit.bounds.Rd[2] - fit.Rd > least and fit.bounds.Rd[2] - fit.Rd < 4 * least, fit)
end)

test("Re follows Rd if both are one number, also in each direction of an asymmetric law", function()
    local r = uneven(0.05, 0.15):simulate { M = M, t_end = 30, dt = 0.05 }
    local fit = identify { data = r, M = M, system = uneven(0.1, 0.1), free = { "friction.forward.Rd", "friction.backward.Rd" } }
    near(fit["friction.forward.Rd"], 0.05, 1e-6)
    local Rd, Re = tostring(fit.system):match "forward = { Rd = (%S+), Re = (%S+) }"
    equal(Re, Rd)
end)

test("a fit of several bodies that is impossible is refused with a reason", function()
    local function refused(changes, ...)
        local asked = { data = measured_both(1), system = drive_train(0.4, 6), M = turned, free = { "load.Rd" }, measured = of_both }
        return { merged(asked, changes), ... }
    end
    local varying = system { bodies = { load = { I = 1, k = 1, Rd = function(t) return 0.1 end }, motor = { I = 1 } } }
    refuses(identify, {
        refused({ free = { "laod.Rd" } }, "free has 'laod.Rd', which is no number of the system, such as load.I", "did you mean 'load.Rd'?"),
        refused({ free = { "shaft.I" } }, "free has 'shaft.I', which is no number"),
        refused({ system = varying }, "free has 'load.Rd', but that is a function: only numbers can be fitted"),
        refused({ measured = { "laod.theta" } }, "got \"laod.theta\"; did you mean 'load.theta'?"),
        refused({ measured = { ["load.theta"] = "thta" } }, "there is no column 'thta' among load.theta, t, w"),
        refused({ measured = "load.theta", theta0 = { laod = 1 } }, "theta0: the system has no 'laod'", "did you mean 'load'?"),
        refused({ theta0 = 1 }, "theta0 must be a table by body, such as { load = 1 }, got 1"),
        refused({ theta0 = { shaft = 1 } }, "theta0 must be a table by body"),
        refused({ M = { laod = 1 } }, "M: there is no body or link 'laod'", "did you mean 'load'?"),
    })
    refused { { 'identify { data = measured_both(1), system = varying, free = { "load.k" } }', "measured must be", "got nil" } }
end)

test("a fit that is impossible is refused with a reason", function()
    local record = { t = run.t, theta = run.theta }
    refuses(identify, {
        { { data = record, measured = "velocity" }, "measured (the string \"velocity\") needs a guess: system = system{ ... }" },
        { { data = record, system = guess, free = { "friction.speed" } }, "free has 'friction.speed', which is no number of the system" },
        { { data = record, system = guess, free = { "q.x" } }, "free has 'q.x'" },
        { { data = record, system = guess }, "free must be a list" },
        { { data = record, system = guess, free = { "k" }, k = 3 }, "k is part of the first guess, system" },
        { { data = record, system = guess, free = { "k" }, measured = "speed" }, "measured must be \"theta\"" },
        { { data = record, system = guess, free = { "k" }, measured = "velocity" }, "there is no column 'velocity'" },
        { { data = record, system = guess, free = { "k" }, M = function() error "broken" end }, "broken" },
    })
end)

finish()
