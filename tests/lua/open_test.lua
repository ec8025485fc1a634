-- Contacts that open when nothing presses on them or their limits are 0, and close again.
dofile "tests/lua/support.lua"

local both = { function(f) return f end, unread }

test("an open clutch has no events, and its story mentions neither slipping nor sticking", function()
    local M = { a = function(t, _, v) return t - v.a end, b = function(t, _, v) return t - v.b end }
    for _, normal in ipairs { 0, -2, function() return 0 end, function(t) return -t end } do
        local links = { clutch = { "a", "b", Rd = 1, normal = normal } }
        local rig = system { bodies = { a = { I = 1 }, b = { I = 1 } }, links = links }
        local run = expect(rig, { M = M, t_end = 1 }, { events = 0, ["a.velocity"] = math.exp(-1) })
        for _, each in ipairs { run, rig:simulate { t_end = 1 } } do
            has_not(each:explain(), "slipped", "stuck")
            if type(normal) ~= "number" then says(each, "It was open all the time.") end -- else there is no contact
        end
    end
end)

test("a clutch that closes for a while carries the load, and releases it", function()
    for _, as in ipairs(both) do
        local normal = as(function(t) return t > 1 and t < 2 and 1 or 0 end)
        -- a comes with 0.3, loses 0.7 in a unit of time, b gains 1; together they gain 0.15, and alone a gains 0.3.
        local meet = 1 + 0.3 / 1.7
        local together = meet - 1 + 0.15 * (2 - meet)
        local run = expect({ bodies = { a = { I = 1 }, b = { I = 1 } }, links = { clutch = { "a", "b", Rd = 1, normal = normal } } }, { M = { a = 0.3 }, t_end = 3 },
            { events = 3, close = { 1 }, stick = { meet }, open = { 2 }, ["b.velocity"] = together, ["a.velocity"] = together + 0.3,
                story = { "It was open for 66.7 % of the time.", "it was stuck for 0.82353 of 3 time units (27.5 %)", "It locked at t = 1.1765", "until its contact opened." } })
        for _, event in ipairs(run.events) do equal(event.where, "clutch") end
        says(run.system:simulate { M = { a = 0.3 }, t_end = 0.5 }:continue(3), "It was open for 66.7 % of the time.")
    end
end)

test("a contact opens and closes where its load passes zero, also if it stays at zero for long", function()
    for _, as in ipairs(both) do
        local loads = { as(math.sin), as(function(t) return math.max(0, math.sin(t)) end) }
        for _, options in ipairs { { Rd = 1, normal = loads[1] }, { Rd = 1, normal = loads[2] }, { Rd = loads[2] } } do
            -- It sticks when 0.5 t has gone into 1 - cos t, and slips where sin t falls to 0.5.
            local from, back = math.pi * 5 / 6, 2 * math.pi
            local run = expect(merged({ I = 1, k = 0 }, options), { M = 0.5, t_end = 8 }, { events = 4, stick = 1, slip = { from }, open = { math.pi }, close = { back },
                velocity = 0.5 * (8 - from) + (math.cos(math.pi) - math.cos(from)) + (math.cos(8) - math.cos(back)), within = 1e-11 })
            local stop = run.events[1].t
            near(0.5 * stop + math.cos(stop), 1, 1e-12)
        end
        -- One that only touches zero does not open.
        expect({ I = 1, k = 1, Rd = 1, normal = as(function(t) return math.abs(math.sin(t)) end) }, { theta0 = 0.5, t_end = 10 }, { open = 0, close = 0 })
    end
end)

test("a stuck body whose contact opens moves without a slip, and is no longer stuck", function()
    expect({ I = 1, k = 1, Rd = 1, normal = function(t) return 1 - t end }, { t_end = 3 }, { events = 1, open = { 1 }, story = { "It was open for 66.7 % of the time." } })
    expect({ I = 1, k = 1, Rd = 1, normal = function(t) return t < 1 and 1 or 0 end }, { theta0 = 0.5, t_end = 5 },
        { events = 2, open = { 1 }, turn = { 1 + math.pi }, theta = 0.5 * math.cos(4),
            story = { "stuck there until t = 1, when its contact opened.", "it was stuck for 1 of 5 time units (20 %)" } })
end)

