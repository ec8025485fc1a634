dofile "tests/lua/support.lua"

local stribeck = friction.stribeck { Rd = 0.25, Re = 0.6, speed = 0.4 }

test("a law is an option of a system, and the system's text reproduces it", function()
    for _, law in ipairs {
        stribeck, friction.stribeck { Rd = 0.25, Re = 0.6, speed = 0.4, shape = 1 },
        friction.asymmetric { forward = { Rd = 0.1, Re = 0.3 }, backward = { Rd = 0.2 } },
        friction.table { speed = { 0, 0.5, 2 }, torque = { 0.45, 0.2, 0.35 }, Re = 0.6 },
        friction.law(function(speed) return 0.25 + 0.1 * speed ^ 2 end, { Re = 0.6 }),
    } do
        local sys = system { I = 1, k = 1, friction = law }
        equal(tostring(load("return " .. tostring(sys))()), tostring(sys))
        equal(tostring(sys.friction), tostring(law))
        local nd = nondimensional { zeta = 0.1, friction = law }
        equal(tostring(nd.friction), tostring(law))
        equal(sys.Re, law.Re)
    end
    equal(tostring(system { I = 1, k = 1, friction = friction.coulomb { Rd = 0.2, Re = 0.3 } }),
        "system{ I = 1, k = 1, Rd = 0.2, Re = 0.3 }")
end)

