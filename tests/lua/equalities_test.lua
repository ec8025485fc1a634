-- One number computed in two ways: a part and its whole, a continued and a whole run, a worker and a direct call, and
-- one record read in two ways.
dofile "tests/lua/support.lua"

-- All systems here are of size 1. A motion in two parts differs from the whole by the rounding of the panels between.
local tolerance = 1e-9

local function close(found, wanted, what)
    if type(found) == "number" then found, wanted = vector { found }, vector { wanted } end
    equal(#found, #wanted, what)
    local far = #found > 0 and (found - wanted):abs():max() or 0
    if not (far <= tolerance * math.max(1, wanted:abs():max())) then error(("%s differ by %g"):format(what, far), 2) end
end

local sine = excitation.harmonic { amplitude = 2, omega = 1.3 }

-- ---- parts and the whole

local a = { I = 1, k = 4, C = 0.1, Rd = 0.3, Re = 0.4 }
local b = { I = 0.5, k = 1, Rd = 0.1, walls = { lower = -0.6, upper = 0.6, restitution = 0.6 } }
local parts = {
    ["a belt on a link"] = { { k = 2, C = 0.1, Rd = 0.3, Re = 0.4 }, { belt = { link = 0.4, b = 0.2 } } },
    ["a belt of t on a link"] = { { k = 2, Rd = 0.3 }, { belt = { link = function(t) return 0.4 * math.sin(t) end } } },
    ["a ratio"] = { { k = 2, C = 0.1, Rd = 0.3, ratio = 0.6 }, {} },
    ["a base"] = { { k = 2, Rd = 0.1 }, { base = excitation.harmonic { amplitude = 0.8, omega = 0.9 } } },
    ["an impact at a link"] = { { walls = { lower = -0.3, upper = 0.2, restitution = 0.5 } }, {} },
    ["all of it"] = {
        { k = 2, C = 0.1, Rd = 0.3, walls = { lower = -0.4, upper = 0.3, restitution = 0.5 } },
        { belt = { link = 0.4 }, base = function(t) return 0.5 * math.cos(2 * t) end,
            events = { { when = function(t) return t - 3.3 end,
                act = function(t, theta, velocity) velocity.b = 0.4 end } } },
    },
    ["sliders behind springs"] = { { friction = friction.jenkins { stiffness = 5, Rd = 0.2 } }, { belt = { link = 0.3 } } },
    ["an elastic wall and a belt"] = {
        { Rd = 0.3, walls = { lower = -0.3, upper = 0.2, stiffness = 30, damping = 1 } }, { belt = { link = 0.4 } },
    },
    bristles = {
        { k = 2, friction = friction.lugre { Rd = 0.2, Re = 0.3, speed = 0.1, stiffness = 20, damping = 1 } },
        { belt = { link = 0.3 } },
    },
}

test("the energy of each part of a system is its row in the energy of all", function()
    local named = { "input", "base", "kinetic", "spring", "viscous", "dry", "belt", "impacts", "acts" }
    local stored = { kinetic = true, spring = true }
    for kind, given in pairs(parts) do
        local drive = { M = { a = sine }, velocity0 = { b = 0.5 }, t_end = 12, dt = 0.1 }
        local run = pair(a, b, merged(given[1])):simulate(merged(drive, given[2]))
        local whole = run:energy()
        assert(whole.total.closure < 1e-10, kind)
        close(whole.error, 0 * whole.error, kind)
        local sums = {}
        for _, part in ipairs { "a", "b", "link" } do
            local own = run[part]:energy()
            for _, name in ipairs(named) do
                local what = ("%s: %s of %s"):format(kind, name, part)
                if whole[part][name] then close(own.total[name], whole[part][name], what) end
                if not stored[name] then
                    close(own[name][#run], own.total[name], what .. " in the last row and in total")
                end
                sums[name] = (sums[name] or 0) + own.total[name]
            end
            if part ~= "link" then
                for _, name in ipairs { "dry", "others" } do
                    local halves = 0
                    for _, half in ipairs(own.half_cycles) do halves = halves + half[name] end
                    close(halves, own.total[name], ("%s: %s of the half cycles of %s"):format(kind, name, part))
                end
                assert(#own.half_cycles > 5)
            end
        end
        for _, name in ipairs(named) do
            local what, column = kind .. ": " .. name, whole[name]
            if stored[name] then
                close(column[#run] - column[1], whole.total[name], what)
            else
                equal(column[1], 0.0, what)
                close(column[#run], whole.total[name], what)
                close(sums[name], whole.total[name], what .. " of all parts")
            end
        end
        has(run.a:energy(), "work of its links on it")
        for _, name in ipairs { "belt", "base", "acts", "impacts" } do
            local text = (name == "impacts" and "%s %.6g were lost" or "%s %.6g was added"):format(name, whole.total[name])
            assert(whole.total[name] == 0 or tostring(whole):find(text, 1, true), text)
        end
        assert(not kind:find "belt" or math.abs(whole.link.belt) > 0.01, kind)
        assert(kind ~= "a base" or math.abs(whole.a.base) > 0.01 and math.abs(whole.b.base) > 0.01)
        assert(not kind:find "impact" or whole.link.impacts > 0.01)
    end
end)

test("column M is M at the rows, also of a mass that is stuck or at rest, and M of an event is M at its time", function()
    -- Under rk4 rows are between its steps, or at some of them.
    local methods = { integrator.exact {}, integrator.spectral {}, integrator.rk4 { h = 0.01 }, integrator.rk4 { h = 0.0371 / 4 }, integrator.dopri5 { tolerance = 1e-10 } }
    for _, method in ipairs(methods) do
        for _, Re in ipairs { 0, 1.9, 9 } do -- under 9 it rests for good
            local sys = system { I = 1, k = 4, C = 0.1, Rd = Re / 2, Re = Re }
            local run = sys:simulate { M = sine, theta0 = 1, t_end = 9, dt = 0.0371, integrator = method }
            for i, t in ipairs(run.t) do near(run.M[i], sine(t), tolerance) end
            assert(#run.events > 3 or Re == 9)
            for _, event in ipairs(run.events) do near(event.M, sine(event.t), 1e-6) end
        end
    end
end)

test("the friction of a link is at most its limit, also where its own load jumps with the slip and holds it", function()
    local function M(t, theta, velocity) return velocity.a > velocity.b and -2 or 2 end
    local run = pair({ I = 1 }, { I = 1 }, { Rd = 0.1 }):simulate { M = { link = M, a = sine }, velocity0 = { a = 1 }, t_end = 5, dt = 0.1 }
    near(run.link.velocity[#run], 0, 1e-12)
    near(run.link.friction:abs():max(), 0.1, tolerance)
end)

test("a mass is not at rest for good when a spline exceeds Re between two samples", function()
    local hump = excitation.samples { t = { 0, 1, 2, 3 }, M = { 0, 1, 1, 0 }, interpolation = "cubic", period = 3 }
    local peak = hump(1.5)
    assert(peak > 1.1, peak)
    for _, method in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.01 } } do
        local run = system { I = 1, k = 1, Rd = 0.5, Re = 1.05 }:simulate { M = hump, t_end = 9, integrator = method }
        equal(run.events[1].kind, "slip")
        near(hump(run.events[1].t), 1.05, 1e-6)
    end
end)

-- ---- a run that goes on

local function averaging(body)
    return function(t, theta, velocity, z, memory)
        local x = body and theta[body] or theta
        memory.sum = 0.9 * memory.sum + x
        return -0.2 * memory.sum
    end
end
local lugre = friction.lugre { Rd = 0.3, Re = 0.4, speed = 0.2, stiffness = 20, damping = 1 }
local cut = 4.05
local going = {
    ["no more"] = {},
    LuGre = { body = { friction = lugre } },
    ["sampled with memory"] = { M = function(of)
        local start = function() return { sum = 0 } end
        return excitation.sampled(averaging(of), { every = 0.3, delay = 0.07, start = start })
    end },
    delayed = { M = function(of)
        local function brake(t, theta, velocity) return -0.4 * (of and velocity[of] or velocity) end
        return excitation.delayed(brake, { by = 0.7 })
    end },
    relay = { M = function(of)
        return excitation.relay { on = -0.1, off = 0.1, amplitude = 1, of = of and "theta." .. of or "theta" }
    end },
    states = {
        M = function(of) return excitation.scripted(function(t, theta, velocity, z) return 0.5 * z.lag end) end,
        states = function(of)
            local function rate(t, theta, velocity, z) return (of and theta[of] or theta) - z.lag end
            return { lag = { start = 0.2, rate = rate } }
        end,
    },
    normal = { body = { Rd = 0.3, Re = 0.4, normal = function(t) return 1 + 0.5 * math.sin(0.7 * t) end } },
    walls = { body = { Rd = 0.1, walls = { lower = -0.5, upper = 0.4, restitution = 0.7 } } },
    ["M jumps at the cut"] = { body = { Rd = 2.2, Re = 2.5 }, M = function() return excitation.step { amplitude = 6, at = cut } end },
    ["the belt jumps at the cut"] = { body = { Rd = 2.2, Re = 2.5 }, belt = excitation.step { amplitude = 3, at = cut } },
    ["the contact opens at the cut"] = { body = { Rd = 0.3, Re = 0.4, normal = function(t) return t < cut and 1 or 0 end } },
}

for kind, more in pairs(going) do
    local body = merged({ I = 1, k = 4, C = 0.1 }, more.body or { Rd = 0.3, Re = 0.4 })
    local function drive(of)
        local M = more.M and sine + more.M(of) or sine
        local states = more.states and more.states(of)
        return { M = of and { a = M } or M, belt = of and { a = more.belt } or more.belt, states = states, dt = 0.1 }
    end
    local ways = {
        ["one body"] = { system(body), drive(), { "theta", "velocity", "M", "friction", "damping", "acceleration" } },
        ["a rig"] = { pair(body, { I = 0.5, k = 1, C = 0.1 }, { k = 3, Rd = 0.1 }), drive "a",
            { "a.theta", "b.velocity", "a.M", "a.friction", "link.torque", "link.friction", "a.acceleration" } },
    }
    for way, given in pairs(ways) do
        test(("a run that goes on is the whole run, rows included, and that of rk4 is near it: %s, %s"):format(kind, way), function()
            local function run(t_end) return given[1]:simulate(merged(given[2], { t_end = t_end })) end
            local whole, longer = run(9), run(2.7813):continue { t_end = cut }:continue { t_end = 9 }
            local function column(of, name)
                if way == "one body" then return of[name] end
                return name == "a.acceleration" and of.a.acceleration or of:data()[name]
            end
            close(longer.t, whole.t, "t")
            for _, name in ipairs(given[3]) do close(column(longer, name), column(whole, name), name) end
            for name, values in pairs(whole.states) do close(longer.states[name], values, name) end
            same_events(longer, whole, tolerance)
            equal(longer:explain(), whole:explain())
            if way == "a rig" then close(run(cut).b:continue { t_end = 9 }.theta, whole.b.theta, "theta of b") end
            -- rk4 makes steps in blocks, also with a state that nothing asks for.
            local idle = { start = 1, rate = function(t, theta, velocity, z) return -z.idle end }
            local by_steps = { t_end = 9, states = merged({ idle = idle }, given[2].states), integrator = integrator.rk4 { h = 0.002 } }
            near(column(given[1]:simulate(merged(given[2], by_steps)), given[3][1]), column(whole, given[3][1]), kind == "LuGre" and 1e-6 or 1e-9)
            local total = whole:energy().total
            for name, value in pairs(longer:energy().total) do close(value, total[name], name) end
        end)
    end
end

-- ---- a worker and the call itself

local acting = {
    constant = function() return excitation.constant(0.5) end,
    harmonic = function() return excitation.harmonic { amplitude = 2, omega = 1.3, phase = 0.4 } end,
    step = function() return excitation.step { amplitude = 1.5, at = 0.7 } end,
    pulse = function() return excitation.pulse { amplitude = 3, at = 0.4, width = 0.6 } end,
    half_sine = function() return excitation.half_sine { amplitude = 3, at = 0.4, width = 0.6 } end,
    gaussian = function() return excitation.gaussian { amplitude = 3, at = 1.2, sigma = 0.3 } end,
    ramp = function() return excitation.ramp { slope = 0.8, at = 0.3, duration = 1.5 } end,
    square = function() return excitation.square { amplitude = 1.5, period = 1.7, duty = 0.3, at = 0.2 } end,
    sawtooth = function() return excitation.sawtooth { amplitude = 1.5, period = 1.7, at = 0.2 } end,
    triangle = function() return excitation.triangle { amplitude = 1.5, period = 1.7, at = 0.2 } end,
    chirp = function()
        return excitation.chirp { amplitude = 2, from = 0.1, to = 0.6, duration = 3, at = 0.2, phase = 0.3 }
    end,
    exponential = function() return excitation.exponential { amplitude = 2, tau = 0.8, at = 0.3 } end,
    polynomial = function() return excitation.polynomial { coefficients = { 0.5, -0.4, 0.3 }, at = 0.6 } end,
    samples = function()
        return excitation.samples { t = { 0, 0.7, 1.3, 2 }, M = { 0, 1, -1, 0 }, interpolation = "cubic", period = 2 }
    end,
    scripted = function()
        local pulses = unread(function(t) return t % 1.5 < 0.5 and 2 or 0 end)
        return excitation.scripted(pulses, { breaks = { 0, 0.5 }, period = 1.5 })
    end,
    ["delayed and cut"] = function() return 0.7 * excitation.harmonic { omega = 2 }:delay(0.3):window(0.4, 2.9) end,
    sampled = function()
        local start = function() return { sum = 0.3 } end
        return excitation.sampled(averaging(), { every = 0.3, delay = 0.07, at = 0.1, start = start })
    end,
    relay = function()
        return excitation.relay { on = -0.2, off = 0.3, amplitude = { 1, -0.5 }, of = "velocity", start = "off" }
    end,
    delayed = function()
        return excitation.delayed(function(t, theta, velocity) return -0.4 * velocity end, { by = 0.7 })
    end,
    ["laws in a list, one of them a function"] = function()
        local slope = 0.1
        local law = friction.law(function(v) return 0.2 + slope * v end)
        return sine, system { I = 1, k = 4, friction = { law, friction.jenkins { stiffness = 3, Rd = 0.1 } } }
    end,
}

test("a worker of a sweep gives the same result as a direct call, for each controller and native term with its options", function()
    for kind, make in pairs(acting) do
        local M, sys = make()
        sys = sys or system(a)
        local function ask()
            local run = sys:simulate { M = M, theta0 = 0.4, t_end = 4, dt = 0.5 }
            local theta, velocity = run:at(3.7)
            local last = run.events[#run.events].t
            return { theta = theta, velocity = velocity, M = run.M[7], events = #run.events, last = last }
        end
        local here, there = ask(), sweep { over = { x = { 1 } }, workers = 1, run = ask }
        for name, value in pairs(here) do close(there[name][1], value, kind .. ": " .. name) end
    end
end)

test("many equal bodies around one are one body as heavy as all of them", function()
    local hub, pad, link = { I = 1, k = 4, C = 0.1 }, { I = 0.1, C = 0.02 }, { k = 0.3, C = 0.01 }
    local count = 70
    local many, links = { hub = hub }, {}
    for i = 1, count do
        many["b" .. i], links["l" .. i] = pad, merged({ "hub", "b" .. i }, link)
    end
    local one = {}
    for name, number in pairs(pad) do one[name] = count * number end
    for name, number in pairs(link) do link[name] = count * number end
    local options = { M = { hub = sine }, t_end = 3, dt = 0.1 }
    local all = system { bodies = many, links = links }:simulate(options)
    local two = system { bodies = { hub = hub, b = one }, links = { l = merged({ "hub", "b" }, link) } }:simulate(options)
    close(all.hub.theta, two.hub.theta, "the hub")
    close(all.b9.theta, two.b.theta, "a body around it")
end)

-- ---- one record read in two ways

test("the same record gives the same errors with I or k given, and with a system", function()
    local function alike(fits, names)
        for _, name in ipairs(names) do
            local first = fits[1]
            assert(first.error_if_right[name] > 0, name)
            for i = 2, #fits do
                near(fits[i].error_if_right[name] / first.error_if_right[name], 1, 0.1)
                near(fits[i].std_error[name] / first.std_error[name], 1, 0.2) -- a fit from a guess takes differences of runs
            end
        end
    end
    local truth = system { I = 1, k = 4, C = 0.1, Rd = 0.05 }
    local free = truth:simulate { theta0 = 1, t_end = 20, dt = 0.05 }
    local decay = { t = free.t, theta = noisy(free, 1, 1e-3) }
    alike({ identify { data = decay, k = 4 }, identify { data = decay, I = 1 } }, { "omega0", "zeta", "Rd_over_k" })
    local names, guess = { "k", "C", "Rd" }, system { I = 1, k = 3.9, C = 0.12, Rd = 0.04 }
    alike({ identify { data = decay, I = 1, offset = 0 },
        identify { data = decay, system = guess, free = names } }, names)
    local run = truth:simulate { M = sine, theta0 = 0.5, t_end = 20, dt = 0.05 }
    local driven = { t = run.t, theta = noisy(run, 2, 1e-3) }
    names = { "I", "k", "C", "Rd" }
    alike({ identify { data = driven, M = sine, free = names },
        identify { data = driven, M = sine, system = guess:with { I = 1.02 }, free = names } }, names)
    local slow, sticky = excitation.harmonic { amplitude = 2, omega = 0.6 }, system { I = 1, k = 4, C = 0.1, Rd = 0.8, Re = 1.2 }
    run = sticky:simulate { M = slow, theta0 = 0.5, t_end = 40, dt = 0.05 }
    local stops = { t = run.t, theta = noisy(run, 2, 1e-3) }
    names = { "k", "C", "Rd", "Re" }
    alike({ identify { data = stops, M = slow, I = 1, offset = 0, free = names },
        identify { data = stops, M = slow, system = sticky:with { Rd = 0.78, Re = 1.23 }, offset = 0, free = names } }, names)
end)

finish()
