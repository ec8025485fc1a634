dofile "tests/lua/support.lua"

test("the work of a torque is its integral over the body's way, and a slipping clutch dissipates", function()
    local rig = system { bodies = { motor = { I = 1 }, load = { I = 3 } }, links = { clutch = { "motor", "load", Rd = 2 } } }
    local run = expect(rig, { velocity0 = { motor = 3 }, M = { motor = 1 }, t_end = 4 })
    local e = run:energy()
    near(e.motor.input, run.motor.theta[1001], 1e-12)
    near(e.clutch.dry, 2 * (run.clutch.theta[1001]), 1e-11)
    near(e.total.dry, e.clutch.dry, 0)
    local free = rig:simulate { velocity0 = { motor = 3 }, t_end = 4 }:energy() -- 4.5 becomes 4 (3/4)^2 / 2
    has(tostring(free):gsub("%s+", " "), "input kinetic spring viscous dry", "motor 0 -4.21875 0 0 0", "load 0 0.84375 0 0 0",
        "clutch 0 0 0 0 3.375 ", "all 0 -3.375 0 0 3.375 ")
    refused { { "e.brake", "this energy has no 'brake'; its bodies and links are load, motor, clutch" } }
end)

test("the rows of the table of several bodies show the numbers of each", function()
    local a, link = { I = 1, k = 4, C = 0.1, Rd = 0.2 }, { k = 3, C = 0.05, Rd = 0.1 }
    local energy = pair(a, { I = 1, C = 0.3 }, link):simulate { velocity0 = { a = 1 }, M = { b = 2 }, t_end = 9 }:energy()
    local columns, rows = { "input", "kinetic", "spring", "viscous", "dry" }, 0
    for name, numbers in tostring(energy):gsub("\n  error.*", ""):gmatch "\n  (%l+) +(%-?%d[^\n]*)" do
        local i = 0
        for number in numbers:gmatch "%S+" do
            i = i + 1
            near(tonumber(number), (name == "all" and energy.total or energy[name])[columns[i]], 1e-5 * energy.total.flow)
        end
        equal(i, 5, name)
        rows = rows + 1
    end
    equal(rows, 4)
end)

test("a locked pair gets all its energy from its belt, and varying friction is named as such", function()
    local e = expect(pair({ I = 1, k = 1, Rd = 5 }, { I = 1 }, { Rd = 5 }), { belt = { a = 0.3 }, velocity0 = { a = 0.3, b = 0.3 }, t_end = 3 }):energy()
    equal(e.total.dry, 0.0)
    near(e.a.belt, 0.9 ^ 2 / 2, 1e-12)
    local varying = system { I = 1, k = 4, Rd = 0.3, normal = function(t) return 1 end }:simulate { theta0 = 1.03, t_end = 20 }
    says(varying, "dry friction that varies")
    has_not(varying:explain(), "because", "M is constant")
end)

test("the energy of several bodies is computed during the run: no function is called for it", function()
    local calls = 0
    local function M(t) calls = calls + 1 return math.sin(1.3 * t) + 0 * #tostring(t) end
    local rig = pair({ I = 1, k = 2, Rd = 0.2 }, { I = 2, k = 1, walls = { upper = 0.4, restitution = 0.6 } }, { k = 3, C = 0.1, Rd = 0.1 })
    local options = { M = { a = M }, belt = { b = 0.1 }, base = 0.05, theta0 = { a = 0.3 }, t_end = 40, dt = 0.5 }
    local whole = rig:simulate(options)
    local before = calls
    local total = whole:energy().total
    whole:explain()
    equal(calls, before)
    assert(total.closure < 1e-11, total.closure)
    local energy = whole:energy()
    near(energy.finish.kinetic + energy.finish.spring - energy.start.kinetic - energy.start.spring, total.kinetic + total.spring, 1e-9)
end)

