-- Loads that jump on a surface to which both sides drive the motion back: it slides along the surface, with the mixture of
-- both sides that keeps it there (Filippov).
dofile "tests/lua/support.lua"

local function switches(run) return of_kind(run, "switch") end

test("a feedback -A sgn v acts as dry friction", function()
    local function f(t) return 0.9 * math.sin(0.8 * t) + 0.3 * math.sin(2.1 * t) end
    local task = { M = function(t, _, v) return (v > 0 and -0.7 or 0.7) + f(t) end, theta0 = 3.3, t_end = 40 }
    local run = system { I = 1, k = 1.3, C = 0.05 }:simulate(task)
    local dry = system { I = 1, k = 1.3, C = 0.05, Rd = 0.7 }:simulate(merged(task, { M = f }))
    near(run.theta, dry.theta, 1e-11)
    near(run.velocity, dry.velocity, 1e-11)
    closes(run)
    local ends, sticks = switches(run), 0
    for _, event in ipairs(dry.events) do
        if event.kind ~= "turn" then
            sticks = sticks + 1
            near(ends[sticks].t, event.t, 1e-10)
            near(ends[sticks].theta, event.theta, 1e-11)
            near(ends[sticks].velocity, 0, 1e-15)
        end
    end
    equal(#ends, sticks)
    assert(sticks > 0)
end)

test("a run may begin on the sliding surface, without an event there", function()
    local run = system { I = 1, k = 1 }:simulate {
        M = function(_, _, v) return v > 0 and -1 or 1 end, theta0 = 0.3, t_end = 10,
    }
    near(run.theta, 0.3, 1e-14)
    near(run.M, 0.3, 1e-14)
    equal(#switches(run), 0)
end)

test("a controller in sliding mode decays as its surface prescribes, whatever disturbs the mass", function()
    local c = 2
    local run = system { I = 1, k = 1, C = 0.2 }:simulate {
        M = function(t, theta, v) return (v + 2 * theta > 0 and -5 or 5) + 0.8 * math.sin(3 * t) end, theta0 = 1, t_end = 10,
    }
    equal(run.status, "end")
    closes(run)
    local reached = switches(run)
    equal(#reached, 1)
    for i, t in ipairs(run.t) do
        if t > reached[1].t then
            local expected = reached[1].theta * math.exp(-c * (t - reached[1].t))
            near(run.theta[i], expected, 1e-11)
            near(run.velocity[i], -c * expected, 1e-11)
            near(run.M[i], expected * (c * c + 1 - 0.2 * c), 1e-11)
        end
    end
end)

test("a sliding surface may be curved and may move", function()
    -- theta follows theta' = cos t - theta^3 from where it is reached
    local run = system { I = 1, k = 0.5 }:simulate {
        M = function(t, theta, v) if v + theta ^ 3 - math.cos(t) < 0 then return 20 end return -20 end, theta0 = 0.5,
        t_end = 8,
    }
    closes(run)
    equal(#switches(run), 1)
    local from = switches(run)[1]
    local truth = system { I = 1, k = 0 }:simulate {
        states = { x = { rate = function(t, _, _, z) return math.cos(t) - z.x ^ 3 end, start = from.theta } },
        t_start = from.t, t_end = 8,
    }
    near(run.theta[#run], truth.x[#truth], 1e-11)
end)

test("a slide ends where one side no longer drives the motion back", function()
    local slope = 0.3
    local run = system { I = 1, k = 0 }:simulate {
        M = function(t, _, v) return (v > 0 and -1 or 1) + slope * t end, t_end = 8,
    }
    local left = switches(run)
    equal(#left, 1)
    near(left[1].t, 1 / slope, 1e-10)
    -- from there on v' = 0.3 t - 1
    local s = 8 - 1 / slope
    near(run.velocity[#run], slope * s ^ 2 / 2, 1e-11)
    near(run.theta[#run], slope * s ^ 3 / 6, 1e-11)
end)

test("the sign may have three values, and may result from other conditions", function()
    local sys = system { I = 1, k = 1 }
    local function go(M) return sys:simulate { M = M, theta0 = 3, t_end = 6 } end
    local two = go(function(_, theta, v) return v + 2 * theta > 0 and -5 or 5 end)
    local three = go(function(_, theta, v)
        local s = v + 2 * theta
        return s > 0 and -5 or s < 0 and 5 or 0
    end)
    local folded = go(function(_, theta, v)
        local s = v + 2 * theta
        return 5 - (math.max(s, 0) > 0 and 10 or 0)
    end)
    equal(#switches(two), 1)
    for _, other in ipairs { three, folded } do
        same_events(other, two, 1e-10)
        near(other.theta, two.theta, 1e-10)
    end
end)

test("when dry friction reverses during a slide, the load compensates", function()
    local run = system { I = 1, k = 1, Rd = 0.3 }:simulate {
        M = function(t, theta, v) return v + 2 * (theta - math.sin(t)) > 0 and -5 or 5 end, theta0 = 1, t_end = 12,
    }
    equal(#switches(run), 1)
    closes(run)
    -- theta' = -2 (theta - sin t)
    local from = switches(run)[1]
    local function forced(t) return 0.8 * math.sin(t) - 0.4 * math.cos(t) end
    for i, t in ipairs(run.t) do
        if t > from.t then
            near(run.theta[i], forced(t) + (from.theta - forced(from.t)) * math.exp(-2 * (t - from.t)), 1e-11)
        end
    end
end)

test("a break of M during a slide is not an event", function()
    local run = system { I = 1, k = 1 }:simulate {
        M = function(t, theta, v) return (v + 2 * theta > 0 and -5 or 5) + (t > 1.7 and 1 or 0) end, theta0 = 3, t_end = 4,
    }
    equal(#switches(run), 1)
    local from = switches(run)[1]
    near(run.theta[#run], from.theta * math.exp(-2 * (4 - from.t)), 1e-12)
end)

test("another condition of the load may change during a slide", function()
    local function sgn(x) return x > 0 and 1 or x < 0 and -1 or 0 end
    local sys = system { I = 1, k = 0.6, C = 0.2 }
    -- At velocity 0.4 the surface needs M = 0.6 theta + 0.08; the load allows 0.9 on either side of its rest.
    local function go(M) return sys:simulate { M = M, theta0 = -0.1, velocity0 = 0.4, t_end = 3.9 } end
    local run = go(function(_, theta, v) return -0.2 - 0.9 * sgn(v - 0.4) - 0.3 * sgn(theta - 1) end)
    local left = switches(run)
    equal(#left, 1)
    near(left[1].t, 2.75, 1e-13)  -- theta = 1, from where at most 0.4 is left for the 0.68
    local free = sys:simulate { M = 0.4, theta0 = 1, velocity0 = 0.4, t_start = 2.75, t_end = 3.9 }
    near(run:at(3.9), free:at(3.9), 1e-13)
    closes(run)
    for _, at in ipairs { 0.5, 0.1 + 0.2, 0.7 } do
        run = go(function(_, theta, v) return 0.3 - 0.9 * sgn(v - 0.4) - 0.3 * sgn(theta - at) end)
        left = switches(run)
        equal(#left, 1)
        near(left[1].theta, 0.82 / 0.6, 1e-13)  -- it slides on over the change, without an event
    end
end)

test("a load moves a resting mass along its surface, against dry friction", function()
    local sys = system { I = 1, k = 1, C = 0.1, Rd = 0.3, Re = 0.5 }
    for _, theta0 in ipairs { 0, 0.4, -0.8 } do  -- the last one is let go by its spring
        local run = sys:simulate {
            M = function(t, _, v) return v - math.sin(t) > 0 and -3 or v - math.sin(t) < 0 and 3 or 0 end,
            theta0 = theta0, t_end = 9,
        }
        equal(run.status, "end")
        for i, t in ipairs(run.t) do
            near(run.velocity[i], math.sin(t), 1e-13)
            near(run.theta[i], theta0 + 1 - math.cos(t), 1e-12)
        end
    end
    -- The surface passes the mass, which stands at -0.2 from the start, at t = 1.
    local late = sys:simulate {
        M = function(t, _, v) return v - math.sin(t - 1) > 0 and -0.25 or 3 end, theta0 = -0.2, t_end = 4,
    }
    local first = late.events[1]
    near(first.t, 1, 1e-13)
    for i, t in ipairs(late.t) do near(late.velocity[i], t > 1 and math.sin(t - 1) or 0, 1e-13) end
    -- One that is too weak to keep the mass on it only lets it go.
    local weak = sys:simulate { M = function(t, _, v) return v - 2 * math.sin(t) > 0 and -1 or 1 end, t_end = 1 }
    near(weak.theta, sys:simulate { M = 1, t_end = 1 }.theta, 1e-13)
end)

test("a continued run continues its slide, without an event", function()
    local task = { M = function(t, theta, v) return (v + 2 * theta > 0 and -5 or 5) + 0.5 * math.sin(t) end, theta0 = 3, t_end = 8 }
    local whole = system { I = 1, k = 1 }:simulate(task)
    task.t_end = 4
    local longer = system { I = 1, k = 1 }:simulate(task):continue { t_end = 8 }
    same_events(longer, whole, 1e-12)
    near(longer.theta[#longer], whole.theta[#whole], 1e-13)
end)

test("a jump that does not depend on velocity is crossed, without sliding", function()
    local run = system { I = 1, k = 0 }:simulate {
        M = function(_, theta) return theta > 0 and -1 or 1 end, theta0 = -0.5, t_end = 20,
    }
    equal(run.status, "end")
    equal(#switches(run), 0)
    near(run:at(4), -0.5, 1e-12)  -- four parabolas, each of the duration 1
    near(run:at(20), -0.5, 1e-12)
end)

test("a mass that its feedback holds, or that nothing moves, is not called moving", function()
    local function held(t, theta, velocity) if velocity > 0 then return -0.4 end return 0.4 end
    has(system { I = 1, k = 1 }:simulate { M = held, theta0 = 1.3, t_end = 20 }, "velocity 0 at the end")
    has(system { I = 1, k = 1 }:simulate { t_end = 5 }, "velocity 0 at the end")
    has(system { I = 1, k = 1 }:simulate { theta0 = 1, t_end = 5 }, "moving at the end")
end)

-- -A sgn v beside Rd and Re is dry friction Rd + A. At a standstill the value at velocity 0 counts: the body breaks
-- away where that is beyond Re and the motion is not driven back, at Rd + A. Where it moves with a belt or another body,
-- rounding says what the value is: there it breaks away at Re + A.
local function together(Rd, Re, A, at_0)
    local function side(value) return { Rd = Rd + A, Re = math.max(Rd + A, Re + value) } end
    return friction.asymmetric { forward = side(-at_0), backward = side(at_0) }
end
local relays = {
    read = function(A) return function(v) return v > 0 and -A or A end end,
    ["with a value at 0"] = function(A) return function(v) return v > 0 and -A or v < 0 and A or 0 end end,
    ["not read"] = function(A) return function(v) return select(1, v > 0 and -A or A) + tonumber("0") end end,
}
local function kinds_of(run)
    local kinds = {}
    for _, event in ipairs(run.events) do
        if event.kind ~= "turn" then kinds[#kinds + 1] = event.kind == "rest" and "stick" or event.kind end
    end
    return table.concat(kinds, " ")
end

test("a feedback -A sgn v beside dry friction adds to it", function()
    local function f(t) return 1.1 * math.sin(0.8 * t) + 0.5 * math.sin(2.1 * t) end
    local ends = 0
    for name, relay in pairs(relays) do
        for _, case in ipairs { { 0.7, 0.3, 0.4 }, { 0.05, 0.3, 0.9 }, { 1.5, 0.2, 0.2 } } do
            local A, Rd, Re = table.unpack(case)
            local g = relay(A)
            local task = { M = function(t, _, v) return g(v) + f(t) end, theta0 = 3.3, t_end = 40 }
            local run = system { I = 1, k = 1.3, C = 0.05, Rd = Rd, Re = Re }:simulate(task)
            task.M = f
            local dry = system { I = 1, k = 1.3, C = 0.05, friction = together(Rd, Re, A, g(0)) }:simulate(task)
            near(run.theta, dry.theta, 1e-11)
            equal(kinds_of(run), kinds_of(dry), name)
            ends = ends + #dry.events
        end
    end
    assert(ends > 40)
end)

test("a body that comes to rest exactly at the sum of both limits is held", function()
    local M = function(_, _, v) return v > 0 and -0.4 or v < 0 and 0.4 or 0 end
    local run = system { I = 1, k = 1, Rd = 0.2, Re = 0.3 }:simulate { M = M, theta0 = 3, t_end = 20 }
    equal(run.status, "stuck")
    equal(kinds_of(run), "stick")
    near(run.theta[#run], 0.6, 1e-14)
end)

test("a feedback that falls with speed makes Coulomb's friction Stribeck's", function()
    local function drive(t) return 1.2 * math.sin(t) end
    local function falls(v) return v > 0 and 0.3 * math.exp(-v / 0.1) or v < 0 and -0.3 * math.exp(v / 0.1) or 0 end
    local function go(M, more) return system(merged({ I = 1, k = 1, C = 0.1 }, more)):simulate { M = M, theta0 = 0.3, velocity0 = 0.2, t_end = 20 } end
    local run = go(function(t, _, v) return drive(t) - falls(v) end, { Rd = 0.3 })
    local dry = go(drive, { friction = friction.stribeck { Rd = 0.3, Re = 0.6, speed = 0.1, shape = 1 } })
    near(run.theta, dry.theta, 1e-9)
    equal(kinds_of(run), kinds_of(dry))
    assert(#dry.events > 5, #dry.events)
end)

test("such a feedback also adds to the friction of belts and links", function()
    local A = 0.4
    local function on_belt(M, law)
        return system { I = 1, k = 1.3, C = 0.05, friction = law }:simulate { M = M, belt = 0.3, t_end = 30 }
    end
    local run = on_belt(function(t, _, v) return (v > 0.3 and -A or A) + 0.8 * math.sin(1.7 * t) end, friction.coulomb { Rd = 0.3, Re = 0.6 })
    local dry = on_belt(function(t) return 0.8 * math.sin(1.7 * t) end, friction.coulomb { Rd = 0.3 + A, Re = 0.6 + A })
    near(run.theta, dry.theta, 1e-11)
    equal(kinds_of(run), kinds_of(dry))
    local function of_link(M, law)
        local links = { c = { "a", "b", friction = law } }
        return system { bodies = { a = { I = 1, k = 2 }, b = { I = 2, k = 1 } }, links = links }
            :simulate { M = M, theta0 = { a = 2 }, t_end = 30 }
    end
    run = of_link({ c = function(_, _, v) return v.a - v.b > 0 and -A or A end }, friction.coulomb { Rd = 0.2, Re = 0.3 })
    dry = of_link(nil, friction.coulomb { Rd = 0.2 + A, Re = 0.3 + A })
    near(run.a.theta, dry.a.theta, 1e-11)
    equal(kinds_of(run), kinds_of(dry))
end)

test("a slide that dies out with dry friction is at rest to rounding, without an error", function()
    for _, Rd in ipairs { 0.01, 1 } do
        local run = system { I = 1, k = 1, Rd = Rd }:simulate {
            M = function(_, theta, v) return v + 5 * theta > 0 and -8 or 8 end, theta0 = 3, t_end = 40,
        }
        assert(run.status == "end" or run.status == "stuck", run.status)
        near(run.theta[#run], 0, 1e-14)
    end
end)

test("a state slides where its rate jumps, and follows the surface", function()
    local function go(rate, start, M)
        return system { I = 1, k = 1, C = 0.1 }:simulate {
            M = M or function(_, _, _, z) return 0 * z.z end, states = { z = { rate = rate, start = start } }, theta0 = 0.5,
            t_end = 8, dt = 0.1,
        }
    end
    local run = go(function(_, _, _, z) return z.z > 0 and -1 or 1 end, 1)
    for i, t in ipairs(run.t) do near(run.states.z[i], math.max(0, 1 - t), 1e-13) end
    equal(#switches(run), 1)
    near(switches(run)[1].t, 1, 1e-12)
    run = go(function(t, theta, _, z) return z.z > theta and -2 or 2 end, 1, function(_, _, _, z) return 0.3 * z.z end)
    for i, t in ipairs(run.t) do
        if t > switches(run)[1].t then near(run.states.z[i], run.theta[i], 1e-13) end
    end
    -- on the surface M is 0.3 theta
    local from = switches(run)[1]
    local free = system { I = 1, k = 0.7, C = 0.1 }:simulate {
        theta0 = from.theta, velocity0 = from.velocity, t_start = from.t, t_end = 8,
    }
    near(run.theta[#run], free.theta[#free], 1e-11)
    -- it leaves where one side no longer drives it back
    run = go(function(t, _, _, z) return (z.z > 0 and -1 or 1) + 0.5 * t end, 0)
    near(switches(run)[1].t, 2, 1e-10)
    near(run.states.z[#run.states.z], 0.25 * 6 ^ 2, 1e-10)
end)

test("explain() says when the mass slid along a surface, and why that ended", function()
    local function told(run) return (run:explain():gsub("%s+", " ")) end
    local story = told(system { I = 1, k = 0 }:simulate { M = function(t, _, v) return (v > 0 and -1 or 1) + 0.3 * t end, t_end = 8 })
    has(story, "From t = 0 to 3.3333 it stood at theta = 0: M jumps there and drives it back from both sides; then one side no longer did.")
    story = told(system { I = 1, k = 5, C = 8, spring = function(theta) return theta > 0 and 0.4 or -0.4 end }:simulate { M = 0.3, t_end = 8 })
    has(story, "it stood at theta = 0: a spring jumps there and drives it back from both sides, until the run ended")
    story = told(system { I = 1, k = 1 }:simulate { M = function(_, theta, v) return theta + v > 0 and -3 or 3 end, theta0 = 1, t_end = 4 })
    has(story, "it slid along a surface on which M jumps and drives it back from both sides, until the run ended")
    story = told(system { I = 1, k = 1 }:simulate { M = function(_, _, v) return v > 0 and -1 or 1 end, theta0 = 3.3, t_end = 20 })
    has(story, "until the run ended")
    story = told(system { I = 1, k = 1.3, Rd = 0.3 }:simulate { M = function(_, _, v) return v > 0 and -1 or 1 end, theta0 = 3.3, t_end = 20 })
    has(story, "because M drives it back from both sides of velocity 0")
    story = told(system { I = 1, k = 1, Rd = 0.1, spring = function(x) return 2 * math.floor(x / 0.1) end }:simulate { M = 1, theta0 = 0.15, t_end = 20 })
    has(story, "at theta = 0.1 because the spring jumps there and drives it back from both sides.")
end)

-- A load -D sgn(theta - a) beside dry friction: the body passes a and is stopped beside it, ever faster.
local function passes(D, a) return function(_, theta) return theta > a and -D or theta < a and D or 0 end end

test("a body that a load drives back to a place comes to rest right there", function()
    for _, form in ipairs { passes, function(D, a) return function(_, theta) return theta > a and -D or D end end } do
        for _, case in ipairs { { 1, 0.3, 0 }, { 2.5, 0.9, 0.7 }, { 1, 0.02, -0.4 }, { 3, 2.9, 0.1 } } do
            local D, Rd, a = table.unpack(case)
            local run = system { I = 1, k = 0, Rd = Rd }:simulate { M = form(D, a), theta0 = a, velocity0 = 1.3, t_end = 200 }
            equal(run.status, "stuck")
            local last = run.events[#run.events]
            equal(last.kind, "stick")
            equal(run.theta[#run], a)
            -- out against D + Rd, back with D - Rd: each passage takes so much longer than the one after
            local out, back = D + Rd, D - Rd
            local slower = math.sqrt(back / out)
            near(last.t, 1.3 * (1 / out + slower / back) / (1 - slower), 3e-8 * last.t)  -- the last passages are in the last digits
            for i = 1, #run do assert(math.abs(run.friction[i]) <= Rd * (1 + 1e-15), run.friction[i]) end
            closes(run)
        end
    end
end)

test("a spring and other loads do not keep it from there, and it leaves where they overcome both", function()
    local D, Rd, Re, a = 1.2, 0.4, 0.5, 0.6
    local g = passes(D, a)
    local function f(t) return 0.3 * math.sin(t) + (t > 20 and 0.5 * (t - 20) or 0) end
    local run = system { I = 1, k = 0.5, C = 0.1, Rd = Rd, Re = Re }:simulate {
        M = function(t, theta) return g(t, theta) + f(t) end, theta0 = -2, t_end = 24.5,
    }
    local stick, slip
    for _, event in ipairs(run.events) do
        if event.kind == "stick" then stick = event elseif event.kind == "slip" then slip = event end
    end
    equal(stick.theta, a)
    equal(slip.theta, a)
    near(f(slip.t) - 0.5 * a, D + Re, 1e-10)
    closes(run)
    -- from there on it has D and Rd against it
    local free = system { I = 1, k = 0.5, C = 0.1, Rd = Rd, Re = Re }:simulate {
        M = function(t) return f(t) - D end, theta0 = a, t_start = slip.t, t_end = 24.5,
    }
    near(run:at(24.5), free:at(24.5), 1e-9)
end)

test("a body that stands on such a place from the start stays, and leaves where it is pushed beyond both", function()
    local sys = system { I = 1, k = 0, Rd = 0.3 }
    for _, at_0 in ipairs { -1, 0, 1 } do
        local M = function(t, theta) return (theta > 0.5 and -1 or theta < 0.5 and 1 or at_0) + (t > 3 and 1.5 or 0.2) end
        local run = sys:simulate { M = M, theta0 = 0.5, t_end = 4 }
        equal(kinds_of(run), "slip")
        near(run.events[1].t, 3, 1e-12)
        near(run.theta[#run], 0.6, 1e-12)  -- by 1.5 - 1 - 0.3
    end
    -- A load on the velocity adds to it.
    local M = function(t, theta, v)
        return -0.534 * (theta > -0.758 and 1 or theta < -0.758 and -1 or 0) - 0.951 * (v > 0 and 1 or v < 0 and -1 or 0) + (t > 3 and 2.1 or 0)
    end
    local run = system { I = 1, k = 0, Rd = 0.435 }:simulate { M = M, theta0 = -0.758, t_end = 4 }
    near(run.theta[#run], -0.758 + (2.1 - 0.534 - 0.951 - 0.435) / 2, 1e-12)
end)

test("a load slides beside the friction of a belt, which may move and turn the slip", function()
    local sys = system { I = 1, k = 1, C = 0.2, Rd = 0.3, Re = 0.4 }
    local function sin_2t(t) return math.sin(2 * t) end
    local function ramp(t) return 0.2 * t - 0.5 end
    for _, case in ipairs {
        { function(_, theta, v) return v + 2 * theta > 0 and -5 or 5 end, 0.5, function(_, theta) return -2 * theta end },
        { function(t, _, v) return v - math.sin(t) > 0 and -5 or 5 end, sin_2t, math.sin },
        { function(_, theta, v) return v + theta - 0.3 > 0 and -5 or 5 end, ramp, function(_, theta) return 0.3 - theta end },
    } do
        local M, belt, surface = table.unpack(case)
        local run = sys:simulate { M = M, belt = belt, theta0 = 1, t_end = 8 }
        equal(run.status, "end")
        closes(run)
        local from = #switches(run) > 0 and switches(run)[1].t or 0
        assert(from < 0.5 and #switches(run) <= 1, from)
        for i, t in ipairs(run.t) do
            if t > from then
                near(run.velocity[i], surface(t, run.theta[i]), 1e-12)
                near(math.abs(run.friction[i]), 0.3, 1e-15)
            end
        end
    end
    -- A belt that the surface follows holds the mass until the load is too weak, as dry friction of both would.
    local function f(t) return 0.9 * math.sin(1.3 * t) end
    local run = sys:simulate { M = function(t, _, v) return (v > 0.2 and -1 or 1) + f(t) end, belt = 0.2, t_end = 12 }
    local dry = system { I = 1, k = 1, C = 0.2, Rd = 1.3, Re = 1.4 }:simulate { M = f, belt = 0.2, t_end = 12 }
    near(run.theta, dry.theta, 1e-10)
end)

-- A load -D sgn(theta - a) without dry friction that could hold the body: it passes a ever faster, and stays there.
test("a load holds a body at the place to which it drives it back, beside damping alone or on a belt", function()
    local run = system { I = 1, k = 0.5, C = 2 }:simulate { M = passes(1, 0.2), theta0 = 1, t_end = 30 }
    equal(run.status, "end")
    near(run.theta[#run], 0.2, 1e-12)
    near(run.M[#run], 0.1, 1e-9)
    assert(#run.events < 30000, #run.events)
    closes(run)
    -- friction of the belt pushes it forward, the load holds it against that until the pull of the last term is too strong
    local g = passes(2, -0.7)
    run = system { I = 1, k = 1, Rd = 0.9 }:simulate {
        M = function(t, theta) return g(t, theta) + 0.2 * t end, belt = 0.1, theta0 = -0.7, t_end = 9,
    }
    local left = switches(run)
    near(left[#left].t, (2 - 0.9 - 0.7) / 0.2, 1e-9)
    for i, t in ipairs(run.t) do
        if t < left[#left].t then near(run.theta[i], -0.7, 1e-12) end
    end
end)

test("the place may move, and may be one of a link", function()
    local run = system { I = 1, k = 1, C = 0.4 }:simulate {
        M = function(t, theta) return theta > 0.3 * math.sin(t) and -2 or 2 end, velocity0 = 0.3, t_end = 12,
    }
    for i, t in ipairs(run.t) do near(run.theta[i], 0.3 * math.sin(t), 1e-9) end
    local rig = system { bodies = { a = { I = 1, k = 1, C = 0.2 }, b = { I = 2 } }, links = { c = { "a", "b", k = 0.5 } } }
    run = rig:simulate { M = { c = function(_, theta) return theta.a - theta.b > 0.4 and -3 or 3 end }, theta0 = { a = 0.4 }, t_end = 10 }
    local one = system { I = 3, k = 1, C = 0.2 }:simulate { theta0 = 0.4, t_end = 10 }
    near(run.a.theta, one.theta, 1e-10)
    near(run.b.theta, one.theta - 0.4, 1e-10)
end)

test("growing passages are followed", function()
    local run = system { I = 1, k = 0 }:simulate {
        M = function(_, theta, v) return (theta > 0 and -1 or 1) + 3 * v end, velocity0 = 1e-3, t_end = 6,
    }
    assert(math.max(run.theta:max(), -run.theta:min()) > 1e-3, run.theta:max())
end)

test("where two surfaces meet the motion goes on along the one that holds it", function()
    local function go(D1, D2, slope)
        return system { I = 1, k = 0 }:simulate {
            M = function(t, _, v)
                local one, other = v - 0.5 * t, v - slope * t - 0.5 + slope
                return (one > 0 and -D1 or D1) + (other > 0 and -D2 or D2)
            end, t_end = 3,
        }
    end
    for _, case in ipairs { { 1.2, 1.5, 0.2, 0.2 }, { 2.2, 1, 0.2, 0.5 }, { 1.5, 1.5, -0.5, 0 } } do
        local run = go(table.unpack(case))
        equal(run.status, "end")
        for i, t in ipairs(run.t) do near(run.velocity[i], t < 1 and 0.5 * t or 0.5 + case[4] * (t - 1), 1e-11) end
    end
end)

test("a body sticks where its surface passes velocity 0 and the load is too weak to take it along", function()
    local run = system { I = 1, k = 0, Rd = 0.7 }:simulate {
        M = function(t, _, v) return (v - 1 + t > 0 and -0.9 or 0.9) + 0.4 end, velocity0 = 1, t_end = 3,
    }
    equal(run.status, "stuck")
    near(run.theta[#run], 0.5, 1e-12)
end)

test("rk4, which samples such loads, comes to rest as well", function()
    for _, M in ipairs { passes(1, 0.2), function(_, _, v) return v > 0 and -1 or 1 end } do
        local task = { M = M, theta0 = 1, t_end = 20 }
        local truth = system { I = 1, k = 0.5, Rd = 0.3 }:simulate(task)
        task.integrator = integrator.rk4 { h = 0.002 }
        local run = system { I = 1, k = 0.5, Rd = 0.3 }:simulate(task)
        equal(run.status, truth.status)
        near(run.theta[#run], truth.theta[#truth], 1e-9)
    end
end)

test("a body that a belt carries past velocity 0 slips where its load jumps there", function()
    for _, name in ipairs { "spectral", "rk4" } do
        local run = system { I = 1, k = 0, Rd = 1 }:simulate {
            M = function(t, theta, v) return v > 0 and -0.7 or 0.7 end, belt = function(t) return 0.5 * (t - 1) end,
            velocity0 = -0.5, t_end = 3, dt = 0.5, integrator = integrator[name] { h = name == "rk4" and 0.002 or nil },
        }
        near(of_kind(run, "slip")[1].t, 1, 1e-9)
        near(run.theta[#run], -0.25 + (1 - 0.7) * 2 ^ 2 / 2, 1e-6) -- from there with the excess of friction
    end
end)

test("two loads of one link that slide by turns follow an independent time-stepping program", function()
    local rig = system {
        bodies = { a = { I = 1.26 }, b = { I = 0.538, C = 0.246 } }, links = { c = { "a", "b", Rd = 0.373 } },
    }
    local function c(t, theta, v)
        local slip = v.a - v.b
        local x = slip - 0.177 * math.sin(0.743 * t + 5.96)
        return (slip + 0.857 * (theta.a - theta.b) + 0.21425 > 0 and -2.44 or 2.44) + (x > 0 and -2.62 or x < 0 and 2.62 or 0)
    end
    local run = rig:simulate {
        M = { a = excitation.harmonic { amplitude = 0.72, omega = 2.11, phase = 2.39 }, c = c },
        theta0 = { a = -1.05, b = -0.294 }, t_end = 8,
    }
    near(run.a.theta[#run], -1.449599902, 3e-9)
    near(run.b.theta[#run], -1.133706203, 3e-9)
end)

test("functions that jump at one surface have one share, in loads and in rates", function()
    local function sgn(x) return x > 0 and 1 or x < 0 and -1 or 0 end
    -- On the surface theta' = -2 theta, which takes M = 5 theta, and so the mean -5/3 theta of sgn.
    local run = system { I = 1, k = 1 }:simulate {
        M = function(_, theta, v) return -3 * sgn(v + 2 * theta) end,
        states = { z = { rate = function(_, theta, v) return sgn(2 * v + 4 * theta) end } },
        theta0 = 0.3, velocity0 = -0.6, t_end = 3,
    }
    for i, t in ipairs(run.t) do near(run.states.z[i], -0.25 * (1 - math.exp(-2 * t)), 1e-12) end
    -- Two surfaces that meet at the start are two.
    run = system { I = 1, k = 1 }:simulate {
        M = function(_, theta, v) return -3 * sgn(v + 2 * theta) end,
        states = { z = { start = -0.6, rate = function(_, _, v, z) return -2 * sgn(z.z - v) end } },
        theta0 = 0.3, velocity0 = -0.6, t_end = 3,
    }
    for i, t in ipairs(run.t) do near(run.states.z[i], -0.6 * math.exp(-2 * t), 1e-12) end
    -- A pair of loads between two bodies is dry friction between them.
    local bodies = { a = { I = 1 }, b = { I = 2 } }
    local function f(t) return 2.9 * math.sin(t) end
    local task = {
        M = {
            a = function(t, _, v) return -2 * sgn(v.a - v.b) + 2.9 * math.sin(t) end,
            b = function(_, _, v) return 2 * sgn(v.a - v.b) end,
        }, velocity0 = { a = 0.5 }, t_end = 9,
    }
    run = system { bodies = bodies }:simulate(task)
    task.M = { a = f }
    local dry = system { bodies = bodies, links = { l = { "a", "b", Rd = 2 } } }:simulate(task)
    near(run.a.theta, dry.a.theta, 1e-10)
    near(run.b.theta, dry.b.theta, 1e-10)
    equal(#of_kind(run.a, "switch"), #of_kind(dry, "stick") + #of_kind(dry, "slip"))
    equal(#of_kind(run.b, "switch"), #of_kind(run.a, "switch"))
    closes(run)
end)

test("a slide ends where friction turns against it, and the body does not stick there if the load moves it on", function()
    -- the surface passes the velocity of the belt at t = 1.5; from there on the friction acts against the load
    local function on_belt(D)
        return system { I = 1, k = 0, Rd = 0.3 }:simulate {
            M = function(t, _, v) return v - t + 1 > 0 and -D or D end, belt = 0.5, velocity0 = -1, t_end = 3,
        }
    end
    for _, D in ipairs { 0.9, 1.2 } do
        local run = on_belt(D)
        near(run.velocity[#run], 0.5 + (D - 0.3) * 1.5, 1e-12)
        closes(run)
    end
    local strong = on_belt(1.4)
    near(strong.velocity[#strong], 2, 1e-12)
    -- the surface moves with another body, and passes 0 at t = 1.2
    local function beside(D)
        return system { bodies = { a = { I = 1 }, b = { I = 1, Rd = 0.3 } } }:simulate {
            M = { a = 0.5, b = function(_, _, v) return v.b - v.a - 0.4 > 0 and -D or D end },
            velocity0 = { a = -1, b = -0.6 }, t_end = 3,
        }
    end
    local run = beside(0.6)
    near(run.b.velocity[#run.t], 0.3 * 1.8, 1e-12)
    equal(#of_kind(run, "stick"), 0)
    run = beside(0.25)
    equal(of_kind(run, "stick")[1].where, "b")
    near(run.b.velocity[#run.t], 0, 0)
    -- or with a state
    run = system { I = 1, k = 0, Rd = 0.3 }:simulate {
        M = function(_, _, v, z) return v - z.z > 0 and -0.6 or 0.6 end,
        states = { z = { start = -1, rate = function() return 0.5 end } }, velocity0 = -1, t_end = 4,
    }
    near(run.velocity[#run], 0.3 * 2, 1e-12)
    equal(#of_kind(run, "stick"), 0)
end)

test("a load and the rate of a state slide at once, and follow an independent program with steep lines", function()
    local function sgn(x) return x > 0 and 1 or -1 end
    local run = system { I = 1.623, k = 0, Rd = 0.473 }:simulate {
        M = function(t, _, v, z)
            return 0.1909 * math.sin(2.0131 * t + 2.9762) - 0.9518 * sgn(v + 1.1731 * z.z - 0.4392 * math.sin(1.2811 * t + 1.3491))
        end,
        states = {
            z = {
                start = 0.044,
                rate = function(_, theta, v, z)
                    return -1.6205 * z.z + 0.8402 * theta - 0.5364 * v - 0.4514 * sgn(z.z - 0.7472 * v + 0.1837)
                end,
            },
        }, theta0 = 0.292, t_end = 6,
    }
    near(run.theta[#run], 0.580617977, 3e-9)
    near(run.velocity[#run], 0.179453653, 3e-9)
    near(run.states.z[#run], -0.010953476, 3e-9)
end)

test("the motion slides and rests on the steps of a staircase as on those of comparisons", function()
    local q = 0.3
    local function compared(x)
        return x >= 2.5 * q and 3 or x >= 1.5 * q and 2 or x >= 0.5 * q and 1 or x >= -0.5 * q and 0 or x >= -1.5 * q and -1
            or x >= -2.5 * q and -2 or x >= -3.5 * q and -3 or x >= -4.5 * q and -4 or -5
    end
    local rows = {
        floor = function(t, theta, velocity) return -0.4 * math.floor(velocity / q + 0.5) end,
        divided = function(t, theta, velocity) return -0.4 * ((velocity + 0.5 * q) // q) end,
        ceil = function(t, theta, velocity) return -0.4 * math.ceil(velocity / q - 0.5) end,
        loop = function(t, theta, velocity)
            local n = 0
            for step = 1, 6 do
                if velocity >= (step - 0.5) * q then n = n + 1 end
                if velocity < (0.5 - step) * q then n = n - 1 end
            end
            return -0.4 * n
        end,
        remainder = function(t, theta, velocity) return -0.4 / q * (velocity + 0.5 * q - (velocity + 0.5 * q) % q) end,
    }
    for _, Rd in ipairs { 0, 0.05, 0.2 } do
        local sys = system { I = 1, k = 1.6, C = 0.3, Rd = Rd }
        local function at_end(M) return sys:simulate { M = M, theta0 = 0.9, t_end = 20, times = {} }:at(20) end
        local expected = at_end(function(t, theta, velocity) return -0.4 * compared(velocity) end)
        for name, M in pairs(rows) do
            local theta = at_end(M)
            assert(math.abs(theta - expected) < 1e-11, ("%s, Rd %g: %.15g, not %.15g"):format(name, Rd, theta, expected))
        end
        near(at_end(function(t, theta) return -0.4 * math.floor(theta / q + 0.5) end),
            at_end(function(t, theta) return -0.4 * compared(theta) end), 1e-11)
    end
end)

test("a mass that begins at rest on a jump that drives it back stays there, however the jump is written", function()
    local signs = {
        function(x) return x > 0 and 1 or x < 0 and -1 or 0 end,
        function(x) return x < 0 and -1 or x > 0 and 1 or 0 end,
        function(x) return x >= 0 and 1 or -1 end,
        function(x) return x <= 0 and -1 or 1 end,
        function(x) return (x > 0 and 1 or 0) - (x < 0 and 1 or 0) end,
        function(x) return math.abs(x) * x + (x > 0 and 1 or x < 0 and -1 or 0) end, -- a kink beside the jump
    }
    for n, sign in ipairs(signs) do
        for _, load in ipairs { -0.9, -0.5, 0, 0.5, 0.9 } do
            for _, k in ipairs { 0, 2 } do
                for _, case in ipairs {
                    { load, sign },
                    { function(t, theta) return load - sign(theta) end },
                    { function(t, theta) return load + 0.05 * math.sin(t) - sign(theta) end },
                } do
                    local run = system { I = 1, k = k, spring = case[2] }:simulate { M = case[1], t_end = 10, dt = 1 }
                    equal(run.t[#run], 10)
                    assert(run.theta:abs():max() < 1e-9, ("sign %d, load %g, k %g: %s"):format(n, load, k, run.outcome))
                end
            end
        end
    end
end)

test("friction stops a body at the step of a staircase, from which side it ever comes", function()
    for _, Rd in ipairs { 0.05, 0.2 } do
        for _, I in ipairs { 0.5, 2 } do
            local sys = system { I = I, k = 0, Rd = Rd, spring = function(x) return 2 * math.floor(x / 0.1) end }
            for _, theta0 in ipairs { 0.08, 0.1, 0.12, 0.2 } do
                for _, velocity0 in ipairs { 0, 0.1, -0.1 } do
                    local run = sys:simulate { M = 1, theta0 = theta0, velocity0 = velocity0, t_end = 60 }
                    near(run.theta[#run], 0.1, 1e-9)
                    near(run.velocity[#run], 0, 1e-9)
                    closes(run)
                end
            end
        end
    end
end)

test("a feedback that begins exactly at its limit holds like dry friction", function()
    local signs = {
        function(v) return v > 0 and 1 or v < 0 and -1 or 0 end,
        function(v) return v > 0 and 1 or -1 end,
        function(v) return v < 0 and -1 or 1 end,
    }
    for _, sign in ipairs(signs) do
        for _, m in ipairs { 0.1, 0.5 } do
            for _, load in ipairs { m, -m } do
                for _, case in ipairs { { load, 0 }, { 0, load } } do -- by the load, by the spring
                    local function f(t) return case[1] + math.sin(t) end
                    local start = { theta0 = case[2], t_end = 20, dt = 0.5 }
                    local run = system { I = 0.5, k = 1, C = 0.1 }:simulate(merged(start, { M = function(t, _, v) return f(t) - m * sign(v) end }))
                    local dry = system { I = 0.5, k = 1, C = 0.1, Rd = m }:simulate(merged(start, { M = f }))
                    near(run.theta, dry.theta, 1e-11)
                end
            end
        end
    end
end)

test("a preload holds a body whose friction vanishes there or varies", function()
    local function jump(x) return x > 0 and 1 or -1 end
    local varies = system { I = 1, k = 4, C = 0.2, Rd = function(t) return 0.2 * (1 + 0.5 * math.sin(t)) end, spring = function(x) return math.abs(x) * x + 0.5 * jump(x) end }
    local run = varies:simulate { theta0 = 0.5, velocity0 = 0.5, t_end = 20 }
    equal(run.theta[#run], 0.0)
    closes(run)
    local vanishes = system { I = 0.1, k = 0.5, C = 0.5, Rd = function(_, theta) return 0.5 * math.abs(theta) end, spring = function(x) return 2 * jump(x) end }
    local slow = vanishes:simulate { velocity0 = 1e-3, t_end = 5 }
    assert(#slow.events < 30000)
    near(slow.theta[#slow], 0, 1e-15)
end)

test("a preload and a clutch that stop a body together let it go at the sum of their limits", function()
    local bodies = { a = { I = 2, Rd = 3 }, b = { I = 0.2, C = 0.1, spring = function(x) return x > 0 and 1 or x < 0 and -1 or 0 end } }
    for _, velocity in ipairs { 0, 1, 2, -2 } do
        for _, rate in ipairs { 0.1, -0.1 } do
            local rig = system { bodies = bodies, links = { clutch = { "a", "b", Rd = 0.2, Re = 0.5 } } }
            local run = rig:simulate { M = { b = function(t) return rate * t end }, velocity0 = { b = velocity }, t_end = 20 }
            local slips = of_kind(run.clutch, "slip").t
            near(slips[#slips], 15, 1e-12)
            closes(run)
        end
    end
end)

test("two bodies that a preload holds together stop at once, and stay together", function()
    local bodies = { a = { I = 0.1, C = 0.2 }, b = { I = 0.1, friction = friction.stribeck { Rd = 0.2, Re = 0.2, speed = 1 } } }
    local preload = { "a", "b", spring = function(x) return x > 0 and 1 or x < 0 and -1 or 0 end }
    local start = { theta0 = { a = 0.1, b = 0.2 }, velocity0 = { b = 0.5 } }
    local run = system { bodies = bodies, links = { preload = preload } }:simulate(merged(start, { t_end = 10 }))
    near(run.preload.theta[#run], 0, 1e-15)
    near(run.a.velocity[#run], 0, 1e-15)
    equal(#of_kind(run.b, "stick"), 1)
    closes(run)
end)

finish()

test("a feedback of the velocity and a preload hold a body together, as dry friction and a preload do", function()
    local sign = function(x) return x > 0 and 1 or x < 0 and -1 or 0 end
    for _, amplitude in ipairs { 0.3, 0.9, 1.6 } do
        local function go(Rd, feedback)
            return system { I = 1, k = 1, C = 0.1, Rd = Rd, spring = sign }:simulate {
                M = function(t, _, v) return amplitude * math.sin(t) - feedback * sign(v) end,
                theta0 = 0.3, velocity0 = 0.5, t_end = 30,
            }
        end
        near(go(0, 0.5).theta, go(0.5, 0).theta, 1e-12)
    end
    local function linked(Rd, feedback)
        return system {
            bodies = { a = { I = 1, C = 0.1 }, b = { I = 0.5, C = 2, Rd = Rd, spring = function(x) return x^3 + sign(x) end } },
            links = { l = { "a", "b", k = 1, C = 0.5 } },
        }:simulate {
            M = { a = function(_, x) return -2 * sign(x.a) end, b = function(_, _, v) return -feedback * sign(v.b) end },
            velocity0 = { a = -1, b = -1 }, t_end = 8,
        }
    end
    near(linked(0, 1).a.theta, linked(1, 0).a.theta, 1e-12)
    -- One that drives the motion on holds nothing: each half cycle is faster than the last by the root of 2.5/1.5.
    local t, v = 0, 1e-3
    for _ = 1, 6 do
        local back = v * math.sqrt(2.5 / 1.5)
        t, v = t + v / 1.5 + back / 2.5, back
    end
    local driven = system { I = 1, k = 0, spring = function(x) return 2 * sign(x) end }
    local run = driven:simulate { M = function(_, _, w) return 0.5 * sign(w) end, velocity0 = 1e-3, t_end = t }
    near(run.velocity[#run.t], v, 1e-13)
end)

test("what rests on the surface of a slide neither switches by rounding nor lets a stop there bear and release", function()
    local sign = function(x) return x > 0 and 1 or x < 0 and -1 or 0 end
    -- A clutch pulls a body that a preload holds at its elastic stop.
    local run = system {
        bodies = { b = { I = 1, C = 0.2, spring = sign, walls = { lower = 0, upper = 1, stiffness = 10, damping = 1 } }, c = { I = 0.5 } },
        links = { l = { "b", "c", Rd = 0.2 } },
    }:simulate {
        M = { b = function(_, x) return -sign(x.b) end, c = function(t) return math.sin(t) > 0 and 0.1 or -0.1 end }, t_end = 8,
    }
    near(run.b.theta, 0 * run.t, 1e-14)
    near(run.c.theta, 0 * run.t, 1e-14)
    assert(#run.events < 12)
    -- The same, thrown by another body that begins at a stop of a link.
    local thrown = system {
        bodies = { a = { I = 1, k = 0.5 }, c = { I = 0.5 },
            b = { I = 1, C = 0.2, spring = sign, walls = { lower = 0, upper = 1, stiffness = 10, damping = 1 } } },
        links = { l1 = { "a", "b", walls = { lower = -1, upper = 1, stiffness = 100, damping = 0 } }, l2 = { "b", "c", Rd = 0.2 } },
    }:simulate {
        M = { b = function(_, x) return -sign(x.b) end, c = function(t) return math.sin(t) > 0 and 0.1 or -0.1 end },
        theta0 = { a = 1 }, velocity0 = { a = 2 }, t_end = 8,
    }
    equal(thrown.status, "end")
    near(thrown:energy().total.error, 0, 1e-11)
    -- A clutch sticks to a held body, and its own body has a feedback of the velocity.
    local stuck = system {
        bodies = { a = { I = 2, C = 2, spring = function(x) return x end }, b = { I = 0.2, k = 1, C = 0.2, Rd = 1 }, c = { I = 0.5, C = 0.2 } },
        links = { l1 = { "a", "b", friction = friction.freewheel { Rd = 0.1 } }, l2 = { "b", "c", k = 1 },
            l3 = { "c", "a", k = 0.5, Rd = 0.5 } },
    }:simulate {
        M = { a = function(_, x) return -2 * sign(x.a) end, c = function(_, _, v) return -0.5 * sign(v.c) end },
        theta0 = { b = 0.5, c = 1 }, velocity0 = { a = 2, c = 2 }, t_end = 8,
        belt = { a = function(t) return t < 2 and 0.2 or -0.2 end, c = math.sin },
    }
    equal(stuck.status, "end")
end)

test("a feedback that changes just beside a body at rest is decided where the body is", function()
    local sign = function(x) return x > 0 and 1 or x < 0 and -1 or 0 end
    local run = system { I = 2, k = 0, C = 0.5, Rd = 0.5, spring = sign }:simulate {
        M = function(_, x, v) return -0.5 * sign(x + v) end, theta0 = 0.1, t_end = 8,
    }
    near(run.theta[#run.t], 0, 1e-11)
end)