test("a contact that closes at a wall holds there against a pull off the wall", function()
    for _, as in ipairs(both) do
        expect({ I = 1, k = 0, Rd = 0.5, Re = 1, normal = as(function(t) return t > 1.5 and 1 or 0 end), walls = { upper = 1, restitution = 0 } },
            { theta0 = 1, M = as(function(t) return 2 - t end), t_end = 4 }, { events = 2, close = { 1.5 }, slip = { 3 }, velocity = -0.5 - 0.5, theta = 1 - 0.25 - 1 / 6 })
    end
end)

test("a contact whose load depends on the angle has a period, and is never stuck", function()
    local sys = system { I = 1, k = 1, Rd = 0.2, normal = function(_, theta) return theta end }
    -- With the friction the spring has 0.8 of its stiffness on the way down, and 1.2 on the way up.
    local down, up = math.sqrt(0.8), math.sqrt(1.2)
    local opens = math.pi / 2 / down
    local closes = opens + math.pi
    local run = expect(sys, { theta0 = 3, t_end = 7 }, { events = 4, open = { opens }, close = { closes }, turn = { opens + math.pi / 2, closes + math.pi / 2 / up } })
    near(run.events[4].theta, 3 * down / up, 1e-12)
    local steady = sys:steady { M = function(t) return math.sin(1.3 * t) end, period = 2 * math.pi / 1.3 }
    equal(steady.status .. steady.stuck, "steady0.0")
end)

test("a small spring torque lets the mass slip right before its contact opens, early and late", function()
    local a, k, Rd, theta0 = 1.2, 7, 0.4, 1e-4
    local normal = function(t) return math.max(0, 1 + a * math.sin(6 * t + 1)) end
    for _, start in ipairs { 0, 30.5, 1000 } do
        local run = system { I = 1, k = k, C = 0.2, Rd = Rd, normal = normal }:simulate { theta0 = theta0, t_start = start, t_end = start + 20 }
        equal(run.t_end, start + 20)
        for i, pressed in ipairs { k * theta0 / Rd, 0 } do
            local phase = math.pi - math.asin((pressed - 1) / a)
            local round = math.ceil((6 * start + 1 - phase) / (2 * math.pi))
            near(run.events[i].t, (phase + 2 * math.pi * round - 1) / 6, 1e-12)
            equal(run.events[i].kind, i == 1 and "slip" or "open")
        end
    end
end)

test("a contact that closes beside a loop of contacts that hold stays at rest", function()
    local rig = system {
        bodies = { a = { I = 1.6, k = 3, Rd = 1.33 }, b = { I = 0.65, k = 3, Rd = 1.23 }, c = { I = 1.7, k = 3 } },
        links = { ab = { "a", "b", k = 4.9, Rd = 0.43 }, bc = { "b", "c", k = 1.2, Rd = 0.44, normal = function(t) return 1 + 1.3 * math.sin(t) end } } }
    local run = rig:simulate { M = { a = function(t) return 0.5 * math.sin(1.6 * t) end }, t_end = 20 }
    equal(run.t_end, 20)
    for i, event in ipairs(run.events:filter(function(e) return e.kind ~= "stick" end)) do
        local round = (i - 1) // 2 * 2 * math.pi
        equal(event.kind, i % 2 == 1 and "open" or "close")
        near(event.t, round + (i % 2 == 1 and math.pi + math.asin(1 / 1.3) or 2 * math.pi - math.asin(1 / 1.3)), 1e-12)
    end
    equal(run.c.theta:abs():max(), 0)
end)

