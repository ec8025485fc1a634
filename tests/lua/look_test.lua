-- Details of a function between the nodes of spectral, functions that are rough on every scale, and narrow bumps, which
-- no integrator may miss silently.
dofile "tests/lua/support.lua"

local length, pi = 10, math.pi -- of runs, natural periods
local function lot(a, b) return a + (b - a) * math.random() end
local function oscillator(zeta, ratio) return system { I = 1, k = 4 * pi ^ 2, C = 4 * pi * zeta, Rd = ratio * 4 * pi ^ 2 } end

--- The run under f, which is sampled, and how often f was called.
local function look(sys, f, theta0, options, end_)
    local calls = 0
    local run = sys:simulate { M = excitation.scripted(function(t) calls = calls + 1 return f(t) end, options and options.hints), theta0 = theta0,
        t_end = end_ or length, dt = end_ or length, integrator = integrator.spectral { narrowest = options and options.narrowest } }
    return run, calls
end
local function differs(a, b)
    local theta, velocity = a:at(a.t_end)
    local other, fast = b:at(b.t_end)
    return #a.events ~= #b.events or math.abs(theta - other) > 1e-9 or math.abs(velocity - fast) > 1e-9
end
-- It moves the mass by much more than any error.
local function pulse(at, width) return function(t) return t >= at and t < at + width and 50 or 0 end end
local function nothing() return 0 end
local function smooth(t) return 20 * math.sin(5 * t) end

long_test("few single pulses between the nodes are missed, moving or at rest", function()
    math.randomseed(11)
    for _, resting in ipairs { false, true } do
        local sys, theta0 = oscillator(0.05, resting and 0.3 or 0), resting and 0 or 1
        local still, calls = look(sys, nothing, theta0)
        -- 17 panels of 16 new nodes each, a fifth of that more, and what is asked again at the end
        assert(calls <= 1.2 * 17 * 16 + 20, calls)
        for width, most in pairs { [0.07] = 0, [0.05] = 0.02, [0.03] = 0.2, [0.01] = 0.75 } do
            local n, missed = 75, 0
            for _ = 1, n do
                if not differs(look(sys, pulse(lot(0, length - width), width), theta0), still) then missed = missed + 1 end
            end
            -- three deviations of the lot's own on top
            assert(missed <= most * n + 3 * math.sqrt(most * (1 - most) * n), ("%g wide: %d missed"):format(width, missed))
        end
    end
end)

long_test("no pulse of the width that a user names is missed", function()
    math.randomseed(12)
    for i = 1, 35 do
        local resting, width = i % 2 == 0, 0.002 * 30 ^ math.random()
        local sys, theta0, at, options = oscillator(0.05, resting and 0.3 or 0.02), resting and 0 or 1, lot(0, length - width), { narrowest = width }
        local what = ("%g wide at %.17g"):format(width, at)
        local one = look(sys, pulse(at, width), theta0, options)
        assert(differs(one, look(sys, nothing, theta0, options)), what)
        assert(one.gap <= width, what)
        -- And where it is: a native pulse says so itself.
        assert(not differs(one, sys:simulate { M = excitation.pulse { amplitude = 50, at = at, width = width }, theta0 = theta0, t_end = length,
            integrator = integrator.spectral { narrowest = width } }), what)
    end
end)

test("an unannounced jump costs at most 70 values of M more than an announced one", function()
    math.randomseed(13)
    local sys, more = oscillator(0.05, 0.05), 0
    for _ = 1, 60 do
        local at = lot(1, 9)
        local function f(t) return smooth(t) + (t >= at and 10 or 0) end
        more = more + select(2, look(sys, f, 1)) - select(2, look(sys, f, 1, { hints = { breaks = { at } } }))
    end
    assert(more <= 70 * 60, more)
end)

