-- What is timed of dinal alone, beside the work of the peers: each row is a function, how many of what `per` names it
-- does, and the most that one of them may take in `unit`; "x" is the time of `against`.

local w0 = 2 * math.pi
local rows = {}
local function add(group, name, per, count, most, unit, run, more)
    local row = { group = group, name = name, per = per, count = count, most = most, unit = unit, run = run }
    for key, value in pairs(more or {}) do row[key] = value end
    rows[#rows + 1] = row
end
local by_clock = { by_clock = true } -- the clock of the process counts all workers

local w3 = nondimensional { zeta = 0, friction_ratio = 0.836 }
local w4 = nondimensional { zeta = 0.119, friction_ratio = 0.418 }
local resonant = excitation.harmonic { frequency = 1 }
local function over(sys, options, t_end) -- without rows
    options.times, options.t_end = {}, t_end
    return function() sys:simulate(options) end
end

-- ---- loads of many terms, by exact

do -- a smooth record, a hundred samples a natural period
    local t = vector.range(0, 1000000) / 100
    local record = excitation.samples { t = t, M = (5.1 * t):sin() + 0.4 * (7.7 * t + 1):sin() }
    add("terms", "exact, 1e6 samples, 1e4 T0", "sample", 1e6, 20, "ns", over(w4, { M = record, theta0 = 1, dense = false }, 1e4))
    for _, case in ipairs { { 10, 100, 30 }, { 100, 100, 300 }, { 1000, 20, 10000 } } do
        local harmonics, periods, most = table.unpack(case)
        local sum = excitation.constant(0)
        for i = 1, harmonics do sum = sum + excitation.harmonic { amplitude = 1 / i ^ 2, frequency = i } end
        add("terms", ("exact, %d harmonics of amplitude 1/i^2"):format(harmonics), "period", periods, most, "us",
            over(w4, { M = sum, theta0 = 1, dense = false }, periods))
    end
end

-- ---- questions

do
    local r, g = vector.linspace(0.2, 3, 200), vector.linspace(0, 1.2, 200)
    local function point(p)
        local s = nondimensional { friction_ratio = p.g }:steady { M = excitation.harmonic { frequency = p.r } }
        return { A = s.amplitude, stops = s.stops }
    end
    local function swept(workers)
        return function()
            for _, message in ipairs(sweep { over = { r = r, g = g }, workers = workers, run = point }.error) do
                if message ~= "" then error(message, 0) end -- a point that fails is a row all the same, and a fast one
            end
        end
    end
    local function plane()
        for i = 1, #g do
            local sys = nondimensional { friction_ratio = g[i] }
            for j = 1, #r do sys:steady { M = excitation.harmonic { frequency = r[j] } } end
        end
    end
    add("questions", "steady, 200 x 200 points", "point", 40000, 10, "us", plane)
    add("questions", "steady, 200 x 200 points, sweep", "point", 40000, 25, "us", swept(1), by_clock)
    add("questions", "the same on two workers", "point", 40000, 25 / 1.8, "us", swept(2), by_clock)
    local nothing = { 1 }
    add("questions", "a sweep of one point with nothing to do", "sweep", 1, 5, "ms", function()
        sweep { over = { x = nothing }, workers = 1, run = function(p) return { y = p.x } end }
    end, by_clock)
    add("questions", "response, 300 points", "response", 1, 5, "ms", function()
        nondimensional { friction_ratio = 0.5 }:response { over = { frequency = vector.linspace(0.1, 3, 300) }, between = true }
    end)
    local decay = system { I = 1, k = 40, C = 0.3, Rd = 0.8 }:simulate { theta0 = 1, t_end = 8, dt = 8 / 999 }
    local record = { t = decay.t, theta = decay.theta + vector.normal { n = #decay, seed = 1, std = 0.01 } }
    add("questions", "identify, free decay, 1000 samples", "fit", 1, 10, "ms", function() identify { data = record } end)
end

-- ---- rows, files and plots

do
    local damped = nondimensional { zeta = 1e-4 }
    local function stepped(options) -- new memory each time, as for a user
        options.velocity0, options.t_end, options.integrator = w0, 1000, integrator.rk4 { h = 0.001 }
        return function() damped:simulate(options) collectgarbage() end
    end
    add("rows", "rk4 without rows", "step", 1e6, 5, "ns", stepped { times = {} })
    add("rows", "rk4 with a row a step", "row", 1e6, 200, "ns", stepped { dt = 0.001 })
    local run = w4:simulate { M = resonant, theta0 = 1, t_end = 1000, dt = 0.001 }
    local folder = os.rename("/dev/shm", "/dev/shm") and "/dev/shm" or "/tmp" -- no disk, where there is such a folder
    local name = os.tmpname()
    os.remove(name)
    local memory, disk, svg = folder .. name:match "/[^/]*$" .. ".csv", name .. ".csv", name .. ".svg"
    run:save(memory)
    add("files", "CSV, 1e6 rows written in memory", "row", 1e6, 300, "ns", function() run:save(memory) end)
    add("files", "CSV, 1e6 rows written to the disk", "row", 1e6, 300, "ns", function() run:save(disk) end)
    add("files", "CSV, 1e6 rows read", "row", 1e6, 250, "ns", function() load(memory) collectgarbage() end)
    for of, name in pairs { plot = "over time", phase_plot = "phase plane" } do
        add("plots", name .. ", 1e6 rows in the terminal", "plot", 1, 50, "ms", function() tostring(run[of](run, { show = false })) end)
        add("plots", name .. ", 1e6 rows as SVG", "plot", 1, 1000, "ms", function() run[of](run, { file = svg }) end)
    end
    rows.files = setmetatable({ memory, disk, svg }, { __gc = function(files) for _, name in ipairs(files) do os.remove(name) end end })
end

-- ---- the program as a process, whose history must not become ours

do
    local home = os.tmpname()
    os.remove(home)
    os.execute(("mkdir '%s' && : >'%s/empty.lua'"):format(home, home))
    local function started(arguments, times)
        local one = ("'%s' %s </dev/null >/dev/null 2>&1 || exit 1"):format(PROGRAM, arguments:gsub("HOME", home))
        local all = ("cd '%s' && HOME='%s' && i=0 && while [ $i -lt %d ]; do %s; i=$((i+1)); done"):format(home, home, times, one)
        return function() assert(os.execute(all), "the program failed") end
    end
    for name, arguments in pairs { ['to the end of -e ""'] = "-e ''", ["to the end of an empty script"] = "empty.lua", ["to the prompt"] = "-i" } do
        add("start", name, "start", 20, 20, "ms", started(arguments, 20), by_clock)
    end
    add("start", "all figures of the report", "run", 1, 30, "s", started(EXAMPLES .. "/report/all.lua HOME", 1), by_clock)
    rows.home = setmetatable({}, { __gc = function() os.execute("rm -rf '" .. home .. "'") end })
end

-- ---- M in Lua, controllers with a memory, laws of friction, jumps and short runs

do
    local function M(t) return math.sin(2 * math.pi * t) end
    local arcs = { against = { "W3", "closed-form arcs by hand" } }
    add("Lua", "W3, M in Lua that is read", "run", 1, 3.5, "x", over(w3, { M = M, theta0 = 1 }, 1000), arcs)
    local k = 4 * math.pi ^ 2
    local held = { I = 1, k = k, C = 1, Rd = 1, Re = 1.2 }
    local function error_of(t, theta) return math.sin(3 * t) - theta end
    add("Lua", "a PID's integral as a state", "T0", 100, 40, "us", over(system(held), {
        M = function(t, theta, velocity, z) return 40 * error_of(t, theta) - 4 * velocity + 30 * z.e end,
        states = { e = { start = 0, rate = error_of } },
    }, 100))
    add("Lua", "a controller of 100 samples", "T0", 100, 150, "us", function()
        local sum = 0
        over(system(held), { M = excitation.sampled(function(t, theta)
            local e = error_of(t, theta)
            sum = sum + 0.01 * e
            return 40 * e + 30 * sum
        end, { every = 0.01 }) }, 100)()
    end)
    local relay = { M = excitation.relay { on = -0.01, off = 0.01, amplitude = { 10, -10 } }, t_end = 100, times = {} }
    local switches = #system(held):simulate(relay).events:filter(function(event) return event.kind == "switch" end)
    assert(switches > 100, "a relay that switches")
    add("Lua", "a relay", "switch", switches, 3, "us", over(system(held), relay, 100))
    local laws = {
        ["a belt under Stribeck's law"] = { friction.stribeck { Rd = 2, Re = 4, speed = 0.5 }, { belt = 0.3 } },
        ["asymmetric friction"] = { friction.asymmetric { forward = { Rd = 1, Re = 1.5 }, backward = { Rd = 2, Re = 2 } } },
        ["a friction law as a table"] = { friction.table { speed = { 0, 1, 3, 10 }, torque = { 2, 1.5, 1.8, 4 }, Re = 2.5 } },
    }
    for name, law in pairs(laws) do
        local drive = law[2] or { M = excitation.harmonic { amplitude = 20, frequency = 0.7 } }
        add("Lua", name, "T0", 100, 100, "us", over(system { I = 1, k = k, C = 0.1, friction = law[1] }, drive, 100))
    end
    local free = nondimensional { zeta = 0, friction_ratio = 0.167 }
    add("Lua", "a run of three rows (W2)", "run", 1000, 3, "us", function()
        for _ = 1, 1000 do free:simulate { velocity0 = w0, t_end = 3, dt = 1.5 } end
    end)

    local sys = nondimensional { zeta = 0.05, friction_ratio = 0.2 }
    add("Lua", "a sine of 16 bits over 10 T0", "run", 1, 1, "s",
        over(sys, { M = function(t) return math.floor(M(0.7 * t) * 32768 + 0.5) / 32768 end }, 10))
end

return rows
