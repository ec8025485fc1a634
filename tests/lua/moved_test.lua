-- Bodies that are moved: their angle or velocity is given.
dofile "tests/lua/support.lua"

test("a moved end of a spring is a shaking support", function()
    local A, w = 0.2, 1.7
    local rig = system { bodies = { cam = { theta = function(t) return A * math.sin(w * t) end }, load = { I = 2, C = 0.1 } },
        links = { spring = { "load", "cam", k = 5, C = 0.3 } } }
    local task = { t_end = 20, velocity0 = { load = A * w } }
    local run = expect(rig, task, { ["cam.theta"] = function(t) return A * math.sin(w * t) end, ["cam.velocity"] = function(t) return A * w * math.cos(w * t) end, within = 1e-11 })
    near(rig.spring.omega0, math.sqrt(5 / 2), 1e-15)
    -- Relative to the end: x'' = -(k x + C x' + C0 (x' + v))/I + A w^2 sin.
    local relative = system { I = 2, k = 5, C = 0.4 }:simulate { t_end = 20, base = function(t) return -A * w ^ 2 * math.sin(w * t) end,
        M = function(t) return -0.1 * A * w * math.cos(w * t) end }
    near(run.load.theta - run.cam.theta, relative.theta, 1e-10)
    -- What moves it takes what the spring gives.
    near(run.cam.torque, -run.spring.torque * -1, 1e-10)
    local heavy = expect(rig:with { bodies = { cam = { I = 3 } } }, task, { ["load.theta"] = run.load.theta, within = 1e-11 })
    near(heavy.cam.torque, run.cam.torque - 3 * A * w ^ 2 * (w * run.t):sin(), 1e-9)
end)

