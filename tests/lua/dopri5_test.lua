-- The adaptive pair of order 5: its error falls with its tolerance, also through events, which are those of spectral.
dofile "tests/lua/support.lua"

local function by(tolerance) return integrator.dopri5 { tolerance = tolerance } end

--- The slope of log y over log x.
local function slope(x, y)
    local n, sx, sy, sxx, sxy = #x, 0, 0, 0, 0
    for i = 1, n do
        local a, b = math.log(x[i]), math.log(y[i])
        sx, sy, sxx, sxy = sx + a, sy + b, sxx + a * a, sxy + a * b
    end
    return (n * sxy - sx * sy) / (n * sxx - sx * sx)
end

--- An M that is 0, and how often it was evaluated.
local function counted()
    local times = { 0 }
    return function() times[1] = times[1] + 1 return 0 end, times
end

local tolerances = { 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10 }

test("the error against the closed form of a free oscillation is of order 5 and follows the tolerance", function()
    local sys, work, errors = system { I = 1, k = 4, C = 0.2 }, {}, {}
    local w = math.sqrt(4 - 0.01)
    for i, tolerance in ipairs(tolerances) do
        local M, times = counted()
        local run = sys:simulate { M = M, theta0 = 1, t_end = 20, dt = 0.25, integrator = by(tolerance) }
        errors[i], work[i] = 0, times[1]
        for k, t in ipairs(run.t) do
            local right = math.exp(-0.1 * t) * (math.cos(w * t) + 0.1 / w * math.sin(w * t))
            errors[i] = math.max(errors[i], math.abs(run.theta[k] - right))
        end
        assert(errors[i] < 2 * tolerance, errors[i])
    end
    -- A stretch is a step, and has the same number of evaluations.
    local order = slope(work, errors)
    assert(order > -5.6 and order < -4.6, order)
end)

-- Systems of size 1 with the options of a run, a column to compare, and how many events there are.
local systems = {
    ["a mass on a belt that sticks and slips"] = { column = "theta", events = 49,
        system = function() return nondimensional { zeta = 0.02, friction_ratio = 0.3, breakaway_ratio = 0.45 } end,
        options = { belt = 0.5, t_end = 30 } },
    ["a clutch between two bodies"] = { column = "load.theta", events = 16,
        system = function()
            return system { bodies = { motor = { I = 1, C = 0.05 }, load = { I = 2, C = 0.1, k = 3 } },
                links = { clutch = { "motor", "load", Rd = 0.6, Re = 0.8 } } }
        end,
        options = { M = { motor = excitation.harmonic { amplitude = 1.5, omega = 1.1 } }, velocity0 = { motor = 3 }, t_end = 30 } },
    -- A first step that is too long goes so far away that its error is little of what acts there.
    ["a double well under feedback"] = { column = "theta", events = 6,
        system = function()
            return system { I = 0.6, k = 0.6, C = 0.15, spring = spring.polynomial { [1] = -1.3, [3] = 0.9 }, Rd = 0.055, Re = 0.07 }
        end,
        options = { theta0 = -0.74, velocity0 = 0.6, belt = -0.13, t_end = 12,
            M = excitation.harmonic { amplitude = 0.27, omega = 1.85 } + function(t, theta, velocity) return -2.3 * theta - 0.75 * velocity end } },
    -- Such a step has great rates, too, the rounding of which is not that of the motion.
    ["a fast state of a mass that sticks"] = { column = "z", events = 1,
        system = function() return system { I = 1, k = 1, C = 0.1, Rd = 0.4, Re = 0.5 } end,
        options = { theta0 = 1, t_end = 12, belt = function(t) return 0.3 * math.cos(1.7 * t) end,
            states = { z = { start = 0.2, rate = function(t, theta, velocity, z) return 0.8 * theta + velocity - 30 * z.z + math.cos(t) end } } } },
    ["elastic walls"] = { column = "theta", events = 21,
        system = function()
            return system { I = 1, k = 4, Rd = 0.2, walls = { lower = -0.6, upper = 0.7, stiffness = 300, damping = 2 } }
        end,
        options = { M = excitation.harmonic { amplitude = 2, omega = 1.3 }, t_end = 15 } },
}

