dofile "tests/lua/support.lua"

local nd = nondimensional { friction_ratio = 0.1, breakaway_ratio = 0.12 }
local run = nd:simulate { M = excitation.harmonic { frequency = 0.7 }, theta0 = 1, t_end = 5, dt = 0.01 }

test("columns are vectors of equal length with the quantities that their names say", function()
    for _, name in ipairs(run.names) do
        equal(#run[name], 501)
    end
    equal(run.theta[1], 1.0)
    equal(run.M[1], 0.0) -- M(0) as it is, without rounding
    near(run.M[101], run.excitation(1), 1e-14) -- columns of M are filled in blocks, with roundings of their own
    assert((run.damping):abs() <= 0)
    assert(run.friction:abs() <= 0.12)
end)

test("a column outlives its run", function()
    local theta = nd:simulate { theta0 = 1, t_end = 1, dt = 0.001 }.theta
    local copy = theta:table()
    for _ = 1, 20 do
        collectgarbage()
        nd:simulate { theta0 = 2, t_end = 1, dt = 0.001 }
    end
    equal(theta, vector(copy))
end)

test("run:columns selects by name or number", function()
    local t, theta = run:columns("t", "theta")
    assert(t == run.t and theta == run.theta)
    local M, first = run:columns(4, 1)
    assert(M == run.M and first == run.t)
    equal(select("#", run:columns()), 6)
    refused {
        { 'run:columns("thta")', "thta", "did you mean", "theta" },
        { "run:columns(7)", "7" },
    }
end)

test("a run can be used as data, and events always have a velocity", function()
    equal(run:select("t", "theta").theta, run.theta)
    equal(run:sort("theta").theta[1], run.theta:min())
    equal(run[2].t, run.t[2])
    equal(run[#run + 1], nil)
    equal(run[#run].t, run.t[#run])
    for i, row in ipairs(run) do equal(row.theta, run.theta[i]) end
    assert(run:markdown():find("| t, T0 | theta, Mc/k |", 1, true) == 1)
    equal(run.events.velocity, 0 * run.events.t)
    equal(run:spectrum("velocity").amplitude, run:spectrum{ of = "velocity" }.amplitude)
end)

test("load reads what the program wrote and any table of numbers", function()
    local old, name = reloaded(run)
    equal(old.theta, run.theta)
    write(name, "t;theta;M\ns;m;N\n0;1,5;2\n1;2,5;3\n") -- times and angles: a run
    local record = load(name)
    equal(record.units.theta .. record.units.t .. record.units.M, "msN")
    equal(record.theta[2], 2.5)
    write(name, "# by hand\nt\ttheta\n0\t1\n1\t\n") -- with a gap: data
    equal(load(name):select("t").t, vector{ 0, 1 })
end)

test("events are a list of tables, the same list each time", function()
    local events = run.events
    assert(#events > 0)
    for i, e in ipairs(events) do
        assert(math.type(e.t) == "float" and math.type(e.theta) == "float" and math.type(e.M) == "float")
        assert(e.kind == "turn" or e.kind == "stick" or e.kind == "slip" or e.kind == "rest")
        assert(i == 1 or e.t >= events[i - 1].t)
        local _, velocity = run:at(e.t)
        near(velocity, 0, 1e-6) -- the event's time is rounded, and velocity changes by about 40 per time unit
    end
    equal(run.events, events)
end)

test("run:at gives vectors at several times, of one body and of several", function()
    local times = vector { 0.5, 1.25, 2 }
    local theta, velocity = run:at(times)
    for i = 1, 3 do
        local x, v = run:at(times[i])
        equal(theta[i], x)
        equal(velocity[i], v)
    end
    equal(run:at { 0.5, 1.25, 2 }, theta)
    equal(#run:at {}, 0)
    local rig = system { bodies = { a = { I = 1, k = 1 }, b = { I = 2, k = 3 } }, links = { l = { "a", "b", k = 1 } } }
    local both = rig:simulate { theta0 = { a = 1 }, states = { z = { rate = function(t) return 2 end } }, t_end = 3 }
    local angles, speeds, z = both:at(times)
    equal(angles.b[2], (both:at(1.25)).b)
    equal(speeds.a[3], select(2, both:at(2)).a)
    near(z.z[3], 4, 1e-12)
end)

test("run:at gives theta and velocity at rows and between them", function()
    local theta, velocity = run:at(run.t[200])
    near(theta, run.theta[200], 1e-12)
    near(velocity, run.velocity[200], 1e-11)
    local fine = nd:simulate { M = run.excitation, theta0 = 1, t_end = 5, dt = 0.0025 }
    near((run:at(3.2125)), fine.theta[1286], 1e-10) -- both integrate with h = 0.001, whose error is below 1e-10
    refuses(function(t) run:at(t) end, {
        { 5.00000001, "t = 5.00000001 is outside the run from 0 to 5" },
        { -1, "outside" },
        { "1", "finite number" },
    })
    refused { { "run.at(1)", "use a colon: run:at(t)" } }
end)

test("a run shows its origin and cannot be changed", function()
    equal(tostring(run.system), tostring(nd))
    equal(tostring(run.integrator), "integrator.exact{}")
    refused {
        { "run.theta = 1", "a run cannot be changed" },
        { "run.tetha", "this run has no field 'tetha'; its columns are", "did you mean 'theta'?" },
    }
    assert(tostring(run):find("^501 rows, t 0 … 5; %d+ events"), tostring(run))
end)

test("a run saved as CSV reads back to the last bit", function()
    local old, name = reloaded(run)
    equal(#old, 501)
    for _, column in ipairs(run.names) do
        assert(old[column] == run[column], column)
    end
    equal(table.concat(old.names, " "), "t theta velocity M friction damping")
    equal(old.outcome, "read from a file")
    equal(old.system, nil)
    equal(#old.events, 0)
    near((old:at(0.005)), (run:at(0.005)), 1e-5) -- cubic between rows 0.01 apart: h^4/384 theta''''
    local _, again = reloaded(old)
    equal(read(again), read(name), "saving what was loaded")
end)

test("a run saved as the record of 1989 reads back to the last bit", function()
    local old, name = reloaded(run, nil, ".dat")
    equal(table.concat(old.names, " "), "t theta velocity_over_omega0 M_over_k friction_over_k damping_over_k")
    assert(old.theta == run.theta and old.velocity_over_omega0 == run.velocity / nd.omega0)
    local _, again = reloaded(old, nil, ".dat")
    equal(read(again), read(name))
    refused { { "old.velocity", "no field 'velocity'", "velocity_over_omega0" } }
end)

test("columns of a file with other names are fields, too", function()
    local name = temporary ".csv"
    write(name, "time,acceleration\n0,1\n1,2.5\n")
    local record = load(name)
    equal(record.acceleration[2], 2.5)
    refused {
        { "record.acelleration", "did you mean 'acceleration'?" },
        { "record.theta", "there is no column 'theta' among time, acceleration" },
    }
end)

test("a selection of columns can be saved", function()
    local name = temporary ".csv"
    equal(table.concat(reloaded(run, { columns = { "theta", 3 } }).names, " "), "theta velocity")
    refuses(function(o) run:save(name, o) end, {
        { { columns = { "thta" } }, "thta", "did you mean" },
        { { columns = {} }, "columns must be a list" },
        { { columns = { "t", 1 } }, "columns names 't' twice" },
        { { column = { "t" } }, "did you mean 'columns'?" },
    })
    refused { { 'run:save(temporary ".dat", { columns = { "t" } })', "six columns" } }
end)

test("an unknown file type, or a path that cannot be written, is an error", function()
    refuses(function(name) run:save(name) end, {
        { "run.txt", "run.txt", ".csv", ".dat" },
        { "run", ".csv", ".dat" },
        { nil, "must be a string" },
        { "/nowhere/at/all/run.csv", "/nowhere/at/all/run.csv" },
        { "/dev/full/x.csv", "/dev/full" },
    })
    refused {
        { 'load("/nowhere/run.csv")', "/nowhere/run.csv" },
        { 'load("no such.txt")', "load: ", "no such.txt" },
    }
    equal(load("x.csv", "name"), nil) -- with more than a name it is Lua's own
    equal(load("return run.csv", "=(load)", "t", { run = { csv = 3 } })(), 3)
    equal(load("local x = { csv = 1 } return x.csv")(), 1)
    refused { { "data.load(name)", "there is no data.load" } }
end)

--- The comment block, stripped of "# ", must make a run with the same file.
local function check_repeats(first, what)
    local run, name = repeated(first)
    local _, again = reloaded(run)
    local function rows(file)
        return (read(file):gsub("#[^\n]*\n", ""))
    end
    equal(rows(again), rows(name), what)
    has_not(read(name), "could not be written down")
end

test("the comment block of a CSV repeats the times of a run and its integrator", function()
    check_repeats(nd:simulate { theta0 = 1, velocity0 = -0.3, t_start = 0.1, times = { 0.1, 0.2, 1 / 3, 2 } }, "times")
    check_repeats(nd:simulate { M = 3, t_end = 2, dt = 0.3, integrator = integrator.dinal1989 { h = 0.01, slip = true } }, "1989")
end)

function global_drive(t) return global_gain * math.sin(global_omega * t) end

test("the comment block repeats a scripted M with its local and global variables as they were", function()
    check_repeats(nd:simulate { M = function(t) return math.sin(t) end, t_end = 2, dt = 0.1 }, "one line")
    local gain, table_of = 2.5, { [0] = 0.25, 1, 2, { x = 0.5, ["a b"] = true } }
    local function helper(x) return gain * x end
    local M = function(t, theta, velocity)
        -- a comment with "end" in it
        local text = "end"
        return helper(math.sin(7 * t)) * table_of[3].x - 0.1 * velocity + #text - 3 + table_of[0]
    end
    check_repeats(nd:simulate { M = M, t_end = 2, dt = 0.1 }, "locals")
    global_gain, global_omega = 3, 1 / 3
    local first = nd:simulate { M = global_drive, t_end = 2, dt = 0.1 }
    global_gain = 4
    check_repeats(first, "globals")
    check_repeats(nd:simulate { M = 2 * excitation.scripted(M, { breaks = { 0.5 }, period = 1 }):delay(0.1) + 1, t_end = 2, dt = 0.1 }, "terms")
    local pulse = unread(function(t) return t >= 0.537 and t < 0.5371 and 300 or 0 end) -- missed without its breaks
    check_repeats(nd:simulate { M = excitation.scripted(pulse, { breaks = { 0.537, 0.5371 } }), t_end = 2, dt = 0.1 }, "breaks")
    check_repeats(nd:simulate { M = math.sin, t_end = 2, dt = 0.1 }, "a function of Lua")
    check_repeats(nd:simulate { M = load("return 2 * ..."), t_end = 2, dt = 0.1 }, "a chunk")
    local function countdown(t) return t > 1 and 1 + countdown(t - 1) or t end
    check_repeats(nd:simulate { M = countdown, t_end = 3, dt = 0.1 }, "recursion")
end)

test("a value that cannot be written as Lua text is named in the comment block", function()
    local thread = coroutine.create(print)
    local name = temporary ".csv"
    nd:simulate { M = function(t) return thread and 1 or 0 end, t_end = 1, dt = 1 }:save(name)
    has(read(name), "# -- a thread could not be written down")
    local late = setmetatable({ 3 }, { __index = function() return 2 end })
    nd:simulate { M = function(t) return late[2] * t end, t_end = 1, dt = 1 }:save(name)
    has(read(name), "# -- the metatable of a table could not be written down")
    local run = system { I = 1, k = 4, Rd = 0.3 }:simulate { theta0 = 1, t_end = 5 }
    local row, total = run[1], run:energy().total
    nd:simulate { M = function(t) return (row.t + total.dry) * t end, t_end = 1, dt = 1 }:save(name)
    has_not(read(name), "metatable")
end)

test("the status of a run is one word for each way to end", function()
    local sys = system{ I = 1, k = 4, Rd = 1 }
    equal(system{ I = 1, k = 4 }:simulate{ theta0 = 1, t_end = 1 }.status, "end")
    equal(sys:simulate{ theta0 = 2, t_end = 50 }.status, "rest")
    equal(sys:simulate{ M = excitation.harmonic{ amplitude = 3, omega = 0.01 }, t_end = 5 }.status, "stuck")
    equal(sys:simulate{ theta0 = 2, t_end = 5, events = { { when = function(_, theta) return theta end, stop = true } } }.status, "event")
    pcall(sys.simulate, sys, { M = function(t) return t < 1 and 2 or error("mine") end, t_end = 5 })
    equal(dinal.partial.status, "failed")
    local name = temporary(".csv")
    sys:simulate{ theta0 = 2, t_end = 5 }:save(name)
    equal(load(name).status, nil)
end)

test("the acceleration is the derivative of the velocity, and 0 at rest", function()
    local sys = system{ I = 2, k = 3, C = 0.4, Rd = 0.3, Re = 0.5, spring = spring.polynomial{ [3] = 0.7 } }
    for _, options in ipairs{ { M = math.sin, theta0 = 1 }, { belt = 0.1, theta0 = 1 }, { base = function(t) return math.cos(t) end, theta0 = 1.5 } } do
        options.t_end, options.dt = 3, 1e-4
        local r = sys:simulate(options)
        local a = r.acceleration
        equal(#a, #r)
        local differences = (r.velocity:slice(3) - r.velocity:slice(1, #r - 2)) / 2e-4
        local off = (a:slice(2, #r - 1) - differences):abs()
        assert(off:quantile(0.95) < 1e-6) -- where friction jumps no difference tells
    end
    local stuck = system{ I = 1, k = 4, Rd = 1 }:simulate{ M = 0.5, t_end = 1 }
    equal(stuck.acceleration:max(), 0.0)
    local walled = system{ I = 1, k = 1, walls = { upper = 0.5 } }:simulate{ M = 3, theta0 = 0.5, t_end = 1 }
    equal(walled.acceleration:max(), 0.0)
end)

test("run:cycle returns the cycle as data", function()
    local sys = system{ I = 1, k = 4, Rd = 0.3, Re = 0.6 }
    local s, c = sys:steady{ belt = 0.1 }, sys:simulate{ belt = 0.1, t_end = 60 }:cycle()
    near(c.period, s.period, 1e-9)
    near(c.amplitude, s.amplitude, 1e-9)
    near(c.stuck, s.stuck, 1e-9)
    near(c.middle, 0.075, 1e-9)
    equal(c.stops, 1)
    equal(c.drift, 0.0)
    assert(c.steady and c.since < 20 and c.change < 1e-9)
    c = nondimensional{ friction_ratio = 0.4 }:simulate{ M = excitation.harmonic{ frequency = 0.4 }, t_end = 60 }:cycle()
    near(c.period, 2.5, 1e-9)
    equal(c.stops, 2)
    equal(sys:simulate{ theta0 = 2, t_end = 20 }:cycle(), nil)
    near(system{ I = 1, k = 1 }:simulate{ theta0 = 1, t_end = 40 }:cycle().since, math.pi, 1e-9)  -- the first event
end)

finish()