test("a body moved at a given velocity is a belt, whatever rubs on it", function()
    local pads = {
        { Rd = 0.4, Re = 0.6 }, { Rd = 0.3, normal = function(t) return 1 + 0.5 * math.sin(0.7 * t) end },
        { friction = friction.stribeck { Rd = 0.3, Re = 0.6, speed = 0.3 } }, { friction = friction.jenkins { stiffness = 6, Rd = 0.4 } },
        { friction = friction.lugre { Rd = 0.3, Re = 0.4, speed = 0.2, stiffness = 20, damping = 1 } },
    }
    local e = excitation
    for _, velocity in ipairs { 0.3, e.step { amplitude = 0.7, at = 2 }, e.harmonic { amplitude = 0.6, omega = 1.1 }, e.square { amplitude = 0.5, period = 3 } } do
        for _, pad in ipairs(pads) do
            local rig = system { bodies = { disc = { velocity = velocity }, block = { I = 1, k = 2, C = 0.05 } }, links = { pad = merged({ "block", "disc" }, pad) } }
            local belt = system(merged({ I = 1, k = 2, C = 0.05 }, pad)):simulate { t_end = 30, belt = velocity }
            local run = expect(rig, { t_end = 30 }, { ["block.theta"] = belt.theta, within = 1e-11, closes = 1e-9 })
            equal(#of_kind(run, "stick") + #of_kind(run, "slip"), #of_kind(belt, "stick") + #of_kind(belt, "slip"))
            assert(velocity ~= 0.3 or math.abs(run.disc.theta[#run] - 9) < 1e-12)
        end
    end
end)

test("a jump of velocity is an impulse, and a moved body is infinitely heavy", function()
    local jump = { velocity = excitation.step { amplitude = 2, at = 1 } }
    for _, load in ipairs { "beam", "load" } do -- before and behind the crank in the order of the bodies
        local run = expect({ bodies = { crank = jump, [load] = { I = 3 } }, links = { gear = { "crank", load, ratio = 2, rigid = true } } }, { t_end = 2 }, { [load .. ".velocity"] = 1 })
        near(run:energy().total.input, 1.5, 1e-13)
        near(run:energy().crank.input, 1.5, 1e-13)
        equal(run.crank.events.kind[1], "impact")
    end
    -- Friction gives no impulse: the load slips until it is as fast.
    for _, crank in ipairs { jump, { theta = excitation.ramp { slope = 2, at = 1 } } } do
        local rig = { bodies = { crank = crank, load = { I = 1, Rd = 0.1 } }, links = { pad = { "crank", "load", Rd = 3 } } }
        local ends = 6 - 2 ^ 2 / (2 * 2.9)
        expect(rig, { t_end = 4 }, { ["crank.theta"] = 6, ["load.theta"] = ends })
        near(system(rig):simulate { t_end = 1 }:continue(4):at(4).load, ends, 1e-12)
    end
    expect({ bodies = { bat = { velocity = 1, I = 1 }, ball = { I = 1 } }, links = { gap = { "bat", "ball", walls = { upper = 0.5, restitution = 1 } } } }, { t_end = 1 },
        { ["ball.velocity"] = 2, ["bat.velocity"] = 1 })
end)

test("a moved body has a text, can be changed, and is refused where it is impossible", function()
    local rig = system { bodies = { cam = { theta = 0.5, I = 1 }, a = { I = 1 } }, links = { s = { "a", "cam", k = 1 } } }
    has(tostring(rig), "cam = { I = 1, theta = ")
    says(rig:simulate { t_end = 1 }, "cam is moved by its angle, which takes torques from")
    local slow = system { bodies = { cam = { theta = excitation.ramp {} }, a = { theta = 0 } }, links = { s = { "cam", "a", k = 3 } } }
    says(slow:simulate { t_end = 2 }, "which takes torques from 0 to 6 at the rows")
    refused {
        { "rig:simulate { t_end = 1, theta0 = { cam = 1 } }", "this body is moved by its theta" },
        { "rig:steady {}", "a body is moved" },
        { "system { bodies = { cam = { theta = 1, velocity = 1 } } }", "exclude each other" },
        { "system { bodies = { cam = { k = 1 } } }", "needs I" },
        { "system { bodies = { cam = { theta = function(t, theta) return theta end } } }", "function of t alone" },
    }
end)

test("a body moved by its angle moves as by the corresponding velocity, also for long and through a ratchet", function()
    local function ratchet(lever)
        return system { bodies = { lever = lever, wheel = { I = 2, C = 0.05, Rd = 0.3 } },
            links = { pawl = { "wheel", "lever", friction = friction.freewheel { Rd = 0.02 } } } }:simulate { t_end = 30 }
    end
    local by_angle = ratchet { theta = function(t) return 0.3 * math.sin(6 * t) end }
    equal(by_angle.outcome, "reached the end")
    alike(by_angle, ratchet { velocity = function(t) return 1.8 * math.cos(6 * t) end }, 1e-10)
end)

test("rigid walls of a moved body are refused: they could not stop it", function()
    local moved = { theta = math.sin, walls = { upper = 0.5 } }
    refused { { "system { bodies = { cam = moved, b = { I = 1 } } }", "bodies.cam: rigid walls cannot stop a body that is moved" } }
    moved.walls.stiffness = 100
    assert(system { bodies = { cam = moved, b = { I = 1 } } })
end)

test("a run ends where something stands in the way of a moved body, or of one that a rigid link ties to it", function()
    local cam, gear = { theta = function(t) return 0.5 * math.sin(t) end }, { "a", "b", ratio = 2, rigid = true }
    for _, case in ipairs {
        { { I = 2, walls = { lower = -1, upper = 0.5, restitution = 0.5 } }, { l = gear }, math.pi / 6 },
        { { I = 2, friction = friction.freewheel {} }, { l = gear }, math.pi / 2 },
        { { I = 2 }, { l = gear, k = { "a", "b", rigid = true } }, 0 },
    } do
        local own, links, ends = table.unpack(case)
        local run = system { bodies = { a = own, b = cam }, links = links }:simulate { t_end = 5 }
        has(run.outcome, "a wall, freewheel or rigid link stops a moved body")
        near(run.t_end, ends, 1e-9)
    end
    -- A freewheel cannot fall behind a moved body, nor behind a belt at a wall.
    local other = { velocity = function(t) return 0.5 + 0.5 * math.cos(t / 2) end }
    local both = system { bodies = { a = other, b = { velocity = function(t) return 0.3 * math.sin(t) end } },
        links = { l = { "a", "b", friction = friction.freewheel {} } } }:simulate { t_end = 8 }
    has(both.outcome, "stops a moved body or belt")
    near(both.t_end, 2 * math.pi, 1e-9)
    local carried = system { I = 1, k = 0, friction = friction.freewheel {}, walls = { upper = 1, restitution = 0.5 } }:simulate { belt = 0.5, t_end = 5 }
    has(carried.outcome, "stops a moved body or belt")
    near(carried.t_end, 2, 1e-9)
end)

test("an angle that is not read is sampled at most run.gap apart", function()
    local times = {}
    local angle = function(t) times[#times + 1] = t return 0.3 * math.sin(2 * t) end
    local rig = system { bodies = { cam = { theta = angle }, b = { I = 1, k = 1, Rd = 0.1 } }, links = { rod = { "b", "cam", k = 3 } } }
    local run = rig:simulate { t_end = 20, dt = 20 }
    table.sort(times)
    local apart = 0
    for i = 2, #times do apart = math.max(apart, times[i] - times[i - 1]) end
    near(apart, run.gap, 1e-12)
end)

test("a moved body is not a system by itself", function()
    local rig = system { bodies = { cam = { theta = 0.1, k = 3 }, b = { I = 1 } }, links = { rod = { "b", "cam", k = 3 } } }
    refused { { "rig.cam", "sys.cam: cam is moved, and so no system by itself" } }
    equal(rig.b.I, 1.0)
    equal(rig:with { bodies = { b = { I = 2 } } }.b.I, 2.0)
end)

test("the foot of a narrow peak of an angle, whose rounding is that of a great exponent, is followed", function()
    for _, w in ipairs { .1, .0392, 1e-2 } do
        local function angle(t) return .12 * math.exp(-((t - .94135) / w) ^ 2) end
        local rig = system { bodies = { m = { theta = angle }, b = { I = 1, C = .1 } }, links = { s = { "m", "b", k = 4 } } }
        local same = system { I = 1, k = 4, C = .1 }:simulate { M = function(t) return 4 * angle(t) end, t_end = 3, dt = 1 }
        expect(rig, { t_end = 3, dt = 1 }, { ["b.theta"] = same.theta, ["b.velocity"] = same.velocity, within = 1e-10, closes = false, parts = false })
    end
end)

test("the impulse of a moved body at a stop is work of that body", function()
    -- A mass flies at 1 towards an anvil that comes at 0.5: at restitution e it leaves with 0.5 + 1.5 e.
    for _, e in ipairs { 0, .5, 1 } do
        local rig = system { bodies = { a = { I = 2 }, anvil = { velocity = .5 } },
            links = { gap = { "a", "anvil", walls = { lower = 0, restitution = e } } } }
        local run = rig:simulate { theta0 = { a = 1 }, velocity0 = { a = -1 }, t_end = 1 }
        local after = .5 + 1.5 * e
        near(select(2, run:at(1)).a, after, 1e-12)
        local energy = run:energy()
        near(energy.total.input, 2 * (after + 1) * .5, 1e-12)  -- the impulse times the velocity of the anvil
        near(energy.total.impacts, (1 - e ^ 2) * 1.5 ^ 2, 1e-12)
        near(energy.total.error, 0, 1e-12)
    end
    local shaken = system { bodies = { a = { I = .5, k = 1 }, b = { velocity = function(t) return .2 * math.cos(t) end } },
        links = { l = { "a", "b", ratio = -1, walls = { lower = -.2, upper = .1, restitution = .5 } } } }
    near(shaken:simulate { velocity0 = { a = 1 }, t_end = 13 }:energy().total.error, 0, 1e-9)
end)

test("a body that rubs on the ground is taken along by a rigid link from the start, and so is a slider", function()
    local cam = { theta = function(t) return 0.5 * math.sin(t) end }
    for _, law in ipairs { friction.coulomb { Rd = 0.9 }, friction.jenkins { stiffness = 4, Rd = 0.5 } } do
        for _, link in ipairs { { "cam", "a", rigid = true }, { "cam", "a", Rd = 100 } } do
            local rig = system { bodies = { cam = cam, a = { I = 3, k = 4, C = 0.4, friction = law } }, links = { l = link } }
            local run = rig:simulate { t_end = 2 * math.pi, velocity0 = link.rigid and {} or { a = 0.5 } }
            near(run.a.theta, 0.5 * vector(run.t):sin(), 1e-12)
            local energy, Rd = run:energy(), law.Re
            near(energy.total.error, 0, 1e-12)
            -- 4 Rd X a period; a slider, relaxed at the start, slips 3/8 and then 3/4 in one more half of it.
            near(energy.a.dry, Rd == 0.9 and 4 * 0.9 * 0.5 or 0.5 * (0.375 + 0.75 + 0.25), 1e-12)
        end
    end
    says(system { bodies = { cam = cam, a = { I = 3, Rd = 0.9 } }, links = { l = { "cam", "a", rigid = true } } }:simulate { t_end = 1 },
        "the prescribed motion of cam 0.11313")
end)

finish()
