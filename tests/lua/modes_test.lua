-- Eigenvalues of the motion near a rest or a steady sliding.
dofile "tests/lua/support.lua"

test("a mass on a spring has its well-known pair of modes", function()
    local sys = system { I = 2, k = 8, C = 0.4 }
    local modes = sys:modes()
    equal(#modes, 1)
    near(modes[1].re, -0.1, 1e-14)
    near(modes[1].im, math.sqrt(4 - 0.01), 1e-14)
    near(modes[1].frequency, math.sqrt(4 - 0.01) / (2 * math.pi), 1e-14)
    near(modes[1].zeta, sys.zeta, 1e-14)
    equal(modes[1].shape.theta, 1.0)
    local slow = system { I = 1, k = 1, C = 2.5 }:modes() -- overdamped: -0.5 and -2
    near(slow[1].re, -2, 1e-13)
    near(slow[2].re, -0.5, 1e-13)
    equal(slow[1].im, 0.0)
    equal(#system { I = 1, k = 4, Rd = 1 }:modes(), 0) -- it sticks
end)

test("bodies have the modes of their matrices, also through gears", function()
    local rig = system { bodies = { a = { I = 1, k = 1 }, b = { I = 1, k = 1 } }, links = { rod = { "a", "b", k = 4 } } }
    local modes = rig:modes()
    near(modes[1].im, 1, 1e-14)
    near(modes[2].im, 3, 1e-14)
    near(modes[1].shape.b / modes[1].shape.a, 1, 1e-13)
    near(modes[2].shape.b / modes[2].shape.a, -1, 1e-13)
    -- Damping at one of them makes the other lead: shape + i quadrature is an eigenvector.
    local damped = system { bodies = { a = { I = 1, k = 4, C = 0.8 }, b = { I = 1, k = 4 } }, links = { rod = { "a", "b", k = 1 } } }
    for _, mode in ipairs(damped:modes()) do
        local re, im, s, q = mode.re ^ 2 - mode.im ^ 2 + 5, 2 * mode.re * mode.im, mode.shape, mode.quadrature
        near(re * s.b - im * q.b, s.a, 1e-12)
        near(re * q.b + im * s.b, q.a, 1e-12)
    end
    local n = 3
    local geared = system { bodies = { motor = { I = 2 }, load = { I = 5, k = 7 } }, links = { gear = { "motor", "load", ratio = n, rigid = true } } }
    local mode = geared:modes()[1]
    near(mode.im, math.sqrt(7 / (5 + 2 * n ^ 2)), 1e-14)
    equal(mode.shape.motor, 1.0)
    near(mode.shape.load, 1 / n, 1e-15)
    local held = system { bodies = { a = { I = 1, k = 1 }, b = { I = 1, Rd = 5 } }, links = { rod = { "a", "b", k = 3 } } }
    near(held:modes()[1].im, 2, 1e-14)
end)

test("dry friction and the jump of a spring or a load hold a mass together", function()
    local function step(theta) return theta > 0 and 1 or -1 end
    equal(#system { I = 1, k = 1, Rd = 0.2, spring = step }:modes { M = 1.1 }, 0)
    equal(#system { I = 1, k = 1, Rd = 0.2 }:modes { M = function(t, theta) return -step(theta) end }, 0)
    local held = system { bodies = { a = { I = 1, k = 1, Rd = 0.2, spring = step }, b = { I = 1, k = 2 } }, links = { rod = { "a", "b", k = 1 } } }
    near(held:modes()[1].im, 3 ^ 0.5, 1e-13)
    refused {
        { "system { I = 1, k = 1, Rd = 0.2, spring = step }:modes { M = 1.3 }", "there is no rest" },
        { "system { I = 1, k = 1, Rd = 0.2, spring = function(theta) return -step(theta) end }:modes()", "there is no rest" },
    }
end)

test("in the modes at a rest a slider and a pressed elastic wall are springs, and an open contact has no effect", function()
    local rows = { -- what the body has beside I and k, and its load, and the stiffness of all
        { { friction = { friction.jenkins { stiffness = 5, Rd = 1 }, friction.jenkins { stiffness = 2, Rd = 1 } } }, 0, 11 },
        { { walls = { lower = -0.5, upper = 0.5, stiffness = 12 } }, -8, 16 },
        { { walls = { lower = -0.5, upper = 0.5, stiffness = 12 } }, 8, 16 },
        { { Rd = 9, normal = function() return -1 end }, 1, 4 },
    }
    for _, row in ipairs(rows) do
        near(system(merged({ I = 1, k = 4 }, row[1])):modes { M = row[2], theta0 = row[2] / 4 }[1].im, row[3] ^ 0.5, 1e-9)
    end
end)

test("friction that falls with the speed drives a mass on a belt", function()
    local law = { Rd = 0.3, Re = 0.6, speed = 0.1 }
    local sys = system { I = 1, k = 4, C = 0.2, friction = friction.stribeck(law) }
    local slope = -2 * 0.3 * math.exp(-1) / 0.1 -- of the torque by the speed, at the speed 0.1
    local mode = sys:modes { belt = 0.1 }[1]
    near(mode.re, -(0.2 + slope) / 2, 1e-9)
    near(mode.im, math.sqrt(4 - mode.re ^ 2), 1e-9)
    assert(mode.zeta < 0)
    -- What it tells is how a small motion grows: a run from beside the rest.
    local rest = 0.3 + 0.3 * math.exp(-1)
    local run = sys:simulate { belt = 0.1, theta0 = rest / 4 + 1e-6, t_end = 3, velocity0 = 0 }
    local x = run.theta - rest / 4
    local t = run.t[#run]
    local function wanted(t) return 1e-6 * math.exp(mode.re * t) * (math.cos(mode.im * t) - mode.re / mode.im * math.sin(mode.im * t)) end
    near(x[#run], wanted(t), 1e-8)
end)

test("modes use nonlinear springs and feedback linearised at the rest, and include states", function()
    local sys = system { I = 1, k = 0, spring = spring.polynomial { [1] = 1, [3] = 1 } }
    near(sys:modes { M = 2, theta0 = 1 }[1].im, 2, 1e-9) -- rest at 1: 1 + 3
    local fed = system { I = 1, k = 4 }:modes { M = function(t, theta, velocity) return 0.6 * velocity end }
    near(fed[1].re, 0.3, 1e-10)
    local slow = system { I = 1, k = 4 }:modes { M = function(t, theta, velocity, z) return z.u end, states = { u = { rate = function(t, theta, velocity, z) return -theta - z.u end } } }
    equal(#slow, 2)
    refused {
        { "system { I = 1, k = 0 }:modes { M = 1 }", "nothing holds the bodies" },
        { "system { I = 1, k = 0, Rd = 1 }:modes { M = 2 }", "would have to hold 2, but holds 1" },
    }
    local function timed(t, theta) return theta * math.cos(t) end
    for _, M in ipairs { excitation.harmonic { omega = 1 }, excitation.step { at = 1 }, timed } do
        refused { { "system { I = 1, k = 1 }:modes { M = M }", "M must be constant" } }
    end
    local function brakes(_, _, velocity) return -velocity end
    for _, M in ipairs { excitation.sampled(brakes, { every = 0.1 }), excitation.delayed(brakes, { by = 0.1 }) } do
        refused { { "system { I = 1, k = 1 }:modes { M = M }", "do not include controllers" } }
    end
    refused { { "system { I = 1, k = 1, Rd = 1, normal = function(t) return 1 + t end }:modes { belt = 1 }", "normal must be constant" } }
end)

test("a clutch that holds is rigid, sliding becomes unstable at the Hopf point of the response, and states have modes", function()
    local rig = system { bodies = { a = { I = 1, k = 8 }, b = { I = 1 } }, links = { clutch = { "a", "b", Rd = 100 } } }
    local m = rig:modes()
    near(m[#m].im, 2, 1e-12)
    local hysteresis = system { I = 1, k = 1, friction = friction.jenkins { stiffness = 3, Rd = 1 } }
    near(hysteresis:modes()[1].im, 2, 1e-9)
    near(hysteresis:modes { belt = 0.1 }[1].im, 1, 1e-9) -- its slider slides
    m = system { bodies = { a = { I = 1 }, b = { I = 3 } }, links = { rod = { "a", "b", k = 3 } } }:modes()
    near(m[#m].im, 2, 1e-12)
    local sys = system { I = 1, k = 1, C = 0.1, friction = friction.stribeck { Rd = 0.5, Re = 1, speed = 0.3 } }
    local low, high = 0.55, 0.7
    for _ = 1, 40 do
        local middle = (low + high) / 2
        if sys:modes { belt = middle }[1].re > 0 then low = middle else high = middle end
    end
    near(low, 0.6168, 5e-5)
    -- theta'' = -z - 2 theta', z' = theta: lambda^3 + 2 lambda^2 + 1 = 0.
    m = system { I = 1, k = 0 }:modes { M = function(t, theta, velocity, z) return -z.e - 2 * velocity end,
        states = { e = { start = 0, rate = function(t, theta) return theta end } } }
    equal(#m, 2)
    for _, one in ipairs(m) do
        local re, im = one.re, one.im
        near(re ^ 3 - 3 * re * im ^ 2 + 2 * (re ^ 2 - im ^ 2) + 1, 0, 1e-7)
        near(3 * re ^ 2 * im - im ^ 3 + 4 * re * im, 0, 1e-7)
    end
end)

test("the rest is found at an elastic stop, on a spring without a slope at theta0, and refused beyond a wall", function()
    local stop, cubic = { lower = -0.2, upper = 0.1, stiffness = 20, damping = 0.3 }, spring.polynomial { [3] = 1 }
    for _, case in ipairs {
        { { I = 2, k = 4, walls = stop }, 0.3, 4 },
        { { I = 2, k = 4, walls = stop }, 0.5, 24 },
        { { I = 2, k = 4, walls = stop }, -1, 24 },
        { { I = 2, k = 0, walls = stop }, -1, 20 },
        { { I = 2, k = 0, spring = cubic }, -5, 3 * 5 ^ (2 / 3) },
    } do
        local own, M, stiffness = table.unpack(case)
        local m = system { bodies = { a = own } }:modes { M = { a = M } }[1]
        near(m.re ^ 2 + m.im ^ 2, stiffness / 2, 1e-9)
    end
    local walls = { lower = -0.2, upper = 0.1 }
    near(system { I = 2, k = 4, walls = walls }:modes { M = 0.3 }[1].im ^ 2, 2, 1e-12)
    refused { { "system { I = 2, k = 4, walls = { lower = -0.2, upper = 0.1 } }:modes { M = 0.5 }", "no rest between the walls" } }
end)

finish()
