-- The units of a system or a run: words in cards, columns and axes, on which no number depends.
dofile "tests/lua/support.lua"

local metres = { theta = "m", t = "s", M = "N" }
local plain = system{ I = 1, k = 4, C = 0.2, Rd = 0.1 }
local block = plain:with{ units = metres }
local function asked(more)
    return merged({ M = excitation.harmonic{ amplitude = 2, omega = 1 }, theta0 = 1, t_end = 5, dt = 0.1 }, more)
end
local run = block:simulate(asked())

test("axes have the units of the system, unless the call gives a label", function()
    has(picture(run, { y = "theta" }), "theta, m", "t, s")
    has(picture(run, { y = "velocity" }), "theta', m/s")
    has(picture(run, { y = "M" }), "M, N")
    has(picture(run, { y = { "M", "friction" } }), "torque, N")
    has(picture(run, {}, "phase_plot"), "theta'/omega0, m", "theta, m")
    has(picture(run, { y = "theta", units = { theta = "mm" } }), "theta, mm")
    has(picture(plain:simulate(asked()), { units = metres }, "phase_plot"), "theta'/omega0, m", "theta, m")
    has(picture(plain:simulate(asked()), { y = "velocity" }), "theta', rad/time")
end)

test("a run may have its own units, instead of those of the system", function()
    local own = block:simulate(asked{ units = { theta = "mm" } })
    has(picture(own, { y = "velocity" }), "theta', mm/time")
    equal(own.units.theta, "mm")
    equal(own.units.t, nil)
    equal(own.system.units.theta, "mm")
    equal(block.units.theta, "m")
    equal(own:continue{ t_end = 6 }.units.theta, "mm")
end)

test("the varied column of a response has its unit", function()
    for name, unit in pairs { period = "s", frequency = "1/s", omega = "rad/s" } do
        equal(block:response { over = { [name] = { 2, 3 } } }.units[name], unit, name)
    end
end)

