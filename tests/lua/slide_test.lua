-- Loads that jump on a surface and drive the motion back from both sides: the motion slides along the surface, with the
-- mixture of both sides that keeps it there (Filippov).
dofile "tests/lua/support.lua"

local function sgn(x) return x > 0 and 1 or x < 0 and -1 or 0 end

-- ---- as dry friction

--- A load that jumps moves `own` as dry friction moves `dry`, and its switches are the sticks and slips of that.
local function as_dry(what, own, task, dry, M, within)
    local run = expect(own, task, { closes = false }, what)
    local other = expect(dry, merged(task, { M = M or false }), {}, what)
    for _, name in ipairs(other.names) do
        if name:find "theta" or name:find "velocity" then
            local off = (run:column(name) - other:column(name)):abs():max()
            assert(off <= (within or 1e-11), ("%s: %s differs by %g"):format(what, name, off))
        end
    end
    local marks = {}
    for i, each in ipairs { run, other } do
        marks[i] = each.events:filter(function(event) return event.kind ~= "turn" end)
    end
    equal(#marks[1], #marks[2], what)
    for i, event in ipairs(marks[1]) do
        local wanted = marks[2][i]
        if event.kind ~= "switch" then equal(event.kind == "rest" and "stick" or event.kind, wanted.kind == "rest" and "stick" or wanted.kind, what) end
        assert(math.abs(event.t - wanted.t) < 1e-9, what)
    end
    return #marks[1]
end

-- At a standstill the value at velocity 0 counts: the body breaks away where that is beyond Re and the motion is not
-- driven back, at Rd + A. Where it moves with a belt or another body, rounding says what the value is: there it breaks
-- away at Re + A.
local function together(Rd, Re, A, at_0)
    local function side(value) return { Rd = Rd + A, Re = math.max(Rd + A, Re + value) } end
    return friction.asymmetric { forward = side(-at_0), backward = side(at_0) }
end
local relays = {
    read = function(A) return function(v) return v > 0 and -A or A end end,
    ["with a value at 0"] = function(A) return function(v) return -A * sgn(v) end end,
    ["not read"] = function(A) return function(v) return select(1, v > 0 and -A or A) + tonumber("0") end end,
}

test("a feedback -A sgn v adds to the dry friction of the ground, of a belt and of a link", function()
    local function f(t) return 1.1 * math.sin(0.8 * t) + 0.5 * math.sin(2.1 * t) end
    local ends = 0
    for name, relay in pairs(relays) do
        for _, case in ipairs { { 0.7, 0, 0 }, { 0.7, 0.3, 0.4 }, { 0.05, 0.3, 0.9 }, { 1.5, 0.2, 0.2 } } do
            local A, Rd, Re = table.unpack(case)
            local g, what = relay(A), ("%s, A %g, Rd %g, Re %g"):format(name, A, Rd, Re)
            local function own(law) return { I = 1, k = 1.3, C = 0.05, friction = law } end
            local law, both = friction.coulomb { Rd = Rd, Re = Re }, friction.coulomb { Rd = Rd + A, Re = Re + A }
            if Rd > 0 or name ~= "not read" then
                ends = ends + as_dry(what, own(law), { M = function(t, _, v) return g(v) + f(t) end, theta0 = 3.3, t_end = 40 },
                    own(together(Rd, Re, A, g(0))), f)
            end
            if name ~= "not read" then
                for _, load in ipairs { f, function(t) return 0.8 * math.sin(1.7 * t) end } do
                    ends = ends + as_dry(what .. ", belt", own(law), { M = function(t, _, v) return g(v - 0.3) + load(t) end, belt = 0.3, t_end = 30 }, own(both), load)
                end
            end
            if name == "read" then
                local function rig(l) return { bodies = { a = { I = 1, k = 2 }, b = { I = 2, k = 1 } }, links = { c = { "a", "b", friction = l } } } end
                local M = { a = f, c = function(_, _, v) return g(v.a - v.b) end }
                ends = ends + as_dry(what .. ", link", rig(law), { M = M, theta0 = { a = 2 }, t_end = 30 }, rig(both), { a = f })
            end
        end
    end
    assert(ends > 150, ends)
    local falls = friction.stribeck { Rd = 0.3, Re = 0.6, speed = 0.1, shape = 1 } -- the part that falls is in M
    local own = { I = 1, k = 1, C = 0.1 }
    as_dry("Stribeck", merged(own, { Rd = 0.3 }), { theta0 = 0.3, velocity0 = 0.2, t_end = 20, M = function(t, _, v)
        return 1.2 * math.sin(t) - 0.3 * sgn(v) * math.exp(-math.abs(v) / 0.1)
    end }, merged(own, { friction = falls }), function(t) return 1.2 * math.sin(t) end, 1e-9)
    local bodies = { a = { I = 1 }, b = { I = 2 } }
    local loads = { a = function(t, _, v) return -2 * sgn(v.a - v.b) + 2.9 * math.sin(t) end, b = function(_, _, v) return 2 * sgn(v.a - v.b) end }
    local run = system { bodies = bodies }:simulate { M = loads, velocity0 = { a = 0.5 }, t_end = 9 }
    equal(#of_kind(run.b, "switch"), #of_kind(run.a, "switch"))
    closes(run)
    local dry = pair(bodies.a, bodies.b, { Rd = 2 }):simulate { M = { a = function(t) return 2.9 * math.sin(t) end }, velocity0 = { a = 0.5 }, t_end = 9 }
    near(run.a.theta, dry.a.theta, 1e-10)
    near(run.b.theta, dry.b.theta, 1e-10)
    equal(#of_kind(run.a, "switch"), #of_kind(dry, "stick") + #of_kind(dry, "slip"))
    -- A belt along the surface: the mass is held until the load is too weak, as by dry friction of both.
    local function f(t) return 0.9 * math.sin(1.3 * t) end
    as_dry("a belt along the surface", { I = 1, k = 1, C = 0.2, Rd = 0.3, Re = 0.4 }, { M = function(t, _, v) return (v > 0.2 and -1 or 1) + f(t) end, belt = 0.2, t_end = 12 },
        { I = 1, k = 1, C = 0.2, Rd = 1.3, Re = 1.4 }, f)
end)

test("a feedback that begins exactly at its limit holds like dry friction", function()
    local signs = { sgn, function(v) return v > 0 and 1 or -1 end, function(v) return v < 0 and -1 or 1 end }
    for n, sign in ipairs(signs) do
        for _, m in ipairs { 0.1, 0.5 } do
            for _, load in ipairs { m, -m } do
                for _, case in ipairs { { load, 0 }, { 0, load } } do -- by the load, by the spring
                    local function f(t) return case[1] + math.sin(t) end
                    local own, start = { I = 0.5, k = 1, C = 0.1 }, { theta0 = case[2], t_end = 20, dt = 0.5 }
                    local run = system(own):simulate(merged(start, { M = function(t, _, v) return f(t) - m * sign(v) end }))
                    local dry = system(merged(own, { Rd = m })):simulate(merged(start, { M = f }))
                    assert((run.theta - dry.theta):abs():max() <= 1e-11, ("sign %d, %g, load %g"):format(n, m, load))
                end
            end
        end
    end
end)

-- ---- slides whose velocity is known

local block, swing = { I = 1, k = 0 }, { I = 1, k = 1 }
local damped, rubbed = { I = 1, k = 1, C = 0.2 }, { I = 1, k = 1, C = 0.2, Rd = 0.3, Re = 0.4 }
local function relay(_, _, v) return v > 0 and -1 or 1 end
local function to(D, surface) return function(t, theta, v) return v - surface(t, theta) > 0 and -D or D end end
local function decay(_, theta) return -2 * theta end
local function late(t) return t > 1 and math.sin(t - 1) or 0 end

--- The system, M, the velocity from the first switch on, and what else acts, happens and is wanted.
local slides = {
    ["from the start"] = { swing, relay, function() return 0 end, { theta0 = 0.3 }, { switch = 0, theta = function() return 0.3 end } },
    disturbed = { damped, function(t, theta, v) return (v + 2 * theta > 0 and -5 or 5) + 0.8 * math.sin(3 * t) end, decay, { theta0 = 1 } },
    ["three values"] = { swing, function(_, theta, v) return -5 * sgn(v + 2 * theta) end, decay, { theta0 = 3 } },
    ["of another condition"] = { swing, function(_, theta, v) return 5 - (math.max(v + 2 * theta, 0) > 0 and 10 or 0) end, decay, { theta0 = 3 } },
    ["a break of M"] = { swing, function(t, theta, v) return (v + 2 * theta > 0 and -5 or 5) + (t > 1.7 and 1 or 0) end, decay, { theta0 = 3 } },
    curved = { { I = 1, k = 0.5 }, function(t, theta, v) if v + theta ^ 3 - math.cos(t) < 0 then return 20 end return -20 end,
        function(t, theta) return math.cos(t) - theta ^ 3 end, { theta0 = 0.5 } },
    ["friction that turns"] = { { I = 1, k = 1, Rd = 0.3 }, to(5, function(t, theta) return -2 * (theta - math.sin(t)) end),
        function(t, theta) return -2 * (theta - math.sin(t)) end, { theta0 = 1 } },
    ["left by one side"] = { block, function(t, _, v) return relay(t, 0, v) + 0.3 * t end,
        function(t) return 0.15 * math.max(0, t - 1 / 0.3) ^ 2 end, {}, { switch = { 1 / 0.3 } } },
    ["left to friction"] = { { I = 1, k = 0, Rd = 0.7 }, function(t, _, v) return (v - 1 + t > 0 and -0.9 or 0.9) + 0.4 end,
        function(t) return math.max(0, 1 - t) end, { velocity0 = 1 }, { status = "stuck", theta = 0.5 } },
    ["a place, crossed and not slid along"] = { block, function(_, theta) return theta > 0 and -1 or 1 end,
        function(t) return math.abs((t - 1) % 4 - 2) - 1 end, { theta0 = -0.5 }, { switch = 0 } },
    ["the surface comes to a mass that stands"] = { rubbed, function(t, _, v) return v - math.sin(t - 1) > 0 and -0.25 or 3 end, late,
        { theta0 = -0.2 }, { slip = { 1 } } },
    ["a belt"] = { rubbed, to(5, decay), decay, { theta0 = 1, belt = 0.5 } },
    ["a belt that turns"] = { rubbed, to(5, math.sin), math.sin, { theta0 = 1, belt = function(t) return math.sin(2 * t) end } },
    ["a belt that passes"] = { rubbed, to(5, function(_, theta) return 0.3 - theta end), function(_, theta) return 0.3 - theta end,
        { theta0 = 1, belt = function(t) return 0.2 * t - 0.5 end } },
    ["a state is the surface until friction turns"] = { { I = 1, k = 0, Rd = 0.3 }, function(_, _, v, z) return v - z.z > 0 and -0.6 or 0.6 end,
        function(t) return t < 2 and 0.5 * t - 1 or 0.3 * (t - 2) end,
        { states = { z = { start = -1, rate = function() return 0.5 end } }, velocity0 = -1 }, { stick = 0 } },
}
for _, theta0 in ipairs { 0, 0.4, -0.8 } do -- the last one is let go by its spring
    slides["from rest at " .. theta0] = { rubbed, function(t, _, v) return -3 * sgn(v - math.sin(t)) end, math.sin, { theta0 = theta0 } }
end
-- The surface passes the velocity of the belt at t = 1.5; from there on the friction acts against the load.
for _, D in ipairs { 0.9, 1.2, 1.4 } do
    slides["the belt is passed under " .. D] = { { I = 1, k = 0, Rd = 0.3 }, to(D, function(t) return t - 1 end),
        function(t) return t < 1.5 and t - 1 or 0.5 + math.min(1, D - 0.3) * (t - 1.5) end, { belt = 0.5, velocity0 = -1 } }
end
for _, case in ipairs { { 1.2, 1.5, 0.2, 0.2 }, { 2.2, 1, 0.2, 0.5 }, { 1.5, 1.5, -0.5, 0 } } do
    local D1, D2, slope, on = table.unpack(case)
    local one, other = to(D1, function(t) return 0.5 * t end), to(D2, function(t) return slope * (t - 1) + 0.5 end)
    slides["two surfaces that meet, on along " .. on] = { block, function(t, theta, v) return one(t, theta, v) + other(t, theta, v) end,
        function(t) return t < 1 and 0.5 * t or 0.5 + on * (t - 1) end, { t_end = 3 } }
end

test("a mass slides as the surface prescribes on which M jumps and drives it back, whatever disturbs it", function()
    for name, case in pairs(slides) do
        local own, M, surface, task, wanted = table.unpack(case)
        local from
        expect(own, merged({ M = M, t_end = 8 }, task), merged({ within = 1e-10, velocity = function(t, run)
            from = from or (of_kind(run, "switch").t or {})[1] or 0
            local theta = run:at(t)
            return t > math.min(from, 3) and surface(t, theta)
        end }, wanted), name)
    end
end)

test("another condition of the load may change during a slide", function()
    local own = { I = 1, k = 0.6, C = 0.2 }
    -- At velocity 0.4 the surface needs M = 0.6 theta + 0.08; the load allows 0.9 on either side of its rest.
    local function go(M, wanted) return expect(own, { M = M, theta0 = -0.1, velocity0 = 0.4, t_end = 3.9 }, wanted) end
    -- theta = 1 at t = 2.75, from where at most 0.4 is left for the 0.68
    local run = go(function(_, theta, v) return -0.2 - 0.9 * sgn(v - 0.4) - 0.3 * sgn(theta - 1) end, { switch = { 2.75 } })
    local free = system(own):simulate { M = 0.4, theta0 = 1, velocity0 = 0.4, t_start = 2.75, t_end = 3.9 }
    near(run:at(3.9), free:at(3.9), 1e-13)
    for _, at in ipairs { 0.5, 0.1 + 0.2, 0.7 } do -- it slides on over the change, without an event
        run = go(function(_, theta, v) return 0.3 - 0.9 * sgn(v - 0.4) - 0.3 * sgn(theta - at) end, { switch = 1 })
        near(of_kind(run, "switch")[1].theta, 0.82 / 0.6, 1e-13)
    end
end)

test("a surface that cannot keep a resting mass only lets it go", function()
    expect(rubbed, { M = function(t, _, v) return v - 2 * math.sin(t) > 0 and -1 or 1 end, t_end = 1 },
        { theta = system(rubbed):simulate({ M = 1, t_end = 1 }).theta })
end)

test("a mass that its feedback holds, or that nothing moves, is not called moving", function()
    local function held(t, theta, velocity) if velocity > 0 then return -0.4 end return 0.4 end
    has(system(swing):simulate { M = held, theta0 = 1.3, t_end = 20 }, "velocity 0 at the end")
    has(system(swing):simulate { t_end = 5 }, "velocity 0 at the end")
    has(system(swing):simulate { theta0 = 1, t_end = 5 }, "moving at the end")
end)

moves("a body that comes to rest exactly at the sum of both limits is held", { I = 1, k = 1, Rd = 0.2, Re = 0.3 },
    { M = function(_, _, v) return -0.4 * sgn(v) end, theta0 = 3, t_end = 20 }, { status = "stuck", stick = 1, slip = 0, theta = 0.6, parts = false })

test("a slide that dies out with dry friction is at rest to rounding, without an error", function()
    for _, Rd in ipairs { 0.01, 1 } do
        expect({ I = 1, k = 1, Rd = Rd }, { M = function(_, theta, v) return v + 5 * theta > 0 and -8 or 8 end, theta0 = 3, t_end = 40 },
            { theta = 0, within = 1e-14 })
    end
end)

test("a state slides where its rate jumps, and follows the surface", function()
    local function go(rate, start, wanted, M)
        local states = { z = { rate = rate, start = start } }
        return expect({ I = 1, k = 1, C = 0.1 }, { M = M or function(_, _, _, z) return 0 * z.z end, states = states, theta0 = 0.5, t_end = 8, dt = 0.1 }, wanted)
    end
    go(function(_, _, _, z) return z.z > 0 and -1 or 1 end, 1, { z = function(t) return math.max(0, 1 - t) end, switch = { 1 } })
    local run = go(function(t, theta, _, z) return z.z > theta and -2 or 2 end, 1, {}, function(_, _, _, z) return 0.3 * z.z end)
    local from = of_kind(run, "switch")[1]
    for i, t in ipairs(run.t) do
        if t > from.t then near(run.states.z[i], run.theta[i], 1e-13) end
    end
    -- on the surface M is 0.3 theta
    local free = system { I = 1, k = 0.7, C = 0.1 }:simulate { theta0 = from.theta, velocity0 = from.velocity, t_start = from.t, t_end = 8 }
    near(run.theta[#run], free.theta[#free], 1e-11)
    -- it leaves where one side no longer drives it back
    go(function(t, _, _, z) return (z.z > 0 and -1 or 1) + 0.5 * t end, 0, { switch = { 2 }, z = 0.25 * 6 ^ 2, within = 1e-10 })
end)

test("explain() says when the mass slid along a surface, and why that ended", function()
    local function staircase(x) return 2 * math.floor(x / 0.1) end
    for _, case in ipairs {
        { { I = 1, k = 0 }, { M = function(t, _, v) return (v > 0 and -1 or 1) + 0.3 * t end, t_end = 8 },
            "From t = 0 to 3.3333 it stood at theta = 0: M jumps there and drives it back from both sides; then one side no longer did." },
        { { I = 1, k = 5, C = 8, spring = function(theta) return theta > 0 and 0.4 or -0.4 end }, { M = 0.3, t_end = 8 },
            "it stood at theta = 0: a spring jumps there and drives it back from both sides, until the run ended" },
        { swing, { M = function(_, theta, v) return theta + v > 0 and -3 or 3 end, theta0 = 1, t_end = 4 },
            "it slid along a surface on which M jumps and drives it back from both sides, until the run ended" },
        { swing, { M = relay, theta0 = 3.3, t_end = 20 }, "until the run ended" },
        { { I = 1, k = 1.3, Rd = 0.3 }, { M = relay, theta0 = 3.3, t_end = 20 }, "because M drives it back from both sides of velocity 0" },
        { { I = 1, k = 1, Rd = 0.1, spring = staircase }, { M = 1, theta0 = 0.15, t_end = 20 },
            "at theta = 0.1 because the spring jumps there and drives it back from both sides." },
    } do says(system(case[1]):simulate(case[2]), case[3]) end
end)

-- A load -D sgn(theta - a) beside dry friction: the body passes a and is stopped beside it, ever faster.
local function passes(D, a) return function(_, theta) return -D * sgn(theta - a) end end

test("a body that a load drives back to a place comes to rest right there", function()
    for _, form in ipairs { passes, function(D, a) return function(_, theta) return theta > a and -D or D end end } do
        for _, case in ipairs { { 1, 0.3, 0 }, { 2.5, 0.9, 0.7 }, { 1, 0.02, -0.4 }, { 3, 2.9, 0.1 } } do
            local D, Rd, a = table.unpack(case)
            local run = expect({ I = 1, k = 0, Rd = Rd }, { M = form(D, a), theta0 = a, velocity0 = 1.3, t_end = 200 }, { status = "stuck", theta = a, within = 0, parts = false })
            local last = run.events[#run.events]
            equal(last.kind, "stick")
            -- out against D + Rd, back with D - Rd: each passage takes so much longer than the one after
            local out, back = D + Rd, D - Rd
            local slower = math.sqrt(back / out)
            near(last.t, 1.3 * (1 / out + slower / back) / (1 - slower), 3e-8 * last.t) -- the last passages are in the last digits
            assert(run.friction:abs():max() <= Rd * (1 + 1e-15))
        end
    end
end)

test("a body comes to rest where a load drives it back also under a spring and other loads, and leaves when they overcome it", function()
    local D, Re, a = 1.2, 0.5, 0.6
    local own, g = { I = 1, k = 0.5, C = 0.1, Rd = 0.4, Re = Re }, passes(D, a)
    local function f(t) return 0.3 * math.sin(t) + (t > 20 and 0.5 * (t - 20) or 0) end
    local run = expect(own, { M = function(t, theta) return g(t, theta) + f(t) end, theta0 = -2, t_end = 24.5 })
    local slips = of_kind(run, "slip")
    local slip, sticks = slips[#slips], of_kind(run, "stick")
    equal(sticks[#sticks].theta, a)
    equal(slip.theta, a)
    near(f(slip.t) - 0.5 * a, D + Re, 1e-10)
    -- from there on it has D and Rd against it
    local free = system(own):simulate { M = function(t) return f(t) - D end, theta0 = a, t_start = slip.t, t_end = 24.5 }
    near(run:at(24.5), free:at(24.5), 1e-9)
end)

test("a body that starts at rest where a load drives it back stays until it is pushed harder than load and friction together", function()
    for _, at_0 in ipairs { -1, 0, 1 } do -- it is pushed on by 1.5 - 1 - 0.3
        local M = function(t, theta) return (theta > 0.5 and -1 or theta < 0.5 and 1 or at_0) + (t > 3 and 1.5 or 0.2) end
        expect({ I = 1, k = 0, Rd = 0.3 }, { M = M, theta0 = 0.5, t_end = 4 }, { stick = 0, slip = { 3 }, theta = 0.6 })
    end
    -- A load on the velocity adds to it.
    local M = function(t, theta, v) return -0.534 * sgn(theta + 0.758) - 0.951 * sgn(v) + (t > 3 and 2.1 or 0) end
    expect({ I = 1, k = 0, Rd = 0.435 }, { M = M, theta0 = -0.758, t_end = 4 }, { theta = -0.758 + (2.1 - 0.534 - 0.951 - 0.435) / 2 })
end)

-- Without dry friction the body crosses the place at ever shorter intervals, and stays there.
test("a load holds a body at the place to which it drives it back, beside damping alone or on a belt", function()
    local run = expect({ I = 1, k = 0.5, C = 2 }, { M = passes(1, 0.2), theta0 = 1, t_end = 30 }, { status = "end", theta = 0.2, most = 30000, parts = false })
    near(run.M[#run], 0.1, 1e-9)
    -- friction of the belt pushes it forward, the load holds it against that until the pull of the last term is too strong
    local g, leaves = passes(2, -0.7), (2 - 0.9 - 0.7) / 0.2
    run = expect({ I = 1, k = 1, Rd = 0.9 }, { M = function(t, theta) return g(t, theta) + 0.2 * t end, belt = 0.1, theta0 = -0.7, t_end = 9 },
        { theta = function(t) return t < leaves - 1e-9 and -0.7 end, parts = 1e-5 })
    local left = of_kind(run, "switch")
    near(left[#left].t, leaves, 1e-9)
end)

test("the place to which a load drives a body back may move, and may be an angle of a link", function()
    expect({ I = 1, k = 1, C = 0.4 }, { M = function(t, theta) return theta > 0.3 * math.sin(t) and -2 or 2 end, velocity0 = 0.3, t_end = 12 },
        { theta = function(t) return 0.3 * math.sin(t) end, within = 1e-9, parts = false })
    local one = system { I = 3, k = 1, C = 0.2 }:simulate { theta0 = 0.4, t_end = 10 }
    expect({ bodies = { a = { I = 1, k = 1, C = 0.2 }, b = { I = 2 } }, links = { c = { "a", "b", k = 0.5 } } },
        { M = { c = function(_, theta) return theta.a - theta.b > 0.4 and -3 or 3 end }, theta0 = { a = 0.4 }, t_end = 10 },
        { ["a.theta"] = one.theta, ["b.theta"] = one.theta - 0.4, within = 1e-10, parts = false })
end)

test("passages at growing intervals of a place to which a load drives a body back are followed", function()
    local run = expect(block, { M = function(_, theta, v) return (theta > 0 and -1 or 1) + 3 * v end, velocity0 = 1e-3, t_end = 6 }, { parts = false })
    assert(run.theta:abs():max() > 1e-3, run.theta:max())
end)

test("a body comes to rest where a load drives it back also under rk4, which samples loads", function()
    for _, M in ipairs { passes(1, 0.2), relay } do
        local task, sys = { M = M, theta0 = 1, t_end = 20 }, system { I = 1, k = 0.5, Rd = 0.3 }
        local truth = sys:simulate(task)
        expect(sys, merged(task, { integrator = integrator.rk4 { h = 0.002 } }),
            { status = truth.status, theta = truth.theta[#truth], within = 1e-9, closes = false, parts = false })
    end
end)

test("a body that a belt carries past velocity 0 slips where its load jumps there", function()
    for _, by in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.002 } } do
        local run = system { I = 1, k = 0, Rd = 1 }:simulate { M = function(t, theta, v) return v > 0 and -0.7 or 0.7 end,
            belt = function(t) return 0.5 * (t - 1) end, velocity0 = -0.5, t_end = 3, dt = 0.5, integrator = by }
        near(of_kind(run, "slip")[1].t, 1, 1e-9)
        near(run.theta[#run], -0.25 + (1 - 0.7) * 2 ^ 2 / 2, 1e-6) -- from there with the excess of friction
    end
end)

-- The angles are those of an independent time-stepping program.
moves("two loads of one link that slide by turns follow an independent time-stepping program",
    { bodies = { a = { I = 1.26 }, b = { I = 0.538, C = 0.246 } }, links = { c = { "a", "b", Rd = 0.373 } } },
    { M = {
        a = excitation.harmonic { amplitude = 0.72, omega = 2.11, phase = 2.39 },
        c = function(t, theta, v)
            local slip = v.a - v.b
            return (slip + 0.857 * (theta.a - theta.b) + 0.21425 > 0 and -2.44 or 2.44) - 2.62 * sgn(slip - 0.177 * math.sin(0.743 * t + 5.96))
        end,
    }, theta0 = { a = -1.05, b = -0.294 }, t_end = 8 }, { ["a.theta"] = -1.449599902, ["b.theta"] = -1.133706203, within = 3e-9 })

test("a belt that only touches velocity 0 carries on as one that hardly misses it", function()
    local loads = { speed = function(t, x, v) return v > 0 and -0.3 or 0.3 end, place = function(t, x) return x > 0 and -0.3 or 0.3 end }
    for _, way in ipairs { 1, -1 } do
        local function belt(by) return function(t) return way * (0.5 + by + 0.5 * math.cos(t)) end end
        for name, M in pairs(loads) do
            for _, Rd in ipairs { 0.1, 0.2, 0.5, 1 } do
                local sys = system { I = 1, k = 0.5, Rd = Rd }
                local one, other = sys:simulate { belt = belt(0), M = M, t_end = 12 }, sys:simulate { belt = belt(1e-7), M = M, t_end = 12 }
                assert(one.status ~= "failed", name .. ": " .. one.outcome)
                near(one.theta, other.theta, 1e-5)
            end
        end
    end
    -- A freewheel on such a body takes a load along again.
    local function turned(by)
        return system { bodies = { disc = { velocity = function(t) return 0.5 + by + 0.5 * math.cos(0.7 * t) end }, load = { I = 1, k = 1, Rd = 0.1 } },
            links = { wheel = { "disc", "load", friction = friction.freewheel { Rd = 0.2 } } } }:simulate { t_end = 20 }
    end
    near(turned(0).load.theta, turned(1e-7).load.theta, 1e-5)
end)

test("functions that jump at one surface slide with one common weight, in loads and in rates", function()
    local function go(rate, start, z)
        expect(swing, { M = function(_, theta, v) return -3 * sgn(v + 2 * theta) end, states = { z = { start = start, rate = rate } },
            theta0 = 0.3, velocity0 = -0.6, t_end = 3 }, { z = z })
    end
    -- On the surface theta' = -2 theta, which takes M = 5 theta, and so the mean -5/3 theta of sgn.
    go(function(_, theta, v) return sgn(2 * v + 4 * theta) end, 0, function(t) return -0.25 * (1 - math.exp(-2 * t)) end)
    -- Two surfaces that meet at the start are two.
    go(function(_, _, v, z) return -2 * sgn(z.z - v) end, -0.6, function(t) return -0.6 * math.exp(-2 * t) end)
end)

test("a slide ends where friction turns against it, and the body does not stick there if the load moves it on", function()
    -- The surface moves with another body, and passes 0 at t = 1.2.
    local function beside(D, wanted)
        return expect({ bodies = { a = { I = 1 }, b = { I = 1, Rd = 0.3 } } }, { M = { a = 0.5, b = function(_, _, v) return v.b - v.a - 0.4 > 0 and -D or D end },
            velocity0 = { a = -1, b = -0.6 }, t_end = 3 }, wanted, D)
    end
    beside(0.6, { ["b.velocity"] = 0.3 * 1.8, stick = 0 })
    equal(of_kind(beside(0.25, { ["b.velocity"] = 0, within = 0 }), "stick")[1].where, "b")
end)

-- The program has steep lines in place of the jumps.
moves("a load and the rate of a state slide at once, and follow an independent program with steep lines", { I = 1.623, k = 0, Rd = 0.473 },
    { M = function(t, _, v, z)
        return 0.1909 * math.sin(2.0131 * t + 2.9762) - (v + 1.1731 * z.z - 0.4392 * math.sin(1.2811 * t + 1.3491) > 0 and 0.9518 or -0.9518)
    end, states = { z = { start = 0.044, rate = function(_, theta, v, z)
        return -1.6205 * z.z + 0.8402 * theta - 0.5364 * v - (z.z - 0.7472 * v + 0.1837 > 0 and 0.4514 or -0.4514)
    end } }, theta0 = 0.292, t_end = 6 }, { theta = 0.580617977, velocity = 0.179453653, z = -0.010953476, within = 3e-9 })

-- ---- staircases and preloads

test("the motion slides and rests on the steps of a staircase as on those of comparisons", function()
    local q = 0.3
    local function compared(x)
        local n = 0
        for step = 1, 6 do n = n + (x >= (step - 0.5) * q and 1 or 0) - (x < (0.5 - step) * q and 1 or 0) end
        return n
    end
    local rows = {
        floor = function(t, theta, velocity) return -0.4 * math.floor(velocity / q + 0.5) end,
        divided = function(t, theta, velocity) return -0.4 * ((velocity + 0.5 * q) // q) end,
        ceil = function(t, theta, velocity) return -0.4 * math.ceil(velocity / q - 0.5) end,
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
                    assert(k == 0 or #of_kind(run, "turn") == 0, ("sign %d, load %g, k %g: it turns"):format(n, load, k))
                end
            end
        end
    end
end)

test("friction stops a body at the step of a staircase, from whichever side it comes", function()
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

test("a body at rest on the surface of a slide is not switched by rounding, and a stop there does not close and open", function()
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

test("a feedback that changes just beside a body at rest is evaluated where the body is", function()
    local sign = function(x) return x > 0 and 1 or x < 0 and -1 or 0 end
    local run = system { I = 2, k = 0, C = 0.5, Rd = 0.5, spring = sign }:simulate {
        M = function(_, x, v) return -0.5 * sign(x + v) end, theta0 = 0.1, t_end = 8,
    }
    near(run.theta[#run.t], 0, 1e-11)
end)

test("feedbacks of several bodies move a machine as dry friction does", function()
    local damped, light = { I = 2, k = 0.2, C = 2 }, { I = 0.5, k = 2, C = 1, Rd = 0.2 }
    -- each: bodies, links, the feedbacks of bodies, other loads, start
    for i, case in ipairs {
        -- a clutch holds two bodies together that both have one
        { { a = { I = 2, k = 0, C = 0.5, Rd = 0.2 }, b = damped }, { l = { "a", "b", k = 2, Rd = 1 } }, { a = 2, b = 1 },
            { a = math.sin, b = function(t) return 2 * math.sin(t) end }, { velocity0 = { b = 0.2 } } },
        -- rounding of what is held moves nothing else
        { { a = light, b = { I = 1, k = 0.5, C = 1 }, c = { I = 2, k = 2, C = 2 } },
            { l = { "a", "b", k = 0.2, Rd = 0.1 }, m = { "b", "c", k = 1 } }, { b = 1 },
            { b = function(t) return 0.5 * math.sin(t) end }, { theta0 = { a = -0.1 }, velocity0 = { a = 0.2 } } },
        -- the preload of a link reverses, and pulls off the body that its feedback has held
        { { a = { I = 0.5, k = 0, Rd = 0.5, walls = { lower = -0.1, restitution = 1 } }, b = { I = 0.5, k = 0.5, Rd = 0.5 } },
            { l = { "a", "b", Rd = 0.1, spring = function(x) return 2 * sgn(x) end } }, { b = 2 },
            { b = function(t) return 0.5 * math.sin(t) end }, { theta0 = { a = 0.1 }, velocity0 = { a = 0.5 } } },
        -- the same, from a start right at the reversal
        { { a = { I = 2, k = 0, C = 0.5, Rd = 0.2 }, b = damped },
            { l = { "a", "b", k = 2, Rd = 1, spring = function(x) return 2 * sgn(x) end } }, { a = 2 }, { a = math.sin },
            { velocity0 = { b = 0.2 } } },
        -- a stop presses one body against another that its feedback holds
        { { a = { I = 0.5, k = 1, C = 2, Rd = 0.2 }, b = { I = 2, k = 0.1, C = 2, Rd = 0.1 } },
            { l = { "a", "b", k = 0.1, C = 1, walls = { lower = -0.2, upper = 0.2, restitution = 0.5 } } }, { b = 2 },
            { a = function(t) return math.min(t, 2) end }, { theta0 = { a = 0.05, b = 0.1 }, velocity0 = { b = 0.5 } } },
    } do
        local bodies, links, most, loads, task = table.unpack(case)
        local dry, M = {}, {}
        for name, body in pairs(bodies) do
            local own, A = loads[name] or function() return 0 end, most[name] or 0
            dry[name] = merged(body, { Rd = (body.Rd or 0) + A })
            M[name] = function(t, _, v) return own(t) - A * sgn(v[name]) end
        end
        local run = system { bodies = bodies, links = links }:simulate(merged(task, { M = M, t_end = 20 }))
        local truth = system { bodies = dry, links = links }:simulate(merged(task, { M = loads, t_end = 20 }))
        equal(run.status, truth.status, i)
        for _, name in ipairs(truth.names) do
            if name:find "theta" or name:find "velocity" then near(run:column(name), truth:column(name), 1e-11) end
        end
        if i == 2 then equal(#run.events, #truth.events) end
    end
    -- That of a link whose bodies begin to move together is decided by the slip between them.
    for _, strong in ipairs { 2, 3, 4 } do
        local function run(Rd, M)
            return system { bodies = { a = { I = 1, k = 5 }, b = { I = 1, Rd = 0.2 } }, links = { l = { "a", "b", k = 0.5, Rd = Rd } } }
                :simulate { M = { a = function(t) return strong * math.cos(t) end, l = M }, t_end = 8 }
        end
        near(run(1, function(_, _, v) return v.a > v.b and -0.3 or 0.3 end).a.theta, run(1.3).a.theta, 1e-13)
    end
end)

test("a place to which a load drives a body back holds it also where a link's preload reverses", function()
    local a = { I = 2, k = 0.5, C = 0.5, Rd = 0.2, Re = 0.7 }
    local alone = system(a):simulate { M = function(_, x) return -2.1 * sgn(x) end, theta0 = 0.1, t_end = 20 }
    -- The preload acts between it and a body that stays at 0.
    local run = system {
        bodies = { a = a, b = { I = 0.5, k = 2, C = 0.5, Rd = 0.5, Re = 0.7 } },
        links = { l = { "a", "b", spring = function(x) return 0.1 * sgn(x) end } },
    }:simulate { M = { a = function(_, x) return -2 * sgn(x.a) end }, theta0 = { a = 0.1 }, t_end = 20 }
    equal(run.status, "stuck")
    near(run.a.theta, alone.theta, 1e-12)
end)

test("a feedback of the velocity acts beside a belt as dry friction on the ground, also where the belt reverses", function()
    -- each: A, Rd, speed of the belt, its omega, k, I, C, theta0, velocity0, amplitude of M
    for _, case in ipairs {
        { 0.5, 0.2, 0.5, 2, 1, 2, 0, -0.5, 0, 1 }, { 0.1, 0.2, 0.5, 1, 0, 1, 0.1, 0.1, 0, 0.3 }, { 0.2, 0.1, 0.5, 2, 0.5, 0.5, 0.1, -0.5, 0, 0.3 },
        { 0.2, 0.2, 0.5, 1, 1, 0.5, 0, 0, 0, 1 }, { 0.1, 0.5, 0.5, 1, 1, 2, 0.1, 0, 0, 0 }, { 0.5, 0.5, 0.2, 0.5, 0, 1, 0.1, 0.1, 0.2, 1 },
    } do
        local A, Rd, fast, omega, k, I, C, theta0, velocity0, amplitude = table.unpack(case)
        local function belt(t) return fast * math.sin(omega * t) end
        local run = system { I = I, k = k, C = C, Rd = Rd }:simulate {
            M = function(t, _, v) return amplitude * math.sin(t) - A * sgn(v) end, belt = belt, theta0 = theta0, velocity0 = velocity0, t_end = 20,
        }
        local truth = system { bodies = { a = { I = I, k = k, C = C, Rd = Rd }, ground = { theta = 0 } }, links = { l = { "a", "ground", Rd = A } } }
            :simulate {
                M = { a = function(t) return amplitude * math.sin(t) end }, belt = { a = belt }, theta0 = { a = theta0 },
                velocity0 = { a = velocity0 }, t_end = 20,
            }
        near(run.theta, truth.a.theta, 1e-11)
    end
end)

test("a body tied by a preload to another one on a belt moves with it, past its own friction and stops", function()
    local function tied(b, preload, load)
        local run = system {
            bodies = { a = { I = 0.5, k = 0.2, C = 2, Rd = 1 }, b = merged({ I = 2, k = 1, C = 1, Rd = 0.1 }, b) },
            links = { l = { "a", "b", spring = function(x) return preload * sgn(x) end } },
        }:simulate { M = { b = function() return load end }, theta0 = { a = 0.04, b = 0.04 }, belt = { a = function(t) return 0.2 * math.sin(t) end }, t_end = 20 }
        near(run:energy().total.error, 0, 1e-10)
        return run
    end
    for _, preload in ipairs { 1, 2 } do
        for _, load in ipairs { 0, 0.5, 1 } do
            local run = tied({}, preload, load)
            local apart = (run.a.theta - run.b.theta):abs():max()
            if preload == 2 and load < 1 then near(apart, 0, 1e-9) end
        end
        tied({ walls = { lower = -0.1, upper = 0.1, stiffness = 20, damping = 1 } }, preload, 0)
    end
end)

test("a load that holds a speed carries a body on: past a clutch that sticks to it, and into a stop", function()
    local function cruise(t, v) return 0.1 * math.sin(t) - 0.7 * sgn(v - 0.1) end
    local pair = system { bodies = { a = { I = 1, k = 0, Rd = 0.3 }, b = { I = 1, k = 0.2 } }, links = { l = { "a", "b", Rd = 0.1 } } }
        :simulate { M = { a = function(t, _, v) return cruise(t, v.a) end }, velocity0 = { a = 0.2, b = 0.3 }, t_end = 3 }
    near(pair.a.velocity[#pair.t], 0.1, 1e-14)
    near(pair.b.velocity[#pair.t], 0.1, 1e-14)
    near(pair:energy().total.error, 0, 1e-13)
    local stopped = system { I = 1, k = 0, Rd = 0.3, walls = { upper = 0.3, stiffness = 50, damping = 1 } }
        :simulate { M = function(t, _, v) return cruise(t, v) end, velocity0 = 0.2, t_end = 8 }
    local begun, met = stopped.events[1], stopped.events[2]
    equal(met.kind, "impact")
    near(met.t, begun.t + (0.3 - begun.theta) / 0.1, 1e-13)
    -- It presses with 0.8 - 0.3 at most, and its speed adds 0.1/sqrt(50).
    assert(stopped.theta:max() < 0.33)
end)

test("a body that is held at a moving place turns with it, and does not stick where the place turns", function()
    local run = system { I = 0.5, k = 1, C = 0.5, Rd = 0.5 }
        :simulate { M = function(t, x) return -2 * sgn(x - 0.1 * math.sin(t)) end, theta0 = 0.1, t_end = 12 }
    local held = run:filter(function(row) return row.t > 2 end)
    near(held.theta, 0.1 * held.t:sin(), 1e-12)
    -- What holds it: 0.5 x'' + 0.5 x' + x, and friction against its motion.
    near(held.M, 0.05 * held.t:sin() + 0.05 * held.t:cos() + 0.5 * held.velocity:map(sgn), 1e-9)
    local kinds = run.events:filter(function(event) return event.t > 2 end)
    equal(#kinds, 3)
    for i, event in ipairs(kinds) do
        equal(event.kind, "turn")
        near(event.t, (i + 0.5) * math.pi, 1e-7)
    end
end)

test("a body that comes to rest on the ground and on one that a load holds still sticks to both at once", function()
    local rig = system {
        bodies = { a = { I = 1.2, k = 3, Rd = 0.1, Re = 0.4 }, b = { I = 1.4, C = 0.3, k = 2.9, Rd = 0.4, spring = function(x) return 1.3 * x ^ 3 end },
            c = { I = 1.8, C = 0.2, Rd = 0.2, Re = 0.6, walls = { upper = 0.2, stiffness = 12.6 } } },
        links = { ab = { "a", "b", Rd = 0.1, Re = 0.3 }, bc = { "b", "c", k = 4.9, friction = friction.jenkins { stiffness = 6.4, Rd = 0.3 } } } }
    local function step(to, at) return function(t) return t < at and 0 or to end end
    local run = rig:simulate { M = { a = step(-0.9, 4), b = function(_, _, v) return v.b > 0 and -0.6 or 0.6 end, c = step(-1.3, 1.5) },
        belt = { b = 0.6, c = -0.4 }, theta0 = { a = 0.3, c = -0.4 }, velocity0 = { a = -0.4, b = -0.5, c = -0.1 }, t_end = 9 }
    local last = run.events:filter(function(event) return event.t > 7 end)
    equal(#last, 2)
    for i, where in ipairs { "a", "ab" } do
        equal(last[i].kind .. last[i].where, "stick" .. where)
        near(last[i].t, 7.81911518249, 1e-9)
    end
end)

test("a clutch that reaches its limit as a load stops to hold its body slips from there on", function()
    local rig = system {
        bodies = { a = { I = 0.6, C = 0.2, spring = function(x) return 2 * x ^ 3 end }, c = { I = 1.7 },
            b = { I = 0.3, C = 0.5, spring = function(x) return 1.2 * x ^ 3 end, walls = { upper = 0.6, stiffness = 30.6 } } },
        links = { ab = { "a", "b", Rd = 0.7, k = 5.1, C = 0.3 }, bc = { "b", "c", Rd = 0.5, C = 0.1 } } }
    local function simulated(cruise)
        return rig:simulate { M = { b = function(t) return 0.2 * math.sin(2.1 * t + 0.3) end, c = function(_, _, v) return cruise(v.c) end },
            theta0 = { a = 0.1, b = 0.1, c = 0.5 }, velocity0 = { a = -0.8, b = -0.3, c = 0.1 }, t_end = 3.5, times = { 2.7, 3.5 } }
    end
    local run = simulated(function(v) return v > -0.2 and -0.5 or v < -0.2 and 0.5 or 0 end)
    near(run.c.theta, simulated(function(v) return -0.5 * math.tanh((v + 0.2) / 1e-6) end).c.theta, 1e-5)
    near(run:energy().total.error, 0, 1e-10)
end)

finish()
