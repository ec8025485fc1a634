dofile "tests/lua/support.lua"

local nd = nondimensional { zeta = 0.119, friction_ratio = 0.418, breakaway_ratio = 0.45 }

test("rows are exactly on the grid or at a list of times, from a table or a vector, and the last one at t_end", function()
    equal(nd:simulate { t_end = 1, dt = 0.3 }.t, vector { 0, 0.3, 0.6, 3 * 0.3, 1 })
    local times = { 0, 0.1, 0.25, 1 / 3, 1.7 }
    for _, list in ipairs { times, vector(times) } do equal(nd:simulate { theta0 = 1, times = list }.t, vector(times)) end
end)

test("times = {} keeps no rows, but the events and the motion", function()
    local run = nondimensional {}:simulate { theta0 = 1, times = {}, t_end = 1.2 }
    equal(#run, 0)
    equal(#run.events, 2)
    near((run:at(1)), 1, 1e-9) -- h = T0/1000: the error of RK4 is about 2 pi (2 pi h)^4/120 = 8e-11
end)

test("a function of one parameter is called with t alone, one of more parameters with theta and velocity", function()
    local count, theta, velocity
    nd:simulate { M = function(...) count, _, theta, velocity = select("#", ...), ... return 0 end, theta0 = 1, t_end = 0.1, dt = 0.1 }
    equal(count, 3)
    equal(math.type(theta), "float")
    equal(math.type(velocity), "float")
    local seen = {}
    nd:simulate { M = function(t) seen[#seen + 1] = t return 0 end, t_end = 0.1, dt = 0.1 }
    assert(#seen > 0)
    local run = nd:simulate { M = math.sin, t_end = 1, dt = 0.5 }
    equal(run.M[3], math.sin(1))
    local callable = setmetatable({}, { __call = function(_, t) return 2 * t end })
    equal(nd:simulate { M = callable, belt = callable, t_end = 1, dt = 1 }.M[2], 2.0)
end)

test("the default integrator is exact if that accepts M, otherwise spectral", function()
    equal(tostring(nd:simulate { t_end = 1, dt = 1 }.integrator), "integrator.exact{}")
    equal(tostring(nd:simulate { M = function(t) return 0 * t end, t_end = 1, dt = 1 }.integrator), "integrator.exact{}")
    local sampled = function(t) return #{} * t end
    equal(tostring(nd:simulate { M = sampled, t_end = 1, dt = 1 }.integrator), "integrator.spectral{}")
    local chirp = excitation.chirp { from = 0, to = 1, duration = 1 }
    equal(tostring(nd:simulate { M = chirp, t_end = 1, dt = 1 }.integrator), "integrator.spectral{}")
    refused { { "nd:simulate { M = chirp, t_end = 1, dt = 1, integrator = integrator.exact {} }", "integrator.exact{} supports only native terms other than chirp and gaussian: use integrator.spectral{}" } }
end)

test("missing, superfluous and misspelt options are errors that suggest the right ones", function()
    refuses(function(o) nd:simulate(o) end, {
        { { dt = 0.1 }, "sys:simulate needs t_end, for example" },
        { { times = {} }, "needs t_end" },
        { { t_end = 1, dt = 0.1, times = { 1 } }, "exclude each other" },
        { { t_end = 1, dt = 0.1, m = 1 }, "did you mean 'M'?" },
    })
    refused {
        { "nd:simulate()", "one table of named options", "sys:simulate{" },
        { "nd:simulate(1, 2)", "one table of named options" },
        { "nd:simulate { 1, 2 }", "named options only" },
        { "nd.simulate { t_end = 1, dt = 0.1 }", "use a colon: sys:simulate{" },
    }
end)

test("impossible windows and grids are errors with their values", function()
    refuses(function(o) nd:simulate(o) end, {
        { { t_end = 0, dt = 0.1 }, "t_end = 0 must be after t_start = 0" },
        { { times = { 0, 1, 1 } }, "times[3] = 1", "must increase" },
        { { times = { -1, 1 } }, "times[1] = -1", "outside" },
        { { times = { 0, 3 }, t_end = 2 }, "times[2] = 3", "outside" },
    })
end)

test("a step above the stability limit is refused with the limit", function()
    refused {
        { "nondimensional {}:simulate { t_end = 1, dt = 0.1, integrator = integrator.rk4 { h = 0.5 } }", "h = 0.5 exceeds the stability limit 0.45", "use h <=" },
        { 'integrator.dinal1989 { h = 0.1, stop = "txt" }', "stop must be 'listing' or 'text'", "did you mean 'text'?" },
    }
end)

test("more rows than memory allows are refused with their size and the cure, before anything is computed", function()
    refused { -- these rows would take days
        { "nd:simulate { t_end = 1e9, dt = 1e-6 }", "rows need", "GB", "use dt >=" },
        { "nd:simulate { t_end = 1e70, dt = 1e-300 }", "rows need" },
    }
end)

test("without dt and times a run has 40 rows a natural period, but 1000 to 100000", function()
    local function rows(sys, t_end) return #sys:simulate { t_end = t_end } - 1 end
    equal(rows(nd, 10), 1000)
    equal(rows(nd, 100), 4000)
    equal(rows(nd, 1e4), 100000)
    equal(rows(system { I = 1, k = 0 }, 1e4), 1000)
    local pair = { bodies = { a = { I = 1, k = 4*math.pi^2 }, b = { I = 1 } }, links = { rod = { "a", "b", Rd = 1 } } }
    equal(rows(system(pair), 100), 4000)
    pair.links.rod.k = 12*math.pi^2
    equal(rows(system(pair), 100), 8000)
    local function card(dt) return tostring(nondimensional {}:simulate { theta0 = 1, t_end = 8, dt = dt }) end
    has(card(0.25), "fewer than 4 rows an event")
    has_not(card(0.1), "fewer")
end)

test("without dt and times a short run has 1001 rows, and a continued one keeps their distance", function()
    local run = nd:simulate { theta0 = 1, t_start = 3, t_end = 7 }
    equal(#run, 1001)
    near(run.t[2] - run.t[1], 0.004, 1e-15)
    equal(run.t[1001], 7.0)
    equal(#run:continue { t_end = 8 }, 1251)
    equal(nd:simulate { theta0 = 1, t_end = 1 }.theta[501], nd:simulate { theta0 = 1, t_end = 1, dt = 0.001 }.theta[501])
end)


test("rows lie at t_start + i dt and the last one at t_end, exactly, whatever h and dt", function()
    local sys = nondimensional { zeta = 0.1 }
    local function times(t_start, t_end, dt, by) return sys:simulate { theta0 = 1, t_start = t_start, t_end = t_end, dt = dt, integrator = by }.t end
    equal(times(0, 1, 0.25), vector { 0, 0.25, 0.5, 0.75, 1 })
    equal(times(-1, 0.5, 0.5), vector { -1, -0.5, 0, 0.5 })
    equal(times(0, 1, 0.4), vector { 0, 0.4, 0.8, 1 })
    equal(times(0, 1, 5), vector { 0, 1 })
    for _, t_end in ipairs { 1, 0.77, 3.14159 } do
        for _, dt in ipairs { 0.01, 0.0123, 0.5, 7 } do
            local wanted = times(0, t_end, dt)
            equal(wanted[#wanted], t_end)
            for _, h in ipairs { 0.01, 0.0031, 0.02 } do
                for _, by in ipairs { integrator.rk4 { h = h }, integrator.dinal1989 { h = h } } do equal(times(0, t_end, dt, by), wanted) end
            end
        end
    end
    -- A dt that divides the window to rounding leaves no tiny last interval; late times are rounded by more than the division is.
    for _, dt in ipairs { 0.1, 0.01, 0.001, 0.3, 0.7, 1 / 3, 1e-3 / 3, 8.0299443320945283e-07 } do
        for _, n in ipairs { 1, 3, 7, 10, 100, 1000, 12345 } do
            local t = times(0, n * dt, dt)
            equal(#t, n + 1, dt)
            equal(t[n + 1], n * dt)
        end
        for _, start in ipairs { 0.1, 1e3 + 0.1, -149121.09375, 1e6 + 1 / 3, 1e9 + 0.7 } do
            if dt >= 2 ^ -47 * math.abs(start) then equal(#times(start, start + 16 * dt, dt), 17, start) end
        end
    end
    equal(#times(0, 0.3, 0.1), 4) -- 3 * 0.1 > 0.3
    refused { { "sys:simulate { t_start = 1e9, t_end = 1e9 + 1e-3, dt = 1e-8 }", "dt = 1e-08", "rounding" } }
end)

finish()
