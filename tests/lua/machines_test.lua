-- Machines: gears, planetary sets and couplings, torques on links.
dofile "tests/lua/support.lua"

local M = excitation.harmonic { amplitude = 3, omega = 1.3 }

--- The rig moves as the wanted one does: columns of it, by those of the other and a factor.
local function moves_as(rig, task, other, its_task, columns, within)
    local truth = system(other):simulate(its_task)
    local wanted = { within = within or 1e-11 }
    for name, by in pairs(columns) do wanted[name] = by[2] * truth:column(by[1]) end
    return expect(rig, task, wanted), truth
end

test("an elastic gear acts like a shaft of the reflected load", function()
    local n, motor, link = 4, { I = 2, C = 0.1 }, { "motor", "load", k = 30, C = 0.2 }
    local geared = system { bodies = { motor = motor, load = { I = 5, k = 2, Rd = 0.8 } }, links = { gear = merged(link, { ratio = n }) } }
    -- The load turns n times as far on the side of the motor.
    local a, b = moves_as(geared, { M = { motor = M }, t_end = 20 },
        { bodies = { motor = motor, load = { I = 5 / n ^ 2, k = 2 / n ^ 2, Rd = 0.8 / n } }, links = { gear = link } }, { M = { motor = M }, t_end = 20 },
        { ["motor.theta"] = { "motor.theta", 1 }, ["load.theta"] = { "load.theta", 1 / n }, ["gear.torque"] = { "gear.torque", 1 } })
    same_events(a, b, 1e-10)
    equal(geared.gear.k, 30)
end)

