dofile "tests/lua/support.lua"

local duffing = spring.polynomial { [3] = 0.5 }

test("a spring is an option of a system, and the system's text reproduces it", function()
    for _, own in ipairs {
        duffing, spring.polynomial { [1] = -1, [2] = 0.25, [5] = 3 }, function(theta) return 0.5 * theta ^ 3 end,
    } do
        local sys = system { I = 1, k = 1, C = 0.1, Rd = 0.2, spring = own }
        local again = load("return " .. tostring(sys))()
        equal(tostring(again), tostring(sys))
        equal(again.spring:torque(2), sys.spring:torque(2))
    end
    equal(tostring(system { I = 1, k = 0, spring = duffing }), "system{ I = 1, k = 0, spring = spring.polynomial{ [3] = 0.5 } }")
    equal(tostring(spring.polynomial { -1, 0, 2 }), "spring.polynomial{ [1] = -1, [3] = 2 }")
    equal(system { I = 1, k = 1 }.spring, nil)
    equal(system { I = 1, k = 1, spring = spring.polynomial {} }.spring, nil)
end)

test("with changes a spring, or removes it", function()
    local sys = system { I = 1, k = 1, Rd = 0.1, spring = duffing }
    equal(tostring(sys:with { k = 2 }.spring), tostring(duffing))
    equal(sys:with { spring = spring.polynomial {} }.spring, nil)
    near(nondimensional { zeta = 0.1 }:with { spring = duffing }.spring:torque(2), 4, 0)
    equal(sys.dead_zone, nil)  -- Re/k is none any more
end)

test("a spring that fails is reported with the angle and its line, and the rows until then are kept", function()
    local soft = system { I = 1, k = 1, spring = function(theta) return theta < 1.5 and theta or nil end }
    for _, method in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.01 }, integrator.dopri5 { tolerance = 1e-9 } } do
        raises(function() soft:simulate { velocity0 = 4, t_end = 20, dt = 0.01, integrator = method } end,
            "spring_test.lua:", ": spring returned nil at theta = 1.", "; it must return a finite number")
        assert(#dinal.partial > 10)
    end
    for message, own in pairs {
        ["spring returned nil at theta = 0"] = function() return nil end,
        ["nan at theta = 0"] = function() return 0 / 0 end,
        ["no spring"] = function() error("no spring") end,
        ["system: spring must be a function of theta, or a spring such as"] = 3,
    } do
        raises(function() system { I = 1, k = 1, spring = own } end, message)
    end
end)

test("each mistake in a spring is one sentence with the name of the option", function()
    refused { { "spring.polynomial(3)", "spring.polynomial takes a table of powers of theta, got 3" } }
    refuses(spring.polynomial, {
        { { [0.5] = 1 }, "the power 0.5 must be a whole number from 1 to 31" },
        { { [32] = 1 }, "the power 32 must be" },
        { { [0] = 1 }, "the power 0 is a constant torque, not a spring" },
        { { cubic = 1 }, "the power the string \"cubic\" must be" },
        { { [3] = "a" }, "[3] must be a finite number, got the string" },
        { { [3] = 1 / 0 }, "[3] must be a finite number, got inf" },
    })
    refused { { "duffing.c = 2", "a spring cannot be changed" } }
end)

test("a motion that a softening spring releases ends with a message about the motion, not about M", function()
    local sys = system { I = 1, k = 40, C = 1, Rd = 8, spring = spring.polynomial { [3] = -4 } }
    for _, M in ipairs { 40 * excitation.harmonic { frequency = 0.5 }, excitation.constant { amplitude = 200 } } do
        for _, with in ipairs { integrator.spectral {}, integrator.rk4 { h = 1e-3 } } do
            local run = sys:simulate { M = M, t_end = 20, dt = 0.1, integrator = with }
            has(run.outcome, "the state became infinite")
            says(run, "stopped early, at t = ", ": the state became infinite")
        end
    end
end)

test("a spring that fails while the mass rests between walls ends the run with the reason", function()
    local function brittle(theta)
        if theta > 0.5 then error("too far") end
        return theta
    end
    raises(function() system { I = 1, k = 1, Rd = 0.1, spring = brittle, walls = { upper = 1.5 } }:simulate { theta0 = 1, t_end = 2, dt = 0.1 } end, "too far")
end)