test("a law that fails, or is negative, is reported with the speed, and the rows until then are kept", function()
    local negative = system { I = 1, k = 1, friction = friction.law(function(speed) return 0.3 - speed end) }
    local ok, problem = pcall(negative.simulate, negative, { theta0 = 2, t_end = 20, dt = 0.01 })
    assert(not ok and tostring(problem):find("friction returned %-[%d.e-]+ at speed = 0%.%d+; it must return a finite number that is not negative"), problem)
    assert(#dinal.partial > 10)  -- 17 rows before it is too fast
    for _, name in ipairs { "Rd", "Re" } do
        local falls = system { I = 1, k = 0, [name] = function(t) return 0.3 - t end }
        raises(function() falls:simulate { M = 0.1, velocity0 = 1, t_end = 2 } end, name .. " returned -", "it must return a finite number that is not negative")
    end
    refused {
        { "friction.law(function() return nil end)", "friction returned nil at speed = 0" },
        { 'friction.law(function() error("no law") end)', "no law" },
        { "friction.law(3)", "friction.law takes a function of the speed, got 3" },
    }
end)

test("each mistake in a law is one sentence with the name of the option", function()
    refuses(friction.stribeck, {
        { { Rd = 0.3, Re = 0.2, speed = 1 }, "friction.stribeck: Re = 0.2 must be at least Rd = 0.3" },
    })
    refuses(friction.asymmetric, {
        { { forward = { Rd = 1 }, backward = 2 }, "backward must be a table such as" },
        { { forward = { Rd = 1 }, backward = { Rd = 2, Re = 1 } }, "backward.Re = 1 must be at least backward.Rd = 2" },
        { { forward = { Rd = 1 }, backward = { Rf = 2 } }, "friction.asymmetric: backward has no option 'Rf'" },
    })
    refused {
        { "friction.table { speed = { 0, 1 }, torque = { 1 } }", "torque has 1 numbers" },
        { "friction.law(function(speed) return 1 + speed end, { Re = 0.5 })", "Re = 0.5 must be at least the friction at speed 0, 1" },
        { "system { I = 1, k = 1, friction = stribeck, Rd = 1 }", "friction and Rd exclude each other" },
        { "nondimensional { friction = stribeck, friction_ratio = 1 }", "friction and friction_ratio exclude each other" },
        { "system { I = 1, k = 1, friction = 0.3 }", "friction must be a law such as" },
        { "stribeck.Re = 2", "a friction cannot be changed" },
    }
end)

test("dinal1989 and the closed forms accept only Coulomb friction and the spring k theta, and no walls", function()
    for option, only in pairs { friction = "only Coulomb friction", spring = "only the spring k theta", walls = "walls" } do
        local parts = { friction = stribeck, spring = spring.polynomial { [3] = 0.5 }, walls = { upper = 1 } }
        local sys = system { I = 1, k = 1, [option] = parts[option] }
        raises_here(function() sys:simulate { t_end = 1, dt = 1, integrator = integrator.dinal1989 { h = 0.1 } } end, "support", only)
        for _, closed in ipairs { theory.time_to_rest, theory.extremes } do
            raises_here(function() closed { system = sys, theta0 = 0.5 } end, "the closed forms ", "include ", only)
        end
    end
end)

test("sys:with makes the same system except for the given changes", function()
    local sys = system { I = 2, k = 8, C = 0.5, Rd = 1, Re = 1.5 }
    equal(tostring(sys:with { I = 3 }), "system{ I = 3, k = 8, C = 0.5, Rd = 1, Re = 1.5 }")
    equal(tostring(sys:with { Rd = 1.2 }), "system{ I = 2, k = 8, C = 0.5, Rd = 1.2, Re = 1.5 }")
    equal(sys:with { Re = 2 }.Re, 2.0)
    equal(system { I = 1, k = 1, Rd = 1 }:with { Rd = 2 }.Re, 2.0)
    has(system { I = 1, k = 1, Rd = 1, normal = 2 * excitation.constant { amplitude = 3 } }:with { k = 2 }, "normal = 6 }")
    equal(tostring(sys:with { friction = stribeck }.friction), tostring(stribeck))
    equal(tostring(sys:with { friction = stribeck }:with { k = 9 }.friction), tostring(stribeck))
    equal(tostring(sys:with { friction = stribeck }:with { Rd = 1, Re = 1.5 }), tostring(sys))
    refused {
        { "sys:with { Rd = 2 }", "sys:with: Re = 1.5 must be at least Rd = 2" },
        { "sys:with { friction = stribeck }:with { Rd = 2 }", "the friction of this system is friction.stribeck{" },
    }
end)

test("with k = 0 quantities that need a period have no value", function()
    local block = system { I = 2, k = 0, Rd = 0.3, Re = 0.4 }
    for _, name in ipairs { "omega0", "T0", "zeta", "omega1", "regime", "dead_zone" } do
        equal(block[name], nil)
    end
    equal(tostring(block), "system{ I = 2, k = 0, Rd = 0.3, Re = 0.4 }")
    local run = expect(block, { velocity0 = 1.5, t_end = 12, dt = 1 }, { status = "rest", rest = { 10 }, theta = 7.5, story = { "a block without a spring" } })
    near(run:energy().total.dry, 2.25, 1e-12)
    refused {
        { "theory.time_to_rest { system = block, theta0 = 1 }", "this system has k = 0" },
        { 'run:save(os.tmpname() .. ".dat")', "this system has k = 0" },
        { "block:simulate { t_end = 1, dt = 1, integrator = integrator.dinal1989 { h = 0.1 } }", "divides by k" },
    }
end)

test("a law that jumps up, or begins infinitely steep, is reported with its speed and a working remedy", function()
    local function block(law) return system { I = 1, k = 0, friction = law } end
    local jump = friction.law(function(v) return v < 0.5 and 0.3 or 0.6 end)
    local run = block(jump):simulate { M = 0.45, t_end = 5, dt = 1 }
    has(run.outcome, "it chatters at speed 0.5, where the law of friction")
    has(run, "at speed 0.5")
    says(run, "at speed 0.5")
    -- The cure: the mass comes to 0.5 at t = 0.5/0.15 and stays there, within the width of the line.
    local line = friction.table { speed = { 0, 0.5, 0.50001 }, torque = { 0.3, 0.3, 0.6 } }
    expect(block(line), { M = 0.45, t_end = 5, dt = 1 }, { velocity = 0.5, theta = 0.5*(0.5/0.15)/2 + 0.5*(5 - 0.5/0.15), within = 2e-5 })
    -- velocity (1 - t/2)^2, whatever it says about the end
    near(block(friction.law(math.sqrt, { Re = 0 })):simulate { velocity0 = 1, t_end = 5, dt = 1 }.theta[6], 2/3, 1e-9)
    -- A controller that would slide along its switching line, but is not read.
    run = system { I = 1, k = 0 }:simulate { theta0 = 1, t_end = 5, dt = 1,
        M = unread(function(t, theta, velocity) return theta + 0.2*velocity > 0 and -5 or 5 end) }
    has(run.outcome, "tanh would not, nor excitation.sampled or excitation.relay")
    -- A jump in the rate of a state that is not read, which these two terms of M do not cure.
    run = system { I = 1, k = 1, Rd = 0.1 }:simulate { theta0 = 1, t_end = 5, dt = 1,
        states = { x = { start = 1, rate = unread(function(t, theta, velocity, z) return z.x > 0 and -1 or 1 end) } } }
    has(run.outcome, "the rate of x jumps to and fro and drives it back each time; a steep line or tanh in its place would not")
    has_not(run.outcome, "sampled")
end)

test("a law in Lua moves a mass as the native law with the same numbers does", function()
    local function stribeck_of(v) return 2 + 2*math.exp(-(v/0.5)^2) end
    local speeds, torques = { 0, 1, 3, 10 }, { 2, 1.5, 1.8, 4 }
    local function lines_of(v)
        if v < 1 then return 2 - 0.5*v elseif v < 3 then return 1.5 + 0.15*(v - 1) end
        return 1.8 + 2.2/7*(v - 3)
    end
    local stribeck_law = friction.stribeck { Rd = 2, Re = 4, speed = 0.5 }
    for i, laws in ipairs {
        { stribeck_law, friction.law(stribeck_of) },
        { stribeck_law, friction.law(function(v) return stribeck_of(math.abs(v)) end) },
        -- No formula: it is called, at speeds that are not negative.
        { stribeck_law, friction.law(function(v) assert(v >= 0) return tonumber(string.format("%.17g", stribeck_of(v))) end) },
        { friction.table { speed = speeds, torque = torques, Re = 2.5 }, friction.law(lines_of, { Re = 2.5 }) },
    } do
        for _, load in ipairs {
            { M = excitation.harmonic { amplitude = 20, frequency = 0.7 } }, { belt = 0.3 },
            { M = function(t, theta) return 20*math.sin(4*t) - theta end,
                states = { x = { start = 1, rate = function(t, theta, velocity, z) return velocity - z.x end } } },
        } do
            load.t_end, load.dt = 12, 0.5
            local function run(law) return system { I = 1, k = 4*math.pi^2, C = 0.1, friction = law }:simulate(load) end
            local native, own = run(laws[1]), run(laws[2])
            alike(own, native, 1e-10, i)
            if not load.belt and i == 4 then assert(#own.events > 10) end
        end
    end
end)

test("friction that rises right before a stop is found, however low the speed", function()
    local Rd, Re = 0.3, 0.6
    for _, speed in ipairs { 1e-3, 0.03 } do
        local lua = friction.law(function(v) return Rd + (Re - Rd) * math.exp(-(v / speed) ^ 2) end)
        for _, law in ipairs { friction.stribeck { Rd = Rd, Re = Re, speed = speed }, lua } do
            local stop = system { I = 1, k = 0, friction = law }:simulate { velocity0 = 1, t_end = 5 }.events[1]
            -- The integral of v dv/friction.
            near(stop.theta, 1 / (2 * Rd) - speed ^ 2 / (2 * Rd) * math.log(Re / Rd), 1e-12)
        end
    end
end)

test("a law with a corner costs at most 380 values of M a half swing, at any speed of its corner", function()
    for _, speed in ipairs { 0.002, 0.02, 0.3 } do
        local calls = 0
        local run = nondimensional { friction = friction.stribeck { Rd = 0.005, Re = 0.0125, speed = speed } }:simulate {
            M = function(t) calls = calls + 1 return 0.25 * math.sin(4 * t) end, theta0 = 1, t_end = 20, dt = 20 }
        equal(#run.events, 40)
        assert(calls <= 380 * #run.events, calls)
    end
end)

test("a law may exceed the given Re by rounding, and its Re is then its value at speed 0", function()
    local law = friction.law(function(speed) return 0.1 + 0.2 * math.exp(-speed) end, { Re = 0.3 }) -- 0.1 + 0.2 > 0.3
    equal(law.Re, 0.1 + 0.2)
    refused { { "friction.law(function() return 0.3 + 1e-12 end, { Re = 0.3 })", "Re = 0.3 must be at least" } }
end)

test("a system with Stribeck's law shows Rd, not the friction at standstill", function()
    local sys = system { I = 1, k = 1, friction = friction.stribeck { Rd = 0.3, Re = 0.6, speed = 0.1 } }
    equal(sys.Rd, 0.3)
    equal(sys.Re, 0.6)
    local told = sys:simulate { theta0 = 1, t_end = 5, dt = 1 }:explain():gsub("%s+", " ")
    has(told, "Rd = 0.3 while sliding, Re = 0.6 to break away. Friction falls from Re at rest to Rd at high speed.")
end)

test("a contact that can hold nothing at rest slips under a torque that falls with the velocity", function()
    local function M(t, _, v) return t - v end
    local open = { I = 1, k = 0, Rd = 1, normal = 0 }
    local wanted = math.exp(-1)  -- t + exp(-t) - 1 is the velocity of v' = t - v
    for _, own in ipairs { open, { I = 1, k = 0 }, { I = 1, k = 0, friction = friction.law(function() return 0 end) } } do
        expect(own, { M = M, t_end = 1 }, { status = "end", velocity = wanted })
    end
    expect(pair({ I = 1 }, { I = 1 }, { Rd = 1, normal = 0 }), { M = { a = function(t, _, v) return t - v.a end }, t_end = 1 }, { status = "end", ["a.velocity"] = wanted, ["b.velocity"] = 0 })
end)

test("a breakaway torque that differs each way holds alike under exact and spectral, also with M from a table", function()
    local uneven = system { I = 1, k = 1, friction = friction.asymmetric { forward = { Rd = 0.2, Re = 2 }, backward = { Rd = 0.1, Re = 1 } } }
    local t = vector.linspace(0, 20, 201)
    for _, M in ipairs { excitation.harmonic { amplitude = 0.5, omega = 1 }, excitation.samples { t = t, M = -1.5 * t:sin() } } do
        for _, theta0 in ipairs { 0, 0.8, -1.7 } do
            local function run(by) return expect(uneven, { M = M, theta0 = theta0, t_end = 20, dt = 0.1, integrator = by }) end
            alike(run(integrator.exact {}), run(integrator.spectral {}), 1e-10)
        end
    end
end)

test("friction that falls steeply with the speed stops a fast mass where its decay predicts", function()
    -- Beyond speed 0, where stretches and steps look for the stop, such laws would grow without bound.
    local theta0, k, Rd = 1000, 100, 0.6
    local turn = math.pi / math.sqrt(k)
    for _, law in ipairs {
        function(v) return Rd + 0.6 * math.exp(-v / 0.5) end,
        friction.law(function(v) return Rd + 0.6 * math.exp(-v / 0.5) end),
        friction.stribeck { Rd = Rd, Re = 1.2, speed = 0.5, shape = 1 },
        friction.stribeck { Rd = Rd, Re = 1.2, speed = 0.5, shape = 3 },
    } do
        for _, method in ipairs { integrator.spectral {}, integrator.dopri5 { tolerance = 1e-9 }, integrator.rk4 { h = turn / 3000 } } do
            local turns = {}
            for i = 1, 6 do turns[i] = i * turn end
            local run = expect({ I = 1, k = k, friction = law }, { theta0 = theta0, t_end = 2, integrator = method }, { events = 6, turn = turns, within = 1e-6, parts = 1e-5 })
            for i, event in ipairs(run.events) do near(math.abs(event.theta), theta0 - 2 * i * Rd / k, 1e-3) end
        end
    end
end)

-- Each period the mass slips a little less beyond its limit, until the rest is rounding.
test("a mass that a pulse moves less each period finally sticks, alone and beside others", function()
    local T, M0 = 1.6661962663265, 0.9242939044131
    local M = function(t) return t % T < 0.37 * T and M0 or -M0 / 2 end
    local run = expect({ I = 2, k = 9, C = 0.35, friction = friction.stribeck{ Rd = 0.52, Re = 0.81, speed = 0.22 } }, { M = M, t_end = 400 * T }, { theta = (M0 - 0.81) / 9, within = 1e-15 })
    assert(run.events[#run.events].t < 60)

    -- Here a body and the freewheel behind it leave together.
    local rig = system{ bodies = {
        a = { I = 1.2348302392074664, k = 7.067505931356604, C = 0.1601099096238591, friction = friction.stribeck{ Rd = 0.7431162703298131, Re = 0.8286578402037739, speed = 0.5105445003479095 } },
        b = { I = 1.8312269716371588, k = 7.067505931356604, C = 0.1784696596834161, friction = friction.stribeck{ Rd = 0.7360226583113975, Re = 0.8796659446932642, speed = 0.32106061224699917 } },
        c = { I = 1.7138111173793802, C = 0.05319277253916215, Rd = 0.43160320673749775, Re = 0.4474096104546757 } }, links = {
        l2 = { "a", "b", k = 4.404089616193799, C = 0.17476691211073508 },
        l3 = { "b", "c", k = 1.3183152629880002, C = 0.16569778919233047, friction = friction.freewheel{ Rd = 0.15217480957969656 } } } }
    local T, M0, part = 1.009509094013, 1.1213688179364354, 0.49062246478712
    expect(rig, { M = { b = function(t) return t % T < part * T and M0 or 0 end }, t_end = 300 * T }, { parts = false })
end)

local waves, by_panels = excitation.harmonic { amplitude = 0.8, omega = 0.7 }, integrator.spectral {}

test("a body between two contacts of equal strength neither moves nor hinders the others", function()
    local function run(Rd)
        return system { bodies = { a = { I = 0.5, Rd = Rd }, b = { I = 2 }, c = { I = 1, k = 2 } },
            links = { clutch = { "a", "b", Rd = 0.1 }, shaft = { "b", "c", k = 2, Rd = 0.5 } } }
            :simulate { M = { b = function(t) return 1.5 * math.sin(0.7 * t) end, c = -1 }, theta0 = { c = 0.2 }, t_end = 4 }
    end
    local held = run(0.2)
    for _, Rd in ipairs { 0.1, 0.1 + 1e-9 } do
        near(run(Rd).b.theta, held.b.theta, 1e-13)
        assert(run(Rd).a.theta:abs():max() < 1e-15)
    end
end)

test("the energy adds up under every law, and rows contain its friction", function()
    local function quadratic(v) return 0.25 + 0.1 * v ^ 2 end
    for name, case in pairs {
        coulomb = { friction.coulomb { Rd = 0.25, Re = 0.6 }, function() return 0.25 end },
        asymmetric = { friction.asymmetric { forward = { Rd = 0.1, Re = 0.3 }, backward = { Rd = 0.35, Re = 0.5 } }, function(v) return v > 0 and 0.1 or 0.35 end },
        stribeck = { stribeck, function(v) return 0.25 + 0.35 * math.exp(-(v / 0.4) ^ 2) end },
        tustin = { friction.stribeck { Rd = 0.25, Re = 0.6, speed = 0.4, shape = 1 }, function(v) return 0.25 + 0.35 * math.exp(-math.abs(v) / 0.4) end },
        table = { friction.table { speed = { 0, 0.5, 2 }, torque = { 0.45, 0.2, 0.35 }, Re = 0.6 }, function(v)
            v = math.abs(v)
            return v < 0.5 and 0.45 - 0.5 * v or math.min(0.35, 0.2 + 0.1 * (v - 0.5))
        end },
        ["function"] = { friction.law(quadratic, { Re = 0.6 }), quadratic },
    } do
        local law, torque = table.unpack(case)
        local run = expect({ I = 1, k = 1, C = 0.02, friction = law }, { M = waves, theta0 = 1.3, t_end = 60, dt = 0.5, integrator = by_panels },
            { within = 1e-15, closes = 1e-12, friction = function(t, of)
                local v = of.velocity[math.tointeger(t // 0.5) + 1]
                return v > 0 and -torque(v) or v < 0 and torque(v)
            end }, name)
        local total = run:energy().total
        assert(total.dry > 0.1 * total.flow and total.input > 0.1 * total.flow, name) -- what M did, not what it did less friction
    end
end)

finish()
