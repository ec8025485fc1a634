-- Random systems of several bodies with everything that can act on them, and regression tests of single decisions.
dofile "tests/lua/support.lua"

local function uniform(a, b) return a + (b - a) * math.random() end
local function chance(p) return math.random() < p end

-- Rd and Re, Stribeck's law, or Rd and Re under a normal load, which may fall below zero.
local function rub(part)
    local Rd, kind = uniform(0.05, 1), math.random(4)
    if kind == 1 then
        part.Rd, part.Re = Rd, Rd * uniform(1, 1.6)
    elseif kind == 2 then
        part.Rd = Rd
    elseif kind == 3 then
        part.friction = friction.stribeck { Rd = Rd, Re = Rd * uniform(1, 1.6), speed = uniform(0.05, 0.5) }
    else
        part.Rd, part.Re = Rd, 1.2 * Rd
        local mean, swing, omega, phase = uniform(0.5, 2), uniform(0, 1.5), uniform(0.5, 4), uniform(0, 6)
        part.normal = function(t, theta) return mean * (1 + swing * math.sin(omega * t + phase)) end
    end
end

-- A rig, and what acts in it. Its bodies may be named, and so considered, in the opposite order.
local function random_rig(seed, backwards)
    math.randomseed(seed)
    local function called(i) return backwards and 9 - i or i end
    local n = math.random(2, 6)
    local bodies, links = {}, {}
    local drive = { M = {}, theta0 = {}, velocity0 = {}, belt = {} }
    for i = 1, n do
        local name, body = "b" .. called(i), { I = 10 ^ uniform(-1.5, 1) }
        if chance(0.6) then body.k = uniform(0.5, 10) end
        if chance(0.4) then body.C = uniform(0, 0.5) end
        if chance(0.5) then rub(body) end
        if chance(0.15) then body.walls = { lower = -uniform(0.3, 1), upper = uniform(0.3, 1), restitution = uniform(0.2, 0.8) } end
        bodies[name] = body
        if chance(0.6) then
            local amplitude, omega, mean = uniform(0.5, 3), uniform(0.5, 4), uniform(-0.5, 0.5)
            drive.M[name] = function(t) return amplitude * math.sin(omega * t) + (t < 5 and mean or -4 * mean) end
        end
        if chance(0.3) and (body.Rd or body.friction) then drive.belt[name] = uniform(-0.5, 0.5) end
        if chance(0.4) then drive.velocity0[name] = uniform(-1, 1) end
    end
    for i = 1, n do
        for j = i + 1, n do
            if j == i + 1 or chance(0.15) then
                local link = { "b" .. called(i), "b" .. called(j) }
                if chance(0.6) then link.k = uniform(1, 50) end
                if chance(0.3) then link.C = uniform(0, 0.5) end
                if not link.k and not link.C or chance(0.4) then rub(link) end
                if chance(0.15) then link.walls = { lower = -uniform(0.1, 0.5), upper = uniform(0.1, 0.5), restitution = uniform(0.2, 0.8) } end
                links["l" .. called(i) .. called(j)] = link
            end
        end
    end
    return system { bodies = bodies, links = links }, drive
end

test("the energy of random systems adds up, and a run in two parts, or with other names, ends like a run in one", function()
    for seed = 1, lots(40) do
        local rig, drive = random_rig(seed)
        local run = rig:simulate(merged(drive, { t_end = 12, dt = 12 }))
        assert(run.status ~= "failed", ("rig %d: %s"):format(seed, run.outcome))
        local closure = run:energy().total.closure
        assert(closure < 1e-11, ("rig %d: energy closes to %.3g"):format(seed, closure))
        local parts = rig:simulate(merged(drive, { t_end = 5.1852, dt = 5.1852 })):continue { t_end = 12 }
        local same, its_drive = random_rig(seed, true)
        local renamed = same:simulate(merged(its_drive, { t_end = 12, dt = 12 }))
        for name in pairs(drive.M) do
            local theta, velocity = run[name]:at(12)
            local its = renamed["b" .. 9 - tonumber(name:sub(2))]
            for _, column in ipairs { "M", "friction", "damping", "acceleration" } do near(its[column], run[name][column], 1e-6) end
            for _, other in ipairs { parts[name], its } do
                local as_well, fast = other:at(12)
                assert(math.abs(theta - as_well) < 1e-8 and math.abs(velocity - fast) < 1e-8,
                    ("rig %d: %s is at %.12g, %.12g or at %.12g, %.12g"):format(seed, name, theta, velocity, as_well, fast))
            end
        end
    end
end)

