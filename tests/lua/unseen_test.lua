-- A pulse far narrower than a stretch, in every kind of function that is read, is found, or the gap is reported.
-- Its effect is known in closed form: the integral of exp(-x^2) is sqrt(pi), that of 1/cosh(x) is pi.
dofile "tests/lua/support.lua"

local exp, root = math.exp, math.sqrt(math.pi)
local seed = 20
local function lot(a, b)
    seed = (seed * 1103515245 + 12345) % 2147483648
    return a + (b - a) * seed / 2147483648
end

-- Of pulses w wide, at p, of unit width times height, whose integral is `area`.
local shapes = {
    { area = root, at = function(p, w) return function(x) return exp(-((x - p) / w) ^ 2) / w end end },
    { area = math.pi, at = function(p, w) return function(x) return 2 / (exp((x - p) / w) + exp(-(x - p) / w)) / w end end },
    -- An excitation inside a function: of theta it is not read, so the gap is told.
    { area = root, at = function(p, w)
        local bump = excitation.gaussian { at = p, sigma = w / math.sqrt(2), amplitude = 1 / w }
        return function(x) return bump(x) end
    end },
    { area = 1, at = function(p, w)
        local pulse = excitation.pulse { at = p, width = w }
        return function(x) return pulse(x) / w end
    end },
}
local t_end = 2.5
local free = { I = 1, k = 0 }
local function glide(system_of, o)
    o = o or {}
    o.velocity0, o.t_end, o.dt = o.velocity0 or 1, t_end, .5
    local run = system(system_of):simulate(o)
    return select(2, run:at(t_end)), run
