-- Laws with a direction or a memory: freewheels, Jenkins elements, and laws side by side.
dofile "tests/lua/support.lua"

local function wheel(Rd) return friction.freewheel { Rd = Rd } end

test("a freewheel lets its load overrun, and drives it", function()
    -- The load is driven by the motor and overruns it when the motor brakes.
    local rig = { bodies = { motor = { I = 1 }, load = { I = 3 } }, links = { clutch = { "load", "motor", friction = wheel(0.3) } } }
    local M = excitation.constant(2) + excitation.step { amplitude = -3, at = 1 }
    expect(rig, { M = { motor = M }, t_end = 2 }, { events = 1, slip = { 1 }, ["load.velocity"] = 0.5 - 0.3 / 3, ["motor.velocity"] = 0.5 - 1 + 0.3 })
    -- And it meets the motor again.
    local back = expect(rig, { M = { motor = M + excitation.step { amplitude = 4, at = 2 } }, t_end = 6 })
    assert(of_kind(back, "stick")[1].t > 2)
    near(back.load.velocity[#back], back.motor.velocity[#back], 1e-13)
end)

test("a freewheel is a contact with a huge friction backward", function()
    local M = { a = excitation.harmonic { amplitude = 3, omega = 1.2 } }
    local function run(law) return expect({ bodies = { a = { I = 1, k = 1 }, b = { I = 2, C = 0.4 } }, links = { clutch = { "a", "b", friction = law } } }, { M = M, t_end = 30 }) end
    local one = run(wheel(0.2))
    alike(one, run(friction.asymmetric { forward = { Rd = 0.2 }, backward = { Rd = 1e9 } }), 1e-9)
    assert(#one.clutch.events > 4)
    -- Against the ground it is a ratchet.
    local block = expect({ I = 1, k = 0, friction = wheel(0.2) }, { M = M.a, t_end = 10 })
    assert(block.velocity:min() >= 0)
    equal(block.theta:max(), block.theta[#block])
end)

test("a freewheel behind a body that stops dead at a wall holds the whole train, at once", function()
    -- b1 would run on backward. Pressed by its load it stays where it was stopped, at -1.3 of the angle of b2.
    for _, inertia in ipairs { 1, 0.4, 2 } do
        expect({ bodies = { b1 = { I = inertia, k = 1 }, b2 = { I = 2, walls = { lower = -1, restitution = 0 } } }, links = { l = { "b1", "b2", ratio = 1.3, friction = wheel(0.1) } } },
            { M = { b1 = -2, b2 = 0.65 }, velocity0 = { b1 = -1.3, b2 = -1 }, t_end = 3, dt = 0.5 }, { status = "rest", ["b1.theta"] = -1.3, ["b2.theta"] = -1 }, inertia)
    end
    -- Here it would be stopped by ever smaller impacts.
    local run = expect({ bodies = { b1 = { I = 0.4, walls = { upper = 0.3, restitution = 0 } }, b2 = { I = 1.6 } }, links = { l = { "b1", "b2", ratio = 0.33, friction = wheel(0) } } },
        { velocity0 = { b1 = 0.66, b2 = 2 }, t_end = 1, dt = 0.1 }, { ["b2.theta"] = 2 * 0.3 / 0.66 })
    near(run:energy().total.impacts, 0.2 * 0.66 ^ 2 + 0.8 * 4, 1e-13)
end)

test("from the start a belt or a moved body carries bodies along that a freewheel keeps from falling behind", function()
    local block = system { I = 1, k = 0, friction = wheel(0.2) }
    local function ends_at(theta, velocity, options)
        expect(block, merged({ t_start = 2, t_end = 3, dt = 1 }, options), { theta = theta, velocity = velocity })
    end
    local ramp = excitation.ramp { slope = 1 }
    for _, belt in ipairs { ramp, function(t) return t end } do
        for _, v in ipairs { 2, 1, 0, -1 } do ends_at(2.5, 3, { belt = belt, velocity0 = v }) end
    end
    for _, belt in ipairs { 3, excitation.constant(3), function() return 3 end } do ends_at(3, 3, { belt = belt }) end
    ends_at(-0.6, -0.7, { belt = -1, velocity0 = -0.5 })
    ends_at(-1, -1, { belt = -1, velocity0 = -1.5 })
    refused { { "block:simulate { velocity0 = -0.5, t_end = 1 }", "the freewheel turns forward only, but begins with -0.5" } }
    for _, v in ipairs { 2, -2 } do
        local rig = system { bodies = { motor = { velocity = function() return v end }, load = { I = 1 } },
            links = { clutch = { "load", "motor", friction = friction.freewheel { Rd = 0.3 } } } }
        local run = rig:simulate { t_end = 1, dt = 1 }
        near(run.load.velocity[2], v > 0 and 2 or -0.3, 1e-12)
        equal(closes(run).total.impacts, 0.0)
    end
end)

test("an impact that would turn a freewheel backward stops it", function()
    -- c strikes b, which may not fall behind a: all three go on as one mass would.
    local rig = system { bodies = { a = { I = 2 }, b = { I = 1 }, c = { I = 1 } },
        links = { one_way = { "a", "b", friction = wheel(0) }, play = { "c", "b", walls = { upper = 0.1, restitution = 0 } } } }
    expect(rig, { velocity0 = { c = 1 }, t_end = 1 }, { ["a.velocity"] = 0.25, ["b.velocity"] = 0.25, ["c.velocity"] = 0.25 })
    refused { { "rig:simulate { velocity0 = { b = 1 }, t_end = 1 }", "the freewheel one_way turns forward only, but begins with -1" } }
end)

-- A Jenkins element by hand: a state that clips at q.
local function clipped(q)
    return { z = { rate = function(t, theta, v, z) return (z.z >= q and v > 0 or z.z <= -q and v < 0) and 0 or v end } }
end

test("a jenkins element is a spring in series with a slider", function()
    local M = excitation.harmonic { amplitude = 3, omega = 1.1 }
    local fine = system { I = 1, k = 1 }:simulate { M = function(t, theta, velocity, z) return M(t) - 20 * z.z end, t_end = 20, states = clipped(1 / 20) }
    local run = expect({ I = 1, k = 1, friction = friction.jenkins { stiffness = 20, Rd = 1 } }, { M = M, t_end = 20 }, { theta = fine.theta, within = 1e-6 })
    local slips, sticks = #of_kind(run, "slip"), #of_kind(run, "stick")
    assert(slips > 5 and math.abs(slips - sticks) <= 1)
    near(run.friction:abs():max(), 1, 1e-12)
    -- It is relaxed at the start, wherever that is.
    expect({ I = 1, k = 0, friction = friction.jenkins { stiffness = 20, Rd = 1 } }, { theta0 = 3, t_end = 5 }, { theta = function() return 3 end })
    expect({ I = 1, k = 1, friction = friction.jenkins { stiffness = 3, Rd = 0.5 } }, { theta0 = 1, belt = function(t) return 0.4 * math.sin(t) end, t_end = 9 })
end)

test("a list of jenkins elements obeys Masing's rule", function()
    -- A very stiff spring moves the block along 0.8 sin(t), whatever its friction is.
    local elements, list = {}, {}
    for i = 1, 5 do
        elements[i] = { stiffness = 2 * i, Rd = 0.3 * i ^ 2 }
        list[i] = friction.jenkins(elements[i])
    end
    local function backbone(x)
        local sum = 0
        for _, e in ipairs(elements) do sum = sum + math.min(e.stiffness * x, e.Rd) end
        return sum
    end
    local grounded = system { I = 1, k = 1e8, C = 2e4, friction = list }:simulate { M = function(t) return 1e8 * 0.8 * math.sin(t) + 2e4 * 0.8 * math.cos(t) - 0.8 * math.sin(t) end, velocity0 = 0.8, t_end = 3 * math.pi, dt = math.pi / 100 }
    -- The branches are twice the backbone from the point of return, scaled by two.
    for i = 1, #grounded do
        local t, x, f = grounded.t[i], grounded.theta[i], -grounded.friction[i]
        if t < math.pi / 2 - 0.01 then
            near(f, backbone(x), 1e-4)
        elseif t > math.pi / 2 + 0.01 and t < 3 * math.pi / 2 - 0.01 then
            near(f, backbone(0.8) - 2 * backbone((0.8 - x) / 2), 1e-4)
        end
    end
    closes(grounded)
end)

test("parallel laws add their torques", function()
    local M = excitation.harmonic { amplitude = 3, omega = 1.1 }
    local function run(laws) return expect({ I = 1, k = 1, friction = laws }, { M = M, t_end = 20 }) end
    alike(run { friction.coulomb { Rd = 0.2, Re = 0.3 }, friction.coulomb { Rd = 0.1 } }, run(friction.coulomb { Rd = 0.3, Re = 0.4 }), 1e-12)
    alike(run { friction.stribeck { Rd = 0.2, Re = 0.3, speed = 0.1 }, friction.coulomb { Rd = 0.1 } }, run(friction.stribeck { Rd = 0.3, Re = 0.4, speed = 0.1 }), 1e-11)
    local by_hand = system { I = 1, k = 1, Rd = 0.2 }:simulate { M = function(t, _, _, z) return M(t) - 10 * z.z end, t_end = 20, states = clipped(0.05) }
    near(run { friction.coulomb { Rd = 0.2 }, friction.jenkins { stiffness = 10, Rd = 0.5 } }.theta, by_hand.theta, 1e-6)
    local text = tostring(system { I = 1, k = 1, friction = { friction.jenkins { stiffness = 9, Rd = 1 }, friction.coulomb { Rd = 0.1 } } })
    has(text, "friction = { friction.jenkins{ stiffness = 9, Rd = 1 }, friction.coulomb{ Rd = 0.1, Re = 0.1 } }")
    equal(tostring(load("return " .. text)()), text)
    raises(function() run { 1 } end, "friction[1] must be a law")
    raises(function() run { friction.stribeck { Rd = 1, Re = 2, speed = 1 }, friction.stribeck { Rd = 1, Re = 2, speed = 1 } } end, "one law that depends on the speed")
    refused { { "system { I = 1, k = 1, friction = friction.jenkins { stiffness = 9, Rd = 1 }, normal = math.sin }", "must be a number" } }
end)

test("sliders on a geared link stay at rest while another law holds it", function()
    local rig = { bodies = { a = { I = 0.55, k = 3.4, C = 0.05, Rd = 0.4 }, b = { I = 1.3, C = 0.1 } },
        links = { l = { "a", "b", ratio = -1.285391943567641, friction = { friction.jenkins { stiffness = 13, Rd = 0.36 }, friction.coulomb { Rd = 0.1 } } } } }
    local task = { M = { a = excitation.harmonic { amplitude = 4, omega = 1.7 } }, t_end = 15 }
    local fine = expect(rig, merged(task, { integrator = integrator.spectral { max_panel = 0.05 } }), { parts = false })
    expect(rig, task, { status = "end", ["a.theta"] = fine.a.theta, within = 1e-11 })
end)

test("a law without an Rd lacks this field, and elastic stops are the walls", function()
    local held = system { I = 1, k = 1, friction = friction.freewheel { Rd = 0.1 } }
    refused {
        { "held.Rd", "this system has no constant Rd: its friction is friction.freewheel{ Rd = 0.1 }" },
        { "held.dead_zone", "no constant dead_zone: its friction is friction.freewheel" },
    }
    local joint = system { I = 1, k = 1, friction = { friction.jenkins { stiffness = 2, Rd = 1 }, friction.coulomb { Rd = 1 } } }
    refused { { "joint.Re", "this system has no constant Re: its friction is a list of laws" } }
    equal(joint.omega0, 1.0)
    equal(joint.walls, nil)
    local stopped = system { I = 1, k = 1, Rd = 0.1, walls = { upper = 0.5, stiffness = 100 } }
    equal(stopped.walls.stiffness, 100.0)
    equal(stopped.Rd, 0.1)
    refused { { "stopped.dead_zone", "with elastic walls a mass has no dead zone" } }
end)

test("an impact reverses a slider", function()
    local walls = { lower = -0.5, upper = 0.5, restitution = 0.9 }
    local M = excitation.harmonic { amplitude = 4, omega = 1.3 }
    local by_hand = system { I = 1, k = 1, walls = walls }:simulate { M = M + excitation.scripted(function(_, _, _, z) return -5 * z.z end),
        t_end = 10, dt = 0.1, states = clipped(0.12), integrator = integrator.rk4 { h = 1e-3 } }
    local run = expect({ I = 1, k = 1, walls = walls, friction = friction.jenkins { stiffness = 5, Rd = 0.6 } }, { M = M, t_end = 10, dt = 0.1 },
        { theta = by_hand.theta, within = 1e-3 })
    assert(#of_kind(run, "impact") > 2)
end)

finish()
