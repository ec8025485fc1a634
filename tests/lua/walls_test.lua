dofile "tests/lua/support.lua"

local walls = { lower = -0.8, upper = 0.8, restitution = 0.7 }

test("walls are an option of a system, and the system's text reproduces them", function()
    local sys = system { I = 1, k = 0, walls = walls }
    equal(tostring(sys), "system{ I = 1, k = 0, walls = { lower = -0.8, upper = 0.8, restitution = 0.7 } }")
    equal(tostring(load("return " .. tostring(sys))()), tostring(sys))
    equal(sys.walls.lower, -0.8)
    equal(system { I = 1, k = 1 }.walls, nil)
    local one = system { I = 1, k = 1, Rd = 0.1, walls = { upper = 0.5 } }
    equal(tostring(one), "system{ I = 1, k = 1, walls = { upper = 0.5, restitution = 1 }, Rd = 0.1, Re = 0.1 }")
    equal(one.walls.lower, nil)
    equal(sys:with { walls = {} }.walls, nil)
    equal(sys:with { k = 2 }.walls.upper, 0.8)
    equal(sys:with { walls = { lower = 0 } }.walls.restitution, 1.0)
end)

test("impacts are events with time, place and velocity", function()
    for _, method in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.002 } } do
        local run = expect({ I = 1, k = 0, walls = walls }, { velocity0 = 2, t_end = 3.5, dt = 0.1, integrator = method },
            { events = 3, impact = { 0.4, 0.4 + 1.6 / 1.4, 0.4 + 1.6 / 1.4 + 1.6 / 0.98 } })
        for i, event in ipairs(run.events) do equal(event.theta, i % 2 == 1 and 0.8 or -0.8) end
        near(run.events[2].velocity, -1.4, 1e-13)
        near(run:at(0.4), 0.8, 1e-12)
        has(run, "3 events (3 impacts)")
        assert(run.theta:max() <= 0.8)
    end
end)