test("evenly spaced unannounced jumps are predicted: at most 40 values of M for each step of a staircase", function()
    local sys = oscillator(0.05, 0.05)
    local function stairs(width) return function(t) return width * math.floor(t / width) end end
    -- period, values for each jump, M, the breaks of the first period; the mass turns on most steps of the last two, which is
    -- a panel more each time
    for name, case in pairs {
        ["many steps"] = { 0.0371, 40, stairs(0.0371), { 0.0371 } },
        ["few steps, the last one at the very end"] = { 0.25, 40, stairs(0.25), { 0.25 } },
        ["a square wave"] = { 0.3, 60, function(t) return math.fmod(t, 0.3) < 0.2 and 1 or -1 end, { 0.2, 0.3 } },
        ["three in turn"] = { 0.5, 75, function(t)
            local since = math.fmod(t, 0.5)
            return since < 0.1 and 1 or since < 0.2 and 0.3 or -1
        end, { 0.1, 0.2, 0.5 } },
    } do
        local period, most, M, breaks = table.unpack(case)
        local all = {}
        for i = 0, math.ceil(length / period) - 1 do
            for _, at in ipairs(breaks) do all[#all + 1] = i * period + at end
        end
        local found, calls = look(sys, M, 0.1)
        local announced = look(sys, M, 0.1, { hints = { breaks = all } })
        assert(calls <= most * #breaks * length / period, name .. ": " .. calls)
        equal(#found.events, #announced.events, name)
        -- Both know a jump to the rounding of its time, some 1e-15, and a turn's time follows it.
        near(found:at(length), (announced:at(length)), 1e-12)
    end
end)

test("M is not searched for jumps after the end of the run, where it may fail", function()
    local last = 0
    look(oscillator(0.05, 0.05), function(t)
        last = math.max(last, t)
        return 0.25 * math.floor(t / 0.25)
    end, 1, nil, 2.5)
    equal(last, 2.5)
end)

-- Deterministic bits of a time between -1/2 and 1/2: noise that is a function.
local function noise(t)
    local x = string.unpack("i8", string.pack("d", t)) * 0x9E3779B97F4A7C15
    x = x ~ x >> 29
    x = x * 0xBF58476D1CE4E5B9
    x = x ~ x >> 32
    return (x >> 11) * 2 ^ -53 - 0.5
end
local function noise_of(run)
    local said = run.outcome:match "^reached the end, within the noise of the torques, ([%d.e-]+)"
    return tonumber(said) or 0
end

test("an M that is rough on every scale is followed as accurately as possible, and the run says so", function()
    local sys = oscillator(0.05, 0.05)
    local clean, its_calls = look(sys, smooth, 1)
    equal(clean.outcome, "reached the end")
    local function rounded(step) return function(t) return math.floor(smooth(t) / step + 0.5) * step end end
    local function single(t) return (string.unpack("f", string.pack("f", smooth(t)))) end
    local function followed(name, size, M)
        local run, calls = look(sys, M, 1)
        equal(#run.events, #clean.events, name)
        local told = noise_of(run) -- as a few coefficients tell it
        assert(told >= size / 30 and told <= 10 * size, name .. ": " .. run.outcome)
        -- A constant error of that size would move the mass by its own size over k, and it is not constant.
        near(run:at(length), (clean:at(length)), size)
        return calls
    end
    -- Within a few panels, and then no slower than a smooth one.
    for name, case in pairs {
        ["single precision"] = { 20 * 2 ^ -24, single },
        ["noise of 1e-10"] = { 20e-10, function(t) return smooth(t) * (1 + 1e-10 * noise(t)) end },
        ["noise of 1e-7"] = { 1e-7, function(t) return smooth(t) + 1e-7 * noise(t) end },
        ["16 bit"] = { 20 * 2 ^ -15, rounded(20 * 2 ^ -15) }, ["24 bit"] = { 20 * 2 ^ -23, rounded(20 * 2 ^ -23) },
    } do
        local calls = followed(name, case[1], case[2])
        assert(calls <= 2.5 * its_calls, name .. ": " .. calls)
    end
    -- Where it becomes rough under way, chance has a say in how soon that is seen.
    local calls = 0
    for i = 0, 39 do
        local from = 4.9 + 0.005 * i
        calls = calls + followed("only late", 20 * 2 ^ -24, function(t) return t < from and smooth(t) or single(t) end)
    end
    assert(calls <= 2.75 * its_calls * 40, calls)
    -- Below the tolerance nothing is noise, and few steps are jumps, each in its place.
    for _, M in ipairs { function(t) return smooth(t) + 1e-12 * noise(t) end, rounded(20 * 2 ^ -4) } do equal(noise_of(look(sys, M, 1)), 0) end
end)

long_test("a function that is rough at every scale ends the run soon with its own outcome, unless it is as small as noise", function()
    local k = 4 * pi ^ 2
    local lost, calls = look(oscillator(0.05, 0.3), function(t) return k * (noise(t) + 0.5) end, 0.3)
    has(lost.outcome, "noisy on every scale")
    assert(calls < 2e7, calls)
    local function cantor(t) -- flat almost everywhere, and never smooth
        local x, sum, weight = t / (2 * length), 0, 0.5
        for _ = 1, 40 do
            x = 3 * x
            local digit = math.floor(x)
            x = x - digit
            if digit > 0 then sum = sum + weight end
            if digit == 1 then break end
            weight = weight / 2
        end
        return k * sum
    end
    -- What is left of it on short stretches may be small enough to be taken for noise, or for nothing; it is chance which.
    local climb
    climb, calls = look(oscillator(0.05, 0.3), cantor, 0.3, nil, 1)
    assert(climb.status ~= "failed" or climb.outcome:find "on every scale", climb.outcome)
    assert(noise_of(climb) < 1e-4 * k and calls < 8e6, calls)
end)

-- ---- bumps

test("a gaussian agrees with its formula, and is exactly 0 far away", function()
    local M = excitation.gaussian { amplitude = 3, at = 2, sigma = 0.5 }
    for t, value in pairs { [2] = 3, [2.5] = 3 * math.exp(-0.5), [0.5] = 3 * math.exp(-4.5), [2 + 39 * 0.5 + 1e-12] = 0 } do near(M(t), value, 1e-15) end
    equal(M(2 - 1.25), M(2 + 1.25))
    equal(M:next_break(-99), math.huge)
    -- It is right also where times are too coarse for its width.
    local narrow = excitation.gaussian { amplitude = 3, at = 1e9, sigma = 1e-9 }
    equal(narrow(1e9), 3.0)
    equal(narrow(1e9 + 1e-6), 0.0)
end)

test("a load that grows from zero moves a mass at rest from its first moment on", function()
    -- From 1e-308 down numbers lose their digits, and no M is smooth there.
    for _, width in ipairs { 0.01, 0.06 } do
        local swing = 1e6 * width * math.sqrt(2 * pi) / (2 * pi) * math.exp(-2 * (pi * width) ^ 2)
        local run = look(oscillator(0, 0), function(t) return 1e6 * math.exp(-0.5 * ((t - 4.45) / width) ^ 2) end, 0, nil, 6)
        near(run:at(6), swing * math.sin(2 * pi * 1.55), 1e-10 * swing)
    end
end)

test("an integrator with a fixed step refuses a bump that it would miss, and names a step that is short enough", function()
    local function bump(at, sigma) return excitation.gaussian { at = at, sigma = sigma } end
    local M = 1 + bump(5, 0.01) + bump(8, 0.002)
    local function go(load, from, to, by) return oscillator(0, 0):simulate { M = load, t_start = from, t_end = to, dt = to - from, integrator = by } end
    local rk4 = integrator.rk4
    raises(function() go(M, 0, 7, rk4 { h = 0.01 }) end, "h = 0.01 is too long for the narrow bump of M between t = 4.9 and 5.1: use h <= 0.004995, or integrator.spectral{}")
    raises(function() go(M, 0, 9, integrator.dinal1989 { h = 0.01 }) end, "between t = 7.98 and 8.02: use h <= 0.000999")
    raises(function() go(M, 0, 7, rk4 { h = 0.00501 }) end, "too long")
    for _, case in ipairs { { M, 0, 7, rk4 { h = 0.005 } }, { M, 0, 4, rk4 { h = 0.1 } }, { M, 6, 7, rk4 { h = 0.1 } }, { M:window(0, 4), 0, 9, rk4 { h = 0.1 } },
        { M, 0, 9, integrator.spectral {} } } do go(table.unpack(case)) end
    -- The step that is just allowed sees all of it: the error of the rule that it comes to is exp(-pi^2 / h^2 ...).
    local swing = 0.01 * math.sqrt(2 * pi) / (2 * pi) * math.exp(-2 * pi ^ 2 * 1e-4)
    near(go(bump(5, 0.01), 0, 7.3, rk4 { h = 0.005 }).theta[2], swing * math.sin(2 * pi * 2.3), 1e-6 * swing)
end)

finish()
