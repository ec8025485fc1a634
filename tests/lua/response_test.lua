-- sys:response, run:spectrum and run:poincare against closed forms. Run by dinal.
dofile "tests/lua/support.lua"

test("the response is Den Hartog's without stops, and continues with stops", function()
    local c = nondimensional{ friction_ratio = 0.5 }:response{ over = { frequency = vector.linspace(0.3, 2.1, 46) }, between = true }
    equal(#c, 47) -- and the resonance
    equal(c.frequency[1], 0.3)
    equal(c.frequency[47], 2.1)
    local compared = 0
    for i = 1, #c do
        local A = theory.den_hartog{ r = c.frequency[i], friction_ratio = 0.5 }
        if A and A < math.huge then
            near(c.amplitude[i], A, 1e-10 * math.max(1, A))
            compared = compared + 1
        elseif A then
            equal(c.status[i], "grows")
        else
            assert(c.stops[i] >= 2, c.frequency[i])
        end
        equal(c.stable[i], c.status[i] == "grows" and 0.0 or 1.0)
    end
    assert(compared > 20)
    has(c:plot{ show = false }, "frequency")
end)

local function linear(I, k, C, w) return 1 / math.sqrt((k - I*w^2)^2 + (C*w)^2) end

test("the parameter may be the frequency, omega, period or amplitude of a sine, or anything that at computes from it", function()
    local sys = system{ I = 2, k = 50, C = 1.5 }
    local frequency, w = vector{ 0.5, 0.8, 1.1 }, 2*math.pi*0.8
    local c = sys:response{ amplitude = 3, over = { frequency = frequency } }
    equal(c.frequency, frequency) -- and nothing between them
    for _, other in ipairs{
        { amplitude = 3, over = { omega = 2*math.pi*frequency } },
        { amplitude = 3, over = { period = 1/frequency } },
        { over = { frequency = frequency }, at = function(p) return { M = excitation.harmonic{ amplitude = 3, frequency = p.frequency } } end },
        { over = { f = frequency }, at = function(p) return { M = function(t) return 3*math.sin(2*math.pi*p.f*t) end, period = 1 / p.f } end },
    } do
        local d = sys:response(other)
        near(d.amplitude, c.amplitude, 1e-11)
        near(d.lag, c.lag, 1e-9)
    end
    near(c.amplitude[2], 3*linear(2, 50, 1.5, w), 1e-12)
    near(c.lag[2], math.atan(1.5*w, 50 - 2*w^2), 1e-11)
    for _, at in ipairs{ { frequency = 0.8 }, { omega = w }, { period = 1.25 } } do
        at.over = { amplitude = { 1, 2, 3 } }
        c = sys:response(at)
        near(c.amplitude, c.M0*linear(2, 50, 1.5, w), 1e-12)
    end
    c = sys:response{ over = { C = { 0.1, 0.5, 0.9 } },
        at = function(p) return { M = excitation.harmonic{ omega = w }, system = sys:with{ C = p.C } } end }
    for _, row in ipairs(c) do near(row.amplitude, linear(2, 50, row.C, w), 1e-12) end
end)

test("mistakes in a response are errors with a reason", function()
    local sys = system{ I = 2, k = 50, C = 1.5 }
    local one = { amplitude = { 1, 2 } }
    local function empty() return {} end
    refuses(function(o) sys:response(o) end, {
        { { over = { 1, 2 } }, "over[1] must be a name and its values" },
        { { over = {} }, "over must be a name and its values" },
        { { over = { frequency = { "a" } } }, "over.frequency must be a list of numbers" },
        { { over = { frequency = {} } }, "frequency has no values" },
        { { over = one, omega = 1, amplitude = 2 }, "amplitude is varied, and cannot be given as well" },
        { { over = { x = { 1 } }, at = empty, amplitude = 2 }, "amplitude and at exclude each other" },
        { { over = one, omega = 1, of = "a" }, "this system has no 'a': it has one body without a name" },
        { { over = { frequency = 3 } }, "over.frequency must be a vector or a table" },
        { { over = { frequency = { 1, -1 } } }, "frequency = -1 must be positive" },
        { { over = { a = { 1 }, b = { 1 }, c = { 1 } } }, "varies one or two", "sweep" },
        { { over = { a = { 1 } } }, "over.a needs at" },
        { { over = { { "a", { 1 } }, { "a", { 2 } } }, at = empty }, "two parameters 'a'" },
        { { over = { omega = { 1 }, period = { 1 } } }, "exclude each other" },
        { { over = { omega = { 1 } }, frequency = 1 }, "omega is varied" },
        { { over = { lag = { 1 } }, at = empty }, "'lag' is a column of the result" },
        { { over = one, frequency = 1, period = 1 }, "give one of frequency" },
        { { over = { a = { 1 } }, at = function() return 3 end }, "at returned 3 for a = 1" },
        { { over = { a = { 1 } }, at = function() return { m = 3 } end }, "no option 'm'" },
        { { over = { a = { 1 } }, at = function() return { M = "x" } end }, "at: M" },
    })
end)

test("elastic walls, a slider behind a spring and a normal load answer to a sine as to the same M by at", function()
    local frequencies = vector.linspace(0.3, 0.5, 3)
    local function normal(t) return 1 + 0.5 * math.sin(2 * math.pi * 0.4 * t) end
    for _, case in ipairs {
        { frequencies, { walls = { lower = -0.3, upper = 0.3, stiffness = 50, damping = 1 } } },
        { frequencies, { friction = friction.jenkins { stiffness = 10, Rd = 0.3 } } },
        { { 0.4 }, { Rd = 0.3, normal = normal } },
        -- the greater of two motions, which its start decides
        { { 0.6 }, { C = 0.1, spring = spring.polynomial { [3] = 4 }, walls = { upper = 5, stiffness = 100 } }, { theta0 = 3 } },
    } do
        local sys, start = system(merged({ I = 1, k = 4, C = 0.2 }, case[2])), case[3]
        local c = sys:response(merged({ amplitude = 1, over = { frequency = case[1] } }, start))
        local by_at = sys:response(merged({ over = { f = case[1] }, at = function(p)
            return { M = excitation.harmonic { amplitude = 1, frequency = p.f }, frequency = p.f }
        end }, start))
        equal(#c, #by_at)
        for _, name in ipairs { "amplitude", "lag", "stable", "branch" } do near((c[name] - by_at[name]):abs():max(), 0, 1e-9) end
        assert(not start or c.amplitude[1] > 1)
    end
    local varies = system { I = 1, k = 4, C = 0.2, Rd = 0.3, normal = normal }
    refuses(function(o) varies:response(o) end, { { { over = { frequency = { 0.3 } } }, "period" } })
end)

test("folds, jumps and unstable branches are rows, and a picture in pieces", function()
    local sys = system{ I = 1, k = 1, C = 0.05, Rd = 0.02, spring = spring.polynomial{ [3] = 0.5 } }
    local c = sys:response{ amplitude = 0.5, over = { frequency = { 0.2, 0.3, 0.42 } } }
    equal(#c, 5)   -- 0.3 lies between the jumps: three motions
    local at = c:filter(function(row) return row.frequency == 0.3 end)
    equal(#at, 3)
    equal(at.stable:sum(), 2.0)
    equal(#c.jumps, 2)
    equal(table.concat(c.jumps.sweep, " "), "down up")
    assert(c.jumps.frequency[1] < 0.3 and c.jumps.frequency[2] > 0.3)
    has(picture(at), "unstable")
    local picture = tostring(c:plot{ overlay = "jumps", show = false })
    has(picture, "unstable", "jumps")
    refused {
        { 'c:plot{ overlay = "jump" }', "did you mean 'jumps'?" },
        { 'c:plot{ overlay = "linearised" }', "no overlay 'linearised' among jumps" },
        { 'data{ r = { 1 }, A = { 2 } }:plot{ overlay = "x" }', "nor any other" },
    }
end)

test("the theory curves beside a response are Den Hartog's and that of equivalent damping", function()
    local sys = system{ I = 1, k = 4, C = 0.1, Rd = 0.3 }
    local c = sys:response{ amplitude = 2, over = { frequency = vector.linspace(0.2, 0.5, 20) }, between = true }
    local exact, about = c.den_hartog, c.linearised
    equal(#exact, 400)
    for name, values in pairs { omega = { 1.5, 2 }, period = { 4, 3 } } do
        local other = sys:response{ amplitude = 2, over = { [name] = values } }.den_hartog
        local w = name == "omega" and other.omega[200] or 2*math.pi/other.period[200]
        near(other.amplitude[200], 2/4 * theory.den_hartog{ r = w/sys.omega0, zeta = sys.zeta, friction_ratio = 0.15 }, 1e-12)
    end
    local r = exact.frequency[200] * sys.T0
    near(exact.amplitude[200], 2/4 * theory.den_hartog{ r = r, zeta = sys.zeta, friction_ratio = 0.15 }, 1e-12)
    -- The work of M, pi M0 X sin(lag), is what both frictions take from a sine of this amplitude.
    for i = 1, 400, 57 do
        local X, w = about.amplitude[i], 2*math.pi*about.frequency[i]
        near(math.pi*2*X*math.sin(about.lag[i]), math.pi*0.1*w*X^2 + 4*0.3*X, 1e-12)
    end
    -- With a greater Re the motion without stops ends earlier, where its closed form does.
    sys = system{ I = 1, k = 4, C = 0.1, Rd = 0.3, Re = 1.6 }
    exact = sys:response{ amplitude = 2, over = { frequency = { 0.2, 0.5 } }, between = true }.den_hartog
    local without = 0
    for i = 1, 400 do
        local wanted = theory.den_hartog{ r = exact.frequency[i]*sys.T0, zeta = sys.zeta, friction_ratio = 0.15, breakaway_ratio = 0.8 }
        local there = exact.amplitude[i] == exact.amplitude[i]
        equal(there, wanted ~= nil)
        without = without + (there and 0 or 1)
    end
    assert(without > 5 and without < 200, without)
    local picture = tostring(c:plot{ overlay = { "linearised", "den_hartog" }, show = false })
    assert(picture:find("den_hartog"), picture)
    has(picture, "a amplitude", "linearised")
end)

test("a response is drawn up to its folds, and its rows stay those of the given values", function()
    local duffing = system{ I = 1, k = 1, C = 0.05, Rd = 0.05, spring = spring.polynomial{ [3] = 1 } }
    local values = vector.linspace(0.5, 2.5, 40)
    local c = duffing:response{ over = { r = values },
        at = function(p) return { M = excitation.harmonic{ amplitude = 0.5, omega = p.r } } end }
    for _, row in ipairs(c) do assert(values:find(function(r) return r == row.r end)) end
    near(c.points.r[1], 1.43675, 1e-5)
    local file = temporary ".svg"
    local function description(options)
        c:plot(merged({ file = file }, options))
        return io.open(file):read("a"):match "<desc>(.-)</desc>"
    end
    has(description {}, "unstable: a path from (2.5, 2.662) to (1.44")
    has(description { style = "points" }, #c .. " points")
end)

test("a spectrum shows each sine with its amplitude, whatever the window", function()
    local sys = system{ I = 1, k = 400, C = 40 }
    local M = excitation.harmonic{ amplitude = 4, frequency = 1 } + excitation.harmonic{ amplitude = 2, frequency = 2.5 } + 3
    local run = sys:simulate{ M = M, t_end = 24, dt = 1/64 }
    for _, window in ipairs{ "hann", "rectangle", "flat top" } do
        for _, from in ipairs{ 8 + 1/64, 8 } do -- from 8 to 24 it closes on itself, and has one row more than periods take
            local s = run:spectrum("M", { window = window, from = from })
            equal(#s, 513)
            near(s.frequency[17], 1, 1e-9)
            for line, amplitude in pairs{ [1] = 3, [17] = 4, [41] = 2, [100] = 0 } do near(s.amplitude[line], amplitude, 1e-9) end
        end
    end
    -- The flat top of ISO 18431-2 spreads a line over four to each side.
    local flat = run:spectrum("M", { window = "flat top", from = 8 }).amplitude
    for i, part in ipairs{ 1.933, 1.286, 0.388, 0.0322 } do near(flat[17 + i], 4 * part / 2, 1e-9) end
    equal(tostring(run:spectrum("M")):match("^[^\n]*"), "spectrum of M: 1536 rows, hann window")
    -- A prime number of rows is used as it is: 97 of them, 3 periods.
    local prime = sys:simulate{ M = excitation.harmonic{ amplitude = 4, frequency = 1 }, t_end = 3 * 96/97, dt = 3/97 }
    equal(#prime, 97)
    near(prime:spectrum("M").amplitude[4], 4, 1e-9)
    -- After the transient it is that of the steady motion.
    local settled = nondimensional{ zeta = 0.2 }:simulate{ M = excitation.harmonic{ frequency = 1 }, theta0 = 3, t_end = 40 }
    near(settled:spectrum{ from = 24 }.amplitude[17], theory.magnification{ r = 1, zeta = 0.2 }, 1e-9)
    -- One that comes near to its beginning is not closed.
    for drift, step in pairs{ [0] = 1, [1e-7] = 64/65 } do
        local record = sys:simulate{ M = function(t) return math.sin(2 * math.pi * t) + drift * t end, t_end = 1, dt = 1/64 }
        near(record:spectrum("M").frequency[2], step, 1e-12)
    end
    refused {
        { 'run:spectrum("tetha")', "did you mean 'theta'?" },
        { 'run:spectrum("theta", { of = "velocity" })', "the column is named twice" },
        { "run:spectrum{ segments = 4 }", 'segments are of method = "welch"' },
        { 'sys:simulate{ t_end = 3, times = { 0, 1, 1.5, 2, 2.2, 2.3, 2.4, 2.5, 2.6, 2.7, 2.8 } }:spectrum("M")', "evenly spaced" },
        { 'sys:simulate{ t_end = 3, dt = 1 }:spectrum("M")', "too few" },
        { "sys:simulate{ t_end = 3 }:spectrum{ from = 3 }", "from = 3 must be before the end of the run, t = 3" },
    }
end)

test("the motion is sampled densely enough for the fastest sine of M", function()
    local M = excitation.harmonic { frequency = 0.1 } + excitation.harmonic { amplitude = 4, frequency = 40 }
    local run = system { I = 1, k = 1, C = 0.2 }:simulate { M = M, t_end = 100, dt = 1 }
    local fast = run:spectrum { of = "velocity", from = 80, window = "flat top" }:filter(function(row) return row.frequency > 1 end)
    local i = fast.amplitude:argmax()
    near(fast.frequency[i], 40, 1e-9)
    near(fast.amplitude[i], 0.1 / (2 * math.pi), 1e-4)
end)

test("the spectrum of a motion does not depend on the rows", function()
    local sys = system{ I = 1, k = 4*math.pi^2, C = 1.5 }
    for _, omega in ipairs{ 2*math.pi, 20*math.pi } do
        local M = excitation.harmonic{ amplitude = 30, omega = omega }
        local amplitude = sys:steady{ M = M }.amplitude
        for _, dt in ipairs{ 1.003, 0.01 } do
            local s = sys:simulate{ M = M, t_end = 1003, dt = dt }:spectrum{ from = 103 }
            local i = s.amplitude:argmax()
            near(s.frequency[i], omega/2/math.pi, 1e-9)
            near(s.amplitude[i], amplitude, 1e-6*amplitude)
        end
    end
    local dry = system{ I = 1, k = 4*math.pi^2, C = 1.5, Rd = 16.5, Re = 18 }:simulate{
        M = function(t) return 30*math.sin(2*math.pi*t) end, theta0 = 1, t_end = 1003 }
    has(dry:spectrum{}, "spectrum of theta: 65536 samples of the motion, hann window")
    local lines = dry:spectrum{ from = 3 }
    near(lines.frequency[lines.amplitude:argmax()], 1, 1e-9)
    local uneven = sys:simulate{ theta0 = 1, t_end = 16, times = { 0, 1, 1.5, 15 } }:spectrum("velocity")
    assert(#uneven > 500)
end)

test("poincare samples a run once a period", function()
    local run = nondimensional{ zeta = 0.3 }:simulate{ M = excitation.harmonic{ frequency = 0.8 }, t_end = 50, dt = 10 }
    local d = run:poincare{ period = 1.25, from = 25 }
    equal(#d, 21)
    equal(d.t[21], 50.0)
    assert((d.theta - d.theta[1]):abs() < 1e-10)
    near(d.velocity[21], run.velocity[#run], 1e-10)
    -- M knows its period; a function does not, and a constant has none. The first look chooses the phase.
    equal(run:poincare{ from = 25 }.t[21], 50.0)
    near(run:poincare{ from = 25.3 }.theta[9], (run:at(35.3)), 1e-12)
    local function of(M) return nondimensional{}:simulate{ M = M, t_end = 2, dt = 1 } end
    refused { { "of(function(t) return t end):poincare{}", "has no known one" } }
    for _, M in ipairs{ 2, excitation.harmonic{ frequency = 0.8 }:window(0, 9) } do
        refused { { "of(M):poincare{}", "give a period" } }
    end
    local picture = tostring(d:plot{ show = false })
    equal(tostring(d:filter(function() return true end):plot{ show = false }), picture)
    assert(picture:find("^ *θ'") and picture:find("θ, Mc/k\n*$"), picture)
    refused {
        { "run:poincare{ period = 1, from = 60 }", "is not in the run" },
        { "run:poincare{ period = 1e-9 }", "samples are more than" },
    }
end)

test("a branch that ends at resonance has no jump", function()
    local c = system{ I = 1 / (4 * math.pi ^ 2), k = 1, Rd = 0.4, Re = 0.6 }:response{ over = { frequency = vector.linspace(0.05, 3, 100) }, between = true }
    for i = 1, #c.jumps do assert(c.jumps.from[i] < 1e6, c.jumps) end
end)

test("a mass that a softening spring releases is reported as growing, and the response has its rows on both sides", function()
    local sys = system{ I = 1 / (4 * math.pi^2), k = 1, C = 0.1 / math.pi, Rd = 0.2, spring = spring.polynomial{ [3] = -0.1 } }
    local c = sys:response{ over = { frequency = vector.linspace(0.3, 2.2, 30) }, between = true }
    near(c.frequency:max(), 2.2, 1e-12)
    equal(sys:steady{ M = excitation.harmonic{ frequency = 0.5 } }.status, "grows")
    equal(sys:steady{ M = function(t) return math.sin(math.pi * t) end, period = 2 }.status, "grows")
end)

test("a mass that adheres has nan stops, not 0", function()
    local c = nondimensional{ friction_ratio = 0.5 }:response{ over = { amplitude = { 0.2, 0.3, 2 } }, frequency = 0.5 }
    assert(c.status[1] == "adheres" and c.stops[1] ~= c.stops[1] and c.stuck[1] == 1)
    assert(c.status[3] == "steady" and c.stops[3] == 0)
end)

test("a resonance without enough friction has no finite peak, whatever the points are", function()
    for _, range in ipairs{ { 0.5, 1.5 }, { 1.5, 0.5 } } do
        local c = nondimensional{ friction_ratio = 0.3 }:response{ over = { frequency = vector.linspace(range[1], range[2], 40) }, between = true }
        equal(#c, 41)
        for i, status in ipairs(c.status) do equal(status == "grows", c.frequency[i] == 1) end
        equal(c.amplitude:max(), math.huge)
    end
    for ratio, rows in pairs{ [0.8] = vector.linspace(0.5, 1.5, 40), [0.3] = vector.linspace(1.1, 1.5, 40) } do
        equal(#nondimensional{ friction_ratio = ratio }:response{ over = { frequency = rows }, between = true }, 40)
    end
end)

test("squeal begins at a Hopf point and ends at a fold, where the sliding of the cycle grazes the belt", function()
    local Rd, Re, C, v0 = 0.3, 0.6, 0.15, 0.3
    local squeal = system{ I = 1, k = 4, C = C, friction = friction.stribeck{ Rd = Rd, Re = Re, speed = v0 } }
    local c = squeal:response{ over = { speed = vector.linspace(0.4, 1, 13) }, at = function(p)
        assert(p.speed >= 0.4 and p.speed <= 1) -- nothing else is asked for
        return { belt = p.speed }
    end }
    equal(table.concat(c.points.kind, " "), "fold hopf")
    local function rows(speed)
        return c:filter(function(row) return math.abs(row.speed - speed) < 1e-9 end):sort("amplitude")
    end
    equal(#rows(0.5), 2) -- the cycle and the rest that is left
    equal(#rows(0.9), 1)
    equal(#rows(0.7), 3)
    local rest, unstable, cycle = rows(0.7)[1], rows(0.7)[2], rows(0.7)[3]
    equal(rest.status .. rest.stable .. unstable.stable .. cycle.stable, "rest1.00.01.0")
    equal(unstable.stops, 0)

end)

test("a response over two parameters is a response at each value of the first", function()
    local sys = system{ I = 1, k = 1, C = 0.1, spring = spring.polynomial{ [3] = 0.5 } }
    local M0, omega = vector{ 0.05, 0.2, 0.5 }, vector.linspace(0.8, 2.2, 8)
    local c = sys:response{ over = { amplitude = M0, omega = omega } }
    equal(table.concat(c.names, " "):sub(1, 18), "M0 omega amplitude")
    for _, amplitude in ipairs(M0) do
        local one, rows = sys:response{ amplitude = amplitude, over = { omega = omega } }, c:filter(function(row) return row.M0 == amplitude end)
        for _, name in ipairs{ "omega", "amplitude", "lag", "stable" } do equal(rows[name], one[name]) end
    end
    for _, point in ipairs(c.points) do
        local branch = c:filter(function(row) return row.branch == point.branch end)
        assert(branch.M0:min() == point.M0 and branch.M0:max() == point.M0)
    end
    -- Folds: Newton's method on the half period's map and its determinant, by Runge and Kutta's method.
    local folds = c.points:filter(function(p) return p.kind == "fold" and p.M0 == 0.5 end):sort("omega")
    near(folds.omega[1], 1.357937998722, 1e-8)
    near(folds.omega[2], 1.904583750464, 1e-8)
    -- The order may be given: at each frequency the amplitude is followed.
    local d = sys:response{ over = { { "omega", { 1.3 } }, { "amplitude", vector.linspace(0.05, 0.5, 10) } } }
    equal(d.names[2], "M0")
    equal(table.concat(d.points.kind, " "), "fold fold")
    for _, M0 in ipairs(d.points.M0) do
        local at = sys:response{ amplitude = M0, over = { omega = vector.linspace(1, 1.6, 7) } }
        near((at.points.omega - 1.3):abs():min(), 0, 1e-7)
    end
    local picture = tostring(c:plot{ overlay = "points", show = false })
    has(picture, "amplitude", "fold")
    has(c:plot{ x = "omega", y = "amplitude", show = false }, "unstable")
    -- A map shows the greatest stable amplitude where there are two.
    local map = temporary ".svg"
    c:plot{ x = "omega", y = "M0", z = "amplitude", file = map }
    local stable = c:filter(function(row) return row.stable == 1 end)
    has(read(map), ("greatest %.4g at"):format(stable.amplitude:max()))
    refused { { 'c:plot{ overlay = "jumps" }', "the overlay 'jumps' has no M0" } }
end)

test("limit cycles begin at a Hopf point: those of van der Pol", function()
    local c = system{ I = 1, k = 1 }:response{ over = { mu = vector.linspace(-0.5, 1, 16) }, between = true,
        at = function(p) return { M = function(_, theta, velocity) return (p.mu - theta^2) * velocity end, theta0 = 0.1 } end }
    equal(table.concat(c.points.kind, " "), "hopf")
    near(c.points.mu[1], 0, 1e-8)
    local at = c:filter(function(row) return row.mu == 1 end):sort("amplitude")
    equal(table.concat(at.status, " "), "rest steady")
    equal(tostring(at.stable), "vector{ 0, 1 }")
    near(at.amplitude[2], 2.00861986087484, 1e-9)   -- of the textbooks
    -- Near its beginning the amplitude is 2 sqrt(mu).
    local near_zero = c:filter(function(row) return row.status == "steady" and row.amplitude > 0.05 and row.amplitude < 0.5 end)
    assert(#near_zero > 3)
    for _, row in ipairs(near_zero) do near(row.amplitude, 2 * math.sqrt(row.mu), 1e-3 * row.amplitude) end
    -- A torque that lags behind the velocity begins them at mu = 0, too: (s^2 + 1)(s + 5) = 5 mu s.
    local lagging = system{ I = 1, k = 1 }:response{ over = { mu = { -0.5, 0.25, 1 } }, at = function(p)
        return { M = function(_, theta, _, z) return (p.mu - theta^2) * z.v end, theta0 = 0.1,
            states = { v = { rate = function(_, _, velocity, z) return 5 * (velocity - z.v) end } } }
    end }
    equal(table.concat(lagging.points.kind, " "), "hopf")
    near(lagging.points.mu[1], 0, 1e-6)
    equal(table.concat(lagging.status, " "), "rest rest rest steady steady")
end)

test("a branch that begins at a symmetric motion is right where the problem is symmetric no more", function()
    local plain, sine = system{ I = 1, k = 4, C = 0.2, Rd = 0.1 }, excitation.harmonic{ amplitude = 2, omega = 1.3 }
    local uneven = {
        spring = function(e) return plain:with{ spring = spring.polynomial{ [2] = e, [3] = 0.1 } } end,
        walls = function(e) return plain:with{ walls = { lower = -0.5, upper = 0.5 + e, restitution = 0.6 } } end,
    }
    for name, at in pairs(uneven) do
        local c = plain:response{ over = { e = { 0, 0.1, 0.2 } }, at = function(p) return { M = sine, system = at(p.e) } end }
        equal(#c, 3, name)
        for _, row in ipairs(c) do near(row.amplitude, at(row.e):steady{ M = sine }.amplitude, 1e-8) end
    end
end)

test("at a pitchfork the motion ceases to be symmetric", function()
    local sys = system{ I = 1, k = 1, C = 0.1, spring = spring.polynomial{ [3] = 1 } }
    local c = sys:response{ amplitude = 5, over = { omega = vector.linspace(0.5, 1, 26) } }
    local at = c.points:filter(function(p) return p.kind == "pitchfork" end).omega
    -- Newton's method on the half period's map and the determinant of its derivative + 1, by Runge and Kutta's method.
    near(at[1], 0.526373272182, 1e-8)
    near(at[#at], 0.902505230367, 1e-8)
    local one = system{ bodies = { a = { I = 1, k = 1, C = 0.1, spring = spring.polynomial{ [3] = 1 } } } }
    c = one:response{ over = { omega = vector.linspace(0.85, 1, 8) },
        at = function(p) return { M = { a = excitation.harmonic{ amplitude = 5, omega = p.omega } } } end }
    near(c.points:filter(function(p) return p.kind == "pitchfork" end).omega[1], 0.902505230367, 1e-8)
end)

test("at a torus point the forced oscillator of van der Pol neither damps nor feeds disturbances, by Liouville's formula", function()
    local mu, w = 0.5, 1.5
    local sys = system{ I = 1, k = 1 }
    local function at(p)
        return { M = function(t, theta, v) return mu * (1 - theta^2) * v + p.A * math.sin(w * t) end, period = 2*math.pi / w }
    end
    local c = sys:response{ over = { A = vector.linspace(4, 1, 13) }, at = at }
    equal(table.concat(c.points.kind, " "), "torus")
    local A = c.points.A[1]
    -- det D = exp of the integral of mu (1 - theta^2): one where the mean of theta^2 is 1.
    local function mean_square(amplitude)
        local point = at{ A = amplitude }
        local theta = sys:steady{ M = point.M, period = point.period }.run.theta
        return ((theta * theta):sum() - theta[1]^2) / (#theta - 1)
    end
    -- Just before it the motion is stable, so that steady finds it.
    near(2 * mean_square(A + 0.003) - mean_square(A + 0.006), 1, 2e-5)
end)

test("period doublings are located, and the branches of twice the period followed", function()
    local sys = system{ I = 1, k = 0, C = 0.3, spring = spring.polynomial{ [1] = -1, [3] = 1 } }
    local c = sys:response{ over = { amplitude = vector.linspace(0.25, 0.28, 7) }, omega = 1.2, theta0 = 1, doubled = true }
    equal(table.concat(c.points.kind, " "), "doubling")
    local M0, T = c.points.M0[1], 2 * math.pi / 1.2
    for _, off in ipairs{ -2e-5, 2e-5 } do -- a long run has this period, or twice it
        local run = sys:simulate{ M = excitation.harmonic{ amplitude = M0 + off, omega = 1.2 }, theta0 = 1,
            times = vector.range(5998, 6000) * T, t_end = 6000 * T }
        near(run.theta[3], run.theta[1], 1e-5)
        assert((math.abs(run.theta[3] - run.theta[2]) > 1e-3) == (off > 0))
    end
    assert(c.branch:max() >= 2) -- another one may be in the other well
    local function stable(branch) return c:filter(function(row) return row.M0 > M0 and row.branch == branch end).stable:sum() end
    equal(stable(1), 0.0)
    equal(stable(2), 3.0)
end)

test("Welch's density has the variance of flat noise, and the power of a sine", function()
    local n = 2^14
    local noise, t = vector.normal{ n = n, seed = 3, std = 0.5 }, vector.range(0, n - 1) * 0.01
    local run = system{ I = 1, k = 0 }:simulate{ M = excitation.samples{ t = t, M = noise }, times = t }
    local d = run:spectrum{ of = "M", method = "welch", segments = 31 }
    equal(table.concat(d.names, " "), "frequency density")
    equal(#d, n / 16 / 2 + 1 - (n / 16 % 2))
    local step = d.frequency[2]
    near(d.density:sum() * step, 0.25, 0.01)
    local middle = d.density[d.frequency:find(function(f) return f > 10 and f < 40 end)]
    near(middle:mean(), 0.25 / 50, 3e-4) -- the variance over all frequencies up to 50
    assert(middle:std() < 0.35 * middle:mean()) -- of one segment it would be 1
    local sine = system{ I = 1, k = 1 }:simulate{ M = excitation.harmonic{ amplitude = 3, frequency = 5 }, t_end = 40, dt = 0.01 }
    local s = sine:spectrum{ of = "M", method = "welch" }
    near(s.density:sum() * s.frequency[2], 4.5, 1e-2)
    near(s.frequency[s.density:argmax()], 5, s.frequency[2])
    equal(tostring(sine:spectrum("M")), tostring(sine:spectrum{ of = "M" }))
    refused { { 'sine:spectrum{ of = "M", method = "welch", segments = 3000 }', "4000 rows are too few for 3000 segments, which need 8 each" } }
end)

test("a period may be given as period, frequency or omega in every call", function()
    local sys = nondimensional{ friction_ratio = 0.4 }
    local function M(t) return math.sin(0.8 * math.pi * t) end
    local s = sys:steady{ M = M, period = 2.5 }
    near(sys:steady{ M = M, frequency = 0.4 }.amplitude, s.amplitude, 1e-12)
    near(sys:steady{ M = M, omega = 0.8 * math.pi }.amplitude, s.amplitude, 1e-12)
    refused { { "sys:steady{ M = M, omega = 1, period = 1 }", "exclude each other" } }
    local run = sys:simulate{ M = M, t_end = 60 }
    near(run:steady{ frequency = 0.4 }.amplitude, s.amplitude, 1e-9)
    equal(#run:poincare{ frequency = 0.4, from = 50 }, #run:poincare{ period = 2.5, from = 50 })
    equal(#run:poincare{ omega = 0.8 * math.pi, from = 50 }, 5)
end)

test("a motion stays on its branch before the fold, and leaves it after the fold", function()
    local sys = system{ I = 1, k = 1, C = 0.05, Rd = 0.1, spring = spring.polynomial{ [3] = 0.5 } }
    local c = sys:response{ amplitude = 0.5, over = { frequency = vector.linspace(0.19, 0.38, 8) } }
    local jump = c.jumps:filter(function(row) return row.sweep == "up" end)[1]
    for _, off in ipairs{ -2e-3, 2e-3 } do
        local f = jump.frequency + off
        local M = excitation.harmonic{ amplitude = 0.5, frequency = f }
        local start = sys:steady{ M = excitation.harmonic{ amplitude = 0.5, frequency = jump.frequency - 1e-4 }, theta0 = -jump.from }
        local run = sys:simulate{ M = M, theta0 = start.run.theta[1], velocity0 = start.run.velocity[1], t_end = 120 / f, dt = 120 / f, integrator = integrator.rk4{ h = 0.02 } }
        local high = run.events:filter(function(e) return e.t > 115 / f end).theta:abs():max()
        assert(off < 0 and high > 0.8 * jump.from or off > 0 and math.abs(high - jump.to) < 0.05 * jump.to, off .. ": " .. high)
    end
end)

test("with Re > Rd a mass breaks away where M passes Re, and comes to rest elsewhere on the way back", function()
    local sys = system{ I = 1, k = 1, C = 0.05, Rd = 0.2, Re = 0.3 }
    for _, up in ipairs{ true, false } do
        local jumps = sys:response{ frequency = 0.1, over = { amplitude = up and vector.linspace(0.02, 1.2, 31) or vector.linspace(1.2, 0.02, 31) } }.jumps
        equal(table.concat(jumps.sweep, " "), up and "down up" or "down")
        for _, jump in ipairs(jumps) do
            if jump.sweep == "up" then
                near(jump.M0, 0.3, 1e-8)
                equal(jump.from, 0.0)
            else -- just above it goes on moving, just below it does not
                equal(jump.to, 0.0)
                assert(jump.M0 < 0.3)
                local above = sys:steady{ M = excitation.harmonic{ amplitude = jump.M0 + 2e-3, frequency = 0.1 }, theta0 = jump.from }
                assert(above.status == "steady" and above.amplitude > 0.8 * jump.from)
            end
        end
    end
end)

test("a body that friction holds has no place on a branch, so the branch has no folds where it may stand elsewhere", function()
    local rig = system {
        bodies = {
            a = { I = 1.1, k = 1.7, C = 0.03, Rd = 0.22, Re = 0.37 }, b = { I = 0.34, k = 0.75, C = 0.03 },
            c = { I = 0.48, k = 3.5, C = 0.07, Rd = 0.55, Re = 0.56 },
        },
        links = { ab = { "a", "b", k = 2.3, C = 0.02 }, bc = { "b", "c", k = 0.7, C = 0.14 } },
    }
    local start = { theta0 = { a = 0.07, b = -0.17, c = -0.2 }, velocity0 = { a = 0.6, b = 1, c = -0.65 } }
    local function at(p) return { M = { a = excitation.harmonic { omega = p.omega, amplitude = 0.6 } }, theta0 = start.theta0, velocity0 = start.velocity0 } end
    local c = rig:response { over = { omega = vector.linspace(0.5, 0.95, 6) }, at = at }
    equal(#c.points, 0)
    equal(c["c.amplitude"]:max(), 0)
    for i = 1, #c do
        -- Where friction holds c makes no difference to a: each row is the motion of a rig in which c is a wall.
        local wall = system { bodies = { a = { I = 1.1, k = 1.7, C = 0.03, Rd = 0.22, Re = 0.37 }, b = { I = 0.34, k = 0.75 + 0.7, C = 0.03 + 0.14 } }, links = { ab = { "a", "b", k = 2.3, C = 0.02 } } }
        local s = wall:steady { M = { a = excitation.harmonic { omega = c.omega[i], amplitude = 0.6 } } }
        near(c["a.amplitude"][i], s.a.amplitude, 1e-3)
    end
end)

finish()
