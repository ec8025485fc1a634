-- Motions far from the natural period: very overdamped, almost without a spring, along long records, with stiff or
-- growing feedback; and which systems exact accepts.
dofile "tests/lua/support.lua"

local exact, spectral = integrator.exact {}, integrator.spectral {}
local pi, exp = math.pi, math.exp
local function sine(amplitude, omega, phase) return excitation.harmonic { amplitude = amplitude, omega = omega, phase = phase } end

test("a motion near critical damping keeps its digits on both sides of it", function()
    for _, beyond in ipairs { -1e-3, -1e-8, -1e-13, 0, 1e-13, 1e-8, 1e-3, 0.1 } do
        local delta = (2 + beyond) / 2
        local square = (delta - 1) * (delta + 1)
        local w = math.sqrt(math.abs(square))
        local function even(t) return square > 0 and (exp(w * t) + exp(-w * t)) / 2 or math.cos(w * t) end
        local function odd(t)
            local x = square * t * t
            if math.abs(x) < 0.01 then return t * (1 + x / 6 * (1 + x / 20 * (1 + x / 42 * (1 + x / 72)))) end
            return (square > 0 and (exp(w * t) - exp(-w * t)) / 2 or math.sin(w * t)) / w
        end
        expect({ I = 1, k = 1, C = 2 + beyond }, { theta0 = 1, velocity0 = 0.5, t_end = 10, dt = 0.25, integrator = exact },
            { theta = function(t) return exp(-delta * t) * (even(t) + (0.5 + delta) * odd(t)) end, within = 8e-15 }, beyond)
    end
end)

-- Of I = k = 1 with C = 2e6 under sin(omega t): what it makes of the sine, and a free motion by its two parts.
local C, omega = 2e6, 1.5e-6
local fast = C / 2 + math.sqrt(C ^ 2 / 4 - 1)
local slow = 1 / fast
local real, imaginary = 1 - omega ^ 2, C * omega
local size = real ^ 2 + imaginary ^ 2
local function answer(t) return (real * math.sin(omega * t) - imaginary * math.cos(omega * t)) / size end
local function its_velocity(t) return omega * (real * math.cos(omega * t) + imaginary * math.sin(omega * t)) / size end
local function free(theta, velocity)
    local soon = -(velocity + slow * theta) / (fast - slow)
    return function(since) return (theta - soon) * exp(-slow * since) + soon * exp(-fast * since) end,
        function(since) return -slow * (theta - soon) * exp(-slow * since) - fast * soon * exp(-fast * since) end
end

test("a very overdamped motion over a million natural periods keeps its digits, and follows a linear M in a few arcs", function()
    local own, t_end, line = { I = 1, k = 1, C = C }, 6 * pi / omega, 1e-6
    local rest = free(0.75 - answer(0), -its_velocity(0))
    expect(own, { M = sine(1, omega), theta0 = 0.75, t_end = t_end, dt = t_end / 50, integrator = exact },
        { theta = function(t) return answer(t) + rest(t) end, within = 4e-15, closes = false }) -- its energy takes long
    -- The line's own answer is late by C/k; some roundings of numbers near 8.
    local to_line = free(0.75 + line * C, -line)
    expect(own, { M = excitation.polynomial { coefficients = { 0, line } }, theta0 = 0.75, t_end = 8e6, dt = 1.6e5, integrator = exact },
        { theta = function(t) return line * (t - C) + to_line(t) end, within = 2e-14 })
end)

test("a very overdamped mass slips when M passes Re, and stops at the right time", function()
    local run = system { I = 1, k = 1, C = C, Rd = 0.1 }:simulate { M = sine(1, omega), t_end = 3 / omega, integrator = exact }
    equal(table.concat(run.events.kind, " "), "slip stick slip")
    local slips = math.asin(0.1) / omega
    local _, velocity = free(0.1 - answer(slips), -its_velocity(slips))
    local before, after = 0.5 / omega, 3 / omega
    for _ = 1, 70 do
        local middle = (before + after) / 2
        if its_velocity(middle) + velocity(middle - slips) > 0 then before = middle else after = middle end
    end
    -- Radians of M: a few roundings of M.
    near(run.events[1].t * omega, slips * omega, 1e-15)
    near(run.events[2].t * omega, before * omega, 2e-14)
end)

