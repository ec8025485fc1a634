-- identify: free decays without a guess, driven records, the size of errors, and invalid records.
dofile "tests/lua/support.lua"

local sys = system{ I = 1, k = 40, C = 0.3, Rd = 0.8 }
local decay = sys:simulate{ theta0 = 1, t_end = 8, dt = 0.02 }

test("an exact record identifies the system without a guess", function()
    for _, s in ipairs{ sys, system{ I = 1, k = 4, Rd = 0.3 }, system{ I = 1, k = 100, C = 1.5 }, system{ I = 1, k = 9, C = 0.1, Rd = 0.05 } } do
        local fit = identify{ data = s:simulate{ theta0 = -0.7, velocity0 = 1, t_end = 10, dt = 0.04 } }
        near(fit.omega0, s.omega0, 1e-7 * s.omega0)
        near(fit.zeta, s.zeta, 1e-7)
        near(fit.Rd_over_k, s.Rd / s.k, 1e-7)
        near(fit.theta0, -0.7, 1e-7)
        near(fit.velocity0, 1, 1e-6)
        near(fit.offset, 0, 1e-7)
        equal(table.concat(fit.silent), "Re")
        equal(fit.std_error.Re, nil)  -- 0 would claim that it is known
    end
end)

test("decays of all kinds are identified: 0.1 to 3 % of noise, from seconds to hours, Re = Rd or more", function()
    math.randomseed(7)
    local judged, part, ratio = judge()
    local records, accused = lots(100), 0
    for seed = 1, records do
        local I, k = 10^(4 * math.random() - 2), 10^(4 * math.random() - 2)
        local viscous = math.random() < 0.3 and 0 or 0.15 * math.random()^2
        local dry = math.random() < 0.3 and 0 or 0.1 * math.random()^2
        local s = system{ I = I, k = k, C = 2 * viscous * (I * k)^0.5, Rd = k * dry, Re = k * dry * (1 + 0.3 * (seed % 2)) }
        local t_end, std = (2 + 18 * math.random()) * s.T0, 0.001 * 30^math.random()
        local run = s:simulate{ theta0 = 1, velocity0 = s.omega0 * (2 * math.random() - 1), t_end = t_end,
            dt = t_end / math.random(100, 600) }
        local fit = identify{ data = record(run, seed, std, 0.3) }
        assert(fit.noise < std * (1 + 3 / (2 * #run)^0.5), tostring(s))
        accused = accused + (fit.misfit and 1 or 0)
        part, ratio = judged(fit, { omega0 = s.omega0, zeta = s.zeta, Rd_over_k = dry, offset = 0.3, theta0 = 1,
            velocity0 = run.velocity[1] })
    end
    assert(records < 30 or part >= 0.90 and part <= (records < 100 and 0.99 or 0.98) and ratio <= 1.3, part)
    assert(accused <= 1, accused) -- such a record fits the model
end)

test("given values have no error, and a misspelt field is an error", function()
    local fit = identify{ data = { time = decay.t, x = decay.theta }, velocity0 = 0 }
    equal(fit.velocity0, 0.0)
    equal(fit.std_error.velocity0, 0.0)
    refused { { "fit.error", "a fit has no field 'error'; did you mean 'std_error'?" } }
end)

test("errors are those of the least squares of a sine: in whole periods its parts are orthogonal", function()
    local omega, n, t_end = 2*math.pi, 2000, 20
    local swings = system{ I = 1, k = omega^2 }
    local run = swings:simulate{ theta0 = 1, t_end = t_end*(1 - 1/n), dt = t_end/n }
    local known = { data = record(run, 5, 0.01), I = 1, C = 0, Rd = 0, Re = 0 }
    local fit = identify(merged(known, { k = swings.k }))
    near(fit.error_if_right.offset, 2*fit.noise/n^0.5, 0.01*fit.error_if_right.offset)  -- a line at its first time: the zero may drift
    near(fit.error_if_right.theta0, fit.noise*(2/n)^0.5, 0.01*fit.error_if_right.theta0)
    near(fit.error_if_right.velocity0, omega*fit.noise*(2/n)^0.5, 0.01*fit.error_if_right.velocity0)
    fit = identify(known)  -- the bound of Rife and Boorstyn for a frequency whose phase is unknown
    near(fit.error_if_right.omega0, fit.noise/t_end*(24/n)^0.5, 0.01*fit.error_if_right.omega0)
    near(fit.error_if_right.k, 2*omega*fit.error_if_right.omega0, 1e-3*fit.error_if_right.k)
end)

test("a record that is cut off is fitted as such, and the fit says so", function()
    local run = system{ I = 1, k = 30, C = 0.1, Rd = 1.2 }:simulate{ theta0 = 1, t_end = 6, dt = 1/30 }
    local seen = noisy(run, 5, 0.01):map(function(x) return math.max(-0.4, math.min(0.4, x)) end)
    local fit = identify{ data = { t = run.t, theta = seen } }
    fits(fit, { omega0 = 30^0.5, zeta = 0.1 / 2 / 30^0.5, Rd_over_k = 0.04, theta0 = 1 })
    assert(fit.noise < 0.011)
    local stand = seen:find(function(x) return math.abs(x) == 0.4 end)
    local said = tonumber(tostring(fit):match "(%d+) samples have the extreme values of the record, as if it were clipped there")
    assert(said > 20 and said <= #stand, said)  -- two or three by chance are none
    has_not(identify{ data = record(run, 5, 0.01) }, "clipped")
    has_not(identify{ data = run }, "clipped")
end)

test("with I or k given a free decay identifies the torques, too", function()
    local fit = identify{ data = decay, I = 1 }
    near(fit.k, 40, 1e-6)
    near(fit.Rd, 0.8, 1e-6)
    near(fit.system.C, 0.3, 1e-6)
    near(identify{ data = decay, k = 20 }.I, 0.5, 1e-7)
    refused { { "identify{ data = decay }.k", "a free decay determines only ratios", "give I or k" } }
end)

test("a driven record with a known M identifies the free parameters", function()
    local M = function(t) return 0.3*math.sin(4*t) + 0.2*math.sin(9*t) end
    local s = system{ I = 0.02, k = 0.9, C = 0.01, Rd = 0.06 }
    local run = s:simulate{ M = M, t_end = 12, dt = 0.02 }
    local fit = identify{ data = record(run, 3, 0.002), M = M, I = 0.02, free = { "k", "C", "Rd" },
        theta0 = 0, velocity0 = 0 }
    fits(fit, { k = 0.9, C = 0.01, Rd = 0.06 })
    assert(fit.noise < 0.0023, fit.noise)
    equal(fit.I, 0.02)
    equal(#fit.residual, #run)
    has(fit:plot{ show = false }, "record")
end)

test("a record that is impossible is refused with a reason", function()
    local t = vector.linspace(0, 1, 20)
    refuses(identify, {
        { {}, "identify needs data" },
        { { data = "run.csv" }, "data must be what load gives for that file" },
        { { data = 3 }, "data must be data, a run, or a table of columns" },
        { { data = { t = t } }, "times and angles are needed" },
        { { data = { t = t, theta = t:slice(1, 5) } }, "20 times, but 5 angles" },
        { { data = { t = t, theta = 0 * t } }, "nothing moves in the record" },
        { { data = { t = 1 - t, theta = t } }, "times of the record must increase" },
        { { data = { t = t:slice(1, 4), theta = t:slice(1, 4) } }, "the record has 4 samples" },
        { { data = { t = t, theta = t }, theta = "y" }, "no column 'y'" },
        { { data = decay, free = { "Q" } }, "free has Q" },
        { { data = decay, I = 1, free = { "I" } }, "I is given" },
        { { data = decay, M = function() return 1 end, free = { "k" } }, "I is neither given nor in free" },
    })
    refused {
        { "identify{ data = decay }.zetaa", "did you mean 'zeta'?" },
        { "identify{ data = decay }.omega", "a fit has no field 'omega'; did you mean 'omega0'?" },
    }
    local function few(n)
        local times = vector.linspace(0, 1, n)
        return { t = times, theta = times:map(function(x) return math.cos(6 * x) end) }
    end
    identify { data = few(8) }
    refused { { "identify { data = few(7) }", "the record has 7 samples; for 6 unknowns at least 8 are needed" } }
end)

-- Decays of one or two swings: omega0 2 pi, noise of 1 to 2 %, 30 or 60 samples a second.
local short_decays = {
    { "rests at the second turn, held by Re", { I = 1, k = 40, C = 1, Rd = 5, Re = 9 }, dt = 1/60, std = 0.005 },
    { "the same with more noise", { I = 1, k = 40, C = 1, Rd = 5, Re = 9 }, dt = 1/30, std = 0.02 },
    { "rests at the second turn", { I = 1, k = 40, C = 0.3, Rd = 9 }, dt = 1/30, std = 0.01 },
    { "rests at the first turn", { I = 1, k = 40, C = 0.3, Rd = 15 }, dt = 1/30, std = 0.01, silent = "Rd_over_k Re theta0 offset" },
    { "held at the first turn by Re", { I = 1, k = 40, C = 2, Rd = 8, Re = 20 }, dt = 1/60, std = 0.005, silent = "Rd_over_k Re theta0 offset" },
    { "creeps", { I = 1, k = 40, C = 20, Rd = 2 }, dt = 1/30, std = 0.01, silent = "Rd_over_k Re theta0 offset" },
}

test("a decay of one or two swings has errors as wide as the valley of its misfit, and names undetermined values", function()
    local judged, part, ratio = judge()
    for _, short in ipairs(short_decays) do
        local s = system(short[2])
        local run = s:simulate{ theta0 = 1, t_end = 4, dt = short.dt }
        for seed = 1, 12 do
            local fit = identify{ data = record(run, seed, short.std, 0.1) }
            if short.silent then equal(table.concat(fit.silent, " "), short.silent, short[1]) end
            part, ratio = judged(fit, { omega0 = s.omega0, zeta = s.zeta, Rd_over_k = s.Rd / s.k, offset = 0.1, theta0 = 1,
                velocity0 = 0 })
            for name, far in pairs{ Rd_over_k = 1, offset = 1, theta0 = 2 } do
                assert(math.abs(fit[name]) < 2 * far, short[1] .. ": " .. name)  -- also what is silent has a sane value
            end
        end
    end
    assert(part >= 0.90 and part <= 0.99 and ratio <= 1.3, part .. " " .. ratio)
end)

local swings = excitation.harmonic{ amplitude = 0.3, frequency = 0.5 } + excitation.harmonic{ amplitude = 0.2, frequency = 1.3 }

test("a driven record without a stop says nothing about Re, and no other value is distorted to produce a stop", function()
    local s = system{ I = 0.02, k = 0.8, C = 0.01, Rd = 0.05, Re = 0.08 }
    local run = s:simulate{ M = swings, theta0 = 0.2, velocity0 = -0.5, t_end = 10, dt = 0.02 }
    for _, event in ipairs(run.events) do assert(event.kind ~= "stick") end
    for seed = 1, 5 do
        local fit = identify{ data = record(run, seed, 0.01, 0.1), M = swings, I = 0.02, k = 0.8, C = 0.01,
            Rd = 0.05, offset = 0.1, free = { "Re" } }
        equal(table.concat(fit.silent), "Re")
        equal(fit.Re, 0.05)
        local low, high = table.unpack(fit.bounds.Re)
        has(fit, ("Re         between 0.05 and %.4g, not determined by this record"):format(high))
        equal(low, 0.05)
        local function worse(Re)  -- by how many squares of the noise
            local again = fit.system:with{ Re = Re }:simulate{ M = swings, theta0 = fit.theta0, velocity0 = fit.velocity0,
                t_end = 10, dt = 0.02 }
            local left = noisy(run, seed, 0.01) - again.theta
            return (left:dot(left) - fit.residual:dot(fit.residual)) / fit.noise^2
        end
        assert(worse(0.97 * high) < 4 and worse(1.03 * high) > 4, high)
        fits(fit, { theta0 = 0.2, velocity0 = -0.5 })
    end
end)

test("the whole range of Re is searched for a record with stops, because no slope leads from Rd to it", function()
    local two = excitation.harmonic{ amplitude = 0.25, frequency = 0.3 } + excitation.harmonic{ amplitude = 0.12, frequency = 0.71 }
    local judged, part, ratio = judge()
    for _, case in ipairs{
        { { I = 0.02, k = 0.8, C = 0.01, Rd = 0.05, Re = 0.08 },
            { M = 0.4 * swings, theta0 = 0.2, velocity0 = -0.5, t_end = 10, dt = 0.02 }, seeds = 6, std = 0.003, silent = "" },
        -- from a standstill, which says nothing about the velocity there
        { { I = 0.02, k = 0.8, C = 0.01, Rd = 0.1, Re = 0.15 },
            { M = two, theta0 = 0.05, t_end = 20, dt = 1/30 }, seeds = 3, std = 0.006, silent = "velocity0" },
    } do
        local truth, task = table.unpack(case)
        local run = system(truth):simulate(task)
        truth.offset, truth.theta0, truth.velocity0 = 0.1, task.theta0, task.velocity0 or 0
        for seed = 1, case.seeds do
            local fit = identify{ data = record(run, seed, case.std, 0.1), M = task.M }
            equal(table.concat(fit.silent), case.silent)
            assert(fit.noise < case.std * (1 + 3 / (2 * #run)^0.5), fit.noise)
            part, ratio = judged(fit, truth)
        end
    end
    assert(part >= 0.85 and ratio <= 1.4, part .. " " .. ratio)  -- 69 numbers that hang together by records
end)

test("with everything given nothing is fitted, and the residual is reported", function()
    local known = { I = 1, k = 40, C = 0.3, Rd = 0.8, theta0 = 1, velocity0 = 0, offset = 0.1 }
    local noise = vector.normal{ n = #decay, seed = 2, std = 0.01 }
    known.data = { t = decay.t, theta = decay.theta + noise + 0.1 }
    near(identify(known).residual, noise, 1e-13)
    known.Re = 0.8
    local fit = identify(known)
    near(fit.residual, noise, 1e-13)
    near(fit.noise, (noise:dot(noise) / #noise)^0.5, 1e-12)
    equal(fit.std_error.zeta, 0.0)

end)

test("rows with a gap are left out of a plain table, too", function()
    local x = noisy(decay, 3, 0.01):table()
    local t, kept = {}, {}
    for i = 1, #x do
        if i % 50 == 20 then x[i] = 0/0 else t[#t + 1], kept[#kept + 1] = decay.t[i], x[i] end
    end
    local whole = identify{ data = { t = t, theta = kept } }
    equal(identify{ data = { t = decay.t, theta = x } }.zeta, whole.zeta)
    equal(identify{ data = data{ t = decay.t, theta = x } }.zeta, whole.zeta)
    x[7] = math.huge
    refused { { "identify{ data = { t = decay.t, theta = x } }", "data.theta[7] = inf must be finite" } }
end)

test("a record that the fit does not explain is reported, and one with white noise never", function()
    local t = vector.linspace(0, 8, 241)
    local function says(theta, given)
        local question = given or {}
        question.data = { t = t, theta = theta }
        local fit = identify(question)
        return tostring(fit):find("the record no better than it would fit noise", 1, true) and "noise" or fit.misfit
            or "explained"
    end
    for _, rest in ipairs{ 0, 1 } do  -- noise about zero, and a mass that never left
        local alone = 0
        for seed = 1, 10 do
            if says(rest + vector.normal{ n = 241, seed = seed, std = 0.03 }) == "noise" then alone = alone + 1 end
        end
        assert(alone >= 9, alone)  -- in one of some hundred noise looks like a motion
    end
    equal(says((0.2 * t):exp() * (6 * t):sin()), "velocity")  -- it grows
    local honest = sys:simulate{ theta0 = 1, t_end = 8, dt = 1/30 }
    equal(says(honest.theta, { I = 1, k = 80 }), "theta")
    equal(says(noisy(honest, 5, 0.01) + 0.02 * (17 * t):sin()), "something else")  -- a mode of something else
    for seed = 1, 10 do
        equal(says(honest.theta + vector.normal{ n = 241, seed = seed, std = 0.03 * seed }), "explained")
    end
    equal(says(honest.theta:map(function(x) return math.floor(x / 0.3 + 0.5) * 0.3 end)), "explained")  -- coarse steps
    equal(says(honest.theta), "explained")
end)

test("an invalid sample is named", function()
    local run = system{ I = 1, k = 40, C = 0.1, Rd = 0.4 }:simulate{ theta0 = 0.2, t_end = 10, dt = 1/60 }
    for _, wild in ipairs{ 5, 0.5 } do
        local theta = (run.theta + vector.normal{ n = #run, seed = 3, std = 0.002 }):table()
        local function told() return tostring(identify{ data = { t = run.t, theta = vector(theta) } }):match("sample (%d+) at t") end
        equal(told(), nil)
        theta[200] = wild
        equal(told(), "200")
    end
end)

test("no error is below the rounding of doubles, and a held offset and a missing spring are reported", function()
    local decay = system{ I = 1, k = 40, C = 0.3, Rd = 0.8 }:simulate{ theta0 = 1, t_end = 8, dt = 0.02 }
    local fit = identify{ data = decay, I = 1 }
    for _, name in ipairs{ "k", "C", "Rd", "omega0", "zeta" } do assert(fit.std_error[name] >= 2^-52 * fit[name], name) end
    local held = identify{ data = decay, I = 1, free = { "k", "C", "Rd" } }
    has(held, "offset is held at 0")
    for _, free in ipairs{ { "k", "offset" }, false } do
        assert(not tostring(identify{ data = decay, I = 1, free = free or nil }):find("held at 0", 1, true))
    end
    refused { { "identify{ data = decay, k = 0 }", "k = 0 must be positive: identify needs a spring; without one give a k so small" } }
end)

local rich = excitation.harmonic{ amplitude = 1.2, omega = 1.7 } + excitation.harmonic{ amplitude = 0.5, omega = 4 }
local plain = { I = 0.96, k = 3.2, C = 0.27, Rd = 0.2, Re = 0.25 }
local function moved(changes) return system(merged(plain, changes)):simulate{ M = rich, theta0 = 0.4, t_end = 20, dt = 0.05 } end

test("the remark on a wrong model names what its residual follows: velocity, theta or time", function()
    local stribeck = system{ I = 0.96, k = 3.2, C = 0.27, friction = friction.stribeck{ Rd = 0.2, Re = 0.4, speed = 0.3 } }
        :simulate{ M = rich, theta0 = 0.4, t_end = 20, dt = 0.05 }
    local cubic = moved{ spring = spring.polynomial{ [3] = 0.5 } }
    local honest = moved()
    local words = { velocity = "is the law of friction another one", theta = "is the spring nonlinear", time = "zero of the instrument drift" }
    for _, case in ipairs{ { "velocity", stribeck, stribeck.theta }, { "theta", cubic, cubic.theta },
        { "time", honest, honest.theta + 0.001 * honest.t }, { "time", honest, honest.theta + 0.01 * (0.3 * honest.t):sin() } } do
        local what, run, theta = table.unpack(case)
        local fit = identify{ data = { t = run.t, theta = theta + vector.normal{ n = #run, seed = 1, std = 0.003 } }, M = rich }
        equal(fit.misfit, what)
        has(fit, ("times the noise and follows %s: "):format(what == "theta" and what or "the " .. what), words[what], "standard errors are left out")
        has_not(fit, "+-")
        equal(fit.std_error.k, nil)
        equal(#fit.notes, 2)
        local times = tonumber(fit.notes[1]:match "is (%S+) times the noise")
        near(times * 0.003, fit.noise, 0.1 * fit.noise)
    end
end)

test("a wrong model is also reported for a free decay, with a guess and for several bodies", function()
    local s = system{ I = 1, k = 4, C = 0.1, Rd = 0.1, spring = spring.polynomial{ [3] = 1 } }
    local run = s:simulate{ theta0 = 1, t_end = 20, dt = 0.05 }
    equal(identify{ data = record(run, 1, 0.003) }.misfit, "theta")
    local guess = system{ I = 1, k = 4, C = 0.1, Rd = 0.1 }
    local fit = identify{ data = record(run, 1, 0.003), system = guess, free = { "k", "C", "Rd" } }
    equal(fit.misfit, "theta")
    equal(fit.std_error.k, nil)
    equal(identify{ data = record(run, 1, 0.003), system = s, free = { "k", "C", "Rd" } }.misfit, nil)
    local function two(friction_of_load) return system{ bodies = { motor = { I = 1, C = 0.05 }, load = merged({ I = 2, k = 1 }, friction_of_load) },
        links = { shaft = { "motor", "load", k = 6, C = 0.1 } } } end
    local M = { motor = excitation.harmonic{ amplitude = 3, omega = 1.3 } }
    run = two{ friction = friction.stribeck{ Rd = 0.3, Re = 0.9, speed = 0.3 } }:simulate{ M = M, t_end = 30, dt = 0.05 }
    local d = { t = run.t, ["load.theta"] = run["load.theta"] + vector.normal{ n = #run, seed = 1, std = 0.003 } }
    equal(identify{ data = d, M = M, system = two{ Rd = 0.4 }, free = { "load.Rd", "load.Re", "shaft.k" }, measured = "load.theta" }.misfit, "velocity")
    -- Also at a measured link of which nothing is fitted.
    run = two{ C = 0.2 }:with{ links = { shaft = { Rd = 0.3 } } }:simulate{ M = M, t_end = 30, dt = 0.05 }
    d = { t = run.t, ["shaft.theta"] = run["shaft.theta"] + vector.normal{ n = #run, seed = 1, std = 0.001 } }
    equal(identify{ data = d, M = M, system = two{ C = 0.2 }, free = { "motor.I" }, measured = "shaft.theta" }.misfit, "velocity")
end)

test("a small misfit widens the errors by how far it moves the values", function()
    local s = moved{ spring = spring.polynomial{ [3] = 0.005 } }
    local told, within, all = 0, 0, 0
    for seed = 1, 12 do
        local fit = identify{ data = record(s, seed, 0.003), M = rich }
        if fit.misfit then
            equal(fit.misfit, "theta")
            has(fit, "the errors include how far this moves the values")
            told = told + 1
        end
        for _, name in ipairs{ "I", "k", "C" } do
            all, within = all + 1, within + (math.abs(fit[name] - plain[name]) < 2 * fit.std_error[name] and 1 or 0)
        end
    end
    assert(told > 6 and within / all > 0.85, told .. " " .. within .. " of " .. all)
end)

test("Re of a free decay lies between the torque that holds the mass at rest and the one that would have held it a turn earlier", function()
    local s = system{ I = 1, k = 40, C = 0.3, Rd = 0.8, Re = 1 }
    local run = s:simulate{ theta0 = 1, t_end = 12, dt = 0.02 }
    equal(run.outcome, "at rest")
    local low, high = table.unpack(identify{ data = run, I = 1 }.bounds.Re)
    near(low, math.max(0.8, 40 * math.abs(run.theta[#run])), 1e-5)
    has(identify{ data = run }, ("Re_over_k  between %.4g and %.4g, not determined by this record"):format(low / 40, high / 40))
    local function rest(Re)
        local theta = s:with{ Re = Re }:simulate{ theta0 = 1, t_end = 12 }.theta
        return theta[#theta]
    end
    near(rest(0.999 * high), rest(1), 1e-9)
    assert(math.abs(rest(1.001 * high) - rest(1)) > 1e-3)
end)

finish()