test("a body that is struck while it leans on a wall strikes the wall", function()
    local function struck(b, task, wanted) return expect(pair({ I = 1 }, merged({ I = 0.5 }, b), { walls = { upper = 0, restitution = 0.5 } }),
        merged({ theta0 = { a = -1 }, velocity0 = { a = 1 } }, task), wanted) end
    -- 1 and 0 become 0.5 and 1; the wall makes that -0.8, these two -0.15 and 0.5, the wall -0.4, and so they end
    local run = struck({ walls = { upper = 0, restitution = 0.8 } }, { t_end = 2 }, { ["a.velocity"] = -0.275, ["b.velocity"] = -0.15, ["a.theta"] = -0.275, within = 1e-14 })
    equal(table.concat(run.events.where, " "), "link b link b link")
    near(run:energy().total.impacts, 0.5 * (1 - 0.275 ^ 2) - 0.25 * 0.15 ^ 2, 1e-15)
    -- away from its wall
    run = struck({ walls = { lower = 0 } }, { M = { b = -0.1 }, t_end = 1.5 }, { ["b.velocity"] = 1 - 0.5 * 0.1 / 0.5 })
    equal(run.events[1].kind .. run.events[2].kind .. run.events[2].where, "impactslipb")
end)

test("a loop whose contacts reach their limits one after the other breaks away", function()
    local rig = pair({ I = 1, Rd = 1 }, { I = 2, Rd = 1, normal = function(t) return 1 - t end }, { Rd = 0.5 })
    -- b is held by 1 - t and by the pad; from t = 1 by the pad alone. 0.4 less (1 - t) acts on it up to t = 1, then 0.4.
    local run = expect(rig, { M = { b = 0.9 }, t_end = 2 }, { ["b.velocity"] = (0.16 - 0.08 + 0.4) / 2 })
    equal(run.events[1].kind, "slip")
    near(run.events[1].t, 0.6, 1e-12)
    -- pulled the other way, by the pad alone from t = 1, until it holds no more
    run = expect(rig, { M = { b = function(t) return -0.1 - 0.2 * t end }, t_end = 4 }, { ["b.velocity"] = (-0.1 * 2 - 0.1 * (16 - 4) + 0.5 * 2) / 2 })
    equal(run.events[1].kind .. run.events[2].kind, "openslip")
    near(run.events.t:slice(1, 2), vector { 1, 2 }, 1e-12)
end)

test("a body that rings about the place at which another one sticks comes to rest", function()
    local w = math.sqrt(150 - 1.8 ^ 2)
    for _, place in ipairs { 0.05, 3, 1000 } do -- 0.3 exp(-1.8 t) sin(w t)/w
        expect(pair({ I = 0.1 }, { I = 3, Rd = 1 }, { k = 15, C = 0.36 }), { theta0 = { a = place, b = place }, velocity0 = { a = 0.3 }, t_end = 40 },
            { status = "end", within = 1e-13 * (1 + 10 * place), ["a.theta"] = function(t) return place + 0.3 * math.exp(-1.8 * t) * math.sin(w * t) / w end }, place)
    end
end)

test("a run that ends by chatter keeps its earlier events", function()
    local rig = system { bodies = { a = { I = 1, Rd = 1 }, b = { I = 1, Rd = 1 }, c = { I = 1 }, d = { I = 1, k = 1, Rd = 0.1 } } }
    local loads = {
        a = function(t) return t < 1 and 0 or 2 end,
        -- not read as a formula, so its jump cannot be slid along
        c = function(t, theta, velocity) return t < 2 and 0.1 or tonumber(velocity.c > 0.05 and "-1" or "1") end,
    }
    local run = rig:simulate { velocity0 = { b = 1 }, belt = { d = 0.1 }, M = loads, t_end = 3 }
    equal(run.status, "failed")
    -- at t = 1 the load of a passes what holds it, and b, braked by 1, stops
    local told = {}
    for _, event in ipairs(run.events) do
        told[#told + 1] = event.kind .. " " .. event.where
        near(event.t, 1, 1e-12)
    end
    table.sort(told)
    equal(table.concat(told, ", "), "slip a, stick b")
end)

test("a function that fails only for a trial motion causes no error", function()
    local sys = system { I = 0.02, k = 0, C = 0.1, Rd = 0.1, spring = function(q) return 900 * q + 1e4 * q ^ 3 end }
    local run = sys:simulate { M = function(t) return 1.4 * math.sin(t) end, belt = 0.1, t_end = 1000, dt = 1 }
    equal(run.status, "end")
    raises(function()
        sys:simulate { M = function(t, theta) return theta > 0.001 and 0 / 0 or 1.4 * math.sin(t) end, belt = 0.1, t_end = 1000, dt = 1 }
    end, "M returned")
end)

finish()
