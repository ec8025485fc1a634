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
        local run = system { I = 1, k = 0, walls = walls }:simulate { velocity0 = 2, t_end = 3.5, dt = 0.1, integrator = method }
        equal(#run.events, 3)
        for i, t in ipairs { 0.4, 0.4 + 1.6 / 1.4, 0.4 + 1.6 / 1.4 + 1.6 / 0.98 } do
            equal(run.events[i].kind, "impact")
            near(run.events[i].t, t, 1e-12)
            equal(run.events[i].theta, i % 2 == 1 and 0.8 or -0.8)
        end
        near(run.events[2].velocity, -1.4, 1e-13)
        near(run:at(0.4), 0.8, 1e-12)
        has(run, "3 events (3 impacts)")
        assert(run.theta:max() <= 0.8)
    end
end)

test("a bouncing ball comes to rest in finite time; its energy adds up; the file repeats it", function()
    local ball = system { I = 1, k = 0, walls = { lower = 0, restitution = 0.7 } }
    local run = ball:simulate { M = -2, theta0 = 1, t_end = 10, dt = 0.5 }
    equal(run.outcome, "at rest")
    near(run.events[#run.events].t, 1.7 / 0.3, 1e-11)
    equal(run.events[#run.events].kind, "rest")
    local energy = run:energy()
    near(energy.total.impacts, 2, 1e-11)
    near(energy.impacts[#run], 2, 1e-11)
    assert(energy.total.closure < 1e-12)
    has(energy, "lost at the walls")
    says(run, "It came to rest at the wall, theta = 0")
    local again = repeated(run)
    equal(#again.events, #run.events)
    equal(again.theta[5], run.theta[5])
    local on = ball:simulate { M = -2, theta0 = 1, t_end = 3, dt = 0.5 }:continue { t_end = 10 }
    near(on.events[#on.events].t, 1.7 / 0.3, 1e-11)
    local picture = run:plot { width = 60, height = 12, show = false }
    has(picture, "impact")
end)

test("bounces are reported until the remaining ones last 1e-7 of the motion so far", function()
    local run = system { I = 1, k = 0, walls = { lower = 0, restitution = 0.9 } }:simulate { M = -2, theta0 = 1, t_end = 60, dt = 60 }
    -- It falls for 1; the n-th bounce takes 2*0.9^n, what is left with it 20*0.9^n, all of it 1 + 18.
    equal(#of_kind(run, "impact"), math.ceil(math.log(19e-7 / 20, 0.9)))
    near(run.events[#run.events].t, 19, 1e-10)
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
    assert(at_wall > 0 or lots(15) < 15)
    raises_here(function() system { I = 1, k = 1, walls = { upper = 1 } }:steady { theta0 = 2 } end, "theta0 = 2 is beyond the wall at upper = 1")
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
    raises_here(function() sys:simulate { theta0 = 1, t_end = 1, dt = 1 } end, "sys:simulate: theta0 = 1 is beyond the wall at upper = 0.8")
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

test("a body that leaned on another goes on when that one stops dead at a wall", function()
    -- The loads press b2 against b1 and leave both their common velocity -1. b1 stops at t = 1, and b2 goes on under its
    -- own load, from -0.7.
    local pair = system {
        bodies = { b1 = { I = 1, walls = { lower = -1, restitution = 0 } }, b2 = { I = 1 } },
        links = { l = { "b1", "b2", walls = { lower = -0.3, restitution = 0 } } },
    }
    for _, method in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.01 } } do
        local run = pair:simulate {
            M = { b1 = -0.5, b2 = 0.5 }, theta0 = { b1 = 0, b2 = 0.3 }, velocity0 = { b1 = -1, b2 = -1 },
            t_end = 2, dt = 0.5, integrator = method,
        }
        near(run.b1.theta[#run], -1, 1e-14)
        near(run.b2.theta[#run], -0.7 - 1 + 0.5 * 0.5, 1e-12)
        equal(run.outcome, "reached the end")
    end
end)

test("a body that comes to rest at a wall does not stop the others meanwhile", function()
    local bodies = { a = { I = 1, walls = { lower = 0, restitution = 0.5 } }, b = { I = 1, k = 4 } }
    local run = system { bodies = bodies }:simulate { M = { a = -1 }, theta0 = { a = 1, b = 1 }, t_end = 20 }
    equal(run.a.theta[#run], 0)
    near(run.b.theta[#run], math.cos(2 * 20), 1e-11)
end)

test("masses in a row that strike each other without rebound, or a wall, go on together or stand", function()
    local function play() return { lower = -0.1, upper = 0.5, restitution = 0 } end
    -- A train that is pushed: it moves as one mass once all play is used up.
    local wagons = { a = { I = 0.3 }, b = { I = 0.7 }, c = { I = 1.1 } }
    local train = system { bodies = wagons, links = { l = { "a", "b", walls = play() }, m = { "b", "c", walls = play() } } }
    for i, M in ipairs { excitation.constant(1), excitation.harmonic { omega = 1 } } do
        local run = train:simulate { M = { a = M }, t_end = 3, dt = 0.01 }
        equal(run.status, "end")
        assert(#run.events < 20)
        near(run.l.theta[#run], 0.5, 1e-12)
        near(run.m.theta[#run], 0.5, 1e-12)
        near(2.1 * run.c.velocity[#run], i == 1 and 3 or 1 - math.cos(3), 1e-12)
        closes(run)
    end
    -- Pressed against a wall at 0.5.
    local pressed = system { bodies = { a = { I = 0.1 }, b = { I = 0.1, walls = { upper = 0.5, restitution = 0 } } },
        links = { l = { "a", "b", walls = play() } } }
    local run = pressed:simulate { M = { a = 1 }, t_end = 3 }
    equal(run.outcome, "at rest")
    near(run.a.theta[#run], 1, 1e-12)
    near(run.b.theta[#run], 0.5, 1e-15)
    assert(#run.events < 20)
    closes(run)
    -- Five balls that touch share the velocity of the first; two with a little rebound end against the wall as well.
    local balls, contacts, fast = {}, {}, { b1 = 1 }
    for i = 1, 5 do balls["b" .. i] = { I = 1 } end
    for i = 1, 4 do contacts["l" .. i] = { "b" .. i, "b" .. i + 1, walls = { upper = 0, restitution = 0 } } end
    run = system { bodies = balls, links = contacts }:simulate { velocity0 = fast, t_end = 2 }
    for i = 1, 5 do near(run["b" .. i].theta[#run], 0.4, 1e-12) end
    closes(run)
    for _, e in ipairs { { 0, 0.5 }, { 0.5, 0 }, { 0.5, 0.5 } } do
        local b = { I = 0.1, walls = { upper = 0.5, restitution = e[1] } }
        run = system { bodies = { a = { I = 0.1 }, b = b }, links = { l = { "a", "b", walls = { upper = 0.5, restitution = e[2] } } } }
            :simulate { M = { a = 1 }, t_end = 3 }
        equal(run.outcome, "at rest")
        closes(run)
    end
end)

test("bodies in a row that nothing but their walls pushes go on together under any M", function()
    local wagons = { a = { I = 0.3 }, b = { I = 0.7 }, c = { I = 1.1 } }
    local row = system { bodies = wagons, links = { l = { "a", "b", walls = { upper = 0.5 } }, m = { "b", "c", walls = { upper = 0.5 } } } }
    local run = row:simulate { M = { a = function(t) return 1 + 0.2 * t end }, theta0 = { a = 1, b = 0.5 }, t_end = 3 }
    near(run.c.theta[#run], (4.5 + 0.9) / 2.1, 1e-12)
    near(run.m.torque[#run], -1.6 * 1.1 / 2.1, 1e-12)
    equal(#run.events, 0)
end)

test("impacts in a row that bounce end, also where only rounding is left of them", function()
    for _, e in ipairs { 0.3, 0.5, 0.7 } do
        local function link(first, second) return { first, second, walls = { upper = 0, restitution = e } } end
        local rig = system {
            bodies = { a = { I = 1, C = 0.1 }, b = { I = 2, k = 1 }, c = { I = 0.7, C = 0.2 }, d = { I = 1.5, C = 0.1, k = 2 } },
            links = { ab = link("a", "b"), bc = link("b", "c"), cd = link("c", "d") },
        }
        for _, A in ipairs { 0.5, 1, 2 } do
            local run = rig:simulate {
                M = { a = function(t) return A * math.sin(1.3 * t) + 0.3 end, d = function(t) return -0.5 * math.sin(t) end },
                theta0 = { a = -0.2, b = -0.1, c = 0.1, d = 0.15 }, velocity0 = { a = 0.7, d = -0.5 }, t_end = 12,
            }
            equal(run.status, "end")
            closes(run)
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

test("bounces that keep their speed end where they are lower than the rounding of the angles", function()
    -- The freewheel takes b along with a: what is left of its bounces in c would take 1e8 impacts in a time unit.
    local rig = system {
        bodies = { a = { I = 2, k = 10, Rd = 0.1, walls = { lower = -0.2, upper = 0.2, restitution = 1 } }, b = { I = 0.1 }, c = { I = 0.5 } },
        links = { pawl = { "a", "b", friction = friction.freewheel { Rd = 0.1 } }, stop = { "b", "c", walls = { lower = -0.1, upper = 0, restitution = 1 } } },
    }
    local run = rig:simulate { M = { c = excitation.harmonic { omega = 1 } }, t_end = 20, dt = 0.1 }
    equal(run.status, "end")
    assert(#run.events < 1000, #run.events)
    closes(run)
end)

test("a mass that an impact at the start sets in motion slips then", function()
    local bodies = { a = { I = 1, k = 1, C = 0.1 }, b = { I = 2, Rd = 0.3 } }
    local rig = system { bodies = bodies, links = { stop = { "a", "b", walls = { lower = -0.5, upper = 1, restitution = 0.5 } } } }
    local run = rig:simulate { theta0 = { a = -0.5 }, velocity0 = { a = -1 }, t_end = 8 }
    local slips = of_kind(run.b, "slip").t
    equal(#slips, 1)
    equal(slips[1], 0.0)
    says(run.b, "with velocity 0; it slipped at once.")
    says(run.b, "stuck for 5.1364 of 8 time units") -- from its only stop, at 2.8636
end)

test("a body that another presses against a wall comes to rest, though the stop between them keeps its speed", function()
    local bodies = { b = { I = 0.5, k = 0.5, C = 0.1 }, c = { I = 0.2, C = 0.5, walls = { lower = -0.5, upper = 0.5, restitution = 0.8 } } }
    local stop = { "b", "c", walls = { lower = -0.2, upper = 1, restitution = 1 } }
    local start = { theta0 = { b = 0.1, c = -0.1 }, velocity0 = { b = -1, c = -1 } }
    local task = { M = { b = function(t) return 0.3 * math.floor(t) end }, t_end = 20 }
    local run = system { bodies = bodies, links = { stop = stop } }:simulate(merged(start, task))
    assert(#run.events < 3000)
    near(run.b.theta[#run], 1.5, 1e-15)
    near(run.c.theta[#run], 0.5, 1e-15)
    closes(run)
end)

test("bounces end where a load jumps at the wall itself", function()
    local sys = system { I = 0.1, k = 0, C = 0.5, Rd = 0.1, walls = { lower = -1, upper = 2, restitution = 1 } }
    local run = sys:simulate { M = function(_, theta) return math.abs(theta) < 2 and 2 or 0 end, theta0 = 0.1, t_end = 5 }
    assert(#run.events < 2000)
    near(run.theta[#run], 2, 1e-12)
    near(run.velocity[#run], 0, 1e-6)
end)

test("a wall without a load keeps a body that friction and another wall hold, too", function()
    local a, b = { I = 1, walls = { lower = 0, upper = 0.5, restitution = 0 } }, { I = 1, k = 0.5, Rd = 1 }
    local rig = system { bodies = { a = a, b = b }, links = { l = { "a", "b", walls = { lower = -0.1, upper = 2, restitution = 0.5 }, Rd = 0.5, Re = 2 } } }
    local M = { a = function(t) return t < 1 and 2 or 0 end, b = function(t) return math.cos(2 * t) end }
    local run = rig:simulate { M = M, theta0 = { a = 0.3, b = 0.4 }, velocity0 = { a = 0.5, b = 0.5 }, t_end = 1.5 }
    equal(run.t[#run], 1.5)
    near(run.a.theta[#run], 0.5, 1e-15)
    near(run.b.theta[#run], 0.6, 1e-14)
    closes(run)
end)

test("a body without a load stays at its wall while rounding lets an elastic stop begin to pull", function()
    local b = { I = 0.2, walls = { lower = -0.1, upper = 0.5, restitution = 0 } }
    local stop = { "a", "b", walls = { lower = -0.2, upper = 1, stiffness = 10, damping = 0 } }
    local rig = system { bodies = { a = { I = 1 }, b = b }, links = { stop = stop } }
    local run = rig:simulate { theta0 = { b = -0.1 }, velocity0 = { a = 2, b = 0.5 }, t_end = 20 }
    equal(run.t[#run], 20)
    closes(run)
end)

-- With what each is right to: times and velocities of impacts.
local at_walls = { { integrator.spectral {}, 1e-11 }, { integrator.rk4 { h = 0.002 }, 1e-7 } }

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

test("states are integrated while the mass leans, user events see impacts, and M of a state takes the mass off", function()
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

finish()