test("an overdamped motion that comes from afar keeps its digits", function()
    -- theta = Rd/k + a free motion; it never turns. Each arc decays to exp(-4) of what it was.
    local I, C, k, Rd = 0.12, 1.25, 1.6, 1.8
    local delta = C / (2 * I)
    local fast = delta + math.sqrt(delta ^ 2 - k / I)
    local slow = k / I / fast
    for _, start in ipairs { 1e3, 1e6, 1e12, 1e24 } do
        local run = system { I = I, k = k, C = C, Rd = Rd }:simulate { theta0 = start, t_end = 100, dt = 0.5, integrator = exact }
        for i, t in ipairs(run.t) do
            local theta = Rd / k + (start - Rd / k) * (fast * exp(-slow * t) - slow * exp(-fast * t)) / (fast - slow)
            near(run.theta[i] / theta, 1, 2e-12)
        end
        equal(#run.events .. run.events[1].kind, "1rest")
        near(run.events[1].theta, Rd / k, 1e-14)
    end
end)

test("a mass at its limit under a load that decays for ever is not checked at every moment", function()
    -- It creeps to Rd/k = Re/k; the exponential is 1e-44 when it is there, and then 0. It would take hours.
    local own = { I = 0.12106475830078126, k = 1.5738525390625, C = 1.2460479736328125, Rd = 1.790374755859375 }
    local run = system(own):simulate { M = excitation.exponential { amplitude = 1.09492, tau = 0.18127, at = -17.8864 }, theta0 = 1e6, t_end = 1e12, dt = 1e12,
        integrator = exact }
    equal(run.outcome, "stuck at the end")
end)

-- ---- feedback

test("a stiff relaxation oscillator is followed through its jumps", function()
    local function M(t, theta, v) return 50 * (1 - theta ^ 2) * v end
    local run = nondimensional { zeta = 0.02 }:simulate { M = M, theta0 = 1.5, velocity0 = 0.2, t_end = 20 }
    -- Richardson's limit of classical Runge-Kutta in long double with 2 and 4 million steps.
    near(run:at(10), 1.143363102918, 1e-11)
    near(run:at(12), -1.98732282598, 2e-10)
    closes(run, nil, 1e-10)
end)

test("negative damping grows until overflow without false turns", function()
    for _, Rd in ipairs { 0, 0.3 } do -- both roots of the free motion are real and positive: it turns once at most
        local sys, M = nondimensional { zeta = 0.05, friction_ratio = Rd }, function(t, theta, v) return 2 * v end
        pcall(function() sys:simulate { M = M, theta0 = 1.5, velocity0 = 0.2, t_end = 20, dt = 20 / 64 } end)
        local run = dinal.partial
        equal(run.status .. #run.events, "failed1")
        assert(run.theta:abs():max() < math.huge and math.abs((run:at(run.t_end))) > 1e290)
        refused { { "run:energy()", "beyond the range" } }
    end
end)

test("feedback that pushes at rest and holds in motion keeps a body at rest by rk4 as by spectral", function()
    local function M(t, _, v) return 1.2 * math.sin(t) - 0.3 * exp(-math.abs(v) / 0.1) * (v > 0 and 1 or v < 0 and -1 or 0) end
    for _, zeta in ipairs { 0, 0.05 } do
        local function go(by) return nondimensional { zeta = zeta, friction_ratio = 0.3 }:simulate { M = unread(M), theta0 = 0.3, velocity0 = 0.2, t_end = 20, dt = 0.3, integrator = by } end
        local run, other = go(integrator.rk4 { h = 0.002 }), go(spectral)
        equal(run.outcome, "reached the end")
        equal(#run.events, #other.events) -- none for each of the motions that did not get under way
        equal(run.events[1].kind, "stick")
        near(run:at(20), (other:at(20)), 0.03) -- rk4 spreads a jump of feedback that is not read over a step
    end
end)

-- Damped with 3/(2 sqrt(101) I w0): at rest after some ten swings, to 100 roundings of its torques of 50.
moves("a system in equilibrium under feedback does not turn", nondimensional {},
    { M = function(t, theta, v) return 100 * (0.5 - theta) - 3 * v end, t_end = 200 }, { status = "end", most = 60, theta = 50 / 101, within = 1.1e-14, parts = false })

-- ---- a spring that is nearly absent

test("with a nearly absent spring, stops and turns follow the load, not T0", function()
    -- Under +-1 in turn, friction 0.3: accelerations of 0.7 and 1.3 make it turn 0.7/1.3 of half a period late.
    for _, k in ipairs { 1e-6, 1e-9, 1e-14, 1e-20 } do
        for _, M in ipairs { excitation.square { period = 1 }, function(t) return t - math.floor(t) < 0.5 and 1 or -1 end } do
            local run = system { I = 1, k = k, Rd = 0.3 }:simulate { M = M, t_end = 1000, dt = 15, integrator = spectral }
            equal(run.outcome .. #run.events, "reached the end1999", k)
            near(run.events[1].t, 0.5 + 0.5 * 0.7 / 1.3, 1e-5 * math.sqrt(k) + k + 1e-14)
        end
    end
    -- Slow enough for it to stop in each half: 0.3 of friction outweighs a load of 0.25 at rest.
    local run = system { I = 1, k = 1e-12, Rd = 0.3 }:simulate { M = excitation.square { amplitude = 0.4, period = 1, duty = 0.25 }, t_end = 20000, dt = 300, integrator = spectral }
    assert(run.status ~= "failed" and #run.events > 20000)
    local last
    for _, event in ipairs(run.events) do -- nothing but a slip ends a stick
        assert(not last or event.t >= last.t and (last.kind == "stick") == (event.kind == "slip"), event.t)
        last = event
    end
end)

-- ---- exact

test("exact names what it does not accept, and the default integrator follows the same rule", function()
    local sys = nondimensional { zeta = 0.1, friction_ratio = 0.2 }
    local duffing, slides = system { I = 1, k = 1, spring = spring.polynomial { [3] = 0.5 } }, system { I = 1, k = 0, Rd = 0.1 }
    local of_M = "integrator.exact{} supports only native terms other than chirp and gaussian: use integrator.spectral{}, which supports every M"
    for _, case in ipairs {
        { sys, excitation.chirp { from = 0, to = 1, duration = 1 }, of_M }, { sys, excitation.gaussian { sigma = 1 }, of_M },
        { sys, excitation.scripted(unread(math.sin)), of_M }, { sys, excitation.constant(1) },
        { slides, nil, "integrator.exact{} needs a spring: use integrator.spectral{} for k = 0" },
        { duffing, nil, "integrator.exact{} supports only the spring k theta: use integrator.spectral{}" },
    } do
        local own, M, sentence = table.unpack(case, 1, 3)
        local function go(by) return own:simulate { M = M, theta0 = 1, t_end = 1, dt = 1, integrator = by } end
        if sentence then raises(function() go(exact) end, sentence) else go(exact) end
        equal(tostring(go().integrator), tostring(sentence and spectral or exact))
    end
end)

test("along a record of samples exact integrates from line to line, whatever rows are requested", function()
    for _, uneven in ipairs { 0, 0.3 } do
        local t, M = {}, {}
        for i = 0, 1500 do
            t[i + 1] = (i + uneven * math.sin(1.7 * i)) / 50
            M[i + 1] = math.sin(5.1 * t[i + 1]) + 0.4 * math.sin(7.7 * t[i + 1] + 1)
        end
        for _, dry in ipairs { 0, 0.2, 0.9 } do
            local sys = nondimensional { zeta = 0.02, friction_ratio = dry }
            local function run(rows, by) return sys:simulate(merged({ M = excitation.samples { t = t, M = M }, theta0 = 0.4, velocity0 = 0.1, t_end = 29, integrator = by }, rows)) end
            local rows, other = run({ dt = 0.0037 }, exact), run({ dt = 0.0037 }, spectral)
            assert(#rows.events > 10)
            for _, name in ipairs { "theta", "velocity", "M", "friction" } do near(rows[name], other[name], 1e-11) end
            -- A row is written beside the motion, which does not see it.
            for _, same in ipairs { run({ times = {} }, exact), run({ times = vector(t):slice(1, 1400) }, exact) } do
                equal(same.events.t, rows.events.t)
                equal(same.events.theta, rows.events.theta)
                equal((same:at(29)), (rows:at(29)))
            end
            for i = 1, #rows, 7 do
                local theta, velocity = rows:at(rows.t[i])
                near(theta, rows.theta[i], 1e-14)
                near(velocity, rows.velocity[i], 1e-13)
            end
        end
    end
end)

-- A pulse shorter than 0.3 rad is told by its Taylor series, and the arc after it has a row as long after it.
local function stepped(since) return since > 0 and 1 - math.cos(since) or 0 end
moves("a row shortly after an arc given by a Taylor series has its exact angle", { I = 1, k = 1 },
    { M = excitation.pulse { at = 1, width = 0.125 }, theta0 = 1, t_end = 4, dt = 0.125, integrator = exact },
    { theta = function(t) return math.cos(t) + stepped(t - 1) - stepped(t - 1.125) end, within = 1e-15 })

test("along a record the angle does not accumulate rounding errors", function()
    -- A steady ramp, k theta = M - Rd, of 128 samples a time unit, exact in doubles; no event comes. Pulls of up to 300 are
    -- rounded to 2.8e-14, 128000 times, by chance: 1e-13 in theta.
    local t, v, Rd = vector.range(0, 128000) / 128, 0.3, 0.125
    local run = system { I = 1 / (4 * pi ^ 2), k = 1, Rd = Rd }:simulate { M = excitation.samples { t = t, M = Rd + v * t }, velocity0 = v, times = { 1000 }, integrator = exact }
    equal(#run.events, 0)
    near(run.theta[1], 1000 * v, 6e-13)
end)

finish()
