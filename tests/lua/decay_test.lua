-- Smooth motions that die out until only rounding remains, which is neither noise nor a jump nor an error.
dofile "tests/lua/support.lua"

-- Numbers between 0 and 1 that are the same every time.
local seed = 7
local function random()
    seed = seed * 16807 % 2147483647
    return seed / 2147483647
end
local function between(low, high) return low * (high / low) ^ random() end
local function one_of(list) return list[math.floor(random() * #list) + 1] end

-- Smooth functions of slope 1 at 0 that fall short of their digits there, as differences do, or do not.
local shapes = {
    function(x) return math.exp(x) - 1 end,
    function(x) return (1 - (1 + x) ^ -1.4) / 1.4 end,
    function(x) return math.log(1 + x) end,
    function(x) return ((1 + x) ^ 2 - 1) / 2 end,
    function(x) return 1 / (1 - x) - 1 end,
    function(x) return x / math.sqrt(1 + x * x) end,
    math.sin,
    function(x) return x + x ^ 3 end,
}

-- k, damping c and the options of a run: a spring, a drag and the rate of a state may have any of these shapes.
local kinds = {
    function(k, c, spring, drag)
        local function law(x) return k * spring(x) end
        return system { I = 1, k = 0, spring = law }, { M = function(_, _, v) return -c * drag(v) end }
    end,
    function(k, c, spring)
        local function law(x) return k * spring(x) end
        return system { I = 1, k = 0, C = c, spring = law }, { M = function(t) return 0.01 * math.exp(-c * t) end }
    end,
    function(k, c, _, drag)
        return system { I = 1, k = k }, { M = unread(function(_, _, v) return -c * drag(v) end) }
    end,
    function(k, c, spring, drag)
        local function rate(_, _, v, z) return spring(v / 2) - c * drag(z.q) end
        return system { I = 1, k = k, C = c },
            { M = function(_, _, _, z) return -0.2 * c * z.q end, states = { q = { start = 0, rate = rate } } }
    end,
    function(k, c, spring, drag)
        local bodies = { a = { I = 1, k = k, spring = function(x) return k * spring(x) end }, b = { I = 2, k = k, C = c } }
        local links = { rod = { "a", "b", k = k } }
        return system { bodies = bodies, links = links }, { M = { a = unread(function(_, _, v) return -c * drag(v.a) end) } }
    end,
}

test("motions of smooth springs, drags and states without dry friction die out to rounding", function()
    for i = 1, 100 do
        local k, damping, size = between(0.3, 30), between(0.1, 1.5), between(1e-4, 0.2)
        local rate = damping * math.sqrt(k)
        local sys, task = kinds[i % #kinds + 1](k, rate, one_of(shapes), one_of(shapes))
        task.theta0, task.t_end, task.times = type(task.M) == "table" and { a = size } or size, 200 * 2 / rate, { 0 }
        local run = sys:simulate(task)
        local what = ("system %d: %s"):format(i, run.outcome)
        equal(run.t_end, task.t_end, what)
        equal(run.status, "end", what)
    end
end)

test("a smooth motion that dies out follows its closed form down to rounding, and its run can be continued", function()
    -- v' = 1 - (1 + v)^2 is solved by 1 + v = (1 + a exp(-2 t)) / (1 - a exp(-2 t)) with a = v0 / (2 + v0).
    local v0 = 0.5
    local a = v0 / (2 + v0)
    local function velocity(t) return 2 * a * math.exp(-2 * t) / (1 - a * math.exp(-2 * t)) end
    for _, M in ipairs { function(_, _, v) return 1 - (1 + v) ^ 2 end, unread(function(_, _, v) return 1 - (1 + v) ^ 2 end) } do
        local run = system { I = 1, k = 0 }:simulate { velocity0 = v0, M = M, t_end = 100, dt = 0.25 }
        equal(run.outcome, "reached the end")
        for i = 1, #run do near(run.velocity[i], velocity(run.t[i]), 1e-12 * velocity(run.t[i]) + 1e-15) end
        equal(run:continue(200).outcome, "reached the end")
    end
end)

test("a smooth motion that starts near the rounding of its functions, or below it, reaches the end", function()
    local z = { q = { start = 0, rate = function(_, _, v, z) return math.log(1 + v) - 2 * z.q end } }
    local cases = {
        { { k = 1 }, { M = function(_, _, v) return 1 - (1 + v) ^ 2 end } },
        { { k = 0, C = 0.5, spring = function(x) return 10 * (1 - (1 + x) ^ -1.4) end }, {} },
        { { k = 1, C = 0.5, spring = function(x) return math.exp(x) - 1 end }, {} },
        { { k = 1, friction = function(speed) return math.exp(speed) - 1 end }, {} },
        { { k = 1 }, { M = function(_, _, _, z) return -z.q end, states = z } },
    }
    for i, case in ipairs(cases) do
        case[1].I, case[2].t_end, case[2].times = 1, 50, { 5, 50 }
        for _, start in ipairs { 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15, 1e-16, 1e-20 } do
            case[2].theta0 = start
            local run = system(case[1]):simulate(case[2])
            local what = ("case %d from %g: %s"):format(i, start, run.outcome)
            equal(run.t_end, 50, what)
            equal(run.status, "end", what)
            -- So small it is linear; the first one is critically damped.
            if i == 1 then near(run.theta[1], 6 * math.exp(-5) * start, 1e-15) end
            near(run.theta[2], 0, 1e-4 * start + 2e-15)
        end
    end
end)

test("an M with few digits is followed within its noise when the motion has died out", function()
    local function rounded(x) return math.floor(x * 1e10 + 0.5) / 1e10 end
    local M = unread(function(_, _, v) return rounded(1 - (1 + v) ^ 2) end)
    local run = system { I = 1, k = 1 }:simulate { theta0 = 0.001, t_end = 50, times = { 0, 50 }, M = M }
    local said = tonumber(run.outcome:match("^reached the end, within the noise of the torques, (%S+)$"))
    assert(said and said > 1e-12 and said < 1e-9, run.outcome)
    near(run.theta[2], 0, 1e-9)
end)

test("a run continues when a state decays to denormal numbers", function()
    local run = system { I = 1, k = .136 }:simulate { theta0 = 1e-13, velocity0 = .26, t_end = 1000, dt = 100,
        states = { a = { start = 0, rate = function(t, q, v, z) return math.log(1 + v * v) - z.a end } },
        M = function(t, q, v, z) return -.793 * v * (1 + .5 * math.sin(3 * t)) - .01 * z.a end }
    equal(run.t_end, 1000, run.outcome)
    near(run:at(1000), 0, 1e-14)
end)

test("steady finds the rest to which a smooth motion dies out, even if other starts fail", function()
    -- A slider with rate and state friction (Erickson, Birnir and Lavallee 2008): by Routh and Hurwitz its rest is stable
    -- up to eps = 0.4975.
    local function slider(eps)
        local function rate(_, _, w, z) return -(1 + w) * (z.s + (1 + eps) * math.log(1 + w)) end
        local function M(_, _, w, z) return -2 * (z.s + math.log(1 + w)) end
        return system { I = 0.01, k = 1 }:steady { theta0 = 0.001, M = M, states = { s = { start = 0, rate = rate } } }
    end
    equal(slider(0.3).status, "rest")
    equal(slider(0.6).status, "steady")
    -- Starts farther out have no number to begin with.
    local function M(_, x, v) return math.sqrt(0.5) - math.sqrt(x + 0.5) - math.log(1 + v) end
    for _, f in ipairs { M, unread(M) } do
        local found = system { I = 1, k = 1 }:steady { theta0 = 0.3, M = f }
        equal(found.status, "rest")
    end
end)

test("a motion far smaller than the numbers in its unread functions follows the linear motion", function()
    for i = 1, 40 do
        local k, c, size = between(0.3, 3), between(0.2, 2), between(1e-13, 1e-9)
        local spring, drag = one_of(shapes), one_of(shapes)
        local M = unread(function(_, theta, v) return -k * spring(theta) - c * drag(v) end)
        local run = system { I = 1, k = 0 }:simulate { M = M, theta0 = size, t_end = 100 / c, times = { 0, 1, 4 } }
        local what = ("system %d, %g: %s"):format(i, size, run.outcome)
        equal(run.t_end, 100 / c, what)
        equal(run.status, "end", what)
        local linear = system { I = 1, k = k, C = c }:simulate { theta0 = size, t_end = 100 / c, times = { 0, 1, 4 } }
        for row = 1, 3 do near(run.theta[row], linear.theta[row], 1e-14 + 10 * size ^ 2) end
    end
end)

finish()
