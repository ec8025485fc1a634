-- Conditions on theta, velocity and states in functions that are read: each change of one is located. The example
-- 172-conditions-on-the-motion.lua has a bang-bang motion and a clearance with their known periods.
dofile "tests/lua/support.lua"

test("an encoder acts as a spring in steps, whose energy is conserved", function()
    local d, K, theta0 = 0.05, 3, 0.52
    local run = system { I = 1, k = 1 }:simulate { M = function(_, theta) return -K * math.floor(theta / d) * d end, theta0 = theta0, t_end = 10 }
    local function energy(theta, v)
        local n = math.floor(theta / d)
        return v ^ 2 / 2 + theta ^ 2 / 2 + K * d * (n * theta - d * n * (n + 1) / 2)
    end
    for t = 1, 10 do near(energy(run:at(t)), energy(theta0, 0), 1e-12) end
end)

test("a staircase that is only compared with constants changes at these levels alone", function()
    local p, w = 0.1, 1e-7
    local function ended(M) return system { I = 1, k = 1, C = 0.1, Rd = 0.2 }:simulate { M = M, theta0 = 1.2, t_end = 30, times = {} } end
    local expected = ended(function(t, theta) return (theta >= p and theta < p + w and 5e4 or 0) + 2 * math.sin(0.7 * t) end)
    for name, M in pairs {
        floor = function(t, theta) return (math.floor((theta - p) / w) == 0 and 5e4 or 0) + 2 * math.sin(0.7 * t) end,
        divided = function(t, theta) return ((theta - p) // w == 0 and 5e4 or 0) + 2 * math.sin(0.7 * t) end,
        ceil = function(t, theta) return (math.ceil((theta - p) / w) == 1 and 5e4 or 0) + 2 * math.sin(0.7 * t) end,
        between = function(t, theta)
            local n = math.floor((theta - p) / w)
            return (n > -1 and n < 0.5 and 5e4 or 0) + 2 * math.sin(0.7 * t)
        end,
        branches = function(t, theta)
            local n = math.floor((theta - p) / w)
            local first = t % 3 < 1.5
            return ((first and n == 0 or not first and 0 <= n and not (n >= 1)) and 5e4 or 0) + 2 * math.sin(0.7 * t)
        end,
    } do
        local run = ended(M)
        near(run:at(30), expected:at(30), 1e-10)
        equal(run.gap, nil, name)
    end
end)

test("the greater of two saturated terms is not decided by their rounding again and again", function()
    local function tanh(x) return (math.exp(x) - math.exp(-x)) / (math.exp(x) + math.exp(-x)) end
    local function go(greater)
        return system { I = 1, k = 1, C = 0.1 }:simulate {
            M = function(t, theta, velocity, s) return greater(tanh(-9.94 * theta - 24.27 * velocity - 3 * s.z - 1.3), tanh(-14.61 * theta + 16.82 * velocity - 6.6 * s.z - 1.3)) + math.sin(t) end,
            states = { z = { start = 0.3, rate = function(t, theta, velocity, s) return theta - s.z end } }, theta0 = 2, t_end = 30,
        }
    end
    for name, greater in pairs { min = math.min, max = math.max } do
        local run = go(greater)
        equal(run.status, "end", name)
        near(run:at(30), go(function(a, b) return (a + b + (name == "min" and -1 or 1) * ((a - b) ^ 2) ^ 0.5) / 2 end):at(30), 1e-8)
    end
end)

test("many conditions on the motion do not hide the conditions on time", function()
    local terms = {}
    for i = 1, 12 do terms[i] = ("if theta > %g then M = M + %g * math.sin(%g * t) end"):format(0.1 * i - 0.55, 0.1 * i, 0.3 * i) end
    local M = load("return function(t, theta) local M = 0 " .. table.concat(terms, " ") .. " return M + (t % 2 < 1 and 1 or -1) end")()
    local sys, task = system { I = 1, k = 1, C = 0.1, Rd = 0.2 }, { theta0 = 1.2, t_end = 30, times = {} }
    local run = sys:simulate(merged(task, { M = M }))
    equal(run.gap, nil)
    local square = excitation.square { amplitude = 1, period = 2 }
    local whole = load("return function(t, theta) local M = 0 " .. table.concat(terms, " ") .. " return M end")()
    near(run:at(30), sys:simulate(merged(task, { M = square + whole })):at(30), 1e-10)
end)

test("a comparison is decided anew when its operands jump", function()
    local function tanh(x) return 1 - 2 / (math.exp(2 * x) + 1) end
    local function spring(theta) return 0.728 * tanh(math.max(-0.594 - 1.651 * theta, math.sin(2.696 * theta))) end
    local function M(t, theta, velocity, s)
        local first = math.floor((1.115 * velocity - 1.997 * s.z - 0.528) / 0.707) % 2 == 0 and -0.462 or math.sin(1.342 * t) + math.sin(0.352 * t)
        local second = 1.604 * theta + 1.971 * velocity <= 0.015 and 0.013 - 0.351 * theta + 0.167 * velocity or -0.936
        return 0.66 * math.max(first, second) + 0.873 * math.sin(1.997 * t)
    end
    local function ended(by)
        local run = system { I = 1.481, k = 2.516, C = 0.279, spring = spring }:simulate {
            M = M, states = { z = { start = 0.2, rate = function(t, theta, velocity, s) return -1.72 - 0.997 * s.z end } }, theta0 = 1.4587, velocity0 = 0.1783,
            t_end = 15, integrator = by,
        }
        equal(run.status, "end")
        return run:at(15)
    end
    near(ended(integrator.dopri5 { tolerance = 1e-11 }), ended(integrator.spectral {}), 1e-8)
end)

test("short visits beyond a condition are not missed", function()
    -- it turns just behind the threshold, for a very short time
    for _, beyond in ipairs { 1e-2, 1e-4, 1e-6 } do
        local top = 1
        local run = system { I = 1, k = 1 }:simulate {
            M = function(_, theta) return theta > top - beyond and 100 or 0 end, theta0 = 0, velocity0 = 1, t_end = 4,
        }
        -- behind it M = 100 pushes it on: theta - 100 = (top - beyond - 100) cos s + v sin s
        local before, v = math.asin(top - beyond), math.sqrt(1 - (top - beyond) ^ 2)
        local s = 4 - before
        near(run.theta[#run.theta], 100 + (top - beyond - 100) * math.cos(s) + v * math.sin(s), 1e-9)
    end
end)

test("a few small jumps in a row are treated as jumps, not as noise", function()
    local small = 1e-6
    for _, d in ipairs { 1 / 2, 1 / 16 } do
        local run = system { I = 1, k = 0 }:simulate { M = function(_, theta) return 1 + small * math.floor(theta / d) end, velocity0 = 1, t_end = 1 }
        local x, v = run:at(1)
        local n = math.floor(x / d)
        near(v ^ 2 / 2, 0.5 + x + small * (n * x - d * n * (n + 1) / 2), 1e-14)
        says(run, "are located")
    end
end)

test("functions that are read and sampled give the same motion", function()
    math.randomseed(3)
    local r = math.random
    for _ = 1, lots(60) do
        local a, b, c, d, e = r() - 0.5, r() - 0.5, 0.2 + r(), 1 + 2 * r(), 0.3 * r()
        local functions = {
            function(t, theta) return theta > a and c or e * math.sin(d * t) end,
            function(t, theta, velocity) return velocity >= b and -c or math.max(theta, a) end,
            function(t, theta, velocity) return math.abs(theta - a) * e + (theta * velocity > 0.02 and -c or c) end,
            function(t, theta, velocity) return math.min(c, -velocity) + (t % 2 < 1 and theta > a and 1 or 0) end,
            -- At a turn, 10 + velocity has lost the digits of what sets off.
            function(t, theta, velocity) return 0.2 * math.floor((10 + velocity) / c) end,
            -- No square root is left of theta = a, if |theta - a| is taken to be theta - a there.
            function(t, theta) return math.min(c, math.abs(theta - a) ^ 0.5) end,
            function(t, theta, velocity) return math.abs((velocity // -d) ^ 2 - theta - e) end,
        }
        local f = functions[r(#functions)]
        local sys = system { I = 1, C = 0.1, k = d, Rd = 0.05, Re = 0.06 + 0.1 * r() }
        local function go(M, narrowest)
            return sys:simulate { M = M, theta0 = 0.6 + a, t_end = 8, integrator = integrator.spectral { narrowest = narrowest or math.huge } }
        end
        local x, y = go(f), go(unread(f), 0.05) -- samples must not miss a short visit beyond a condition
        if y.status == "failed" then -- only a function that is read slides along its condition
            has(y.outcome, "switched endlessly")
            near(x:at(y.t_end), y:at(y.t_end), 1e-8)
        else
            equal(x.status, y.status)
            equal(#x.events, #y.events)
            near(x.theta, y.theta, 1e-8)
        end
    end
end)

test("a jump at a given time is found in a function that also depends on the motion, and in the rate of a state", function()
    -- u goes to 0 for 0.3 of each unit of time, and to 1 for the rest
    local calls = 0
    local function rate(t, theta, velocity, z)
        calls = calls + 1
        return (t % 1 > 0.3 and 1 or 0) - z.u
    end
    local wanted = { 0 }
    for i = 1, 20 do wanted[i + 1] = 1 + (wanted[i] * math.exp(-0.3) - 1) * math.exp(-0.7) end
    for _, f in ipairs { function(t, theta, velocity, z) return (t % 1 > 0.3 and 1 or 0) - z.u end, unread(rate) } do
        expect({ I = 1, k = 1, Rd = 0.1 }, { M = function(t, theta, velocity, z) return z.u end, states = { u = { rate = f } }, t_end = 20, dt = 1 }, { u = wanted })
    end
    assert(calls < 2 * 700 * 40, calls)

    local function M(t, theta) return (math.sin(t * t / 10) > 0.3 and 1 or 0) - 0.3 * theta end
    local asked = 0
    local function go(f) return system { I = 1, k = 40, Rd = 0.1 }:simulate { M = f, theta0 = 1, t_end = 40, dt = 1 } end
    local found, sampled = go(M), go(unread(function(t, theta) asked = asked + 1 return M(t, theta) end))
    near(found.theta, sampled.theta, 1e-10)
    assert(asked < 600 * 51, asked)  -- of so many jumps
end)

test("a sampled jump that drives the motion back from both sides ends the run with an explanation", function()
    local f = function(_, theta, velocity) return theta + velocity > 0 and -1 or 1 end
    local run = system { I = 1, k = 1 }:simulate { M = unread(f), theta0 = 2.7, t_end = 40 }
    equal(run.status, "failed")
    has(run.outcome, "switched endlessly")
    near(run.t_end, 4.8154495, 1e-6)
    -- Beside one that is read and could slide there, too.
    local M = excitation.scripted(f) + excitation.scripted(unread(f))
    has(system { I = 1, k = 1 }:simulate { M = M, theta0 = 2.7, t_end = 40 }.outcome, "switched endlessly")
end)

test("a function that truncates its digits is noise, not a condition", function()
    local run = system { I = 1, k = 1 }:simulate { M = function(_, theta) return -math.floor(theta * 1e9) / 1e9 end, theta0 = 1, t_end = 1 }
    near(run.theta[#run.theta], math.cos(math.sqrt(2)), 1e-7)
    says(run, "which are sampled")
end)

test("functions that round or fold the motion jump where math.floor of it does", function()
    local function run(M) return system { I = 1, k = 1 }:simulate { M = M, theta0 = 2.5, t_end = 20, dt = 0.1 }.theta end
    for folded, by_floor in pairs {
        [function(_, q) return math.ceil(q) / 2 end] = function(_, q) return -math.floor(-q) / 2 end,
        [function(_, q) return math.fmod(q, 0.8) end] = function(_, q) return q - 0.8 * (q < 0 and -math.floor(-q / 0.8) or math.floor(q / 0.8)) end,
        [function(_, q) return q % -0.8 end] = function(_, q) return q + 0.8 * math.floor(q / -0.8) end,
        [function(_, q) return q // 0.8 end] = function(_, q) return math.floor(q / 0.8) end,
    } do
        near(run(folded), run(by_floor), 1e-11)
    end
end)

test("a narrow window that a square decides is passed whole in M, springs, rates and beside another body", function()
    local p, free = 1.9715, system { I = 1, k = 0 }
    local faster, slower = math.sqrt(1 + 2 * 0.2), math.sqrt(1 - 2 * 0.2)
    local function last(column) return column[#column] end
    for _, w in ipairs { 1e-3, 1e-5, 1e-6, 1e-7 } do
        local A = 0.1 / w
        for _, f in ipairs {
            function(x) return (x - p) ^ 2 < w ^ 2 and A or 0 end,
            function(x) return 1.5 * A * math.max(0, 1 - ((x - p) / w) ^ 2) end,
            function(x) return math.abs(x - p) < w and A or 0 end,
        } do
            local from = { velocity0 = 1, t_end = 5 }
            near(last(system { I = 1, k = 0, spring = f }:simulate(from).velocity), slower, 1e-9)
            near(last(free:simulate { velocity0 = 1, t_end = 5, M = function(_, x) return f(x) end }.velocity), faster, 1e-9)
            local asked = free:simulate { velocity0 = 1, t_end = 5, states = { z = { rate = function(_, x) return f(x) end } } }
            near(last(asked.states.z), 0.2, 1e-9)
            local rig = system { bodies = { a = { I = 1 }, b = { I = 1, Rd = 0.1 } } }
            local both = rig:simulate { velocity0 = { a = 1 }, t_end = 5, M = { a = function(_, theta) return f(theta.a) end } }
            near(last(both.a.velocity), faster, 1e-9)
        end
    end
end)

test("a condition on the motion is located and slid along where a condition on time opens it", function()
    local sys = system { I = 1, k = 1.6458, C = 0.1, Rd = 0.05, Re = 0.1 }
    local function at_end(M)
        local run = sys:simulate { M = M, theta0 = 1.055, t_end = 20, times = {} }
        assert(run.status ~= "failed" and not run.gap, run.outcome)
        return run:at(20)
    end
    local theta = at_end(function(t, theta, velocity) return velocity < 0.3 and math.sin(2 * t) > 0 and 0.8 or 0 end)
    near(at_end(function(t, theta, velocity) return math.sin(2 * t) > 0 and velocity < 0.3 and 0.8 or 0 end), theta, 1e-12)
    near(at_end(function(t, theta, velocity)
        if t % math.pi < math.pi / 2 then
            if velocity < 0.3 then return 0.8 end
        end
        return 0
    end), theta, 1e-9)
end)

test("a load that switches at a speed at which a belt passes it late is decided", function()
    -- The body sticks to the belt, whose speed passes the level at pi/18 after each period.
    for _, start in ipairs { 0, 2 * math.pi * 5, 2 * math.pi * 50 } do
        for level = 0.25, 0.35, 0.01 do
            local run = system { I = 1, k = 0.1, Rd = 5 }:simulate { belt = function(t) return 0.2 + 0.6 * math.sin(3 * t) end, velocity0 = 0.2,
                M = function(_, _, v) return v > level and -0.3 or 0.3 end, t_start = start, t_end = start + 2 }
            equal(run.t_end, start + 2)
        end
    end
end)

finish()