test("a rigid gear is one body of the reflected inertia", function()
    local n, load = 3, { I = 5, k = 3, Rd = 0.7, walls = { lower = -0.3, upper = 0.4, restitution = 0.5 } }
    local run, reflected = moves_as({ bodies = { motor = { I = 2, C = 0.1 }, load = load }, links = { gear = { "motor", "load", ratio = n, rigid = true } } },
        { M = { motor = M }, t_end = 40, theta0 = { motor = 0.1 }, velocity0 = { motor = n, load = 1 } },
        merged(load, { I = 5 + 2 * n ^ 2, C = 0.1 * n ^ 2 }), { M = n * M, t_end = 40, velocity0 = 1, integrator = integrator.spectral {} },
        { ["load.theta"] = { "theta", 1 } })
    near(run.motor.theta - 0.1, n * reflected.theta, 3e-11)
    equal(run.gear.theta:max(), 0.1)
    equal(run.gear.theta:min(), 0.1)
    equal(run.gear.velocity:max(), 0)
    -- It carries what the motor is short of: I a = M - C v + torque.
    near(run.gear.torque, run.motor.acceleration * 2 - run.motor.M + 0.1 * run.motor.velocity, 1e-11)
    same_events(run.load, reflected, 1e-10)
    assert(#reflected.events > 10)
    -- Friction on both sides adds up.
    n = 2
    run, reflected = moves_as({ bodies = { motor = { I = 1, Rd = 0.2 }, load = { I = 4, k = 6, Rd = 0.5 } }, links = { gear = { "motor", "load", ratio = n, rigid = true } } },
        { M = { load = M }, t_end = 30 }, { I = 4 + n ^ 2, k = 6, Rd = 0.5 + 0.2 * n }, { M = M, t_end = 30 }, { ["load.theta"] = { "theta", 1 } })
    same_events(run.load, reflected, 1e-10)
end)

test("a planetary gear shares torques according to its formula", function()
    local weights, I, torques = { carrier = 2.5, sun = -1, ring = -1.5 }, { carrier = 3, sun = 0.5, ring = 1.2 }, { carrier = -0.7, sun = 2, ring = 0.3 }
    local above, below, bodies = 0, 0, {}
    for name, by in pairs(weights) do
        bodies[name] = { I = I[name] }
        above, below = above + by * torques[name] / I[name], below + by ^ 2 / I[name]
    end
    local wanted = { ["planet.torque"] = function() return -above / below end }
    for name, by in pairs(weights) do
        local a = (torques[name] - by * above / below) / I[name]
        wanted[name .. ".velocity"], wanted[name .. ".theta"] = function(t) return a * t end, function(t) return a * t ^ 2 / 2 end
    end
    expect({ bodies = bodies, links = { planet = merged(weights, { rigid = true }) } }, { M = torques, t_end = 2 }, wanted)
end)

test("a brake on the ring turns a planetary gear into a simple gear, and releases it", function()
    local bodies = { carrier = { I = 3, C = 0.3 }, sun = { I = 0.5 }, ring = { I = 1.2, Rd = 5 } }
    local rig, n = { bodies = bodies, links = { planet = { carrier = 2.5, sun = -1, ring = -1.5, rigid = true } } }, 2.5
    local run = moves_as(rig, { M = { sun = M }, t_end = 10 }, { I = 3 + 0.5 * n ^ 2, k = 0, C = 0.3 }, { M = n * M, t_end = 10 }, { ["carrier.theta"] = { "theta", 1 } }, 1e-12)
    equal(run.ring.velocity:max(), 0)
    equal(#run.ring.events, 0)
    -- Under the carrier's C and a strong sun the ring slips; its friction then acts by its weight.
    bodies.ring = { I = 1.2, Rd = 1 }
    local slips = expect(rig, { M = { sun = 2 * M }, t_end = 20 })
    assert(#slips.ring.events > 3)
    near(2.5 * slips.carrier.velocity, slips.sun.velocity + 1.5 * slips.ring.velocity, 1e-12)
end)

test("a chain of rigid gears is one body, and consistent loops change nothing", function()
    local bodies, links, I, ratio = {}, {}, 0, 1
    for i = 1, 12 do
        bodies["b" .. i] = { I = 1 + i / 10 }
        I = I + (1 + i / 10) * ratio ^ 2
        if i < 12 then
            local n = i % 2 == 0 and 0.5 or 1.5
            links["g" .. i] = { "b" .. i, "b" .. i + 1, ratio = n, rigid = true }
            ratio = ratio / n
        end
    end
    bodies.b1.k, bodies.b1.Rd = 20, 0.4
    local function like_one()
        return (moves_as({ bodies = bodies, links = links }, { M = { b12 = M }, t_end = 10 }, { I = I, k = 20, Rd = 0.4 }, { M = ratio * M, t_end = 10 }, { ["b1.theta"] = { "theta", 1 } }))
    end
    like_one()
    links.back = { "b1", "b12", ratio = 1 / ratio, rigid = true }
    says(like_one(), "It closes a loop of rigid links")
end)

test("inconsistent loops of rigid links lock", function()
    local function still() return 0 end
    local run = expect({ bodies = { a = { I = 1 }, b = { I = 2 }, c = { I = 1 } },
        links = { ab = { "a", "b", ratio = 2, rigid = true }, bc = { "b", "c", rigid = true }, ac = { "a", "c", ratio = 3, rigid = true } } },
        { M = { a = M, c = 1 }, t_end = 5 }, { ["a.theta"] = still, ["b.theta"] = still, ["c.theta"] = still, ["a.velocity"] = still, within = 0 })
    -- a: M + ab + ac = 0, b: -2 ab + bc = 0, c: 1 - bc - 3 ac = 0
    near(run.ab.torque + run.ac.torque, -run.a.M, 1e-12)
    near(2 * run.ab.torque, run.bc.torque, 1e-12)
    near(run.bc.torque + 3 * run.ac.torque, run.c.M, 1e-12)
end)

test("an impact passes through rigid gears and conserves weighted momentum", function()
    -- c and b are geared; a strikes b by a link with walls.
    local n, e = 2, 0.6
    local reflected = 1 + 3 / n ^ 2
    local together, sum = 1.5 / (1.5 + reflected), 1.5 + reflected
    expect({ bodies = { a = { I = 1.5 }, b = { I = 1 }, c = { I = 3 } },
        links = { play = { "a", "b", walls = { lower = -0.1, upper = 0.1, restitution = e } }, gear = { "b", "c", ratio = n, rigid = true } } },
        { velocity0 = { a = 1 }, t_end = 0.4 }, { impact = 1, ["a.velocity"] = together - e * reflected / sum,
            ["b.velocity"] = together + e * 1.5 / sum, ["c.velocity"] = (together + e * 1.5 / sum) / n })
    near(system { bodies = { a = { I = 2 }, b = { I = 3 } }, links = { s = { "a", "b", ratio = 2, k = 5 } } }.s.omega0, (5 * (1 / 2 + 4 / 3)) ^ 0.5, 1e-14)
    -- The wall of a link with a ratio gives each body an impulse times its weight.
    local p = (1 + e) / (1 / 1.5 + 4)
    expect({ bodies = { a = { I = 1.5 }, b = { I = 1 } }, links = { play = { "a", "b", ratio = 2, walls = { upper = 0.1, restitution = e } } } },
        { velocity0 = { a = 1 }, t_end = 0.4 }, { impact = 1, ["a.velocity"] = 1 - p / 1.5, ["b.velocity"] = 2 * p })
end)

test("a weighted link has friction, walls and belts on its angle", function()
    local rig = { bodies = { a = { I = 1 }, b = { I = 4 } }, links = { slip = { "a", "b", ratio = 2, Rd = 0.5 } } }
    -- The slip a - 2 b loses 0.5 (1 + 4/4) a unit of time.
    expect(rig, { velocity0 = { a = 3 }, t_end = 6 }, { events = 1, stick = { 3 }, ["a.velocity"] = 1.5, ["b.velocity"] = 0.75 })
    local belt = expect(rig, { belt = { slip = 1 }, t_end = 6 }, { stick = { 1 } })
    near(belt.a.velocity[#belt] - 2 * belt.b.velocity[#belt], 1, 1e-13)
end)

test("M on a link acts on each body times its weight", function()
    local n = 3
    local f = function(t, theta, velocity) return math.sin(t) - 0.3 * (velocity.a - n * velocity.b) end
    for _, M in ipairs { f, unread(f) } do
        local linked = system { bodies = { a = { I = 1, k = 2 }, b = { I = 2 } }, links = { gear = { "a", "b", ratio = n } } }
        local by_hand = system { bodies = { a = { I = 1, k = 2 }, b = { I = 2 } } }
        local one = linked:simulate { M = { gear = M }, t_end = 10 }
        local two = by_hand:simulate { M = { a = M, b = function(...) return -n * f(...) end }, t_end = 10 }
        near(one.a.theta, two.a.theta, 1e-12)
        near(one.b.theta, two.b.theta, 1e-12)
        closes(one)
        near(one.gear.torque[#one], f(10, nil, { a = one.a.velocity[#one], b = one.b.velocity[#one] }), 1e-11)
        near(one:energy().input, two:energy().input, 1e-11)
    end
    local rigid = system { bodies = { a = { I = 1 }, b = { I = 2 } }, links = { shaft = { "a", "b", rigid = true } } }
    local run = rigid:simulate { M = { shaft = 5, a = 3 }, t_end = 1 }
    near(run.a.velocity[#run], 1, 1e-15)
    near(run.shaft.torque[1], -2, 1e-14) -- all that it carries, M among it
    has(tostring(run:explain()), "M acts on")
end)

test("a machine is written as it was typed, changed and saved", function()
    local rig = system { bodies = { carrier = { I = 3 }, sun = { I = 0.5 }, ring = { I = 1.2, Rd = 5 } },
        links = { planet = { carrier = 2.5, sun = -1, ring = -1.5, rigid = true }, gear = { "sun", "ring", ratio = -2, k = 3 } } }
    has(tostring(rig), "planet = { carrier = 2.5, ring = -1.5, sun = -1, rigid = true }", '"sun", "ring", ratio = -2, k = 3')
    local softer = rig:with { links = { gear = { k = 1 } } }
    has(tostring(softer), "carrier = 2.5", '"sun", "ring", ratio = -2, k = 1')
    equal(tostring(load("return " .. tostring(rig))()), tostring(rig))
    has(rig:simulate { t_end = 1 }:explain(), "2.5 carrier - 1.5 ring - sun", "sun + 2 ring")
end)

test("an impossible gear is refused with a reason", function()
    local function links(of) return function() system { bodies = { a = { I = 1 }, b = { I = 1 }, c = { I = 1 } }, links = { l = of } } end end
    raises(links { "a", "b", ratio = 0 }, "ratio = 0 must not be zero")
    raises(links { "a", "b", c = 1 }, "name two bodies, or give each body its weight, not both")
    raises(links { "a", "b", "c" }, "give each body its weight for more")
    raises(links { a = 1, b = 0 }, "the weight of b must be a number other than 0")
    raises(links { a = 1 }, "gives a a weight, but no other body")
    raises(links { a = 1, b = 1, ratio = 2 }, "ratio is for a link that names two bodies")
    for option, value in pairs { k = 1, C = 1, spring = spring.polynomial { [3] = 1 }, Rd = 1, Re = 1, friction = friction.freewheel {}, normal = 2,
        walls = { upper = 1 } } do
        raises(links { "a", "b", rigid = true, [option] = value }, "a rigid link keeps its angle, so " .. option .. " can do nothing there")
    end
    raises(links { "a", "b", rigid = 1 }, "rigid must be true or false")
    local rig = system { bodies = { a = { I = 1 }, b = { I = 1 } }, links = { gear = { "a", "b", ratio = 10, rigid = true } } }
    refused { { "rig:simulate { velocity0 = { a = 1, b = 0.5 }, t_end = 1 }", "velocity0: the rigid link gear keeps a - 10 b", "a = 1, b = 0.5", "by -4" } }
end)

test("an action on a body throws those that are linked to it rigidly, and friction opposes them all", function()
    local rig = system { bodies = { a = { I = 2, Rd = 0.1 }, b = { I = 1, Rd = 0.2 } }, links = { ab = { "a", "b", rigid = true } } }
    for _, method in ipairs { integrator.spectral {}, integrator.dopri5 { tolerance = 1e-12 } } do
        local thrown = { when = function(t) return t - 0.5 end, act = function(_, _, v) v.a = -2 * v.a end }
        local run = rig:simulate { velocity0 = { a = 1, b = 1 }, events = { thrown }, t_end = 1, times = { 0.75, 1 }, integrator = method }
        -- Friction of 0.3 on 3 takes 0.1 per time unit; of twice -2 v and once v remains -v.
        for i, v in ipairs { -0.95 + 0.025, -0.95 + 0.05 } do
            near(run.a.velocity[i], v, 1e-11)
            near(run.b.velocity[i], v, 1e-11)
            near(run.b.friction[i], 0.2, 1e-15)
        end
        near(run:energy().total.error, 0, 1e-11)
    end
end)

finish()
