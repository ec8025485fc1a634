-- Elastic stops, which push back with k x + C x' at the depth x and never pull.
dofile "tests/lua/support.lua"

test("a block leaves a damped stop where the stop would begin to pull", function()
    local k, C = 4, 1
    local w = math.sqrt(k - C ^ 2 / 4)
    local lasts = (math.pi - math.atan(w, k - C / 2)) / w
    local v = math.exp(-lasts / 2) * (math.cos(w * lasts) - math.sin(w * lasts) / (2 * w))
    local run = expect({ I = 1, k = 0, walls = { upper = 1, stiffness = k, damping = C } }, { velocity0 = 1, t_end = 5 },
        { events = 3, impact = { 1 }, turn = 1, release = { 1 + lasts }, velocity = v, within = 1e-13, story = { "wall at theta = 1 that push", "hit the wall 1 time" } })
    near(run:energy().total.impacts, (1 - v ^ 2) / 2, 1e-13)
end)

test("elastic stops equal the torque that a user can write as M", function()
    local f = function(t) return 2 * math.sin(1.7 * t) end
    for C, upper in pairs { [0] = 0.3, [3] = 0.3, [60] = -0.48 } do -- the last flies from one stop, still deformed, to the other
        local by_hand = system { I = 1, k = 2, C = 0.1 }:simulate { t_end = 30, M = function(t, theta, velocity)
            local up, down = 60 * (theta - upper) + C * velocity, 60 * (theta + 0.5) + C * velocity
            return f(t) - (theta > upper and math.max(0, up) or 0) - (theta < -0.5 and math.min(0, down) or 0)
        end }
        local run = expect({ I = 1, k = 2, C = 0.1, walls = { lower = -0.5, upper = upper, stiffness = 60, damping = C } }, { M = f, t_end = 30 }, { theta = by_hand.theta, within = 1e-9 })
        assert(#of_kind(run, "impact") > 5)
        near(#of_kind(run, "impact"), #of_kind(run, "release"), 1)
    end
end)

test("a link has elastic stops, and a body may rest on them", function()
    local run = expect({ bodies = { a = { I = 1 }, b = { I = 2 } }, links = { gap = { "a", "b", walls = { lower = -0.1, upper = 0.1, stiffness = 50, damping = 1 } } } },
        { velocity0 = { a = 1 }, t_end = 3 })
    near(run.a.velocity[#run] + 2 * run.b.velocity[#run], 1, 1e-13)
    equal(run.gap.events.kind[1], "impact")
    -- A block that rests on a stop: k x = M; friction holds it there.
    local block = { I = 1, k = 0, Rd = 0.5, walls = { upper = 0, stiffness = 10, damping = 2 } }
    local rest = expect(block, { M = 2, t_end = 30 }, { velocity = 0, within = 0 })
    assert(rest.theta[#rest] > 0.15 and rest.theta[#rest] < 0.25)
    expect(block, { theta0 = 0.2, M = 2, t_end = 1 }, { theta = 0.2, within = 0 })
end)

test("elastic stops are written, changed and refused like rigid ones", function()
    local sys = system { I = 1, k = 1, walls = { upper = 1, stiffness = 100, damping = 2 } }
    has(tostring(sys), "walls = { upper = 1, stiffness = 100, damping = 2 }")
    has(tostring(sys:with { walls = { upper = 2, stiffness = 5 } }), "walls = { upper = 2, stiffness = 5 }")
    refused {
        { "system { I = 1, k = 1, walls = { upper = 1, stiffness = 1, restitution = 0.5 } }", "restitution is of rigid walls" },
        { "system { I = 1, k = 1, walls = { upper = 1, damping = 1 } }", "damping needs stiffness" },
        { "sys:simulate { t_end = 1, integrator = integrator.exact {} }", "exact" },
    }
    local steady = sys:steady { M = excitation.harmonic { amplitude = 3, omega = 1.5 } }
    equal(steady.status, "steady")
end)

test("held samples keep each value until the next time", function()
    local t, M = { 0, 1, 2.5, 4 }, { 1, -2, 3, 0.5 }
    local held = excitation.samples { t = t, M = M, interpolation = "hold" }
    for at, value in pairs { [-1] = 1, [0] = 1, [0.999] = 1, [1] = -2, [2.4] = -2, [2.5] = 3, [4] = 0.5, [100] = 0.5 } do
        equal(held(at), value + 0.0)
    end
    local steps = excitation.constant(1) + excitation.step { amplitude = -3, at = 1 } + excitation.step { amplitude = 5, at = 2.5 } + excitation.step { amplitude = -2.5, at = 4 }
    for _, sys in ipairs { system { I = 1, k = 3, Rd = 0.5 }, system { I = 1, k = 3, friction = friction.stribeck { Rd = 0.5, Re = 0.6, speed = 0.1 } } } do
        local a, b = sys:simulate { M = held, t_end = 8 }, sys:simulate { M = steps, t_end = 8 }
        near(a.theta, b.theta, 1e-13)
        same_events(a, b, 1e-12)
    end
    local again = excitation.samples { t = { 0, 1 }, M = { 1, -1 }, interpolation = "hold", period = 2 }
    local square = excitation.square { amplitude = 1, period = 2 }
    near(system { I = 1, k = 3, C = 0.3 }:simulate { M = again, t_end = 9 }.theta, system { I = 1, k = 3, C = 0.3 }:simulate { M = square, t_end = 9 }.theta, 1e-13)
    equal(again(1), -1.0)
    equal(again(2), 1.0)
    equal(again:delay(0.5)(2.4), -1.0)
    has(tostring(held), 'interpolation = "hold"')
    local name = temporary(".csv")
    write(name, "t,M\n0,1\n1,-2\n2.5,3\n4,0.5\n")
    local of_file = excitation.samples(name, { interpolation = "hold" })
    equal(of_file(2.4), -2.0)
    has(tostring(of_file), 'interpolation = "hold"')
end)

test("dry friction does not hold a body against an elastic stop that pushes harder", function()
    -- On the stiffness K of the stop M = -2 brings each turn to the depth 2 (2 -+ Rd)/K less the one before.
    local K, Rd = 2e5, 0.2
    local run = system { I = 0.1, k = 0, Rd = Rd, walls = { lower = 0, stiffness = K } }:simulate { M = -2, t_end = 0.4 }
    local depth, way = 0, -1
    for i, turn in ipairs(run.events:filter(function(e) return e.kind == "turn" end)) do
        depth, way = 2 * (2 + way * Rd) / K - depth, -way
        near(-turn.theta, depth, 1e-12 * depth + 1e-15)
    end
    equal(run.outcome, "at rest")
    assert(math.abs(-run.theta[#run] * K - 2) <= Rd)
end)

test("the energy stored by a pressed stop is the same at the end as in the last row", function()
    local run = system { I = 1, k = 1, walls = { upper = 0.1, stiffness = 20 } }:simulate { velocity0 = 1, t_end = 0.3, dt = 0.1 }
    local e = closes(run)
    near(e.finish.spring, e.spring[#run], 1e-13)
    near(e.finish.kinetic, e.kinetic[#run], 1e-13)
end)

-- Long runs in which a contact stands at its limit to rounding, at times: each ended in "switched endlessly". There a run
-- in two parts may have other events.
local function runs(of, task, wanted) return expect(of, task, merged({ parts = false }, wanted)) end

test("a motion that starts from rest is not required to be more accurate than the rounding of M", function()
    local table_of = friction.table { speed = { 0, 0.3, 1.2 }, torque = { 0.4527, 0.3522, 0.5416 } }
    local rig = { bodies = { a = { I = 1.48, C = 0.08, k = 0.407, friction = table_of }, b = { I = 0.931, k = 1.393 } },
        links = { l = { "a", "b", ratio = 2.229, Rd = 0.255, k = 0.893, normal = function(t) return math.max(0, 1 + 1.486 * math.sin(1.004 * t)) end } } }
    local M = function(t) return math.max(-0.559, math.min(0.359, 1.118 * math.sin(1.4356 * t + 4.306))) end
    for i = 0, 5 do runs(rig, { M = { a = M }, t_start = 600 * i, t_end = 600 * i + 600 }) end
end)

test("a freewheel without friction lets go where its torque passes 0 exactly", function()
    for i = 1, 6 do
        local run = runs({ bodies = { a = { I = 0.43, k = 1.8 }, b = { I = 0.97, k = i % 2, friction = friction.freewheel {} } }, links = { l = { "a", "b", k = 2 } } },
            { theta0 = { a = -i / 4 }, t_end = 20, dt = 1 })
        -- b is pushed as soon as a, which swings by itself until then, passes 0
        local slip = of_kind(run, "slip")[1]
        near(slip.t, math.pi / 2 / math.sqrt(3.8 / 0.43), 1e-12)
    end
end)

test("a run may begin where the normal load jumps", function()
    local jumps = function(t) return math.sin(1.6 * t) > 0 and 1 or 0.7 end
    local rig = { bodies = { a = { I = 2.8, k = 3.8 }, b = { I = 0.5, C = 0.4, Rd = 0.28, Re = 0.32, normal = jumps } }, links = { l = { "a", "b", k = 0.8 } } }
    for _, M in ipairs { excitation.triangle { amplitude = 0.7, period = 1.59 }, excitation.harmonic { amplitude = 0.7, omega = 2 } } do
        for n = -2, 4 do runs(rig, { M = { a = M }, t_start = n * math.pi / 1.6, t_end = n * math.pi / 1.6 + 20 }) end
    end
end)

test("a body comes to rest on a belt that stops while another body stands", function()
    local rig = { bodies = { a = { I = 2.68, k = 1.53, friction = friction.stribeck { Rd = 0.23, Re = 0.32, speed = 0.07 } }, b = { I = 0.867, C = 0.05, Rd = 0.265, k = 1.62 } },
        links = { l = { "a", "b", ratio = 1.289, k = 1.1667, Rd = 0.12 } } }
    local steps = function(t) return 0.24 * math.floor(4 * ((0.05 * t) % 1)) end
    local belt = function(t) return 0.21244 * math.floor(4 * ((0.145121 * t) % 1)) end
    for i = 1, 30 do
        runs(rig, { M = { a = excitation.sawtooth { amplitude = 0.48, period = 19.97 }, b = steps }, belt = { b = belt }, t_start = 20 * i, t_end = 20 * i + 200 })
    end
end)

test("sliders beside dry friction slip only where their contact slips", function()
    local laws = { friction.jenkins { stiffness = 16, Rd = 0.137 }, friction.jenkins { stiffness = 11.2, Rd = 0.082 }, friction.coulomb { Rd = 0.11 } }
    for i = 1, 12 do
        local run = runs({ I = 0.67, k = 4.54, C = 0.037, friction = laws }, { t_end = 1200, dt = 10,
            M = function(t) return 0.67 * math.sin((1.6 + 0.01 * i) * t) + 0.21 * math.sin(2.64 * t + 3.577) end })
        assert(run:energy().error:abs():max() < 1e-11)
    end
end)

test("the slope of a belt far from t = 0 is not required to have more digits than it can have", function()
    local normal = function(t) return math.sin(1.021 * t) > 0 and 1 or 0.3 end
    local belt = function(t) return 0.314194 * math.sin(1.38117 * t) + 0.0619454 * math.sin(2.76233 * t + 4.435) end
    runs({ I = 0.33700739463091, k = 1.5781273779083, C = 0.03783044200749, Rd = 0.1051028529772, normal = normal },
        { M = excitation.square { amplitude = 0.69963788448255482, period = 16.540315653111087 }, belt = belt, t_end = 4962, dt = 10 })
end)

test("a joint with weights leaves a wall once", function()
    for i = 0, 4 do
        local link = { "a", "b", ratio = 1.7268808258001 + i / 50, k = 4.5643744510066, C = 0.0835, Rd = 0.99, walls = { upper = 1.1079021784381, restitution = 0.3 } }
        local bodies = { a = { I = 2.1135645616871, C = 0.013126, Rd = 0.76648721298613, k = 0.62057655107059 }, b = { I = 0.30676646867662, C = 0.118, k = 4.3941484262325 } }
        runs({ bodies = bodies, links = { l = link } }, { theta0 = { a = -0.32872787024971 }, t_end = 100, integrator = integrator.dopri5 { tolerance = 1e-9 },
            M = { a = function(t) return 1.87021 * (t % 16.6863 < 7.96711 and t % 16.6863 or 0) end } })
    end
end)

test("in a chain several contacts reach their limits at one instant", function()
    for N = 5, 8 do
        local bodies, links, M = {}, {}, {}
        for i = 1, N do
            bodies["b" .. i] = { I = 1, Rd = 0.5, k = 0 }
            M["b" .. i] = function(t) return (i % 2 == 0 and -0.5 or 1.5) * math.sin(t) end
            if i > 1 then links["l" .. i - 1] = { "b" .. i - 1, "b" .. i, Rd = 0.5, k = 0 } end
        end
        local run = runs({ bodies = bodies, links = links }, { M = M, t_end = 20 })
        if N % 2 == 1 then near(run.b1.theta, run["b" .. N].theta, 1e-6) end
    end
end)

finish()