-- A spring with preload, from starts on its jump and off it; the same torque as a part of M is the peer.
test("a spring that jumps does what the same function does in M, and holds the mass on its jump", function()
    local function preload(theta) return 0.4 * (theta > 0 and 1 or -1) end
    local function drive(t) return 0.7 * math.sin(1.3 * t) end
    for _, Rd in ipairs { 0, 0.2 } do
        for _, theta0 in ipairs { 0, 0.7 } do
            local options = { theta0 = theta0, t_end = 20, times = {} }
            local loaded = system { I = 1, k = 2, C = 0.2, Rd = Rd }:simulate(merged(options, {
                M = function(t, theta) return 0.7 * math.sin(1.3 * t) - 0.4 * (theta > 0 and 1 or -1) end }))
            for _, with in ipairs { integrator.spectral {}, integrator.dopri5 { tolerance = 1e-9 } } do
                local sprung = system { I = 1, k = 2, C = 0.2, Rd = Rd, spring = preload }
                near(sprung:simulate(merged(options, { M = drive, integrator = with })):at(20), loaded:at(20), 1e-7)
            end
        end
    end
    local run = system { I = 1.6, k = 5.5, C = 8, spring = preload }:simulate { M = 0.2, theta0 = 0.05, t_end = 20 }
    near(run:at(20), 0, 1e-12)
    local linked = pair({ I = 1 }, { I = 1, k = 3, C = 2 }, { k = 2, C = 6, spring = preload })
    local held = linked:simulate { M = { b = 0.3 }, t_end = 60 }
    near(held.a:at(60) - held.b:at(60), 0, 1e-12)
    near(held.b:at(60), 0.1, 1e-6)
end)

test("the energy of a spring like a staircase is its integral, also where samples are symmetric", function()
    local sys = system { I = 2, k = 0, spring = function(x) return 0.5 * math.floor(x / 0.1) end }
    local function integral(x)
        local n = math.floor(x / 0.1)
        return 0.025 * n * (n - 1) + 0.5 * n * (x - 0.1 * n)
    end
    for _, theta in ipairs { 0.05, 0.15, 0.475, 0.95, 1.0393, -0.05, -1.318, 1.52 } do
        local start = sys:simulate { theta0 = theta, t_end = 1e-9 }:energy().start
        near(start.spring, integral(theta), 1e-13)
    end
end)

test("the energy of springs is their integral and adds up", function()
    for i, case in ipairs {
        { spring.polynomial { [3] = 0.5 }, function(x) return x ^ 4 / 8 end },
        { spring.polynomial { [1] = -0.5, [2] = 0.2, [5] = 0.3 }, function(x) return -x ^ 2 / 4 + x ^ 3 / 15 + x ^ 6 / 20 end },
        { math.sin, function(x) return 1 - math.cos(x) end },
        { function(x) return math.abs(x) < 0.3 and 0 or 4 * (x - (x > 0 and 0.3 or -0.3)) end, function(x) return 2 * math.max(0, math.abs(x) - 0.3) ^ 2 end },
    } do
        local run = expect({ I = 1, k = 0.8, C = 0.03, Rd = 0.05, Re = 0.1, spring = case[1] },
            { M = excitation.harmonic { amplitude = 0.8, omega = 0.7 }, theta0 = 1.3, t_end = 60, dt = 0.5 }, { closes = 1e-11 }, i)
        local energy = run:energy()
        for row, theta in ipairs(run.theta) do near(energy.spring[row], 0.4 * theta ^ 2 + case[2](theta), 1e-14) end
        near(energy.error:abs():max(), 0, 1e-11 * energy.total.flow)
    end
end)

test("the steady motion of Duffing's oscillator is the limit of a long run, or a place where the spring pulls little enough", function()
    local M, period = excitation.harmonic { omega = 0.8 }, 2.5 * math.pi
    local sys = system { I = 1, k = 1, C = 0.2, Rd = 0.05, spring = spring.polynomial { [3] = 1 } }
    local s, long = sys:steady { M = M }, sys:simulate { M = M, times = { 60 * period }, t_end = 60 * period }
    assert(s.status == "steady" and s.stable and s.symmetric)
    near(s.run.theta[1], long.theta[1], 1e-9)
    near(s.run.velocity[1], long.velocity[1], 1e-9)
    local rest = system { I = 1, k = 1, Rd = 0.5, spring = spring.polynomial { [3] = 1 } }:steady { M = 0.3 * M }.rest
    near(rest.upper + rest.upper ^ 3, 0.2, 1e-9)
    near(rest.lower, -rest.upper, 1e-9)
end)

finish()