end
-- Each returns the velocity at the end, and what it must be.
local kinds = {
    M = function(f, area) return 1 + area, glide(free, { M = function(t) return f(t) end }) end,
    field = function(f, area) return math.sqrt(1 + 2 * area), glide(free, { M = function(t, theta, v) return f(theta) end }) end,
    damping = function(f, area) return exp(-area), glide(free, { M = function(t, theta, v) return -v * f(t) end }) end,
    state = function(f, area)
        local _, run = glide(free, { M = function(t, theta, v, z) return 0 * z.q end,
            states = { q = { start = 0, rate = function(t, theta, v, z) return f(t) end } } })
        return area, run.states.q[#run.states.q], run
    end,
    spring = function(f, area) return math.sqrt(1 - .2 * area), glide { I = 1, k = 0, spring = function(theta) return .1 * f(theta) end } end,
    friction = function(f, area) return 1 - .1 * area, glide { I = 1, k = 0, friction = function(speed, t) return .1 * f(t) end } end,
    Rd = function(f, area) return 1 - .1 * area, glide { I = 1, k = 0, Rd = function(t) return .1 * f(t) end } end,
    normal = function(f, area) return 1 - .1 * area, glide { I = 1, k = 0, Rd = .1, normal = function(t) return f(t) end } end,
    base = function(f, area) return 1 - .1 * area, glide(free, { base = function(t) return .1 * f(t) end }) end,
    delayed = function(f, area)
        return 1 + area, glide(free, { M = excitation.delayed(function(t, theta, v) return f(t) end, { by = .1 }) })
    end,
    relay = function(f, area, w)
        local run = system(free):simulate { t_end = t_end, dt = .5, M = excitation.relay { on = .3, off = .2, amplitude = 1,
            start = "off", of = function(t, theta, v) return w * f(t) end } }
        return 2, #of_kind(run, "switch"), run
    end,
    moved = function(f, area)
        local bodies = { m = { theta = function(t) return .1 * f(t) end }, b = { I = 1 } }
        local run = system { bodies = bodies, links = { s = { "m", "b", k = 1e-3 } } }:simulate { t_end = t_end, dt = .5 }
        return 1e-4 * area, run.b.velocity[#run.b.velocity], run
    end,
}

test("a narrow smooth pulse is found in every kind of function", function()
    local names = {}
    for kind in pairs(kinds) do names[#names + 1] = kind end
    table.sort(names)
    for _, kind in ipairs(names) do
        local of = kinds[kind]
        for n = 1, lots(24) do
            local shape = shapes[n % #shapes + 1]
            local p, w = lot(.3, 1.5), 10 ^ lot(-6, -2)
            local want, got, run = of(shape.at(p, w), shape.area, w)
            local what = ("%s: w %g p %g got %.10g want %.10g gap %s"):format(kind, w, p, got, want, run.gap)
            assert(math.abs(got - want) < 2e-6 or (run.gap and run.gap > w), what)
            if kind == "M" then assert(math.abs(got - want) < 1e-8, what) end
        end
    end
end)

test("run.gap counts sampled parts of delayed excitations and relays, and unread events, but not functions called at instants", function()
    local function gap(M) return system(free):simulate { M = M, velocity0 = 1, t_end = 1, dt = .5 }.gap end
    local function narrow(t, theta, v) return exp(-((theta - .5) / 1e-6) ^ 2) end
    assert(gap(excitation.delayed(function(t, theta, v) return theta > .5 and theta < .6 and 1 or 0 end, { by = .01 })) > 0)
    assert(gap(excitation.relay { on = .5, off = .4, amplitude = 1, of = function(...) return narrow(...) end }) > 0)
    equal(gap(excitation.relay { on = .5, off = .4, amplitude = 1, of = narrow }), nil)
    equal(gap(excitation.relay { on = .5, off = .4, amplitude = 1, of = "theta" }), nil)
    equal(gap(excitation.sampled(narrow, { every = .1 })), nil)
    equal(gap(excitation.sampled(narrow, { every = .1 }) + function(t) return math.sin(t) end), nil)
    local function late(t) return t - 2 end
    local function watched(when) return system(free):simulate { velocity0 = 1, t_end = 1, events = { { when = when } } }.gap end
    equal(watched(late), nil)
    assert(watched(unread(late)) > 0)
end)

test("a narrow pulse over the past motion is found", function()
    for _ = 1, 24 do
        local p, w = lot(.3, 1.5), 10 ^ lot(-6, -2)
        local M = excitation.delayed(function(t, theta, v) return exp(-((theta - p) / w) ^ 2) / w end, { by = .1 })
        -- The velocity is still 1 while the pulse is passed.
        local got, run = glide(free, { M = M })
        assert(math.abs(got - 1 - root) < 1e-6, ("p %g w %g: %.12g"):format(p, w, got))
        equal(run.gap, nil)
    end
    local _, run = glide(free, { M = excitation.delayed(function(t, theta, v) return -v end, { by = .1 }) })
    equal(run.gap, nil)
end)

test("a small narrow pulse beside a sine is found", function()
    for _ = 1, 40 do
        local p, w, A = lot(.3, 1.5), 10 ^ lot(-6, -1), 10 ^ lot(-5, -1)
        local got = glide(free, { velocity0 = 0, M = function(t) return math.sin(t) + A * exp(-((t - p) / w) ^ 2) end })
        local want = 1 - math.cos(t_end) + A * w * root
        assert(math.abs(got - want) < 1e-11, ("A %g w %g: %g"):format(A, w, got - want))
    end
end)

test("a narrow pulse of the belt, and of an event's function, is found", function()
    for _ = 1, 24 do
        local p, w = lot(.3, 1.5), 10 ^ lot(-5, -2)
        local got = glide({ I = 1, k = 0, Rd = .1 }, { belt = function(t) return 3 * exp(-((t - p) / w) ^ 2) end })
        local want = 1 - .1 * t_end + .4 * w * math.sqrt(math.log(3 / (1 - .1 * p)))
        assert(math.abs(got - want) < .01 * w, ("w %g: %g, want %g"):format(w, got, want))
        local run = system { I = 1, k = 4 }:simulate { theta0 = 1, t_end = 3, dt = 1,
            events = { { when = function(t) return exp(-((t - p) / w) ^ 2) - .5 end } } }
        local told = run.events:filter(function(e) return e.kind == "user" end)
        equal(#told, 2)
        local far = w * math.sqrt(math.log(2))
        assert(math.abs(told[1].t - (p - far)) < 1e-9 and math.abs(told[2].t - (p + far)) < 1e-9)
    end
end)

test("conditions of springs and events are located, however narrow", function()
    for _ = 1, 20 do
        local a, w = lot(.3, 1.5), 10 ^ lot(-6, -1)
        -- A step of the potential by 3/8 takes three quarters of the energy 1/2.
        local got = glide { I = 1, k = 0, spring = function(theta) if theta > a and theta < a + w then return .375 / w end return 0 end }
        assert(math.abs(got - .5) < 1e-9 + 2e-13 / w, ("w %g: %.12g"):format(w, got))
        local run = system(free):simulate { velocity0 = 1, t_end = t_end, dt = 1,
            events = { { when = function(t, theta) if theta > a and theta < a + w then return 1 end return -1 end } } }
        local told = run.events:filter(function(e) return e.kind == "user" end)
        equal(#told, 2)
        assert(math.abs(told[1].t - a) < 1e-9 and math.abs(told[2].t - (a + w)) < 1e-9)
    end
end)

test("a condition that depends on something narrow is found", function()
    for _, d in ipairs { 1e-2, 1e-4, 1e-6 } do
        local run = system(free):simulate { velocity0 = 1, t_end = 2, dt = .1, M = function(t, theta, v)
            if exp(-((theta - .3) / d) ^ 2) > .5 then return 1 / d end
            return 0
        end }
        -- It is as wide as 2 d sqrt(ln 2).
        assert(math.abs(select(2, run:at(2)) - math.sqrt(1 + 4 * math.sqrt(math.log(2)))) < 1e-7)
        equal(run.gap, nil)
    end
end)

test("a pulse right before a condition is found although its formula overflows beyond it", function()
    for _, w in ipairs { 1e-3, 1e-4, 3e-5, 1e-6 } do
        for _, theta in ipairs { .7, 1.03447 } do
            -- exp(2 (x - p)/w) overflows behind p, and the function is 0 there.
            local got, run = glide(free, { M = function(t, x, v)
                if x < theta then
                    local e = exp(2 * (x - theta) / w)
                    return 2 * e / (1 + e) ^ 2 / w
                end
                return 0
            end })
            assert(math.abs(got - math.sqrt(2)) < 1e-9 or run.gap, ("w %g: %g, gap %s"):format(w, got, run.gap))
        end
    end
end)

test("a very short push, over a ten millionth of the way, changes the energy by its work", function()
    local function left_over(k, a, w, area, kind)
        local b = a + w
        local push = area / (b - a)
        local function window(theta) return theta > a and theta < b and push or 0 end
        local of, o = { I = 1, k = k }, { velocity0 = 5.4, t_end = 1.4 / math.sqrt(math.max(k, 1)), dt = 1 }
        if kind == "spring" then
            of.spring = function(theta) return -window(theta) end
        else
            o.M = function(t, theta) return window(theta) end
        end
        local run = system(of):simulate(o)
        local theta, velocity = run:at(o.t_end)
        assert(theta > a + w)
        return (velocity ^ 2 + k * theta ^ 2) / 2 - 5.4 ^ 2 / 2 - area
    end
    for _, kind in ipairs { "M", "spring" } do
        for _ = 1, 20 do
            local k, a, w = lot(.5, 30), lot(.05, .8), 10 ^ lot(-7, -6)
            local off = left_over(k, a, w, lot(-5, 5), kind)
            assert(math.abs(off) < 5e-8, ("%s, k %g, at %.17g, w %.17g: %g"):format(kind, k, a, w, off))
        end
    end
    -- So great that what it would do in a whole stretch hides its end.
    near(left_over(.5, .3667, 1.3e-7, 7.4, "M"), 0, 5e-8)
end)

test("a mass that turns in a window as narrow as a ten millionth of its way leaves it as fast as it came", function()
    local function energy_off(w, event)
        local from, push = .7, 3 / w
        local function M(t, theta) return theta > from and theta < from + w and push or 0 end
        local events = event and { { when = function(t, theta) return theta - from - event * w end } }
        local sys = system { I = .5, k = .2, Rd = .1 }
        local run = sys:simulate { M = M, theta0 = 1, velocity0 = -1, t_end = 1.5, events = events }
        local deepest = math.huge
        for i = 1, #run.events do deepest = math.min(deepest, run.events.theta[i]) end
        assert(deepest > from and deepest < from + w)
        local theta, velocity = run:at(1.5)
        local way = 1 - deepest + theta - deepest
        return (.5 * velocity ^ 2 + .2 * theta ^ 2) / 2 - (.5 + .2) / 2 + .1 * way
    end
    for _ = 1, 20 do
        local w = 10 ^ lot(-7, -3)
        local off, with_event = energy_off(w), energy_off(w, .95)
        assert(math.abs(off) < 5e-8 and math.abs(with_event) < 5e-8, ("w %.17g: %g, %g"):format(w, off, with_event))
    end
end)

test("a rise from almost zero to a peak is not a native term", function()
    local swings = system { I = 1, k = 1 }
    local function after(M) return select(2, swings:simulate { M = M, t_end = 3, dt = 1 }:at(3)) end
    for _, w in ipairs { 1e-2, 1e-3, 1e-4, 1e-5 } do
        local one = after(function(t) return t < 2 and exp((t - 2) / w) / w or 0 end)
        near(one, (math.cos(1) - w * math.sin(1)) / (1 + w ^ 2), 1e-11)
        near(after(function(t) return exp(-math.abs(t - 2) / w) / w end), 2 * math.cos(1) / (1 + w ^ 2), 1e-11)
    end
end)

test("a pulse in a velocity window is followed although its formula has no bounds outside", function()
    local S = system { I = 1, k = 17, C = .1 }
    local function after(M) return select(2, S:simulate { velocity0 = 6.8, t_end = .3, dt = 1, M = M }:at(.3)) end
    local alone = after()
    for _, w in ipairs { 1e-6, 1e-5, 1e-4 } do
        local off = after(function(t, x, v)
            return -1e-3 * (math.abs(v - 4.4) < w and (1 - ((v - 4.4) / w) ^ 2) ^ 3 or 0)
        end) - alone
        assert(math.abs(off) < 1e-3 * w + 1e-11, ("w %g: %g"):format(w, off))
    end
end)

test("an unproven function is reported in run.gap", function()
    local S = system { I = 1, k = 4, C = .2 }
    local function gap(M, o)
        o = o or {}
        o.M, o.t_end, o.dt = M, 10, 1
        return S:simulate(o).gap
    end
    equal(gap(function(t) return math.sin(t) / (1.2 + math.cos(t)) end), nil)
    -- A quotient whose denominator may be 0 has no proven bound.
    local sinc = gap(function(t) local x = 3 * (t - 4.321) return math.sin(x) / x end)
    assert(sinc > 0 and sinc < S.T0, sinc)
    for _, by in ipairs { integrator.rk4 { h = .01 }, integrator.dinal1989 { h = .01 } } do
        equal(gap(function(t) return math.sin(t) / (1.2 + math.cos(t)) end, { integrator = by }), .005)
    end
    -- The gap of a spring or a law of friction is reported, too.
    local function sampled(system_of)
        system_of.I = 1
        return system(system_of):simulate { theta0 = 1, t_end = 1, dt = .5, integrator = integrator.rk4 { h = .01 } }.gap
    end
    near(sampled { k = 1, spring = function(theta) return math.sin(theta) end }, .005, 1e-12)
    local function rising(speed) return .1 + speed end
    for _, law in ipairs { rising, friction.law(rising) } do near(sampled { k = 1, friction = law }, .005, 1e-12) end
    equal(sampled { k = 1, Rd = .1 }, nil)
end)

test("an event right before a kink of its function is located although the old formula overflows beyond it", function()
    for _, w in ipairs { 1e-2, 5.5e-4, 1e-6 } do
        local p = .7121358593554413
        local run = system { I = 1, k = 4, C = .2 }:simulate { theta0 = -.95997455, t_end = 1.5, dt = .5,
            events = { { when = function(t, theta, v) return exp(-math.abs((v - p) / w)) - .5 end } } }
        local told = run.events:filter(function(e) return e.kind == "user" end)
        equal(#told, 4)
        for i, side in ipairs { -1, 1, 1, -1 } do
            assert(math.abs((told[i].velocity - p) / w - side * math.log(2)) < 1e-3, i)
        end
    end
end)

test("a relay whose function jumps past both thresholds switches once", function()
    for _ = 1, 20 do
        local a, b = lot(.2, .4), lot(.5, .9)
        local run = system { I = 1, k = 0, C = .1 }:simulate { velocity0 = 1, t_end = 1.5, dt = .5,
            M = excitation.relay { on = .6, off = .4, amplitude = { .3, 0 }, start = "off",
                of = function(...) local theta = select(2, ...) return theta > a and theta < b and 1 or 0 end } }
        equal(#of_kind(run, "switch"), 2)
    end
end)

test("a narrow peak of a law is found in a list of laws as in the law alone", function()
    local function law(more) return friction.law(function(v) return more + 3 * math.exp(-((v - 0.37) / 0.002) ^ 2) end) end
    local function run(own)
        return system { I = 1, k = 4, friction = own }:simulate { M = excitation.harmonic { amplitude = 1.4, omega = 0.8 }, theta0 = 1.5, t_end = 20, dt = 0.1 }
    end
    local one, many = run(law(0.3)), run { law(0.2), friction.coulomb { Rd = 0.1 } }
    equal(#many.events, #one.events)
    near(many.theta, one.theta, 1e-12)
end)

test("a narrow dip of the law that holds a mass lets it slip", function()
    for _, w in ipairs { 1e-2, 1e-4, 1e-6 } do
        local run = system { I = 1, k = 0, friction = function(speed, t) return 1 - .9 * exp(-((t - .7) / w) ^ 2) + .1 * speed end }:simulate {
            M = .5, t_end = 1.5, dt = .5 }
        equal(table.concat(run.events.kind, " "), "slip stick")
        near(run.events[1].t, .7 - w * math.sqrt(math.log(1.8)), 1e-9)
    end
end)

test("an event in one direction ignores a peak in the other one, also where a stretch is repeated", function()
    for _, w in ipairs { 1e-2, 7.1e-4, 1e-6 } do
        for direction, side in pairs { up = 1, down = -1 } do
            local p = .92874850474157
            local run = system { I = 1, k = 1 }:simulate { velocity0 = 1, t_end = 1.5, dt = .5, events = { { direction = direction,
                when = function(t, theta, v) local e = exp(-math.abs(v - p) / w) return 2 * e / (1 + e * e) - .5 end } } }
            equal(#run.events, 1)
            near((run.events[1].velocity - p) / w, side * math.log(2 + math.sqrt(3)), 1e-3)
        end
    end
end)

test("a smooth window whose formula overflows beyond its ends does not end the run", function()
    local function bump(p, w)
        return function(x)
            local u = (x - p) / w
            if math.abs(u) >= 1 then return 0 end
            return exp(1 - 1 / (1 - u * u)) / w
        end
    end
    for _, kind in ipairs { "M", "field", "damping", "state", "spring", "friction", "Rd", "normal", "base", "delayed" } do
        for _ = 1, lots(12) do
            local p, w = lot(.3, 1.5), 10 ^ lot(-6, -1.5)
            local want, got = kinds[kind](bump(p, w), 1.2069003224378765, w)
            near(got, want, 2e-6, ("%s: w %g p %g"):format(kind, w, p))
        end
    end
end)

test("the rounding of a formula is not taken for a jump of a friction limit or a belt", function()
    local M = excitation.harmonic { amplitude = 1, omega = 1.3 }
    local function run(of, o)
        local parts, options = { I = 1, k = 1, C = .1, Rd = not of.friction and .2 or nil }, { M = M, theta0 = .5, t_end = 20, dt = 1 }
        for key, value in pairs(of) do parts[key] = value end
        for key, value in pairs(o) do options[key] = value end
        local found = system(parts):simulate(options)
        equal(found.status, "end", found.outcome)
        return found:at(20)
    end
    for _, w in ipairs { 3e-3, 3e-4, 5e-5 } do
        -- The first form loses digits: cos t - 1 = -2 sin(t/2)^2.
        local rounds = function(t) return exp((math.cos(t) - 1) / w ^ 2) end
        local exact = function(t) return exp(-2 * (math.sin(t / 2) / w) ^ 2) end
        for kind, of in pairs {
            Rd = function(f) return { Rd = function(t) return .2 * f(t) end }, {} end,
            Re = function(f) return { Re = function(t) return .2 + .3 * f(t) end }, {} end,
            normal = function(f) return { normal = function(t) return 1 + f(t) end }, {} end,
            law = function(f) return { friction = function(s, t) return .1 + .1 * f(t) end }, {} end,
            belt = function(f) return {}, { belt = function(t) return .5 + f(t) end } end,
        } do
            near(run(of(rounds)), run(of(exact)), 1e-6, ("%s: w %g"):format(kind, w))
        end
    end
end)

finish()
