-- A function that is a formula is read: the same bits as Lua, and its conditions of t are breaks.
dofile "tests/lua/support.lua"

local times = {}
for i = 1, 400 do times[i] = (i - 150) * 0.0371 end
for _, t in ipairs { 0.0, -0.0, 1.0, 2.0, 0.5, 1e-300, 1e16, -1e16, 3e18, 1e300 } do times[#times + 1] = t end

local function same(a, b)
    return string.pack("d", a) == string.pack("d", b)
end

--- The values of the function, read, are those of Lua where Lua gives finite numbers.
local function same_values(f, what)
    local good, wanted = {}, {}
    for _, t in ipairs(times) do
        local ok, value = pcall(f, t)
        if ok and math.type(value) and value == value and math.abs(value) < math.huge then
            good[#good + 1], wanted[#wanted + 1] = t, value + 0.0
        end
    end
    local e = excitation.scripted(f)
    equal(e:obstacle(), nil, what)
    local found = e:values(good)
    for i, value in ipairs(wanted) do
        if not same(found[i], value) then
            error(("%s at t = %.17g: read %.17g, Lua %.17g"):format(what, good[i], found[i], value))
        end
    end
    equal(e:obstacle(), nil, what)
    return #good
end

local function not_read(f, why)
    local found = excitation.scripted(f):obstacle() or "nothing"
    assert(found:find(why, 1, true), found)
    local line = debug.getinfo(f, "S").linedefined
    assert(found:match("reading_test.lua:(%d+): ") and tonumber(found:match(":(%d+):")) >= line, found)
end

local list, deep = { 3, 4.5, 6 }, { a = 1, b = { c = 0.25, n = 3 }, f = math.cos }

test("whole numbers beyond 2^53 are left to Lua", function()
    not_read(function(t) local n = math.maxinteger if t > 0 then n = n + 1 end return n end, "beyond 2^53")
    not_read(function(t) return t + 3000000000 * 4000000 end, "beyond 2^53")
    same_values(function(t) return math.floor(t) * 1048576 * 1048576 - math.floor(t // 2) end, "products")
    same_values(function(t) return math.floor(t) % 3 // math.ceil(t) end, "quotients")
    same_values(function(t) return 1 / (-1e300 * (0 * math.floor(t)) - 1) + math.atan(-math.floor(t), -1) end, "zeros")
end)

test("a function that is not a formula is not read, and the line is named", function()
    local n, view = 0, setmetatable({}, { __index = function() return 2 end })
    not_read(function(t) n = n + 1 return t end, "assigns to a variable outside")
    not_read(function(t) UNUSED_GLOBAL = 1 return t end, "assigns to a global")
    not_read(function(t) list[1] = 3 return t end, "writes into a table")
    not_read(function(t) local v = { t } return v[1] end, "makes a table")
    not_read(function(t) return ("x"):len() * t end, "method")
    not_read(function(t) return #tostring(t) end, "not written in Lua (tostring)")
    not_read(function(t) return t + math.random() end, "not written in Lua (random)")
    not_read(function(t) return view.a * t end, "metatable")
    not_read(function(t) return deep.b * t end, "not a number")
    not_read(function(t) return list[math.floor(t)] or 0 end, "not known beforehand")
    not_read(function(t) local s = 0 for i = 1, t do s = s + i end return s end, "constant bounds")
    not_read(function(t) while t > 1 do t = t / 2 end return t end, "too")
    not_read(function(t) local s = t for i = 1, 1000000 do s = s + i end return s end, "too long")
    not_read(function(t) local f = function() return t end return f() end, "makes a function")
    not_read(function(t) for _, x in ipairs(list) do t = t + x end return t end, "ipairs")
    not_read(function(t, ...) return t end, "any number of arguments")
    not_read(function(t) return math.tointeger(t) or 0 end, "math.tointeger with a float")
    has(excitation.scripted(math.sin):obstacle(), "not a Lua function")
end)

test("constants of a formula are read again when they may have changed", function()
    local a, p, many = 1, { b = 2 }, vector.range(1, 50)
    local e = excitation.scripted(function(t) return a * t + p.b end)
    local function last()
        local run = system { I = 1, k = 1 }:simulate { M = e, t_end = 51, times = { 50 } }
        near(run.M[1], e:values(many)[50], 1e-10)
        return e:values(many)[50]
    end
    equal(last(), 52.0)
    a = 3
    equal(last(), 152.0)
    p.b = -1
    equal(last(), 149.0)
    p = { b = 0.5 }
    equal(last(), 150.5)
    local floor = math.floor
    math.floor = function(x) return 10 * x end
    e = excitation.scripted(function(t) return math.floor(t) end)
    equal(last(), 500.0)
    math.floor = floor
    equal(last(), 50.0)
    local list = { 1, 2 }
    e = excitation.scripted(function(t) return #list * t end)
    equal(last(), 100.0)
    list[3] = 3
    equal(last(), 150.0)
    local base = { gain = 2 }
    local own = setmetatable({}, { __index = setmetatable({}, { __index = base }) })
    e = excitation.scripted(function(t) return own.gain * t + (own.none and 1 or 0) end)
    equal(e:obstacle(), nil)
    equal(last(), 100.0)
    base.gain = 3
    equal(last(), 150.0)
    own.gain = 4
    equal(last(), 200.0)
    getmetatable(own).__index = function() return 1 end
    equal(last(), 201.0)
    has(e:obstacle(), "metatable")
end)

test("sums of native terms, and pieces of them, are run by exact, and have known periods", function()
    local sys = system { I = 1, k = 5, Rd = 0.3, Re = 0.35 }
    local a, w = 2, 3
    local cases = { -- with their periods
        { function(t) return a * math.sin(w * t) end, 2 * math.pi / 3 },
        { function(t) return 1 + 2 * math.sin(3 * t + 0.3) - math.cos(2 * t) / 2 + math.sin(2 * (t - 1)) end, 2 * math.pi },
        { function(t) return math.cos(-w * t + 1) * 2 - (t - t) + 0.25 ^ 2 end, 2 * math.pi / 3 },
        { function(t) return 3 * math.exp(-t / 2) + 0.1 * t - 0.01 * t ^ 2 + (1 - t) * (2 + t) / 50 end },
        { function(t) return t % 2 < 0.7 and 2 or t % 2 < 1.1 and 0.5 or -1 end, 2 },
        { function(t) return math.floor(t / 0.5) % 3 end, 1.5 },
        { function(t) return t - 1.3 * math.floor(t / 1.3) end, 1.3 },
        { function(t) return -t // 0.5 % 3 end, 1.5 },
        { function(t) local x if t % 2 < 1 then x = t % 0.5 else x = t % 0.25 end return x end, 2 },
        { function(t) return math.max(0, math.sin(3 * t)) end, 2 * math.pi / 3 },
        { function(t) return math.abs(math.sin(t)) + (t % 1 < 0.5 and 0.5 or 0) * 0 end },
        { function(t) if t < 1 then return t elseif t < 3 then return math.sin(t) end return 2 * math.exp(3 - t) end },
    }
    for i, case in ipairs(cases) do
        local f, period = case[1], case[2]
        local within = i < 5 and 1e-12 or 1e-9
        local function run(M, integrator, t_end)
            return sys:simulate { M = M, t_start = -1, t_end = t_end or 20, dt = 0.1, theta0 = 0.5, integrator = integrator }
        end
        local found, sampled = run(f), run(unread(f))
        equal(tostring(found.integrator), "integrator.exact{}")
        equal(tostring(sampled.integrator), "integrator.spectral{}")
        equal(#found.events, #sampled.events, "function " .. i)
        near(found.theta, sampled.theta, within)
        assert(found.gap == nil)
        says(found, "sum of native terms")
        equal(run(f, integrator.exact {}).theta, found.theta)
        near((run(f, nil, 8):continue { t_end = 20 }:at(20)), (found:at(20)), 1e-13)
        local late = run(0.7 * excitation.scripted(f):delay(2.3):window(1, 11))
        equal(tostring(late.integrator), "integrator.exact{}")
        near(late.theta, run(unread(function(t) return t >= 1 and t < 11 and 0.7 * f(t - 2.3) or 0 end)).theta, 1e-9)
        if period then
            local s = sys:steady { M = f }
            near(s.period / period - math.floor(s.period / period + 0.5), 0, 1e-12)
            near(s.amplitude, sys:steady { M = unread(f), period = period }.amplitude, 1e-8)
        end
    end
    for _, f in ipairs { function(t) return t * math.sin(t) end, function(t) return math.sin(t * t) end,
        function(t, theta) return math.sin(t) - theta end, function(t) return math.max(0, math.sin(t * t)) end } do
        equal(tostring(sys:simulate { M = f, t_end = 1, dt = 1 }.integrator), "integrator.spectral{}")
    end
    -- what else runs in Lua may change what M depends on
    local run = sys:simulate { M = cases[1][1], t_end = 1, dt = 1, events = { { when = function(t) return t - 0.5 end } } }
    equal(tostring(run.integrator), "integrator.spectral{}")
    refused { { "sys:simulate { M = math.sin, t_end = 1, dt = 1, integrator = integrator.exact {} }", "integrator.exact{} supports only native terms" } }
end)

test("a formula may use theta, velocity and states, and a run is the same to the last bit", function()
    local function rows(M, integrator)
        return system { I = 1, k = 4, Rd = 0.3, Re = 0.4 }:simulate {
            M = M, theta0 = 1, t_end = 20, dt = 0.1, integrator = integrator,
            states = { z = { start = 0, rate = function(_, theta, _, z) return theta - 0.5 * z.z end } },
        }
    end
    local f = function(t, theta, velocity, z) return 2 * math.sin(3 * t) - 0.3 * velocity + 0.1 * theta - 0.2 * z.z end
    for _, i in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.01 } } do
        local a, b = rows(f, i), rows(unread(f), i)
        equal(a.theta, b.theta)
        equal(a.velocity, b.velocity)
        equal(#a.events, #b.events)
    end
end)

-- A law that is read goes on below speed 0 as its formula does, one that is called with a bend: stretches differ.
test("functions of several bodies, of the speed, and rates of states are read with their conditions: runs agree to rounding", function()
    local M = function(t, theta, velocity, z)
        return (theta.b > 0.2 and math.sin(2 * t) or -0.3 * theta.b) + 0.1 * velocity.a - 0.2 * z.e
    end
    local friction = function(speed, t, theta, velocity) return 0.3 + 0.1 * speed + 0.05 * theta.a * velocity.b end
    local alone = function(speed, t, theta) return 0.3 + 0.1 * speed + 0.05 * math.sin(theta) end
    local function rig(of)
        local run = pair({ I = 1, k = 4 }, { I = 2, k = 3, friction = of(friction), Re = 0.5 }, { k = 2 }):simulate { M = { a = of(M) }, theta0 = { b = 0.8 }, t_end = 10, dt = 0.1,
            states = { e = { start = 0.1, rate = of(function(_, theta, _, z) return (theta.a > 0.1 and 1 or -1) - z.e end) } } }
        local one = system { I = 1, k = 4, friction = of(alone), Re = 0.5 }:simulate { theta0 = 2, t_end = 10, dt = 0.1 }
        return run, one
    end
    local x, one = rig(function(f) return f end)
    local y, other = rig(unread)
    near(x.a.theta, y.a.theta, 1e-11)
    near(x.b.velocity, y.b.velocity, 1e-11)
    near(one.theta, other.theta, 1e-12)
    equal(#x.events, #y.events)
    assert(#x.events > 3 and #one.events > 3)
end)

test("a body or a state may be named by a constant, a variable, a field or an argument", function()
    local name, config, keys = "a", { body = "a" }, { "a" }
    local function angle(theta, key) return theta[key] end
    local ways = {
        function(t, theta) return theta.a > 0.2 and -1 or 0.5 end,
        function(t, theta) return theta[name] > 0.2 and -1 or 0.5 end,
        function(t, theta) return theta[config.body] > 0.2 and -1 or 0.5 end,
        function(t, theta) return theta[keys[1]] > 0.2 and -1 or 0.5 end,
        function(t, theta) local key = "a" return theta[key] > 0.2 and -1 or 0.5 end,
        function(t, theta) return angle(theta, name) > 0.2 and -1 or 0.5 end,
    }
    local rig = pair({ I = 1, k = 1 }, { I = 1, k = 2 }, { k = 1 })
    local first
    for _, M in ipairs(ways) do
        local run = rig:simulate { M = { a = M }, t_end = 10, dt = 0.5 }
        equal(run.gap, nil)
        first = first or run
        equal(run.a.theta, first.a.theta)
    end
    -- A state whose rate and name come from variables switches M where the constant name does.
    local function switches(of)
        local run = system { I = 1, k = 1 }:simulate { M = function(t, theta, v, z) return of(z) > 0.3 and 1 or 0 end, t_end = 10,
            states = { a = { start = 0, rate = function() return 0.1 end } } }
        equal(run.gap, nil)
        return run.theta
    end
    equal(switches(function(z) return z[name] end), switches(function(z) return z.a end))
    local ok, message = pcall(rig.simulate, rig, { M = { a = function(t, theta) return theta[1] end }, t_end = 1 })
    assert(not ok and message:find "there is no body '1'", message)
end)

local function before(x)
    local n = string.unpack("i8", string.pack("d", x))
    return x > 0 and string.unpack("d", string.pack("i8", n - 1)) or x - 5e-324
end

local function breaks(f, from, to)
    local e, list, t = excitation.scripted(f), {}, from
    repeat
        t = e:next_break(t)
        list[#list + 1] = t < to and t or nil
    until t >= to
    return list
end

-- ---- excitations inside functions

local points = { t = {}, M = {} }
for i = 0, 40 do points.t[i + 1], points.M[i + 1] = 0.25 * i, math.sin(i * i) end
local function samples(o)
    return excitation.samples { t = points.t, M = points.M, interpolation = o.interpolation, period = o.period }
end
local natives = {
    samples {}, samples { interpolation = "cubic" }, samples { interpolation = "hold" },
    samples { interpolation = "cubic", period = 11 }, excitation.harmonic { omega = 3, phase = 1 },
    excitation.gaussian { at = 3.3, sigma = 1e-4, amplitude = 1e4 }, excitation.chirp { from = 0, to = 2, duration = 3, at = 1 },
    excitation.square { period = 0.77, duty = 0.3 }, excitation.sawtooth { period = 0.77 }, excitation.triangle { period = 0.7 },
    excitation.exponential { tau = 0.5, at = 1 }, excitation.half_sine { at = 1, width = 1e-3, amplitude = 1e3 },
    excitation.pulse { at = 2, width = 1e-4, amplitude = 1e4 }, excitation.ramp { at = 1 }, excitation.step { at = 0.5 },
    excitation.polynomial { coefficients = { 1, -1, 0.1 } },
    2 * excitation.harmonic { omega = 3 }:window(1, 2) + excitation.step { at = 5 } - 0.3,
}

test("an excitation inside a function is read, with the same bits, breaks and motion", function()
    local sys, own = system { I = 1, k = 4, C = 0.2, Rd = 0.1 }, { gain = 0.5 }
    for i, e in ipairs(natives) do
        own.e = e
        for _, f in ipairs { function(t) return e(t) end, function(t) return own.e:value(t - 0.5) * own.gain end,
            function(t) return e(2 * t) + e(math.floor(t)) + e(3) end, function(t) return own.e(t % 2) * t end,
            function(t) if e(t) > 0.25 then return e(t) end return -t end } do
            same_values(f, "excitation " .. i)
        end
        local list, t = breaks(function(x) return e(x) * (1 + x) end, 0.01, 9), 0.01
        for _, found in ipairs(list) do
            t = e:next_break(t)
            equal(found, t, i)
        end
        assert(e:next_break(list[#list] or t) >= 9, i)
        local function run(M, method)
            return sys:simulate { M = M, theta0 = 0.5, t_end = 8, dt = 0.5, integrator = method }
        end
        local wanted = run(0.5 * e:delay(0.25) - 0.1)
        for _, method in ipairs { false, integrator.spectral {} } do
            local found = run(function(x) return own.gain * e(x - 0.25) - 0.1 end, method or nil)
            equal(found.gap, nil, i)
            near(found.theta, wanted.theta, 2e-11)
        end
        equal(run(function(x) return e(x) * (2 + math.sin(x) ^ 3) end).gap, nil, i)
    end
end)

test("samples minus a number inside a function run like the samples, however many", function()
    local t, M = {}, {}
    for i = 0, 20000 do t[i + 1], M[i + 1] = i * 1e-3, math.sin(i * 1e-3) + 0.1 * math.sin(i) end
    local lin, p, sys = excitation.samples { t = t, M = M }, { of = 0.1 }, system { I = 1, k = 4, C = 0.2, Rd = 0.1 }
    local run = sys:simulate { M = function(x) return lin(x) - p.of end, t_end = 20, dt = 1 }
    equal(tostring(run.integrator), "integrator.exact{}")
    near(run.theta, sys:simulate { M = lin - 0.1, t_end = 20, dt = 1 }.theta, 1e-13)
    local function square(x) return lin(x) ^ 2 end
    local found = sys:simulate { M = square, t_end = 5, dt = 1 }
    equal(found.gap, nil)
    near(found.theta, sys:simulate { M = square, t_end = 5, dt = 1, integrator = integrator.rk4 { h = 1e-3 } }.theta, 1e-10)
    -- and a fit takes no longer
    local record = sys:simulate { M = lin - 0.1, t_end = 3, dt = 0.1, theta0 = 1 }
    local fit = identify { data = { t = record.t, theta = record.theta }, M = function(x) return lin(x) - p.of end, I = 1 }
    near(fit.system.C, 0.2, 1e-9)
end)

test("an excitation at a time that depends on the motion, with more arguments or with a function in it is not read", function()
    local e = natives[1]
    local scripted = excitation.scripted(math.sin)
    not_read(function(t) return scripted(t) end, "an excitation that has a function in it")
    not_read(function(t) return e(t, 1) end, "an excitation with more than the time")
    not_read(function(t) return e:delay(t) end, "it calls a method")
    equal(excitation.scripted(function(t, theta) return e(theta) end):obstacle(),
        "it evaluates an excitation at a time that depends on the motion")
end)

test("run.proof states what is known between the samples, or why nothing is known", function()
    local function proof(M) return (M + excitation.step {}):proof() end
    equal(excitation.step {}:proof(), "native terms")
    equal(proof(math.pi * excitation.scripted(function(t) return math.sin(t) * t end)), "read: bounded on every stretch")
    equal(proof(function(t) return t % 2 < 1 and 1 or 0 end), "read: 2 conditions, bounded on every stretch")
    equal(proof(function(t) return natives[1](t) > 0 and 1 or 0 end), "read: 1 condition, bounded on every stretch")
    assert(proof(function(t) return #tostring(t) end):find "^sampled: .*reading_test.lua:%d+: it ")
    local function held(t, theta, v) return -v end
    equal(excitation.sampled(held, { every = 1 }):proof(), "called at its instants only")
    equal(excitation.delayed(held, { by = 1 }):proof(), "read: bounded on every stretch")
    local function cut(t, theta, v) return theta > 0 and 1 or 0 end
    local sampled = "sampled: the function of a delayed excitation has conditions on the motion"
    equal(excitation.delayed(cut, { by = 1 }):proof(), sampled)
    local function relay(of) return excitation.relay { on = 0, off = 1, amplitude = 1, of = of }:proof() end
    equal(relay("theta"), "native terms")
    equal(relay(held), "read: bounded on every stretch")
    equal(relay(function(t, theta, v) return theta > 0 and 1 or 0 end), "sampled: a relay's function has conditions on the motion")
    equal(proof(excitation.delayed(cut, { by = 1 }) + function(t) return t end), sampled .. "; read: bounded on every stretch")
end)

test("an error keeps its line", function()
    raises_here(function()
        local f = function(t)
            if t > 3 then error("too late") end
            return t
        end
        system { I = 1, k = 1 }:simulate { M = f, t_end = 5, dt = 1 }
    end, "too late")

end)

-- ---- conditions are breaks

test("breaks are the very times at which Lua's result changes", function()
    local third = 0.3
    local cases = {
        { function(t) return t < 1 and 2 or 3 end, 1 },
        { function(t) return t * third >= 1 and 2 or 3 end, 1 },
        { function(t) return math.sin(t) > 0.5 and 2 or 3 end, 4 },
        { function(t) return t % 2 < 1.1 and 2 or 3 end, 9 },
        { function(t) return math.floor(t / third) end, 33 },
        { function(t) return math.exp(-t) * t > 0.3 and 2 or 3 end, 2 },
        { function(t) local x = math.floor(t) local y = x x = 0 return y + x end, 9 },
        { function(t) return math.floor((t - 3) * 1e6) == 0 and 5 or 0 end, 2, 2 },
        { function(t) return math.abs(t - 3) < 1e-6 and 5 or 0 end, 2, 2 },
        { function(t) return math.floor(t * 1e3) % 1000 < 500 and 5 or 0 end, 19, 19 },
        { function(t) return t % 1 + 0.5 > 2 and 5 or 0 end, 0, 0 },
        { function(t) return math.atan(t) > 1 and 2 or math.log(t + 1) > 2 and 3 or math.sqrt(t) < 1 and 4 or 5 end, 2 },
        -- folds below zero, and by a negative number
        { function(t) return math.fmod(t - 3, 2) < -1.5 and 2 or 3 end, 2 },
        { function(t) return (t - 3) % -2 < -1.1 and 2 or 3 end, 10 },
        { function(t) return (t - 3) // -0.7 end, 14 },
        { function(t) return math.ceil(-t) end, 9 },
        { function(t) return math.abs(math.abs(t - 5) - 3) > 1 and 2 or 3 end, 4 },
    }
    for i, case in ipairs(cases) do
        local f, count = case[1], case[2]
        local list = breaks(f, 1e-9, 10)
        local changes = 0
        for _, b in ipairs(list) do
            if f(b) ~= f(before(b)) then changes = changes + 1 end
        end
        equal(changes, count, "function " .. i)
        if case[3] then equal(#list, case[3], "breaks of function " .. i) end
        local piece, value = 0, nil
        for k = 1, 4000 do
            local t = k / 401
            if piece == 0 or (list[piece] or 10) <= t then
                repeat piece = piece + 1 until (list[piece] or 10) > t
                value = f(t)
            end
            equal(f(t), value, "between the breaks of function " .. i)
        end
    end
end)

test("kinks of abs, max and min are breaks", function()
    local list = breaks(function(t) return math.abs(t - 1) + math.max(t, 2) + math.min(3 - t, 0.25) end, 0, 10)
    equal(table.concat(list, " "), "1.0 2.0 2.75")
    list = breaks(function(t) return math.abs(math.sin(t)) end, 0.1, 10)
    equal(#list, 3)
    near(list[3], 3 * math.pi, 1e-14)
    -- A kink stays one on its way through variables, max and min, and beside another that turns back at the same time.
    local max, min, abs = math.max, math.min, math.abs
    for i, f in ipairs {
        function(t) return max(0, 1 - abs(t - 3)) end,
        function(t) return 3 + 0.5 * max(0, min(5, 1 - abs(t - 3))) end,
        function(t) local x = 1 - abs(t - 3) return x > 0 and x or 0 end,
        function(t) local x = 1 - abs(t - 3) x = x < 0 and 0 or x return x end,
        function(t) if t < 2 or t > 4 then return 0 end return abs(t - 3) + 2 * abs(3 - t) end,
        function(t) if t < 2 or t > 4 then return 0 end local x = abs(t - 3) return x * x * x + x end,
    } do
        equal(table.concat(breaks(f, 0, 10), " "), "2.0 3.0 4.0", i)
    end
end)

test("steep kinks of a train of narrow pulses are breaks in each period, whatever is added", function()
    for _, w in ipairs { 1e-6, 1e-5, 1e-4, 1.14981e-3, 1e-2, 0.1 } do
        for _, c in ipairs { 0, 0.5, -3, 20 } do
            for _, A in ipairs { 0.1, 1, 1 / w } do
                local triangle = function(t)
                    return c + A * math.max(0, 1 - math.abs((t - 0.487 - 2.7 * math.floor((t - 0.487) / 2.7 + 0.5)) / w))
                end
                local window = function(t)
                    local x = ((t - 0.487 + 1.35) % 2.7 - 1.35) / w
                    return c + A * (math.abs(x) < 1 and 1 - x * x or 0)
                end
                for _, f in ipairs { triangle, window } do
                    local what = ("w %g, c %g, A %g"):format(w, c, A)
                    local list, pulses = breaks(f, 0, 108), 0
                    for _, b in ipairs(list) do
                        if math.abs((b - 0.487 + 1.35) % 2.7 - 1.35 + w) < 1e-9 then pulses = pulses + 1 end
                    end
                    equal(pulses, 40, what)
                    local run = system { I = 1, k = 0 }:simulate { M = f, t_end = 108, dt = 108 }
                    equal(run.gap, nil)
                    local area = 40 * A * w * (f == triangle and 1 or 4 / 3)
                    local rounding = 1e-12 * (108 * math.abs(c) + area) + 2e-14 * area / w
                    assert(math.abs(run.velocity[2] - 108 * c - area) < rounding, what)
                end
            end
        end
    end
end)

test("conditions of theta are not breaks, those of t in the same function are", function()
    local e = excitation.scripted(function(t, theta, velocity)
        if theta > 0 then return t < 1 and 1 or 2 end
        if velocity > 0 then return t < 3 and 1 or 2 end
        return math.abs(theta) + 3 * velocity
    end)
    equal(e:obstacle(), nil)
    equal(e:next_break(0), 1.0)
    equal(e:next_break(1), 3.0)
    equal(e:next_break(3), math.huge)
end)

test("the breaks of a delayed function are delayed", function()
    local e = excitation.scripted(function(t) return t % 2 < 1 and 1 or 0 end):delay(0.25)
    equal(e:next_break(0), 0.25)
    equal(e:next_break(0.25), 1.25)
    equal((e * 2 + 1):next_break(1.25), 2.25)
end)

-- ---- random functions

local r = math.random

-- L is a leaf, N a number, F a function of one argument, E an expression, C a condition and S a statement.
local grammar = {
    L = { "t", "t", "a", "p.x", "p.q.n", "x", "N", "N", "list[2]", "math.pi", "triangle(4)", "math.tointeger(3)", "math.huge * 0", "-0.0", "(t - t)" },
    F = { "sin", "cos", "floor", "ceil", "abs", "sqrt", "atan", "exp", "tan", "log", "asin", "acos", "rad", "deg" },
    E = { "(E + E)", "(E - E)", "(E * E)", "(E / E)", "(E // E)", "(E % E)", "(E) ^ 2", "(E) ^ 3", "-(E)", "math.F(E)", "math.F(E)",
        "math.F(E)", "math.max(E, E)", "math.min(E, E)", "math.max(E, E, E)", "math.min(E, E, E, E)", "math.max(E, E, E, E)", "(C and E or E)", "(C and E or E)",
        "helper(E, E)", "math.fmod(E, 1.5 + E)", "math.fmod(E, 3)", "math.log(E, 2)", "math.log(E, 10)", "math.log(E, 3)", "math.atan(E, E)", "(both(E))",
        "math.max(both(E))", "(none == nil and E or 2)", "math.floor(t) // -1", "(math.floor(t) % 7 - math.floor(t) % -7)", "10 // math.floor(t + 0.5)", "(math.floor(t) * 3 + 1)" },
    C = { "E < E", "E <= E", "E > E", "E >= E", "E == E", "E ~= E", "(C and C)", "(C or C)", "not (C)", "(C) == true", "math.floor(t) < 2" },
    S = { "if C then x = E else x = E end", "for i = -1, 3 do x = x * 0.5 + i * E if C then break end end", "if C then return E end",
        "local y = x x = E + y", "for i = 7, 1, -2 do if t > i then x = x + E else x = x - 0.5 end end", "for i = 3, 1 do x = E end",
        "local i = 0 while i < 5 do i = i + 1 if t < i then break end x = x + i * E end", "local i = 0 repeat i = i + 1 x = 0.5 * x + E until i > 3",
        "local y, z = both(E) x = 2 * y + z", "local y, z = E, E y, z = z, y x = y - z", "local y, z, w = E, E if w == nil then x = z end",
        "assert(x < 1e400, 'far')", "if C then error('early') end" },
}
local function text(symbol, depth)
    if symbol == "N" then return r() < 0.5 and tostring(r(-3, 9)) or ("%.3f"):format(r() * 4 - 2) end
    if symbol == "E" and (depth <= 0 or r() < 0.12) then symbol = "L" end
    local forms = grammar[symbol]
    return (forms[r(#forms)]:gsub("%f[%a][LNFECS]%f[%A]", function(inner) return text(inner, depth - 1) end))
end
local function body()
    local lines = { "local x = 0.5 x = " .. text("E", 5) }
    for _ = 1, r(0, 3) do lines[#lines + 1] = text("S", 3) end
    return table.concat(lines, "\n") .. "\nreturn x + " .. text("E", 5)
end

test("random functions give the same bits read as called", function()
    math.randomseed(tonumber(os.getenv("DINAL_READING_SEED")) or 1)
    local cases, read, values = tonumber(os.getenv("DINAL_READING_CASES")) or 1500, 0, 0
    for case = 1, cases do
        local text = "local a, p, list, helper, both, none = ...\nlocal function triangle(n) return n == 0 and 0 or n + triangle(n - 1) end\n" ..
            "return function(t)\n" .. body() .. "\nend"
        local f = assert(load(text))(r() < 0.5 and r(5) or r() * 3, { x = r() - 0.5, q = { n = r(-4, 4) } },
            { 1, 2.5, -3 }, function(u, v) if u < v then return u - v end return u + 0.5 * v end, function(u) return u, -u end)
        local why = excitation.scripted(f):obstacle()
        if not why then
            read = read + 1
            values = values + same_values(f, "case " .. case .. "\n" .. text)
        else
            assert(why:find "divides by zero" or why:find "too " or why:find "no number" or why:find "fmod" or
                why:find "2%^53", why)
        end
    end
    assert(read > 0.7 * cases and values > 50 * cases, read .. " read, " .. values .. " values")
end)

test("long strings are compared by content", function()
    local wanted = "emergency stop with a locked brake, full load"
    for _, case in ipairs { wanted, table.concat({ "emergency stop with a locked", "brake, full load" }, " "), "emergency stop" } do
        local function M(t) if t > 1 and case == wanted then return 1 end return t end
        local function other(t) if t > 1 and case ~= wanted then return 0 end return t * t end
        for _, f in ipairs { M, other } do
            equal(excitation.scripted(f):obstacle(), nil)
            near(system { I = 1, k = 1, C = 1 }:simulate { M = f, times = { 2 } }.M[1], f(2.0), 1e-15)
        end
    end
end)

test("a train of parabolas moves a mass as its closed form does", function()
    local sys = system { I = 1, k = 4, C = 0.2, Rd = 0.05 }
    local trains = {
        function(t) local x = t % 0.5 return x - x * x end,
        function(t) local x = t % 0.04 / 0.04 return x * (1 - x) end,
        function(t) local x = (t % 0.03) / 0.03 return x * (1 - x) * 4 end,
    }
    for i, f in ipairs(trains) do
        local options = { M = f, theta0 = 0.3, t_end = 6, dt = 0.1 }
        local run = sys:simulate(options)
        options.M = unread(f)
        near(run.theta, sys:simulate(options).theta, 1e-9)
        near(run.M[4], f(run.t[4]), 1e-12)
        equal(run.outcome, "reached the end", i)
    end
end)

test("native terms of a short piece far from t = 0 have the digits of their formula", function()
    local sys = system { I = 1, k = 4, C = 0.2 }
    local shapes = {
        function(x) return 1 - x * x end,
        function(x) return (1 + x) ^ 2 * (2 - x) / 4 end,
        function(x) return math.cos(math.pi * x / 2) end,
        function(x) return math.exp(-3 * (x + 1)) end,
    }
    for _, place in ipairs { { 20002, 0.01 }, { 155001.1, 0.001 }, { 1e4, 0.3 }, { -3e5, 0.01 } } do
        local at, width = place[1], place[2]
        for i, shape in ipairs(shapes) do
            local function f(t)
                local x = (t - at) / width
                if x > -1 and x < 1 then return shape(x) / width end
                return 0
            end
            local options = { M = f, t_start = at - 2, times = { at + 4 } }
            local theta = sys:simulate(options).theta[1]
            equal(tostring(sys:simulate(options).integrator), "integrator.exact{}")
            options.integrator = integrator.spectral {}
            near(theta, sys:simulate(options).theta[1], 1e-9)
            assert(math.abs(theta) > 0.05, i)
        end
    end
end)

test("a formula whose native terms would lose digits is integrated as a function", function()
    local sys = system { I = 1, k = 4, C = 0.2 }
    local function f(t) return (t - 1000) ^ 2 * 1e-6 - (t - 1000) ^ 3 * 1e-9 + 1e9 * (1e-9 * math.sin(t) + 1) - 1e9 end
    local run = sys:simulate { M = f, t_end = 20, dt = 0.5 }
    equal(tostring(run.integrator), "integrator.spectral{}")
    near(run.M[11], f(run.t[11]), 5e-7)  -- to its own rounding
end)

test("bytecode that was tampered with is not read beyond its end", function()
    local dump = string.dump(function(t) return 2 * t + (t > 1 and 0.5 or 0) end)
    local seed = 11
    local function below(n)
        seed = seed * 16807 % 2147483647
        return seed % n
    end
    local read = 0
    for _ = 1, 1000 do
        local bytes = { dump:byte(1, -1) }
        for _ = 1, 2 do bytes[40 + below(#bytes - 39)] = below(256) end
        local good, f = pcall(load, string.char(table.unpack(bytes)), "x", "b")
        if good and f and debug.getinfo(f).nups <= 1 then
            local said = excitation.scripted(f):obstacle()
            assert(said == nil or not tostring(said):find("vector", 1, true), said)
            read = read + 1
        end
    end
    assert(read > 50, read)
end)

finish()