test("a bouncing ball comes to rest in finite time; its energy adds up; the file repeats it", function()
    local run = expect({ I = 1, k = 0, walls = { lower = 0, restitution = 0.7 } }, { M = -2, theta0 = 1, t_end = 10, dt = 0.5 },
        { status = "rest", rest = { 1.7 / 0.3 }, story = { "It came to rest at the wall, theta = 0" }, within = 1e-11, closes = 1e-12 })
    local energy = run:energy()
    near(energy.total.impacts, 2, 1e-11)
    near(energy.impacts[#run], 2, 1e-11)
    has(energy, "lost at the walls")
    local again = repeated(run)
    equal(#again.events, #run.events)
    equal(again.theta[5], run.theta[5])
    has(run:plot { width = 60, height = 12, show = false }, "impact")
    -- It falls for 1; the n-th bounce takes 2*0.9^n, what is left with it 20*0.9^n, all of it 1 + 18. Bounces are reported
    -- until those that are left last 1e-7 of the motion so far.
    expect({ I = 1, k = 0, walls = { lower = 0, restitution = 0.9 } }, { M = -2, theta0 = 1, t_end = 60, dt = 60 },
        { impact = math.ceil(math.log(19e-7 / 20, 0.9)), rest = { 19 }, within = 1e-10 })
end)

test("a steady motion between walls is found, and its response", function()
    local sys = system { I = 1, k = 1, C = 0.1, Rd = 0.05, walls = { lower = -0.5, upper = 0.5, restitution = 0.6 } }
    local s = sys:steady { M = excitation.harmonic { amplitude = 0.6, omega = 1.2 } }
    equal(s.status, "steady")
    equal(s.amplitude, 0.5)
    near(s.run.theta[#s.run], s.run.theta[1], 1e-7)
    local c = sys:response { over = { frequency = vector.linspace(0.15, 0.2, 2) }, between = true, amplitude = 0.6 } -- more rows where branches turn back
    assert(#c >= 2 and c.frequency:min() == 0.15 and c.frequency:max() == 0.2, c)
end)

test("between walls nothing grows, and a mass that rests against one is stable", function()
    local at_wall = 0
    for seed = 1, lots(15) do
        math.randomseed(seed, 7)
        local function pick(a, b) return a + (b - a) * math.random() end
        local Rd = pick(0.02, 0.4)
        local sys = system { I = 1, k = pick(0.5, 2), C = pick(0.05, 0.4), Rd = Rd, Re = Rd * pick(1, 1.3),
            walls = { lower = -pick(0.1, 0.8), upper = pick(0.1, 0.8), restitution = math.random(0, 2) / 3 } }
        local M = excitation.harmonic { amplitude = pick(0.5, 2), omega = pick(0.3, 1), phase = pick(0, 6) } + pick(-0.5, 0.5)
        local s = sys:steady { M = M }
        assert(s.status ~= "grows", seed)
        assert(not s:explain():find "grows%.", seed)
        if s.status == "steady" then
            assert(s.unique ~= "proven", seed)
            local theta, velocity, T = s.run.theta[1], s.run.velocity[1], s.period
            local function later(x) -- what 300 periods leave of a disturbance
                local last = sys:simulate { M = M, theta0 = x, velocity0 = velocity, t_end = 300 * T, dt = 300 * T }
                return math.abs(last.theta[2] - theta) + math.abs(last.velocity[2] - velocity)
            end
            local inwards = theta > 0 and -1e-6 or 1e-6
            equal(s.stable, later(theta + inwards) < 2e-6, seed)
            if velocity == 0 and (theta == sys.walls.lower or theta == sys.walls.upper) then
                at_wall = at_wall + 1
                assert(s.stable, seed)
            end
        end
    end
    assert(at_wall > 0 or lots(15) < 5)
    refused { { "system { I = 1, k = 1, walls = { upper = 1 } }:steady { theta0 = 2 }", "theta0 = 2 is beyond the wall at upper = 1" } }
end)

test("each mistake in walls is one sentence with the name of the option", function()
    refuses(function(walls) system { I = 1, k = 1, walls = walls } end, {
        { 3, "system: walls must be a table such as { lower = -0.8", "got 3" },
        { { lower = 1, upper = 0 }, "walls: lower = 1 must be less than upper = 0" },
        { { restitution = 0.5 }, "walls needs lower, upper or both" },
        { { upper = 1, restitution = 1.5 }, "walls: restitution = 1.5 must be from 0 to 1" },
        { { upper = 1, restitution = -0.5 }, "walls: restitution = -0.5 must be from 0 to 1" },
        { { uper = 1 }, "walls has no option 'uper' among lower, upper, restitution, stiffness and damping; did you mean 'upper'?" },
        { { upper = "1" }, "walls: upper must be a finite number" },
    })
    local sys = system { I = 1, k = 1, walls = walls }
    refused { { "sys:simulate { theta0 = 1, t_end = 1, dt = 1 }", "sys:simulate: theta0 = 1 is beyond the wall at upper = 0.8" } }
end)

test("a mass that reaches a wall at velocity 0 does not hit it, despite rounding", function()
    -- From rest at the wall under a constant load away from it: p/k (1 - cos w t), which touches the wall once a period.
    for i = 1, 40 do
        local side, k, p = i % 2 == 0 and 1 or -1, 1 + i % 7, 0.3 + 0.11*i
        local at = i % 3 == 0 and 0.7 or 0
        local bounds = side == 1 and { lower = at, upper = at + 50, restitution = 0 } or { lower = at - 50, upper = at, restitution = 0 }
        local run = system { I = 1.3, k = k, walls = bounds }:simulate {
            M = k*at + side*p/2, base = -side*p/2/1.3, theta0 = at + side*(2*p/k + 1), t_end = 30, dt = 0.25 }
        local impacts = of_kind(run, "impact")
        equal(#impacts, 1)
        local later = run:filter(function(row) return row.t > impacts.t[1] end)
        -- some roundings of theta a swing, over tens of them; an impact that is none costs 1e-8
        near(later.theta, at + side*p/k*(1 - (math.sqrt(k/1.3)*(later.t - impacts.t[1])):cos()), 1e-12*(1 + p/k))
    end
end)

-- The loads press b2 against b1 and leave both their common velocity -1. b1 stops at t = 1, and b2 goes on under its own
-- load, from -0.7.
test("a body that leaned on another goes on when that one stops dead at a wall", function()
    for _, method in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.01 } } do
        expect({ bodies = { b1 = { I = 1, walls = { lower = -1, restitution = 0 } }, b2 = { I = 1 } }, links = { l = { "b1", "b2", walls = { lower = -0.3, restitution = 0 } } } },
            { M = { b1 = -0.5, b2 = 0.5 }, theta0 = { b1 = 0, b2 = 0.3 }, velocity0 = { b1 = -1, b2 = -1 }, t_end = 2, dt = 0.5, integrator = method },
            { status = "end", ["b1.theta"] = -1, ["b2.theta"] = -0.7 - 1 + 0.5 * 0.5 })
    end
end)

moves("a body that comes to rest at a wall does not stop the others meanwhile", { bodies = { a = { I = 1, walls = { lower = 0, restitution = 0.5 } }, b = { I = 1, k = 4 } } },
    { M = { a = -1 }, theta0 = { a = 1, b = 1 }, t_end = 20 }, { ["a.theta"] = 0, ["b.theta"] = math.cos(40), within = 1e-11 })

-- Bodies in a row, by their inertias, whose links are all alike.
local function row(inertias, link, last)
    local bodies, links = {}, {}
    for i, I in ipairs(inertias) do
        bodies["b" .. i] = i == #inertias and merged({ I = I }, last) or { I = I }
        if i > 1 then links["l" .. i - 1] = merged({ "b" .. i - 1, "b" .. i }, link) end
    end
    return { bodies = bodies, links = links }
end

test("masses in a row that strike each other without rebound, or a wall, go on together or stand", function()
    local play, stop = { walls = { lower = -0.1, upper = 0.5, restitution = 0 } }, { walls = { upper = 0.5, restitution = 0 } }
    -- A train that is pushed: it moves as one mass once all play is used up.
    for i, M in ipairs { excitation.constant(1), excitation.harmonic { omega = 1 } } do
        expect(row({ 0.3, 0.7, 1.1 }, play), { M = { b1 = M }, t_end = 3, dt = 0.01 },
            { status = "end", most = 20, ["l1.theta"] = 0.5, ["l2.theta"] = 0.5, ["b3.velocity"] = (i == 1 and 3 or 1 - math.cos(3)) / 2.1 })
    end
    -- Pressed against a wall at 0.5.
    expect(row({ 0.1, 0.1 }, play, stop), { M = { b1 = 1 }, t_end = 3 }, { status = "rest", most = 20, ["b1.theta"] = 1, ["b2.theta"] = 0.5 })
    -- Five balls that touch share the velocity of the first; two with a little rebound end against the wall as well.
    expect(row({ 1, 1, 1, 1, 1 }, { walls = { upper = 0, restitution = 0 } }), { velocity0 = { b1 = 1 }, t_end = 2 },
        { ["b1.theta"] = 0.4, ["b2.theta"] = 0.4, ["b3.theta"] = 0.4, ["b4.theta"] = 0.4, ["b5.theta"] = 0.4 })
    for _, e in ipairs { { 0, 0.5 }, { 0.5, 0 }, { 0.5, 0.5 } } do
        expect(row({ 0.1, 0.1 }, { walls = { upper = 0.5, restitution = e[2] } }, { walls = { upper = 0.5, restitution = e[1] } }),
            { M = { b1 = 1 }, t_end = 3 }, { status = "rest" }, e[1])
    end
end)

moves("bodies in a row that nothing but their walls pushes go on together under any M", row({ 0.3, 0.7, 1.1 }, { walls = { upper = 0.5 } }),
    { M = { b1 = function(t) return 1 + 0.2 * t end }, theta0 = { b1 = 1, b2 = 0.5 }, t_end = 3 },
    { events = 0, ["b3.theta"] = (4.5 + 0.9) / 2.1, ["l2.torque"] = -1.6 * 1.1 / 2.1 })

test("bouncing impacts of masses in a row end, also when only rounding is left of them", function()
    for _, e in ipairs { 0.3, 0.5, 0.7 } do
        local function link(first, second) return { first, second, walls = { upper = 0, restitution = e } } end
        local rig = { bodies = { a = { I = 1, C = 0.1 }, b = { I = 2, k = 1 }, c = { I = 0.7, C = 0.2 }, d = { I = 1.5, C = 0.1, k = 2 } },
            links = { ab = link("a", "b"), bc = link("b", "c"), cd = link("c", "d") } }
        for _, A in ipairs { 0.5, 1, 2 } do
            local run = expect(rig, { M = { a = function(t) return A * math.sin(1.3 * t) + 0.3 end, d = function(t) return -0.5 * math.sin(t) end },
                theta0 = { a = -0.2, b = -0.1, c = 0.1, d = 0.15 }, velocity0 = { a = 0.7, d = -0.5 }, t_end = 12 }, { status = "end", parts = false }, e)
            for _, name in ipairs { "ab", "bc", "cd" } do assert(run[name].theta:max() <= 1e-12, run[name].theta:max()) end
        end
    end
end)

test("runs that begin at an elastic stop exactly, or to rounding, go on", function()
    math.randomseed(3)
    local function lot(a, b) return math.floor((a + (b - a) * math.random()) * 100) / 100 end
    for _ = 1, 150 do
        local lower, stiffness = -lot(0.1, 1), 10 ^ (5 * math.random())
        local start, fast = lower + math.random(-1, 1) * 2 ^ -53, -10 ^ (-14 * math.random())
        -- Pressed against a stop that damps, a mass comes to lie where the springs balance.
        local k, M = lot(0.5, 3), -lot(0, 1)
        local mass = system { I = 1, k = k, C = 1, walls = { lower = lower, stiffness = stiffness, damping = lot(1, 10) } }
        local run = mass:simulate { theta0 = start, velocity0 = fast, M = M, t_end = 300, dt = 10 }
        assert(run.status == "end" or run.status == "rest", run.outcome)
        near(run.theta[#run], math.max(M / k, (M + stiffness * lower) / (k + stiffness)), 1e-10)
        -- Two bodies with a stop between them keep the balance of energy.
        local link = { "a", "b", walls = { lower = lower, stiffness = stiffness } }
        local rig = system { bodies = { a = { I = 1, k = 1 }, b = { I = 1, k = k } }, links = { stop = link } }
        local q = lot(-1, 1)
        run = rig:simulate { theta0 = { a = start + q, b = q }, velocity0 = { a = fast + 0.2, b = 0.2 }, M = { a = M }, t_end = 20 }
        equal(run.status, "end")
        closes(run)
        -- The angle of a rigid stop is a difference of angles, too: a start beyond it by rounding is at it.
        link.walls = { lower = lower, restitution = lot(0, 0.9) }
        rig = system { bodies = { a = { I = 1, k = 1 }, b = { I = 1, k = k } }, links = { stop = link } }
        run = rig:simulate { theta0 = { a = lower + q, b = q }, velocity0 = { a = fast + 0.2, b = 0.2 }, M = { a = M }, t_end = 20 }
        equal(run.status, "end")
        assert(run.stop.theta:min() > lower - 1e-12, run.stop.theta:min())
    end
end)

-- The freewheel takes b along with a: what is left of its bounces in c would take 1e8 impacts in a time unit.
moves("bounces that keep their speed end where they are lower than the rounding of the angles",
    { bodies = { a = { I = 2, k = 10, Rd = 0.1, walls = { lower = -0.2, upper = 0.2, restitution = 1 } }, b = { I = 0.1 }, c = { I = 0.5 } },
        links = { pawl = { "a", "b", friction = friction.freewheel { Rd = 0.1 } }, stop = { "b", "c", walls = { lower = -0.1, upper = 0, restitution = 1 } } } },
    { M = { c = excitation.harmonic { omega = 1 } }, t_end = 20, dt = 0.1 }, { status = "end", most = 1000, parts = false })

test("a mass that an impact at the start sets in motion slips then", function()
    local run = expect({ bodies = { a = { I = 1, k = 1, C = 0.1 }, b = { I = 2, Rd = 0.3 } }, links = { stop = { "a", "b", walls = { lower = -0.5, upper = 1, restitution = 0.5 } } } },
        { theta0 = { a = -0.5 }, velocity0 = { a = -1 }, t_end = 8 }, { slip = { 0 } })
    -- stuck from its only stop, at 2.8636
    says(run.b, "with velocity 0; it slipped at once.", "stuck for 5.1364 of 8 time units")
end)

moves("a body that another presses against a wall comes to rest, though the stop between them keeps its speed",
    { bodies = { b = { I = 0.5, k = 0.5, C = 0.1 }, c = { I = 0.2, C = 0.5, walls = { lower = -0.5, upper = 0.5, restitution = 0.8 } } },
        links = { stop = { "b", "c", walls = { lower = -0.2, upper = 1, restitution = 1 } } } },
    { theta0 = { b = 0.1, c = -0.1 }, velocity0 = { b = -1, c = -1 }, M = { b = function(t) return 0.3 * math.floor(t) end }, t_end = 20 },
    { most = 3000, ["b.theta"] = 1.5, ["c.theta"] = 0.5, within = 1e-15, parts = false })

moves("bounces end where a load jumps at the wall itself", { I = 0.1, k = 0, C = 0.5, Rd = 0.1, walls = { lower = -1, upper = 2, restitution = 1 } },
    { M = function(_, theta) return math.abs(theta) < 2 and 2 or 0 end, theta0 = 0.1, t_end = 5 }, { most = 2000, theta = 2, parts = false })

moves("a wall without a load keeps a body that friction and another wall hold, too",
    { bodies = { a = { I = 1, walls = { lower = 0, upper = 0.5, restitution = 0 } }, b = { I = 1, k = 0.5, Rd = 1 } },
        links = { l = { "a", "b", walls = { lower = -0.1, upper = 2, restitution = 0.5 }, Rd = 0.5, Re = 2 } } },
    { M = { a = function(t) return t < 1 and 2 or 0 end, b = function(t) return math.cos(2 * t) end }, theta0 = { a = 0.3, b = 0.4 },
        velocity0 = { a = 0.5, b = 0.5 }, t_end = 1.5 }, { ["a.theta"] = 0.5, ["b.theta"] = 0.6, within = 1e-14, parts = false })

moves("a body without a load stays at its wall while rounding lets an elastic stop begin to pull",
    { bodies = { a = { I = 1 }, b = { I = 0.2, walls = { lower = -0.1, upper = 0.5, restitution = 0 } } },
        links = { stop = { "a", "b", walls = { lower = -0.2, upper = 1, stiffness = 10, damping = 0 } } } },
    { theta0 = { b = -0.1 }, velocity0 = { a = 2, b = 0.5 }, t_end = 20 }, { parts = false })

-- With what each is right to: times and velocities of impacts.
local at_walls = { { integrator.spectral {}, 1e-11 }, { integrator.rk4 { h = 0.002 }, 1e-7 } }

test("a wall carries the load that presses on it, friction the load that pulls off it", function()
    for _, way in ipairs { 1, -1 } do
        expect({ I = 1, k = 0, Rd = 0.5, walls = { lower = -1, upper = 1, restitution = 0 } },
            { M = function(t) return way * (t < 2 and 3 or -0.3) end, theta0 = way, t_end = 3, times = { 0.5, 1, 2.5, 3 } },
            { friction = { 0, 0, way * 0.3, way * 0.3 }, theta = way })
    end
end)

test("a belt carries the mass against the wall and slides along it", function()
    local vb, Rd = 0.5, 0.3
    for _, e in ipairs { 0, 0.6 } do
        for _, method in ipairs(at_walls) do
            -- Thrown back with e vb, friction of the belt brings it back in 2 e vb/Rd, and so on; then it presses with Rd.
            local rest = 2 + 2 * e * vb / Rd / (1 - e)
            local function leans(x) return function(t) return t > rest + 1e-6 and t < 23 and x end end
            local run = expect({ I = 1, k = 0, Rd = Rd, Re = 0.4, walls = { upper = 1, restitution = e } },
                { M = excitation.ramp { slope = -0.1, at = 20 }, belt = vb, velocity0 = vb, t_end = 30, dt = 0.5, integrator = method[1] },
                { slip = { 23 }, theta = leans(1), velocity = leans(0), friction = leans(Rd), within = 1e-12 }, e)
            near(of_kind(run, "stick")[1].t, rest, 4 * method[2])
            local first = run.events[1]
            equal(first.kind, "impact")
            near(first.t, 2, method[2])
            near(first.velocity, vb, method[2])
        end
    end
end)

test("while the mass leans on a wall states are integrated; user events see impacts, and an M of a state takes the mass off", function()
    local own = { I = 1, k = 0, walls = { upper = 0.5, restitution = 0 } }
    expect(own, { velocity0 = 1, t_end = 4, dt = 0.5, states = { z = { rate = function(t, theta) return theta end } },
        events = { { name = "down", when = function(t, theta, v) return v end } } }, { z = 0.125 + 0.5 * 3.5 })
    expect(own, { M = function(t, theta, v, z) return 1 - z.z end, theta0 = 0.5, t_end = 5, dt = 0.5,
        states = { z = { rate = function(t, theta) return theta end } } }, { slip = { 2 } })
end)

test("a mass that begins at a wall rests there, leaves it or hits it at once, and a load that only touches the limit lets it rest", function()
    for _, method in ipairs(at_walls) do
        local function go(task, wanted, within) expect({ I = 1, k = 0, walls = { lower = -1, upper = 1, restitution = 0.5 } },
            merged({ theta0 = 1, t_end = 1, dt = 1, integrator = method[1] }, task), merged({ within = within or method[2] }, wanted)) end
        go({ M = 1, t_end = 5 }, { status = "rest", events = 0, theta = 1 })
        go({ M = -1 }, { events = 0, theta = 0.5 })
        go({ velocity0 = 1 }, { impact = { 0 }, events = 1, theta = 0.5, velocity = function(t) return t == 0 and -0.5 end })
        -- 1 + cos t comes down to 0 once in a turn, where it neither presses nor pulls.
        go({ M = excitation.harmonic { omega = 1, phase = math.pi / 2 } + 1, t_end = 20 }, { status = "rest", theta = 1 }, 1e-12)
    end
end)

test("an event that would be zero at a wall is not passed there, by any integrator", function()
    for _, method in ipairs { integrator.spectral {}, integrator.dopri5 { tolerance = 1e-10 }, integrator.rk4 { h = 1e-2 } } do
        for start = 0, 10 do -- at other times, other roundings of the impact
            local run = system { I = 1, k = 0.7, walls = { upper = 0.3, restitution = 0.8 } }:simulate { M = function(t) return 0.5 * math.sin(1.3 * t) end,
                theta0 = -0.1, t_start = start / 7, t_end = start / 7 + 12, events = { { when = function(_, theta) return theta - 0.3 end } }, integrator = method }
            equal(#run.events:filter(function(event) return event.kind == "user" end), 0)
            assert(#run.events > 1)
        end
    end
end)

finish()
