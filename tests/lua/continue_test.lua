dofile "tests/lua/support.lua"

local nd = nondimensional { zeta = 0.01, friction_ratio = 0.4, breakaway_ratio = 0.5 }
local M = excitation.harmonic { frequency = 0.3, phase = 0.4 }

--- The rows of two runs, which differ by the rounding of what was computed in between.
local function same_rows(a, b)
    equal(#a, #b)
    near(a.t, b.t, 0)
    near(a.theta, b.theta, 1e-12 * b.theta:abs():max())
    near(a.velocity, b.velocity, 1e-11 * b.velocity:abs():max())
    same_events(a, b, 1e-11)
    equal(a.outcome, b.outcome)
end

for name, integrator in pairs {
    exact = integrator.exact {},
    spectral = integrator.spectral {},
    rk4 = integrator.rk4 { h = 0.01 },
    dopri5 = integrator.dopri5 { tolerance = 1e-14 },
    dinal1989 = integrator.dinal1989 { h = 0.01 },
} do
    test("a continued run equals an uninterrupted one: " .. name, function()
        local whole = nd:simulate { M = M, theta0 = 2, t_end = 12, dt = 0.1, integrator = integrator }
        local first = nd:simulate { M = M, theta0 = 2, t_end = 3.4, dt = 0.1, integrator = integrator }
        local longer = first:continue { t_end = 7 }:continue { t_end = 12 }
        same_rows(longer, whole)
        equal(tostring(longer.integrator), tostring(integrator))
        equal(first.t_end, 3.4)
        equal(#first, 35)
        equal(longer.t_start, 0.0)
        equal(longer.t_end, 12.0)
    end)
end

test("a run with a list of times can be continued with another list", function()
    local first = nd:simulate { M = M, theta0 = 2, times = { 0.5, 1, 2 } }
    local whole = nd:simulate { M = M, theta0 = 2, times = { 0.5, 1, 2, 3, 5, 7.7 } }
    same_rows(first:continue { times = { 3, 5, 7.7 } }, whole)
    same_rows(first:continue { times = vector { 3, 5 } }:continue { times = { 7.7 } }, whole)
    local bare = first:continue { times = {}, t_end = 9 }
    equal(#bare, 3)
    equal(bare.t_end, 9.0)
    near((bare:at(7.7)), whole.theta[6], 1e-12)
end)

test("a run with times that an event has stopped goes on with the new times alone", function()
    local stop = { { when = function(t) return t - 2.5 end, stop = true } }
    local first = nd:simulate { M = M, theta0 = 2, times = { 1, 2, 3, 4 }, events = stop }
    equal(first:continue { times = { 3.5, 5 } }.t, vector { 1, 2, 3.5, 5 })
end)

test("a run interrupted by an error of M can be continued to its end", function()
    local broken = true
    local function fragile(t)
        if broken and t > 4.321 then error "the wire broke" end
        return math.sin(2 * t)
    end
    for _, rows in ipairs { { dt = 0.25 }, { times = { 1, 2, 3, 5, 8, 9 } } } do
        local options = { M = fragile, theta0 = 2, t_end = 10, dt = rows.dt, times = rows.times }
        broken = true
        assert(not pcall(nd.simulate, nd, options))
        local partial = dinal.partial
        assert(partial.t_end < 5 and #partial < 20)
        -- Still broken: what was done stays.
        assert(not pcall(partial.continue, partial))
        equal(dinal.partial.t_end, partial.t_end)
        broken = false
        same_rows(partial:continue(), nd:simulate(options))
        equal(partial:continue { t_end = 20 }.t_end, 20.0)
        local times = partial:continue { t_end = 6 }.t
        assert(times:max() <= 6)
    end
end)

test("the file of a continued run repeats all of it", function()
    local longer = nd:simulate { M = M, theta0 = 2, t_end = 3.4, dt = 0.1 }:continue { t_end = 8 }
    has(read(select(2, reloaded(longer))), "t_end = 8, dt = 0.1")
end)

test("a run without dense output is continued without it", function()
    local first = nd:simulate { M = M, theta0 = 2, t_end = 3, dt = 0.1, dense = false }
    local longer = first:continue { t_end = 6 }
    refused { { "longer:energy()", "dense" } }
    same_rows(longer, nd:simulate { M = M, theta0 = 2, t_end = 6, dt = 0.1 })
end)

test("a run of several bodies is continued without dense output if the first part has none", function()
    local rig = system { bodies = { a = { I = 1, k = 1 } } }
    local longer = rig:simulate { theta0 = { a = 1 }, t_end = 3, dense = false }:continue { t_end = 6 }
    for _, t in ipairs { 2, 5 } do raises_here(function() longer:at(t) end, "dense = false") end
end)

test("rows that exceed the memory are refused, of one body and of several, in a new run and a continued one", function()
    local body = { I = 1, k = 1, C = 0.1 }
    local varying = { I = 1, k = 1, C = 0.1, Rd = function() return 0 end }
    for _, sys in ipairs { system(body), system(varying), system { bodies = { a = body } } } do
        refused {
            { "sys:simulate { t_end = 1, dt = 1e-12 }", "1e+12 rows need", "are allowed: use dt >=" },
            { "sys:simulate { t_start = 1e6, t_end = 1e6 + 1e-9, dt = 1e-14 }", "is lost in the rounding of times" },
        }
        local run = sys:simulate { t_end = 1e-9 }
        refused { { "run:continue { t_end = 1 }", "1e+12 rows need", "are allowed: use dt >=" } }
        equal(#sys:simulate { t_start = -10, t_end = -5, dt = 1 }:continue { t_end = -1 }, 10)
    end
end)

test("a run that ends at a wall, or as near to it as doubles allow, can be continued", function()
    for i = 1, 12 do
        local walled = system { I = 1, k = 1, walls = { lower = -0.1 - 0.00137 * i, restitution = 0.5 } }
        local function run(t_end) return walled:simulate { M = -0.5, theta0 = 0.3, t_end = t_end, dt = 0.5 } end
        local whole = run(6)
        for _, event in ipairs(whole.events) do
            for _, beside in ipairs { 0, 1e-15, -1e-15, 1e-12 } do
                local first = run(event.t + beside)
                assert(first:at(first.t_end) >= walled.walls.lower)
                local longer = first:continue { t_end = 6 }
                -- beside its last bounces a motion is known to the root of a rounding
                near(longer.theta, whole.theta, 1e-8)
            end
        end
    end
end)

test("acts that die out do so at the same time wherever the run was continued", function()
    local function run(t_end)
        return system { I = 1, k = 1 }:simulate {
            M = 1, t_end = t_end, dt = 0.25,
            events = { { when = function(_, theta) return theta - 0.5 end, act = function(_, theta, v) return theta, -0.5 * v end } },
        }
    end
    local whole = run(9)
    has(whole.outcome, "endlessly")
    for _, parts in ipairs { { 1, 9 }, { 2.5, 3.5, 3.9, 4, 9 }, { whole.events[4].t, whole.events[7].t, 9 } } do
        local on = run(parts[1])
        for i = 2, #parts do on = on:continue { t_end = parts[i] } end
        equal(on.outcome, whole.outcome)
        equal(#on.events, #whole.events)
        near(on.t_end, whole.t_end, 1e-11)
    end
end)

test("wrong uses of continue raise errors", function()
    local run = nd:simulate { M = M, theta0 = 2, t_end = 3, dt = 0.1 }
    refused { { "run:continue()", "reached its end at t = 3", "run:continue{ t_end = 40 }" } }
    refuses(function(o) run:continue(o) end, {
        { { t_end = 3 }, "t_end = 3 must be after t = 3, where the run ended" },
        { { tend = 4 }, "did you mean 't_end'" },
        { "4", "t_end must be a finite number, got the string" },
        { { times = { 4 } }, "dt = 0.1" },
    })
    equal(run:continue(4).t_end, 4.0)
    local listed = nd:simulate { M = M, theta0 = 2, times = { 1, 3 } }
    refuses(function(o) listed:continue(o) end, {
        { { times = { 3 } }, "times[1] = 3 must be after t = 3" },
        { { times = { 5, 4 } }, "times[2] = 4" },
        { { times = { 5, 7 }, t_end = 6 }, "times[2] = 7 is outside" },
        { { times = {} }, "reached its end" },
    })
    local loaded = reloaded(run)
    equal(loaded.t_end, 3.0)
    refused { { "loaded:continue { t_end = 5 }", "read from a file" } }
end)

test("a continued run has the greatest gap of its parts", function()
    local a, M = { I = 1, k = 4 }, unread(math.sin)
    for _, run in ipairs { system(a):simulate { M = M, t_end = 10 }, system { bodies = { a = a } }:simulate { M = { a = M }, t_end = 10 } } do
        equal(run:continue { t_end = 10.01 }.gap, run.gap)
    end
end)

finish()
