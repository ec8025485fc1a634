dofile "tests/lua/support.lua"

local function sine(omega, amplitude)
    return excitation.harmonic { amplitude = amplitude or 1, omega = omega }
end

local function chain(friction)
    local a, rod = { I = 1, k = 1, C = 0.1 }, { "a", "b", k = 3 }
    if friction then a.Rd, a.Re, rod.Rd = 0.2, friction, 0.1 end
    return system { bodies = { a = a, b = { I = 2, k = 1, C = friction and 0.1 or nil } }, links = { rod = rod } }
end

--- The time from the event of this kind that was `back` of them ago to the last one.
local function since(run, kind, back)
    local times = of_kind(run, kind).t
    return times[#times] - times[#times - back]
end

-- amplitudes of both bodies without friction under sin(omega t) on a
local function amplitudes(omega)
    local re, im, second = 4 - omega ^ 2, 0.1 * omega, 4 - 2 * omega ^ 2
    local determinant = math.sqrt((re * second - 9) ^ 2 + (im * second) ^ 2)
    return math.abs(second) / determinant, 3 / determinant
end

test("the steady motion of a chain without friction under a sine has its closed form", function()
    local a, b = amplitudes(1.3)
    local s = finds(chain(), { M = { a = sine(1.3) } }, { status = "steady", ["a.amplitude"] = a, ["b.amplitude"] = b, period = 2 * math.pi / 1.3, stable = true,
        unique = "proven", symmetric = true, none = { "rest" }, ["a.mean"] = 0, within = 1e-12, story = { "No other steady motion exists.", "b swings between" } })
    equal(#s.multipliers, 4)
    -- the determinant of a multiplier matrix is exp(-C/I T)
    local product = 1
    for _, m in ipairs(s.multipliers) do product = product * m.abs end
    near(product, math.exp(-0.1 * s.period), 1e-8)
    refused {
        { "s.amplitude", "choose one of them, such as s.a.amplitude" },
        { "s.c", "this steady motion has no 'c'; its bodies and links are a, b, rod" },
    }
end)

test("the steady motion of a chain with friction is that of a long run, with all its sticks", function()
    local rig, M = chain(0.3), { a = sine(1.3) }
    local s = rig:steady { M = M }
    local T, periods = 2 * math.pi / 1.3, 300
    local long = rig:simulate { M = M, theta0 = { a = 0.3, b = -0.5 }, t_end = periods * T }
    local shift = (periods - 2 * s.periods) * T
    for i = 0, 20 do
        local t = i / 20 * s.period
        near(s.run.a:at(t), long.a:at(shift + t), 1e-9)
        near(s.run.b:at(t), long.b:at(shift + t), 1e-9)
    end
    assert(s.a.stops > 0 and s.a.stuck > 0 and s.a.stuck < 1)
    assert(s.multipliers[1].abs < 1)
end)

test("the motion of several bodies is proven to be the only one where no two motions can separate", function()
    local M = { a = sine(1.3) }
    local shown, not_seen = { unique = "proven" }, { unique = "not seen" }
    equal(#finds(chain(0.2), { M = M }, merged(shown, { symmetric = true })).others, 0)
    finds(chain(0.2), { M = M, belt = { a = 0.1 } }, merged(shown, { symmetric = false }))
    finds(chain(0.3), { M = M }, not_seen)
    finds(chain(0.2), { M = { a = sine(1.3) + excitation.scripted(function(t, theta) return -0.1 * theta.a end) }, omega = 1.3 }, not_seen)
    local function apart(k) return { bodies = { a = { I = 1, k = k }, b = { I = 1, k = 3 } } } end
    finds(apart(1.1), { M = M }, shown) -- no natural frequency is a multiple of that of M
    finds({ bodies = { a = { I = 1, k = 1 }, b = { I = 1, k = 6.76 } } }, { M = M }, { unique = false })
end)

test("a drill string sticks and slips while it rotates", function()
    local rig = system { bodies = { top = { I = 2 }, bit = { I = 0.1, friction = friction.stribeck { Rd = 0.5, Re = 1, speed = 0.5 } } },
        links = { pipe = { "top", "bit", k = 1, C = 0.02 } } }
    local M = { top = function(t, theta, velocity) return 20 * (1 - velocity.top) end }
    local s = rig:steady { M = M }
    near(s.period, since(rig:simulate { M = M, t_end = 100 }, "stick", 1), 1e-9)
    for _, name in ipairs { "amplitude", "mean" } do equal(s.bit[name], nil) end
    equal(s.bit.stops, 1)
    assert(s.pipe.amplitude > 0.5)
    says(s, "bit turns by")
    finds(pair({ I = 1, C = 1 }, { I = 1 }, { k = 1, C = 0.5 }), { M = { a = 1 } }, { status = "steady", ["link.amplitude"] = 0, ["link.mean"] = 0, none = { "period", "a.amplitude" } })
end)

test("a relay that depends on another body has a limit cycle", function()
    local rig = pair({ I = 1, C = 0.3 }, { I = 0.5, k = 1, C = 0.1, Rd = 0.05 }, { k = 4, C = 0.2 })
    local M = { a = excitation.relay { on = -0.2, off = 0.2, amplitude = { 1, -1 }, of = "theta.b" } }
    local s = rig:steady { M = M }
    equal(s.status, "steady")
    near(s.period, since(rig:simulate { M = M, t_end = 400 }, "switch", 2), 1e-9)
end)

test("a damper coupled only by friction moves with the period of M, and adheres if friction is large", function()
    local function steady(Rd)
        return system { bodies = { machine = { I = 1, k = 1, C = 0.02 }, damper = { I = 0.28 } }, links = { joint = { "machine", "damper", Rd = Rd } } }
            :steady { M = { machine = sine(0.9, 0.07) } }
    end
    local glued, loose = steady(1), steady(0.05)
    equal(glued.periods .. glued.joint.status .. loose.periods, "1adheres1")
    equal(glued.joint.amplitude, 0.0)
    near(glued.machine.amplitude, 0.07 / math.sqrt((1 - 1.28 * 0.81) ^ 2 + (0.02 * 0.9) ^ 2), 1e-10)
    assert(loose.joint.amplitude > 0 and loose.joint.stuck < 1)
    has_not(loose:explain(), "goes round")
end)

test("bodies may come to rest, and impossible questions are refused", function()
    local rig = pair({ I = 1, k = 1, Rd = 0.1 }, { I = 1, k = 2, C = 0.1 }, { k = 1 })
    local s = rig:steady { theta0 = { a = 1 } }
    equal(s.status, "rest")
    equal(s.run, nil)
    local run = rig:simulate { theta0 = { a = 1 }, t_end = 300 }
    near(s.a.mean, run.a.theta[1001], 1e-9)
    equal(s.period, nil)
    equal(rig:steady { M = { a = sine(1, 0.05) } }.a.status, "adheres")
    local function scripted(t) return math.sin(t) end
    refuses(function(o) rig:steady(o) end, {
        { { M = { a = unread(scripted) } }, "the period of M is not known; give it with period = ..." },
        { { M = { a = scripted }, period = 3 }, "does not repeat itself" },
        { { M = { a = excitation.sampled(function() return 0 end, { every = 0.1 }), b = sine(1) } }, "no common period", "run it for long" },
    })
    near(rig:steady { M = { a = scripted }, omega = 1 }.b.amplitude,
        rig:steady { M = { a = sine(1) } }.b.amplitude, 1e-9)
end)

test("every member of a steady answer gives a value or an explanation, whatever the status, for one body and for several", function()
    local members = { "status", "period", "periods", "amplitude", "peak", "mean", "lag", "peak_lag", "stops", "stuck", "multipliers",
        "stable", "unique", "others", "symmetric", "rest", "growth", "run" }
    local function ask(what, s)
        has(s:explain(), ".")
        assert(#tostring(s) > 5 and not tostring(s):find "nan", what .. ": " .. tostring(s))
        for _, name in ipairs(members) do
            local ok, value = pcall(function() return s[name] end)
            if not ok then has(value, "this motion has several bodies; choose one of them") end
            assert(value == value, what .. "." .. name .. " is nan")
        end
        local run = s.run
        if not run then return end
        has(run:explain(), ".")
        assert(run:energy() and run:plot{ show = false } and #run > 0 and run:at(run.t_end))
        for _, of_one in ipairs{ "phase_plot", "spectrum" } do
            local ok, said = pcall(function() return run[of_one](run, of_one == "phase_plot" and { show = false } or nil) end)
            assert(ok or type(said) == "string" and #said > 40, said)
        end
    end
    local function drag(_, _, v) return 0.1 * (type(v) == "table" and v.a or v) end
    local double_well = { I = 1, k = 0, C = 0.3, spring = function(x) return x ^ 3 - x end }
    for _, case in ipairs{
        { "steady", { I = 1, k = 1, C = 0.1, Rd = 0.1 }, sine(1.3) }, { "adheres", { I = 1, k = 1, Rd = 2 }, sine(1.3) },
        { "rest", { I = 1, k = 1, C = 0.5, Rd = 0.1 } }, { "grows", { I = 1, k = 1 }, sine(1) }, { "grows", { I = 1, k = 1 }, drag },
        { "none", double_well, sine(1.2, 0.5) },
    } do
        local status, body, M = table.unpack(case)
        local one = system(body):steady{ M = M, theta0 = 0.5 }
        equal(one.status, status)
        ask("one body " .. status, one)
        local several = system{ bodies = { a = body } }:steady{ M = { a = M }, theta0 = { a = 0.5 } }
        equal(several.status, status)
        ask("rig " .. status, several)
        ask("its body " .. status, several.a)
        if status == "none" then break end
        local Rd = body.Rd or 0
        body.Rd = function() return Rd end
        local varying = system(body):steady{ M = M, theta0 = 0.5 }
        equal(varying.status, status)
        ask("one body with Rd = function " .. status, varying)
    end
    local turns = system{ bodies = { a = { I = 1, C = 0.5 }, b = { I = 1 } }, links = { rod = { "a", "b", k = 2, C = 0.1 } } }
    for _, M in ipairs{ 1, sine(2) + 1 } do
        local s = turns:steady{ M = { a = M } }
        for what, part in pairs{ whole = s, a = s.a, rod = s.rod } do ask("rotating: " .. what, part) end
        equal(s.a.mean, nil)
        equal(s.unique, "not seen")
    end
end)

test("the steady motion with sampled or delayed controllers has their common period, like a long run", function()
    local rig, T = chain(0.3), 2
    local function pi(t, theta, velocity, z, memory)
        memory.sum = 0.9 * memory.sum + 0.02 * (0.3 * math.sin(math.pi * t) - theta.b)
        return 0.5 * (0.3 * math.sin(math.pi * t) - theta.b) + memory.sum - 0.5 * velocity.b
    end
    for _, M in ipairs {
        { a = excitation.sampled(pi, { every = 0.125, start = function() return { sum = 0 } end }), b = sine(math.pi) },
        { a = excitation.delayed(function(t, theta) return -0.5 * theta.b end, { by = 0.15 }), b = sine(math.pi) },
    } do
        local s = rig:steady { M = M }
        equal(s.status, "steady")
        near(s.period, T, 1e-12)
        equal(s.stable, true)
        local long = rig:simulate { M = M, t_end = 200 * T, times = vector.linspace(199 * T, 200 * T, 2001) }
        near(s.b.amplitude, (long.b.theta:max() - long.b.theta:min()) / 2, 1e-6)
        near(s.run.b:at(s.run.t_end), long.b:at(200 * T), 1e-8)
    end
    -- nothing else depends on t: it comes to rest at the instants' period
    local hold = chain(0.3):steady { theta0 = { a = 1 }, M = { a = excitation.sampled(function(t, theta) return -theta.b end, { every = 0.125 }) } }
    equal(hold.status, "rest")
end)

test("branches of two rigidly coupled bodies fold where those of one body do", function()
    local function M(p) return excitation.harmonic { amplitude = 0.4, omega = p.omega } end
    local over = { omega = vector.linspace(0.8, 2, 13) }
    local one = system { I = 1, k = 1, C = 0.2, spring = spring.polynomial { [3] = 1 } }:response { over = over, at = function(p) return { M = M(p) } end }
    -- Two halves of it, which move alike, so that the link between them carries nothing.
    local half = { I = 0.5, k = 0.5, C = 0.1, spring = spring.polynomial { [3] = 0.5 } }
    local rig = system { bodies = { a = half, b = half }, links = { rod = { "a", "b", k = 3, C = 0.5 } } }
    local two = rig:response { of = "b", over = over, at = function(p) return { M = { a = 0.5 * M(p), b = 0.5 * M(p) } } end }
    equal(#two, #one)
    equal(#two.points, 2)
    equal(#two.jumps, 2)
    for i = 1, 2 do
        equal(two.points.kind[i], "fold")
        near(two.points.omega[i], one.points.omega[i], 1e-7)
        near(two.points.amplitude[i], one.points.amplitude[i], 1e-5)
        near(two.jumps.to[i], one.jumps.to[i], 1e-5)
    end
    for i = 1, #one do near(two["b.amplitude"][i], one.amplitude[i], 1e-5) end
end)

test("a parameter of a response may be called like a column that has the name of a body before it", function()
    local rig = pair({ I = 1, k = 4, C = 0.1 }, { I = 1, k = 1, C = 0.1 }, { k = 2 })
    local c = rig:response { over = { amplitude = { 1, 2 } }, at = function(p) return { M = { a = p.amplitude * sine(1) } } end }
    near(c["b.amplitude"][2], 2 * c["b.amplitude"][1], 1e-9)
    refuses(function(o) rig:response(o) end, {
        { { over = { status = { 1, 2 } }, at = function() return {} end }, "'status' is a column of the result" },
        { { over = { omega = { 1, 2 } } }, "needs at, such as at = function(p) return { M = { a = excitation.harmonic{" },
    })
end)

long_test("a steady rotation is followed to where it begins to stick and slip", function()
    local rig = system { bodies = { top = { I = 2 }, bit = { I = 0.1, C = 0.05, friction = friction.stribeck { Rd = 0.5, Re = 1, speed = 0.5 } } },
        links = { pipe = { "top", "bit", k = 1, C = 0.02 } } }
    local function at(p) return { M = { top = function(t, theta, velocity) return 20 * (p.speed - velocity.top) end } } end
    local c = rig:response { of = "pipe", over = { speed = { 3, 2, 1 } }, at = at }
    local rotates = rig:response { over = { speed = { 3, 2.5 } }, at = function(p) -- told by the bit, which goes round
        return merged(at(p), { velocity0 = { top = p.speed, bit = p.speed } })
    end }
    equal(rotates["pipe.amplitude"], vector { 0, 0 })
    assert(rotates["bit.amplitude"][1] ~= rotates["bit.amplitude"][1])
    local points = c.points:filter(function(p) return p.kind == "hopf" end)
    equal(#points, 1)
    local v = points.speed[1]
    for _, side in ipairs { -1, 1 } do -- beside it a small disturbance grows, or dies out
        local p = { speed = v + side * 0.02 }
        local o = at(p)
        local s = rig:steady { M = o.M, velocity0 = { top = p.speed, bit = p.speed * 1.02 }, theta0 = { top = 0.55 } }
        equal(s.pipe.amplitude > 0.1, side < 0)
    end
end)

test("a response has two Hopf points where two modes of a squealing rig grow at nearly the same speed", function()
    local rig = system { bodies = { a = { I = 1.87, k = 2.5, C = 0.148, friction = friction.stribeck { Rd = 0.5, Re = 0.9, speed = 0.2 } },
        b = { I = 1.51, k = 0.6, C = 0.01 } }, links = { l = { "a", "b", k = 1.35, C = 0.02 } } }
    local values = { 1, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2 }
    local c = rig:response { over = { v = values }, at = function(p) return { belt = { a = p.v } } end }
    local points = c.points:filter(function(p) return p.kind == "hopf" end)
    equal(#points, 2)
    for i = 1, 2 do
        local least = math.huge
        for _, mode in ipairs(rig:modes { belt = { a = points.v[i] } }) do least = math.min(least, math.abs(mode.re)) end
        near(least, 0, 1e-6)
    end
    assert(math.abs(points.v[1] - points.v[2]) > 1e-3)
    equal(#c.points:filter(function(p) return p.kind == "fold" end), 1)
end)

test("a step past a fold to a motion that does not exist ends no response", function()
    local rig = system { bodies = { a = { I = 1.9923107403099094, k = 1.8783629039637184, C = 0.1, friction = friction.stribeck { Rd = 0.5, Re = 0.9809387481776896, speed = 0.2760879220173598 } },
        b = { I = 0.9225472886220519, k = 0.8, C = 0.05399380755190302 } }, links = { l = { "a", "b", k = 0.4510363011009, C = 0.010164974698937219 } } }
    local c = rig:response { over = { v = vector.linspace(0.05, 2.5, 50) }, at = function(p) return { belt = { a = p.v } } end }
    equal(table.concat(c.points.kind, " "), "fold hopf hopf")
    near(c.jumps.v[1], c.points.v[1], 1e-9)
end)

test("the response of a chain has the columns of its bodies, and follows at", function()
    local c = chain(0.3):response { over = { omega = vector { 0.5, 1, 1.5 } }, -- at may make another system
        at = function(p) return { system = chain(), M = { a = sine(p.omega) } } end }
    for i, omega in ipairs(c.omega) do
        local a, b = amplitudes(omega)
        near(c["a.amplitude"][i], a, 1e-10)
        near(c["b.amplitude"][i], b, 1e-10)
    end
    equal(c.status[2], "steady")
    local map = chain():response { over = { M0 = { 1, 2, 3 }, omega = { 0.5, 1.5 } }, at = function(p) return { M = { a = p.M0 * sine(p.omega) } } end }
    equal(tostring(map.M0), "vector{ 1, 1, 2, 2, 3, 3 }")
    for i = 1, #map do near(map["b.amplitude"][i], map.M0[i] * select(2, amplitudes(map.omega[i])), 1e-9) end
    has(map:plot { z = "b.amplitude", show = false }, "M0")
    refuses(function(o) chain():response(o) end, {
        { { over = { x = { 1 }, y = { 1 }, z = { 1 } }, at = function() return {} end }, "varies one or two" },
        { { over = { x = { 1 } } }, "needs at" },
        { { over = { x = { 1 } }, at = function(p) return p.x end }, "at returned 1" },
    })
end)

test("bifurcation samples one of the bodies", function()
    local rig = chain(0.3)
    local b = bifurcation { over = { a = { 0.5, 1 } }, period = 2 * math.pi / 1.3, skip = 150, keep = 2, workers = 1,
        at = function(p) return { system = rig, of = "b", M = { a = sine(1.3, p.a) } } end }
    equal(#b, 4)
    local s = rig:steady { M = { a = sine(1.3, 1) } }
    near(b.theta[3], s.run.b.theta[1], 1e-6)
    raises_here(function()
        bifurcation { over = { a = { 1 } }, period = 1, skip = 1, keep = 1, workers = 1, at = function(p) return { system = rig, M = {} } end }
    end, "of = \"load\"")
end)

test("a motion bounded by damping is not said to grow near its resonance", function()
    for _, C in ipairs { 0.1, 0.01, 0.001, 0.0001 } do
        local own = { I = 1, k = 1, C = C, Rd = 0.01 }
        local M = excitation.harmonic { omega = 0.999 }
        local idle = { z = { start = 0, rate = function(_, _, _, z) return -z.z end } }
        local wanted = system(own):steady { M = M }
        local motions = { system(own):steady { M = M, states = idle }, system { bodies = { a = own } }:steady { M = { a = M } }.a }
        for i, s in ipairs(motions) do
            equal(s.status, "steady", i)
            near(s.amplitude / wanted.amplitude, 1, 1e-8)
        end
    end
end)

test("a motion is symmetric in its angles and velocities", function()
    local C, k, w = 0.4, 4, 1.1
    local phase = math.atan(2 * w * C, k - 4 * w * w)  -- half a period later the angle at the start is opposite, the velocity is not
    local M = excitation.harmonic { omega = w } + excitation.harmonic { omega = 2 * w, phase = phase }
    local own = { I = 1, k = k, C = C }
    equal(system(own):steady { M = M }.symmetric, false)
    equal(system { bodies = { a = own } }:steady { M = { a = M } }.symmetric, false)
end)

test("the stops of a body do not depend on where the period begins", function()
    for phase = 0, 5 do
        local s = system { bodies = { a = { I = 1, k = 1, Rd = 0.6 } } }:steady { M = { a = excitation.harmonic { omega = 0.4, phase = phase } } }
        equal(s.a.stops, 2)
    end
end)

test("bodies that rest anywhere are not the only solution, and a geared link rests at the angle of its bodies", function()
    local rig = system { bodies = { a = { I = 1, Rd = 1 }, b = { I = 1, Rd = 1 } }, links = { gear = { "a", "b", k = 0.1, ratio = 2 } } }
    local s = rig:steady { theta0 = { a = 0.5, b = 0.1 } }
    equal(s.unique, false)
    near(s.gear.rest.lower, 0.3, 1e-12)
end)

test("a response in which the first body rests and another moves is steady", function()
    local rig = system { bodies = { a = { I = 1, k = 1, Rd = 0.5 }, b = { I = 1, k = 1, C = 0.1 } } }
    local c = rig:response { over = { x = { 0.1, 1 } }, at = function(p) return { M = { b = sine(0.5, p.x) } } end }
    equal(table.concat(c.status, " "), "steady steady")
end)

-- Linear drag alone: the mean velocity is the mean torque over C. With dry friction each period of a long run is the judge.
test("a block without a spring that advances evenly is steady, alone and as the only one of several bodies", function()
    for i, own in ipairs { { I = 1, k = 0, C = 1 }, { I = 1, k = 0, C = 1, Rd = 1 }, { I = 1, k = 0, friction = friction.stribeck { Rd = 1, Re = 1.2, speed = 0.3 } } } do
        local M, sys = sine(1, 3) + 0.1, system(own)
        local advance = i == 1 and 0.1 * 2 * math.pi or sys:simulate { M = M, t_end = 200, dt = 200 }:cycle().drift
        local alone, named = sys:steady { M = M }, system { bodies = { a = own } }:steady { M = { a = M } }
        for _, s in ipairs { alone, named } do
            equal(s.status, "steady")
            has(s:explain():gsub("%s+", " "), ("It advances by %.6g in each period."):format(advance))
            equal(#s.others, 0)
        end
        near(alone.run.theta[#alone.run] - alone.run.theta[1], advance, 1e-9)
        equal(alone.amplitude, nil)
        equal(alone:explain(), named:explain())
    end
    -- One that does not advance is one of a family in both.
    local own, M = { I = 1, k = 0, Rd = 0.3, Re = 0.5 }, sine(1, 1)
    for _, s in ipairs { system(own):steady { M = M }, system { bodies = { a = own } }:steady { M = { a = M } } } do
        equal(s.unique, false)
        says(s, "It is marginally stable", "It is one of a family")
    end
    -- Also where a fast start hides the small advance.
    local saw, block = excitation.sawtooth { amplitude = 0.5, period = 3 }, system { I = 1, k = 0, Rd = 0.2 }
    equal(block:steady { M = saw, velocity0 = 3 }.status, "steady")
    near(block:steady { M = saw, velocity0 = 3 }.stuck, block:steady { M = saw }.stuck, 1e-9)
    equal(system { I = 1, k = 0, Rd = 1 }:steady { M = sine(1, 3) + 2 }.status, "grows")
    has(system { I = 1, k = 0, C = 1, Rd = 1 }:steady { M = 3 }:explain(), "It moves at the constant velocity 2.", "no other motion")
    equal(#system { I = 1, k = 0, C = 1, Rd = 1 }:steady { M = 0.3 }.others, 0)
end)

test("the period of functions that are read is found for named bodies, belts and a base as well", function()
    local function M(t) return 2 * math.sin(1.3 * t) end
    local function belt(t) return 0.2 * math.cos(2.6 * t) end
    local rig, sys = chain(0.3), system { I = 1, k = 4, Rd = 0.3 }
    near(rig:steady { M = { a = M }, belt = { a = belt } }.period, 2 * math.pi / 1.3, 1e-12)
    near(sys:steady { belt = belt }.period, math.pi / 1.3, 1e-12)
    near(sys:steady { M = M, base = belt }.period, 2 * math.pi / 1.3, 1e-12)
end)

test("where no steady motion is found, the answer says whether the motion nearly repeats itself", function()
    local function told(a, b, link, M, omega)
        local s = system { bodies = { a = a, b = b }, links = { l = link } }:steady { M = M, omega = omega }
        equal(s.status, "none")
        return s
    end
    -- The freewheel overruns a little less in each period; the distance from the limit falls as the root of 1/n.
    local stops, pawl = { lower = -0.85, upper = 0.56 }, { "a", "b", friction = friction.freewheel { Rd = 0.01 } }
    local square = function(t) return math.sin(1.67 * t) > 0 and 1 or -1 end
    local slow = told({ I = 1, k = 1.52, C = 0.02, walls = stops }, { I = 1, k = 2.71, C = 0.23 }, pawl, { a = square, b = sine(1.67, 0.9) }, 1.67)
    says(slow, "the motion nearly repeats itself, but changes by 4.6e-05 of its amplitude each time")
    local stop = { "a", "b", walls = { lower = -0.54, upper = 10, stiffness = 282.01 } }
    local irregular = told({ I = 1, k = 2.93, C = 0.02 }, { I = 1, k = 2.33, C = 0.03, Rd = 0.06 }, stop, { a = sine(1.52) }, 1.52)
    says(irregular, "the motion is irregular, or it settles very slowly")
end)

test("other motions are listed once, whatever their phase, and bodies that creep to a place adhere there", function()
    local one = system { I = 1, k = 1, walls = { lower = -0.5, upper = 0.5, stiffness = 50 }, Rd = 0.1 }
    local s = one:steady { M = excitation.harmonic { amplitude = 0.4, omega = 1 } }
    equal(s.periods, 3)
    equal(#s.others, 1)
    equal(s.others[1].periods, 1)
    -- The mirror image of a motion in one of two wells is in the other well.
    local well, M = { I = 1, k = 0, C = 0.3, spring = function(x) return x ^ 3 - x end }, excitation.harmonic { amplitude = 0.1, omega = 1.2 }
    for _, s in ipairs { system(well):steady { M = M, theta0 = 1 }, system { bodies = { a = well } }:steady { M = { a = M }, theta0 = { a = 1 } } } do
        equal(s.unique, false)
        equal(#s.others, 1)
    end
    local rig = system { bodies = { a = { I = 1, k = 2, Rd = 0.3 }, b = { I = 2, k = 1, C = 0.1 } }, links = { c = { "a", "b", Rd = 0.5 } } }
    s = rig:steady { M = { b = excitation.harmonic { amplitude = 0.2, omega = 1 } } }
    equal(s.status, "adheres")
    equal(#s.others, 0)
end)

finish()
