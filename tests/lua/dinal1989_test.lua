-- integrator.dinal1989 against a transcription of the listing of 1989 and the numbers of chapter 6 of the report.
dofile "tests/lua/support.lua"

local pi = math.pi
local function by_1989(h, stop, slip) return integrator.dinal1989 { h = h, stop = stop, slip = slip } end
local function sg(x) return x == 0 and 0 or x / math.abs(x) end

-- The loop DO 80 of the listing, transcribed line by line, all in double, with 2 pi in full. U = theta, V = T0 theta',
-- T = t/T0 (k = 1 = Mc, T0 = 1 in the systems below); M* = amplitude sin(2 pi r T).
local function listing(p)
    local A, B, C, K = 2 * p.zeta * 2 * pi, p.gamma * 4 * pi * pi, 4 * pi * pi, p.h
    local U, V, T = p.theta0, p.velocity0, 0
    local function F(t) return 4 * pi * pi * (p.amplitude * math.sin(2 * pi * p.r * t)) end
    local function Q1(Y) return K * Y end
    local function Q2(X, Y, Z) return K * (Z - C * X - B * sg(Y) - A * Y) end
    local function step()
        local X, Y, Z = U, V, F(T)
        local Q11, Q21 = Q1(Y), Q2(X, Y, Z)
        X, Y, Z = U + Q11 / 2, V + Q21 / 2, F(T + K / 2)
        local Q12, Q22 = Q1(Y), Q2(X, Y, Z)
        X, Y = U + Q12 / 2, V + (p.slip and Q21 or Q22) / 2
        local Q13, Q23 = Q1(Y), Q2(X, Y, Z)
        X, Y, Z = U + Q13, V + Q23, F(T + K)
        local Q14, Q24 = Q1(Y), Q2(X, Y, Z)
        local U1, V1 = U, V
        U, V, T = U + (Q11 + 2 * Q12 + 2 * Q13 + Q14) / 6, V + (Q21 + 2 * Q22 + 2 * Q23 + Q24) / 6, T + K
        local slow = p.stop == "listing" and math.abs(V) <= math.abs(V1 - V) or p.stop == "text" and math.abs(V) < math.abs(V1 - V) / 2
        if slow and math.abs(F(T) - C * U) <= p.Re * 4 * pi * pi then U, V = U1, V1 end
    end
    return function() step() return U, V end
end