for name, case in pairs(systems) do
    test("the events are those of spectral, and their error falls with the tolerance: " .. name, function()
        local sys = case.system()
        local function run(method) return sys:simulate(merged(case.options, { dt = 0.25, integrator = method })) end
        local right = run(integrator.spectral {})
        equal(#right.events, case.events)
        local errors = {}
        for i, tolerance in ipairs(tolerances) do
            local found = run(by(tolerance))
            equal(#found.events, #right.events)
            local late = 0
            for k, event in ipairs(right.events) do
                equal(found.events[k].kind, event.kind)
                equal(found.events[k].where, event.where)
                late = math.max(late, math.abs(found.events[k].t - event.t))
            end
            errors[i] = (found[case.column] - right[case.column]):abs():max()
            -- Each of some hundred steps is off by that much, and a stop in a slow part of the motion moves it more.
            assert(errors[i] < 50 * tolerance and late < 200 * tolerance, ("%g: %g %g"):format(tolerance, errors[i], late))
            equal(found.outcome, right.outcome)
        end
        local rate = slope(tolerances, errors)
        assert(rate > 0.9 and rate < 1.15, rate)
    end)
end

local belted = nondimensional { zeta = 0.02, friction_ratio = 0.3, breakaway_ratio = 0.45 }

test("a sticking mass moves with the belt to the last digit", function()
    local run = belted:simulate { belt = 0.5, t_end = 10, dt = 0.01, integrator = by(1e-4) }
    local stuck = 0
    for _, v in ipairs(run.velocity) do if v == 0.5 then stuck = stuck + 1 end end
    assert(stuck > 200, stuck)
end)

test("an unread function is sampled at most run.gap apart, so that wider pulses are found; a formula is proven in between", function()
    local sys = nondimensional { zeta = 0.1, friction_ratio = 0.1 }
    local smooth = unread(function(t) return math.sin(7 * t) end)
    local run = sys:simulate { M = smooth, theta0 = 1, t_end = 5, dt = 0.1, integrator = by(1e-7) }
    assert(run.gap > 0.001 and run.gap < 0.01, run.gap)
    near(run.theta, sys:simulate { M = smooth, theta0 = 1, t_end = 5, dt = 0.1 }.theta, 1e-6)
    local function pulse(t) return math.sin(7 * t) + (t > 2.1 and t < 2.1 + 4 * run.gap and 50 or 0) end
    local seen = sys:simulate { M = unread(pulse), theta0 = 1, t_end = 5, dt = 0.1, integrator = by(1e-7) }
    near(seen.theta, sys:simulate { M = pulse, theta0 = 1, t_end = 5, dt = 0.1 }.theta, 1e-6)
    -- Between its samples spectral proves what a formula does, and so does this.
    equal(sys:simulate { M = function(t) return math.sin(7 * t) / (2 + math.cos(t)) end, t_end = 5, integrator = by(1e-7) }.gap, nil)
end)

test("noise in M does not cause endless steps", function()
    local sys = nondimensional { zeta = 0.1, friction_ratio = 0.1 }
    local function noisy(t) return math.sin(7 * t) + 1e-6 * math.sin(1e9 * t * t) end
    local run = sys:simulate { M = unread(noisy), theta0 = 1, t_end = 5, dt = 0.1, integrator = by(1e-9) }
    has(run.outcome, "within the noise of the torques")
    near(run.theta, sys:simulate { M = function(t) return math.sin(7 * t) end, theta0 = 1, t_end = 5, dt = 0.1 }.theta, 1e-6)
end)

test("a run can be saved and repeated, and has energy and story", function()
    local run = belted:simulate { belt = 0.5, t_end = 12, dt = 0.1, integrator = by(1e-9) }
    equal(tostring(run.integrator), "integrator.dopri5{ tolerance = 1e-09 }")
    equal(run.integrator.tolerance, 1e-9)
    local again, file = repeated(run)
    equal(tostring(again.theta), tostring(run.theta))
    has(read(file), "integrator.dopri5{ tolerance = 1e-09 }")
    local function total(tolerance)
        local of = belted:simulate { belt = 0.5, t_end = 12, integrator = by(tolerance) }
        return math.abs(of:energy().total.error)
    end
    assert(total(1e-5) > 100 * total(1e-9) and total(1e-9) < 1e-7)
    says(run, "It stuck to the belt at t = 0.042965 at theta = 0.010827")
end)

test("a misspelt name of an integrator is an error with a suggestion", function()
    refused { { "integrator.dopri { tolerance = 1e-9 }", "did you mean 'dopri5'?" } }
end)

finish()