test("explain describes a run of several bodies", function()
    local rig = system { bodies = { motor = { I = 1 }, load = { I = 3, Rd = 0.1 } }, links = { clutch = { "motor", "load", Rd = 2 } } }
    says(rig:simulate { velocity0 = { motor = 3 }, t_end = 40 }, "There is no M.", "clutch links motor and load",
        "It locked at t = 1.1392 at theta = 1.7089", "It stopped at t = 30 at theta = 10.823", "It stays at rest")
    local still = rig:simulate { M = { motor = 0.05 }, t_end = 4 }
    says(still, "load started at t = 0 from theta = 0 with velocity 0 and stuck there.", "and stuck together.")
    says(still.clutch, "clutch links motor and load", "and stuck together.")
    has_not(still.clutch:explain(), "load started", "Energy")
    local stopped = rig:simulate { velocity0 = { motor = 3 }, t_end = 40, events = { { when = function(t) return t - 2 end, stop = true } } }
    says(stopped, "The run stopped early, at t = 2")
    -- A load that the motor lets slip again has no reason that one body alone could give.
    local slips = rig:simulate { M = { motor = function(t) return 2.2 * math.sin(t) end }, t_end = 20 }
    says(slips.load, "load has I = 3 and dry friction Rd = Re = 0.1", "until t = ", "when it slipped")
    has_not(slips.load:explain(), "because", "|M")
end)

test("an act adds the kinetic energy of the body that it changes", function()
    local rig = system { bodies = { a = { I = 2, k = 3 }, b = { I = 5 } }, links = { l = { "a", "b", k = 1 } } }
    local run = rig:simulate { theta0 = { a = 1 }, t_end = 4, events = { { when = function(t) return t - 1 end, act = function(_, _, v) v.b = v.b + 0.7 end } } }
    local before, energy = run.b.events[1].velocity, closes(run)
    near(energy.b.acts, 5 / 2 * ((before + 0.7) ^ 2 - before ^ 2), 1e-12)
    equal(energy.a.acts, 0.0)
end)

test("explain names a support or a belt that drives several bodies", function()
    local rig = system { bodies = { a = { I = 1, k = 1, C = 0.1 }, b = { I = 1, k = 1, Rd = 0.1 } } }
    local run = rig:simulate { belt = { b = 0.2 }, base = excitation.harmonic { omega = 1 }, t_end = 20 }
    says(run, "There is no M.", "b rubs on a belt that moves with velocity vb = 0.2.", "The support accelerates", "the base under a")
    has_not(run:explain(), "free", "under of", "1 bodies")
    says(system { bodies = { a = { I = 1, k = 1 } } }:simulate { base = 1, t_end = 5 }, "There is no M.", "The support accelerates")
    says(system { I = 1, k = 1, Rd = function() return 0.1 end }:simulate { belt = 1, t_end = 5 }, "The mass rubs on a belt that moves with velocity vb = 1.")
end)