test("no number depends on the units", function()
    local other = plain:simulate(asked())
    equal(run.theta, other.theta)
    equal(#run.events, #other.events)
    equal(block.T0, plain.T0)
end)

test("sys:with keeps units, changes them and removes them", function()
    equal(block:with{ Rd = 0.2 }.units.M, "N")
    equal(block:with{ units = { theta = "cm" } }.units.M, nil)
    equal(tostring(block:with{ units = {} }), tostring(plain))
    equal(nondimensional{ units = { t = "T0" } }.units.t, "T0")
    equal(plain.units.theta, "rad")
    equal(plain.units.t, nil)
end)

test("the text of a system includes its units", function()
    has_not(plain, "units")
    has(block, 'units = { theta = "m", t = "s", M = "N" } }')
    local systems = { block, system{ I = 1, k = 4, units = { t = "s" } },
        system{ I = 1, k = 4, friction = friction.stribeck{ Rd = .3, Re = .6, speed = .1 }, units = metres },
        system{ I = 1, k = 0, walls = { upper = 1 }, units = { theta = "°", t = "h" } } }
    for _, sys in ipairs(systems) do
        local again = load("return " .. tostring(sys))()
        equal(tostring(again), tostring(sys))
        equal(again.units.t, sys.units.t)
    end
end)

test("energies and steady motions have derived units", function()
    has(run:energy(), "energy in N m, t 0 … 5 s:")
    has(plain:with{ units = { M = "N m" } }:simulate(asked()):energy(), "energy in N m, t 0 … 5:")
    has_not(plain:simulate(asked()):energy(), "energy in")
    has(block:steady{ M = excitation.harmonic{ amplitude = 2, omega = 1 } }, "period 6.28319 s, amplitude", " m, ")
end)

test("the story states the units once, and the time in them", function()
    says(run, "Units: theta in m, t in s, M in N.")
    has(block:simulate{ theta0 = 0.04, t_end = 4, dt = 1 }:explain(), "Units:")
    local stops = block:with{ Re = 1.5, Rd = 1 }:simulate(asked{ theta0 = 0 })
    has(stops:explain(), " of 5 s")
    has_not(plain:simulate(asked()):explain(), "Units:")
end)

test("columns of tables have units, and keep them when rows are selected; their names are unchanged", function()
    local events = run.events
    has(events, "t, s", "theta, m", "M, N")
    has(events:markdown(), "| t, s | kind | theta, m | M, N |")
    has(events:filter(function(row) return row.t > 1 end), "theta, m")
    has(events:select("theta"), "theta, m")
    equal(events.names[1], "t")
    equal(#events.theta, #events)
    has_not(plain:simulate(asked()).events, ", rad")
    has(run:spectrum "velocity", "frequency, 1/s", "amplitude, m/s")
    has(run:poincare{ period = 1 }, "velocity, m/s")
    equal(reloaded(events).names[3], "theta")
end)

test("a response has units at its axes and in its jumps", function()
    local curve = block:response{ amplitude = 2, over = { frequency = vector.linspace(0.2, 0.5, 5) }, between = true }
    has(curve, "frequency, 1/s", "amplitude, m")
    has(curve:plot{ y = "amplitude", width = 60, ascii = true, show = false }, "frequency, 1/s", "amplitude, m")
    has(curve.linearised, "amplitude, m")
    has(block:response{ frequency = 0.3, over = { amplitude = vector.linspace(1, 2, 3) }, between = true }, "M0, N")
end)

test("a fit has the units of its record, and no unit of torque if the record has none", function()
    local function decay(sys) return sys:simulate{ theta0 = 1, t_end = 8, dt = 0.05 } end
    local fit, known = identify{ data = decay(block) }, identify{ data = decay(block), I = 1 }
    assert(tostring(fit):find "omega0 +2 .* rad/s\n" and tostring(fit):find "theta0 +1 .* m\n", tostring(fit))
    equal(fit.system.units.t, "s")
    equal(fit.system.units.M, nil)
    equal(known.system.units.M, "N")
    assert(tostring(known):find "k +4 .* N/m\n", tostring(known))
    has(fit:plot{ show = false, width = 60, ascii = true }, "theta, m", "t, s")
    has_not(identify{ data = decay(plain) }, "rad")
end)

test("a report has units in its tables", function()
    local file = temporary ".html"
    local page = report{ title = "units" }
    page:table(run.events)
    page:save(file)
    has(read(file), "<th>t, s</th>", "<th>theta, m</th>", "<th>kind</th>")
end)

test("a file keeps the units, for its readers and for the loaded run", function()
    local old, file = reloaded(run)
    has(read(file), "# -- units: theta in m, t in s, M in N\n", 'units = { theta = "m", t = "s", M = "N" }',
        "\nt,theta,velocity,M,")
    equal(old.units.M, "N")
    has(picture(old, { y = "velocity" }), "theta', m/s")
    has(old:explain(), "It has theta in m, t in s, M in N.")
    equal(reloaded(old).units.theta, "m")
end)

test("the units in a stranger's file are accepted if they are words", function()
    local file = temporary ".csv"
    for said, theta in pairs{ ["theta in m\27[31m"] = "rad", ["theta in in"] = "in", ["theta in " .. ("m"):rep(99)] = "rad",
        ["nonsense"] = "", ["t in s"] = "" } do
        write(file, "# -- units: " .. said .. "\nt,theta\n0,1\n1,2\n")
        equal(load(file).units.theta or "", theta)
    end
end)

test("a nondimensional system has units such as Mc/k and T0, unless others are given", function()
    local units = nondimensional {}.units
    equal(units.theta .. " " .. units.t .. " " .. units.M, "Mc/k T0 Mc")
    equal(nondimensional { units = { theta = "rad" } }.units.t, nil)
end)

test("wrong units are errors", function()
    refuses(system, {
        { { I = 1, k = 4, units = "m" }, 'units must be a table such as { theta = "m"' },
        { { I = 1, k = 4, units = { theta = 1 } }, "theta must be a string" },
        { { I = 1, k = 4, units = { time = "s" } }, "'time'" },
        { { I = 1, k = 4, units = { "m", "s" } }, "units" },
    })
    refuses(function(o) plain:with(o) end, {
        { { units = { t = "s\27[2J" } }, "the unit of t must be a short word" },
        { { units = { t = "a, b" } }, "without quotes and commas" },
        { { unit = metres }, "did you mean 'units'?" },
    })
    refused { { 'plain:simulate(asked{ units = { M = ("N"):rep(25) } })', "the unit of M must be a short word" } }
    refuses(function(units) run:plot{ units = units, show = false } end, {
        { { theta = 'm"' }, "the unit of theta must be a short word" },
        { "m", "units must be a table such as" },
        { { time = "s" }, "'time'" },
    })
end)

finish()
