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

test("short visits beyond a condition in the rate of a state are not missed", function()
    for _, beyond in ipairs { 1e-2, 1e-4, 1e-6 } do
        local run = system { I = 1, k = 1 }:simulate {
            velocity0 = 1, t_end = 4, states = { z = { rate = function(_, theta) return theta > 1 - beyond and 100 or 0 end } },
        }
        near(run.z[#run], 200 * math.acos(1 - beyond), 1e-9)  -- theta = sin t
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
    for _ = 1, 20 do
        local a, b, c, d, e = r() - 0.5, r() - 0.5, 0.2 + r(), 1 + 2 * r(), 0.3 * r()
        local functions = {
            function(t, theta) return theta > a and c or e * math.sin(d * t) end,
            function(t, theta, velocity) return velocity >= b and -c or math.max(theta, a) end,
            function(t, theta, velocity) return math.abs(theta - a) * e + (theta * velocity > 0.02 and -c or c) end,
            function(t, theta, velocity) return math.min(c, -velocity) + (t % 2 < 1 and theta > a and 1 or 0) end,
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
    for _, f in ipairs { function(t, theta, velocity, z) return (t % 1 > 0.3 and 1 or 0) - z.u end, unread(rate) } do
        local u = 0
        local run = system { I = 1, k = 1, Rd = 0.1 }:simulate {
            M = function(t, theta, velocity, z) return z.u end, states = { u = { rate = f } }, t_end = 20, dt = 1,
        }
        for i = 1, 21 do
            near(run.u[i], u, 1e-12)
            u = 1 + (u * math.exp(-0.3) - 1) * math.exp(-0.7)
        end
    end
    assert(calls < 700 * 40, calls)

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
end)

test("equal functions give the same motion, however their conditions are written", function()
    local pairs_of_functions = {
        -- at a turn, 10 + velocity has lost the digits of what sets off
        { function(_, _, velocity) return -0.2 * math.floor((10 + velocity) / 0.5) end,
            function(_, _, velocity) return -0.2 * math.floor(velocity / 0.5) - 4 end },
        -- the square root has no value beyond theta = 0, if |theta| is taken to be theta there
        { function(_, theta) return math.min(0.4, math.abs(theta) ^ 0.5) end,
            function(_, theta) return math.abs(theta) > 0.16 and 0.4 or math.abs(theta) ^ 0.5 end },
        { function(_, _, velocity) return 0.1 * ((math.abs(velocity) ^ 0.5 - 2) // 0.9) end,
            function(_, _, velocity)
                local speed = math.abs(velocity)
                return speed < 0.04 and -0.3 or speed < 1.21 and -0.2 or -0.1
            end },
        -- what |...| is taken of jumps with the velocity
        { function(_, theta, velocity) return math.abs((velocity // -1.3) ^ 2 - theta - 0.3) end,
            function(_, theta, velocity) return velocity > 0 and 0.7 - theta or math.abs(theta + 0.3) end },
    }
    for i, pair in ipairs(pairs_of_functions) do
        local ends = {}
        for k, M in ipairs(pair) do
            local run = system { I = 1, k = 4, C = 0.05, Rd = 0.1, Re = 0.15 }:simulate {
                M = M, theta0 = 0.3, velocity0 = 0.1, t_end = 4,
            }
            equal(run.status, "end", i)
            ends[k] = run
        end
        near(ends[1].theta[#ends[1].theta], ends[2].theta[#ends[2].theta], 1e-10, i)
    end
end)

--- A mass under a state of this rate.
local function under_state(rate)
    return system { I = 1, k = 4, C = 0.02, Rd = 0.1, Re = 0.15 }:simulate {
        M = function(_, _, _, state) return state.z end, theta0 = 0.3, velocity0 = 0.1, t_end = 4,
        states = { z = { start = 0.1, rate = rate } },
    }
end

--- Two bodies under this load of the second.
local function of_two(M)
    local rig = system { bodies = { a = { I = 1, k = 4, Rd = 0.1, Re = 0.15 }, b = { I = 0.5 } }, links = { ab = { "a", "b", k = 3, C = 0.1 } } }
    return rig:simulate { M = { b = M }, theta0 = { a = 0.3, b = 0.1 }, velocity0 = { a = 0.1, b = -0.2 }, t_end = 4 }
end

test("a condition of |theta| is found on both sides of theta = 0, for a rate and between bodies", function()
    local function visits(theta) return math.abs(theta) ^ 0.5 > 0.172 end
    local function equal_ones(theta) return math.abs(theta) > 0.172 ^ 2 end
    local one, two = {}, {}
    for i, fast in ipairs { visits, equal_ones } do
        local run = under_state(function(_, theta) return fast(theta) and 0.1 or 3 end)
        one[i] = run.theta[#run.theta]
        local both = of_two(function(_, theta, velocity) return fast(theta.b - theta.a / 2) and -velocity.b or -0.2 end)
        two[i] = both.a.theta[#both.a.theta]
    end
    near(one[1], one[2], 1e-11)
    near(two[1], two[2], 1e-11)
end)

test("a function that jumps at the zero of a condition, or only touches its limit there, does not chatter", function()
    -- the velocity of b passes 0, where |velocity| > 0 is false for no time
    local ends = {}
    for i, M in ipairs {
        function(_, _, velocity) return math.abs(velocity.b) > 0 and 0.1 or 0.5 end,
        function(_, _, _) return 0.1 end,
    } do
        local run = of_two(M)
        equal(run.status, "end")
        ends[i] = run.b.theta[#run.b.theta]
    end
    near(ends[1], ends[2], 1e-12)
end)

test("a condition crossed on a long stretch stays crossed on the short stretch after it", function()
    -- behind theta = 0 the next stretch ends at t = 1
    local ends = {}
    for i, low in ipairs {
        function(t, theta) return theta < 0 and math.min(-t, -1) or -t end,
        function(t, theta) return theta < 0 and t < 1 and -1 or -t end,
    } do
        local run = under_state(function(t, theta, _, state) return math.sin(low(t, theta)) - state.z end)
        equal(run.status, "end", i)
        ends[i] = run.theta[#run.theta]
    end
    near(ends[1], ends[2], 1e-11)
end)

test("a function that truncates its digits is noise, not a condition", function()
    local run = system { I = 1, k = 1 }:simulate { M = function(_, theta) return -math.floor(theta * 1e9) / 1e9 end, theta0 = 1, t_end = 1 }
    near(run.theta[#run.theta], math.cos(math.sqrt(2)), 1e-7)
    says(run, "which are sampled")
end)

test("math.ceil of the motion jumps where the opposite of math.floor does", function()
    local function run(M) return system { I = 1, k = 1 }:simulate { M = M, theta0 = 2.5, t_end = 20, dt = 0.1 } end
    local steps = run(function(_, theta) return math.ceil(theta) / 2 end)
    near(steps.theta, run(function(_, theta) return -math.floor(-theta) / 2 end).theta, 1e-11)
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

test("what a formula would do beyond its kink does not spoil the rate of a state before it", function()
    for _, w in ipairs { 3e-4, 1e-2 } do
        local rate = function(_, x) return 0.1 / w * math.exp(-math.abs(x - 1.5) / w) end
        local run = system { I = 1, k = 0 }:simulate { velocity0 = 1, t_end = 5, states = { z = { rate = rate } } }
        near(run.states.z[#run.t], 0.2, 1e-12)
    end
end)

finish()