test("a file of several bodies has their units, and a header that repeats the run", function()
    local units, pull = { theta = "m", t = "s", M = "N" }, 0.3
    local parts = {
        bodies = {
            a = { I = 1, k = 4, Rd = function(t) return 0.1 + pull * t end, spring = function(x) return x ^ 3 end },
            b = { I = 2, C = 0.1, walls = { lower = -1, upper = 1, restitution = 0.5 } },
            c = { I = 1, k = 1, friction = friction.stribeck { Rd = 0.1, Re = 0.2, speed = 0.1 }, normal = function(t, theta) return 1 + theta.a ^ 2 end },
            d = { I = 1, k = 2, friction = function(speed) return 0.1 / (1 + speed) end, Re = 0.3 },
        },
        links = { rod = { "a", "b", k = 3, Rd = 0.05, Re = 0.1 } }, units = units,
    }
    local rig = system(parts)
    local run = rig:simulate {
        M = { a = excitation.harmonic { omega = 2 }, b = function(t) return pull * math.sin(t) end }, belt = { c = 0.2, rod = 0.1 },
        base = excitation.harmonic { amplitude = 0.1, omega = 1 }, theta0 = { a = 0.1 }, velocity0 = { b = 0.2 }, t_end = 5, dt = 0.5,
        states = { z = { start = 1, rate = function(t, theta, velocity, z) return pull * theta.a - z.z end } },
        events = { { when = function(t, theta) return theta.a - 0.2 end, name = "there", act = function(t, theta, velocity) velocity.a = 0 end } },
    }
    local longer = run:continue { t_end = 7 }
    pull = 7 -- the file has what it was
    for _, each in ipairs { run, longer } do
        local again = repeated(each)
        equal(tostring(again), tostring(each))
        for _, column in ipairs { "a.theta", "b.theta", "c.friction", "d.velocity", "rod.torque", "z" } do
            near(again:data()[column], each:data()[column], each == run and 0 or 1e-9)
        end
        equal(again.system.bodies[4], "d")
    end
    equal(run.status .. run.a.status, "endend")
    local back, file = reloaded(run)
    equal(back["rod.torque"], run.rod.torque)
    has(back, "a.theta, m", "a.velocity, m/s")
    has(back:select("rod.torque"), "rod.torque, N")
    has(read(file), "# run = sys:simulate{ M = M, states = states, ", "theta in m, t in s, M in N")
    equal(repeated(rig:simulate { t_end = 5, times = { 1, 2.5 } }).t[2], 2.5)
    equal(repeated(run.a):data()["a.theta"], run.a.theta)
    local one = system { I = 1, k = 1, Rd = function() return 0.1 end, units = units }:simulate { belt = 0.2, theta0 = 1, t_end = 3, dt = 0.5 }
    local same = repeated(one)
    equal(same.theta, one.theta)
    equal(same.units.t, "s")
    local steady = system { bodies = { a = { I = 1, k = 1, C = 0.5 } } }:steady { M = { a = excitation.harmonic { omega = 1 } } }.run
    near(repeated(steady).a.theta, steady.a.theta, 1e-9)
end)

test("half cycles of a body among several begin and end at its own events, also while it rests", function()
    local a = { I = 1, k = 4, Rd = 0.3, Re = 0.4, walls = { lower = -0.4, upper = 0.5, restitution = 0 } }
    local options = { M = excitation.harmonic { amplitude = 2, omega = 1.3 }, theta0 = 0.4, t_end = 12 }
    local alone = system(a):simulate(options):energy().half_cycles
    local rig = system { bodies = { a = a, b = { I = 1, k = 1 } } }
    local beside = rig:simulate { M = { a = options.M }, theta0 = { a = 0.4, b = 1 }, t_end = 12 }.a:energy().half_cycles
    equal(#beside, #alone)
    for i, half in ipairs(alone) do
        near(beside[i].t_start, half.t_start, 1e-9)
        near(beside[i].t_end, half.t_end, 1e-9)
        near(beside[i].dry, half.dry, 1e-9)
    end
end)

test("the energy of a link called like a column hides that column", function()
    local run = system { bodies = { motor = { I = 1 }, load = { I = 3 } }, links = { belt = { "motor", "load", Rd = 2 } } }
        :simulate { velocity0 = { motor = 3 }, t_end = 4 }
    local energy = run:energy()
    near(energy.belt.dry, 3.375, 1e-12)
    equal(energy.total.belt, 0.0)
    equal(#energy.dry, #run)
    refused { { "energy.blt", "belt" } }
end)

test("the energy at the start is that of all bodies and links", function()
    local rig = pair({ I = 1, k = 4 }, { I = 2, k = 3 }, { k = 5 })
    local e = rig:simulate { theta0 = { a = 0.5, b = -0.2 }, velocity0 = { a = 1, b = 2 }, t_end = 1 }:energy()
    near(e.start.spring, (4 * 0.25 + 3 * 0.04 + 5 * 0.49) / 2, 1e-14)
    near(e.start.kinetic, 0.5 + 4, 1e-14)
end)

finish()