test("a contact whose load ends together with a step of M opens once, and the run goes on", function()
    local sys = system { I = 1, k = 1, Rd = .5, normal = function(t) return math.max(0, math.sin(t)) end }
    for _, at in ipairs { math.pi, math.pi - 1e-15, math.pi + 1e-15 } do
        for _, method in ipairs { integrator.spectral {}, integrator.dopri5 { tolerance = 1e-10 } } do
            local M = excitation.step { amplitude = .2, at = at }
            local run = sys:simulate { M = M, t_end = 5, integrator = method }
            equal(run.t_end, 5)
            equal(#run.events, 1)
            equal(run.events.kind[1], "open")
            near(run.events.t[1], math.pi, 1e-12)
            near(run:at(5), .2 * (1 - math.cos(5 - math.pi)), 1e-8)
        end
    end
    local rig = system { bodies = { b = { I = 1, Rd = .5, k = .2 }, c = { I = .2, Rd = .1, k = 2 } },
        links = { m = { "b", "c", Rd = .1, normal = function(t) return math.max(0, math.sin(t)) end } } }
    equal(rig:simulate { M = { b = excitation.square { amplitude = .2, omega = 2 } }, t_end = 20 }.t_end, 20)
end)

test("a narrow smooth peak of the load of an open contact is found, at rest, in motion and by a law with a state", function()
    for _, w in ipairs { 1e-1, 1e-3, 1e-6 } do
        local peak = function(t) return 2 * math.exp(-((t - 1.7) / w)^2) - 1 end
        local closes = { 1.7 - w * math.log(2)^0.5 }
        for _, theta0 in ipairs { 0, 0.7 } do expect({ I = 1, k = 1, Rd = 0.5, normal = peak }, { theta0 = theta0, t_end = 4 }, { close = closes }) end
        -- An integral of 1 over the peak takes the momentum Rd where the bristle yields at once.
        local load = function(t) return math.exp(-((t - 1.7) / w)^2) / (w * math.pi^0.5) - 1e-12 end
        local run = system { I = 1, k = 0, normal = load, friction = friction.dahl { stiffness = 1e9, Rd = 0.3 } }:simulate { velocity0 = 1, t_end = 3, times = { 3 } }
        near(run.velocity[1], 0.7, 1e-8)
    end
end)

test("a contact that opens later than an event ends the stretch opens once", function()
    local rig = system {
        bodies = { a = { I = 0.4, Rd = 0.7, Re = 0.8, k = 0.8, normal = function(t) return 0.7 + 1.1 * math.sin(2.1 * t) end }, b = { I = 1.7, C = 0.4, k = 2.7 } },
        links = { ab = { "a", "b", friction = friction.jenkins { stiffness = 7.2, Rd = 0.5 } } } }
    local opens = (math.pi + math.asin(7 / 11)) / 2.1
    for level = 0.05, 0.15, 0.01 do -- the load slides along its level while the contact opens
        local run = rig:simulate { M = { a = function(_, _, v) return v.a > level and -0.5 or 0.5 end }, theta0 = { a = 0.3, b = -0.5 }, velocity0 = { a = -0.7, b = -0.6 }, t_end = 2 }
        equal(run.t_end, 2)
        equal(#run.events:filter(function(e) return e.kind == "open" end), 1)
        near(run.events.t[#run.events], opens, 1e-12)
    end
end)

test("friction that acts over a part of the way only takes the work that it does there", function()
    for _, w in ipairs { 0.5, 0.01, 1e-5 } do
        local function zone(_, theta) return theta > 1 and theta < 1 + w and 0.3 or 0 end
        local function ramp(_, theta) return math.max(0, 0.3 - 0.6 * math.abs(theta - 1 - w / 2) / w) end
        local function sector(_, theta) return (theta - 1) % 7 < w and 0.3 or 0 end
        for of, work in pairs { [zone] = 0.3 * w, [ramp] = 0.15 * w, [sector] = 0.3 * w } do
            for _, options in ipairs { { Rd = of }, { Rd = 1, normal = of } } do
                expect(merged({ I = 1, k = 0 }, options), { velocity0 = 1.5, t_end = 4, dt = 2 },
                    { events = 2, close = { 1 / 1.5 }, velocity = { 1.5, (1.5^2 - 2 * work)^0.5, (1.5^2 - 2 * work)^0.5 }, within = 1e-11, closes = 1e-7 })
            end
        end
    end
end)

finish()
