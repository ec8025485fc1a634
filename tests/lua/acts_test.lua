-- Acts of user events, events at the same instant, and ends of motions that must not be decided by rounding.
dofile "tests/lua/support.lua"

local block = system { I = 1, k = 0 }
local methods = { integrator.spectral {}, integrator.rk4 { h = 0.01 }, integrator.dopri5 { tolerance = 1e-11 } }

local function above(t, theta) return theta - 0.1 end

-- A fall from 1.5 above: it comes down after sqrt(3), with velocity sqrt(3), in a field where the rest is closed form, too.
local function fall(act, t_end, method, direction)
    return block:simulate {
        theta0 = 1.6, M = -1, t_end = t_end, dt = 0.1, integrator = method,
        events = { { when = above, act = act, direction = direction } },
    }
end

test("a bounce by act, written in two ways, is reported once, and the mass stays above", function()
    for _, method in ipairs(methods) do
        for _, act in ipairs { function(_, theta, v) return theta, -v end, function(_, theta, v) return theta, math.abs(v) end } do
            local run = fall(act, 100, method)
            local bounces = of_kind(run, "user").t
            equal(#bounces, 29) -- sqrt(3) (2 n - 1) <= 100
            -- rk4 is exact under a constant torque, too; the clock loses some ulps of 100
            for n, t in ipairs(bounces) do near(t, math.sqrt(3) * (2 * n - 1), 1e-10) end
            assert(run.theta:min() >= 0.1 - 1e-12)
            equal(run.outcome, "reached the end")
        end
    end
end)

test("an act that reverses a block makes no turn, and one that throws it over the zero of another event no passage", function()
    for _, method in ipairs(methods) do
        local function at_one(act) return { when = function(t) return t - 1 end, act = act } end
        expect(block, { velocity0 = 1, t_end = 3, integrator = method, events = { at_one(function(_, theta, v) return theta, -v end) } },
            { events = 1, user = { 1 }, theta = -1, within = 1e-11 })
        expect(block, { theta0 = 0.05, velocity0 = -0.1, t_end = 12, integrator = method,
            events = { at_one(function(_, _, v) return 0.8, v end), { when = above } } }, { user = { 1, 8 }, within = 1e-9 })
    end
end)

test("a state that reaches zero with an event can be reversed by its act", function()
    for _, method in ipairs(methods) do -- to 1.25, and then to and fro over a length of 2
        expect(block, { t_end = 10, dt = 1, integrator = method,
            states = { way = { start = 1, rate = function() return 0 end }, x = { rate = function(_, _, _, z) return z.way end } },
            events = { { when = function(_, _, _, z) return math.abs(z.x - 0.25) - 1 end, act = function(_, _, _, z) z.way = -z.way end } },
        }, { user = { 1.25, 3.25, 5.25, 7.25, 9.25 }, within = 1e-10 })
    end
end)

test("bounces by act that die out end the run with a remedy, and the mass never falls through", function()
    for _, method in ipairs(methods) do
        for _, direction in ipairs { "down", "both" } do
            for kept, most in pairs { [0.9] = 1e-3, [0.5] = 1e-4, [0.01] = 1e-4, [1e-5] = 1e-4, [0] = 1e-4 } do
                local run = fall(function(_, theta, v) return theta, -kept * v end, 100, method, direction)
                has(run.outcome, "endlessly", "walls")
                -- the sum of the bounces; the last ones, 1e-5 of the first, are not waited for
                near(run.events[#run.events].t, math.sqrt(3) * (1 + 2 * kept / (1 - kept)), most)
                assert(run.theta:min() >= 0.1 - 1e-12)
                says(run, "bounces made by act never come to rest")
            end
        end
    end
end)

test("a mass stopped by an act may stick there, return, or be moved on later", function()
    local dry = system { I = 1, k = 0, Rd = 0.1 }
    for _, method in ipairs(methods) do
        local function stopped(sys, M, wanted, when)
            return expect(sys, { velocity0 = 1, M = M, t_end = 3, dt = 1, integrator = method,
                events = { { when = when or function(_, theta) return theta - 0.5 end, act = function(_, theta) return theta, 0 end } } }, wanted)
        end
        stopped(dry, 0.05, { status = "stuck", theta = 0.5 })
        -- x = t - 0.05 t^2 to the place, and back from rest
        stopped(block, -0.1, { theta = 0.5 - 0.05 * (3 - 10 + math.sqrt(90)) ^ 2 })
        stopped(block, 0.1, { theta = 1.05 + 0.05 * 2 ^ 2 }, function(s) return s - 1 end)
        -- a stop that does not hold is not for ever
        local slips = stopped(dry, excitation.ramp { slope = 0.05 }, { status = "failed" })
        has(slips.outcome, "endlessly")
        near(slips.t_end, 2, 1e-6)
        near(slips.theta:max(), 0.5, 1e-13)
    end
end)

moves("acts at even times are not taken for acts that die out", block, { velocity0 = 1, t_end = 10.02, dt = 1,
    events = { { when = function(t) return math.sin(20 * math.pi * t) end, act = function(_, theta, v) return theta, v + 1 end } } }, { status = "end", events = 200 })

-- 3 - .6 n at the turns, by hand: the fourth, at .6 > Re/k, is one, and the next is a rest.
test("a user's event where the velocity is zero comes after the turn, and does not make it a slip", function()
    local peaks = expect({ I = 1, k = 1, Rd = 0.3, Re = 0.5 }, { theta0 = 3, t_end = 20, dt = 1, events = { { when = function(_, _, v) return v end } } },
        { turn = 4, user = 4, slip = 0, parts = false })
    equal(peaks.events[#peaks.events].kind, "rest")
end)

test("a state that only reaches or touches Re holds the mass; one that exceeds it releases the mass", function()
    local sys = system { I = 1, k = 4, C = 0.2, Rd = 0.3, Re = 0.5 }
    local function run(rate, t_end, wanted)
        return expect(sys, { M = function(_, _, _, z) return z.e end, t_end = t_end, dt = 1, states = { e = { rate = rate } } }, wanted)
    end
    for _, rate in ipairs {
        function(t) return t < 0.5 and 1 or 0 end,
        function(_, _, _, z) return z.e < 0.5 and 1 or 0 end,
        function(t) return 0.5 * math.pi * math.cos(math.pi * t) end,
    } do run(rate, 5, { events = 0, theta = 0, parts = false }) end
    -- what may be the rounding of a state, 3e-12, is not past the limit
    near(run(function() return 0.4 end, 3).events[1].t, 1.25, 1e-11)
    near(run(function(t) return 0.5001 * math.pi * math.cos(math.pi * t) end, 3, { parts = false }).events[1].t, math.asin(0.5 / 0.5001) / math.pi, 1e-9)
end)

test("a jump of velocity by an act comes back through a delay, also at the end of a step", function()
    -- M is -v(t - by), and v is 1 before the run: pieces whose M is a line
    local by, t1, thrown = 0.7, 0.5, -1
    local x, v = 0, 1
    local function piece(M, slope, t) x, v = x + v * t + M * t ^ 2 / 2 + slope * t ^ 3 / 6, v + M * t + slope * t ^ 2 / 2 end
    piece(-1, 0, t1)
    v = thrown
    piece(-1, 0, by - t1)
    piece(-1, 1, t1)
    piece(-thrown, 1, by - t1)
    for _, method in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.125 }, integrator.rk4 { h = 0.1 } } do
        expect(block, { M = excitation.delayed(function(_, _, v) return -v end, { by = by }), velocity0 = 1, t_end = 2 * by, dt = 1, integrator = method,
            events = { { when = function(t) return t - t1 end, act = function(_, theta) return theta, thrown end } } }, { theta = x, velocity = v, within = 1e-14, parts = 1e-12 })
    end
end)

test("a hundred and fifty acts at nearly one instant are not chatter", function()
    local kicks, apart = 150, 2 ^ -31
    local events = {}
    for i = 1, kicks do
        events[i] = { when = function(t) return t - 0.25 - i * apart end, act = function(_, theta, v) return theta, v + 1 end }
    end
    expect(block, { t_end = 1, dt = 1, events = events }, { events = kicks, velocity = kicks, theta = 0.75 * kicks - apart * kicks * (kicks + 1) / 2 })
end)

test("an event is reported only when its value passes in its direction, even if it oscillates much faster than the motion", function()
    local sys = system { I = 1, k = 1, C = 0.05, Rd = 0.1, Re = 0.2 }
    for _, omega in ipairs { 0.5, 1, 2, 3, 4, 5, 6, 8, 10, 13, 25, 100 } do
        for direction, first in pairs { up = 2, down = 1 } do
            local run = sys:simulate {
                M = excitation.harmonic { omega = 1.25 }, theta0 = 1, t_end = 20, dt = 20,
                events = { { when = function(t) return math.sin(omega * t + 0.1) end, direction = direction } },
            }
            local told = of_kind(run, "user").t
            local passages = (20 * omega + 0.1) / math.pi
            equal(#told, math.max(0, (passages - first) // 2 + 1 | 0), direction .. " " .. omega)
            -- the sine itself is rounded to 1e-16, its time to an ulp of 20
            for i, t in ipairs(told) do near(t, ((first + 2 * (i - 1)) * math.pi - 0.1) / omega, 1e-13) end
        end
    end
end)

test("events at the instant of one that stops the run are reported, too", function()
    for i, method in ipairs(methods) do
        local run = block:simulate {
            velocity0 = 1, t_end = 3, dt = 1, integrator = method,
            events = { { when = function(t) return t - 1 end, name = "a", stop = i == 1 }, { when = function(t) return 1 - t end, name = "b", stop = i ~= 1 } },
        }
        equal(run.outcome, "stopped at an event")
        for _, r in ipairs { run, run:continue {} } do
            equal(#r.events, 2)
            equal(r.events[1].name .. r.events[2].name, "ab")
        end
    end
end)

test("an event whose value jumps over zero is reported by every method", function()
    local ball = system { I = 1, k = 0, walls = { lower = -1, upper = 1, restitution = 0.8 } }
    for _, method in ipairs(methods) do
        for _, case in ipairs {
            { function(t, theta) return (t < 1 and -2 or t < 3 and 2 or -2) - theta / 9 end, { 1, 3 } },
            { function(t) return math.floor(t) % 2 - 0.5 end, { 1, 2, 3, 4, 5 } },
            { function(_, _, v) return v + 0.05 end, { 1, 3.5 } },
        } do
            local run = ball:simulate { velocity0 = 1, t_end = 5.5, integrator = method, events = { { when = case[1] } } }
            near(of_kind(run, "user").t, vector(case[2]), 1e-12)
        end
    end
end)

moves("an event is located at a flat zero", block, { velocity0 = 1, t_end = 3, dt = 1, events = { { when = function(t) return (t - 1) ^ 3 end } } }, { user = { 1 }, within = 1e-15 })

moves("the work of an act equals the energy that springs and mass gain", { I = 1, k = 1, C = 0.1, Rd = 0.1, spring = spring.polynomial { [3] = 2 } },
    { theta0 = 1, t_end = 5, dt = 0.1, events = { { when = function(t) return t - 1.3 end, act = function(_, theta, velocity) return theta + 0.3, velocity end } } })

test("a mass at rest is not at rest for good while an act is still to come", function()
    local kick = { when = function(t) return t - 50 end, act = function(_, _, velocity) velocity.a = 1 end }
    local run = system { bodies = { a = { I = 1, k = 1, Rd = 0.3 } } }:simulate { theta0 = { a = 0.1 }, t_end = 10, events = { kick } }
    equal(run.outcome, "stuck at the end")
    assert(run:continue { t_end = 60 }.a.theta:max() > 0.5)
end)

test("an act at a jump or on a narrow peak of its event's function happens once each time it is passed", function()
    local p, w = .6868564635571865, .0004833638909349485
    local function jumps(t, theta) return ((theta > p) ~= (theta > p + w) and 1 or 0) - .5 end
    for _, theta0 in ipairs { -.8626593626879944, -1, -.9 } do
        local count = 0
        local run = system { I = 1, k = 4, C = .2 }:simulate { theta0 = theta0, t_end = 1.5, dt = .5,
            events = { { when = jumps, act = function(t, theta, v) count = count + 1 return theta, v + .05 end } } }
        equal(run.status, "end", run.outcome)
        equal(count, 2)
    end
    for _, width in ipairs { 1e-2, 1e-4, 2e-6 } do
        local count = 0
        local rig = system { bodies = { a = { I = 1, k = 4, C = .2 }, b = { I = 2, k = 3, C = .1 } },
            links = { s = { "a", "b", k = 5, C = .1 } } }
        local run = rig:simulate { theta0 = { a = -1, b = .3 }, t_end = 1, dt = .5, events = { {
            when = function(t, theta) return 1 / (1 + ((theta.b + .1) / width) ^ 2) - .5 end,
            act = function(t, theta, v) count = count + 1 v.a = v.a + .05 end } } }
        equal(run.status, "end", run.outcome)
        equal(count, 2)
    end
end)

test("an event whose function steps is reported once at each step, by each integrator", function()
    local sys = system { I = 1, k = 1, C = 0.05, Rd = 0.01 }
    local function over(t, theta) return theta + 0.1 * t > 0.2 and 1 or -1 end
    for _, by in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.01 }, integrator.dopri5 { tolerance = 1e-9 } } do
        for _, when in ipairs { over, unread(over), function(t, theta) return theta + 0.1 * t - 0.2 end } do
            -- At t = 9.26 and 9.33 it steps for a moment.
            local run = sys:simulate { theta0 = 1, t_end = 9, dt = 1, integrator = by, events = { { when = when } } }
            equal(#of_kind(run, "user"), 2, tostring(by))
        end
    end
end)

test("endless bounces by an act are reported as such also late, where M is rounded with the time", function()
    for _, start in ipairs { 0, 1000, 1e5 } do
        local bounce = { when = function(_, theta) return theta end, direction = "down", act = function(_, theta, v) return theta, -0.6 * v end }
        local run = system { I = 1, k = 0 }
            :simulate { M = function(t) return -1 - 0.5 * math.sin(2.2 * t) end, theta0 = 1, t_start = start, t_end = start + 20, events = { bounce } }
        has(run.outcome, "bounces made by act never come to rest")
    end
end)

test("an act at a step of its event's function, whatever it changes, leaves the function behind the step", function()
    local sys = system { I = 1, k = 1, C = 0.05, Rd = 0.01 }
    local whens = {
        { function(t, theta) return theta > 0.3 and 1 or -1 end, function(t, theta) return theta - 0.3 end },
        { function(t, theta) return math.sin(3 * t) > 0.3 and 1 or -1 end, function(t) return math.sin(3 * t) - 0.3 end },
        { function(t, theta, v) return v + 0.1 * t > 0.2 and 1 or -1 end, function(t, theta, v) return v + 0.1 * t - 0.2 end },
        { function(t, theta, v, z) return theta + 0.5 * z.x > 0.4 and 1 or -1 end, function(t, theta, v, z) return theta + 0.5 * z.x - 0.4 end },
    }
    local acts = {
        function(t, theta, v) return theta, v + 0.1 end,
        function(t, theta, v) return theta, 0.7 * v end,
        function(t, theta, v) return theta + 0.2, v end,
        function(t, theta, v, z) z.x = z.x + 0.1 end,
    }
    for _, by in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.01 }, integrator.dopri5 { tolerance = 1e-10 } } do
        for i, each in ipairs(whens) do
            for j, act in ipairs(acts) do
                local function told(when)
                    local run = sys:simulate { M = function(t) return math.sin(1.3 * t) end, theta0 = 1, velocity0 = 0.3, t_end = 8, dt = 1,
                        integrator = by, states = { x = { start = 0, rate = function(t, theta, v, z) return 0.2 * theta - z.x end } },
                        events = { { when = when, act = act } } }
                    equal(run.status, "end", run.outcome)
                    local times = {}
                    for _, event in ipairs(of_kind(run, "user")) do times[#times + 1] = event.t end
                    return times
                end
                local steps, crosses = told(each[1]), told(each[2])
                equal(#steps, #crosses, ("%s, when %d, act %d"):format(by, i, j))
                for k = 1, #steps do near(steps[k], crosses[k], 1e-7) end
            end
        end
    end
end)

finish()