test("dinal1989 agrees with a plain transcription of the listing over hundreds of steps", function()
    local fields = { "zeta", "gamma", "Re", "amplitude", "r", "theta0", "velocity0", "h" }
    for n, numbers in ipairs {
        { 0.239, 0, 0, 0, 1, 0, 2 * pi, 0.01 }, { 0, 0.167, 0.167, 0, 1, 0, 2 * pi, 0.001 }, { 0, 0.167, 0.167, 1, 1, 1, 0, 0.01 },
        { 0, 0.836, 0.836, 1, 1, 1, 0, 0.01 }, { 0.119, 0.06, 0.06, 0, 1, 0, 2 * pi, 0.002 }, { 0.119, 0.418, 0.45, 1, 1, 1, 0, 0.01 },
        { 0, 0.5, 0.5, 1, 1.35, 1, 0, 0.01 }, { 0.05, 0.3, 0.6, 1, 0.3, 0, 0, 0.007 },
    } do
        local p = {}
        for i, field in ipairs(fields) do p[field] = numbers[i] end
        for _, stop in ipairs { "listing", "text" } do
            for _, slip in ipairs { false, true } do
                p.stop, p.slip = stop, slip
                local next_one, U, V = listing(p), p.theta0, p.velocity0
                local run = nondimensional { zeta = p.zeta, friction_ratio = p.gamma, breakaway_ratio = p.Re }:simulate {
                    M = excitation.harmonic { amplitude = p.amplitude, omega = 2 * pi * p.r }, theta0 = p.theta0, velocity0 = p.velocity0, t_end = 700 * p.h, dt = p.h,
                    integrator = by_1989(p.h, stop, slip) }
                equal(#run, 701)
                local function same(found, wanted, within, name, i) assert(math.abs(found - wanted) <= within, ("case %d, %s, %s, %s in row %d"):format(n, stop, slip, name, i)) end
                for i = 1, 701 do
                    -- 2 pi has 12 digits in the listing, which dinal keeps: 7e-14 of the 44 rad of 7 periods.
                    same(run.theta[i], U, 2e-11, "theta", i)
                    same(run.velocity[i], V, 2e-10, "velocity", i)
                    same(run.M[i], p.amplitude * math.sin(2 * pi * p.r * (i - 1) * p.h), 1e-11, "M", i)
                    same(run.friction[i], -p.gamma * sg(V), 0, "friction", i)
                    U, V = next_one()
                end
                -- An event is recorded at the end of the step in which the velocity has changed its sign.
                for _, event in ipairs(run.events) do
                    local i = math.floor(event.t / p.h + 0.5) + 1
                    equal(event.theta, run.theta[i])
                    assert(event.kind ~= "turn" or run.velocity[i - 1] * run.velocity[i] < 0)
                end
            end
        end
    end
end)

test("one wrong index in stage 3 gives the numbers of chapter 6 of the 1989 report", function()
    -- In units of 1, not of T0, which is 0.99998 with k = 39.48: the last digits tell.
    for _, case in ipairs { { 0.1, 5, -1.0143600, 5e-8 }, { 0.01, 50, -1.0000161, 5e-8 }, { 0.001, 500, -1.000000014, 5e-10 } } do
        local h, n, theta, within = table.unpack(case)
        near(system { I = 1, k = 39.48 }:simulate { theta0 = 1, times = { n * h }, integrator = by_1989(h, nil, true) }.theta[1], theta, within)
    end
end)

--- The geometric mean growth per step of a free motion, over many steps, in the phase plane.
local function growth(zeta, h, steps, slip)
    local run = nondimensional { zeta = zeta }:simulate { theta0 = 1, t_end = steps * h, dt = h, integrator = by_1989(h, nil, slip) }
    local function radius(i) return math.sqrt(run.theta[i] ^ 2 + (run.velocity[i] / (2 * pi)) ^ 2) end
    return (radius(#run) / radius(1)) ^ (1 / (#run - 1))
end

test("chapter 6 of the 1989 report: growth without damping, too slow a decay with it, and the steps from which it diverges", function()
    near(growth(0, 0.1, 2000, true), 1.0030, 5e-5)
    assert(growth(0, 0.1, 2000, false) < 1)
    near(growth(0.02387, 0.1, 1000, true), 0.98720, 2e-5)
    near(growth(0.02387, 0.1, 1000, false), 0.98480, 2e-5)
    near(math.exp(-0.02387 * 2 * pi * 0.1), 0.98511, 5e-6) -- the truth
    -- Without damping: 2 sqrt 2/w0 for Runge-Kutta, any step for the slip.
    for _, case in ipairs { { 0.02387, 0.195, 0.197, true }, { 0.02387, 0.456, 0.458, false }, { 0, 0.4500, 0.4503, false } } do
        local zeta, stable, unstable, slip = table.unpack(case)
        assert(growth(zeta, stable, 2000, slip) <= 1 and growth(zeta, unstable, 2000, slip) > 1, unstable)
    end
    assert(growth(0, 0.05, 2000, true) > 1)
end)

test("a step far beyond stability is a result of dinal1989, not an error", function()
    local run = nondimensional {}:simulate { theta0 = 1, t_end = 5000, dt = 1, integrator = by_1989(1) }
    has(run.outcome, "the state became infinite")
    assert(#run > 10 and run.theta:abs():max() < math.huge)
    refused { { "nondimensional {}:simulate { theta0 = 1, t_end = 50, dt = 1, integrator = integrator.rk4 { h = 1 } }", "stability limit" } }
end)

test("the last row of dinal1989 is the state at t_end, not that of the step beyond it", function()
    -- h = dt = 0.03 does not divide 0.1: the last row lies inside the fourth step.
    local run = nondimensional {}:simulate { theta0 = 1, t_end = 0.1, dt = 0.03, integrator = by_1989(0.03) }
    equal(run.t[#run], 0.1)
    near(run.theta[#run], math.cos(0.2 * pi), 1e-4)
end)

finish()
