-- Section 2 of the design, line by line: what a user types must run as it stands.
package.path = "tests/lua/?.lua;" .. package.path
local support = require "support"
local test, near, equal = support.test, support.near, support.equal

test("a system and its derived values", function()
    sys = system{ I = 1, k = 4*math.pi^2, C = 1.5, Rd = 16.5, Re = 18 }
    near(sys.omega0, 6.283, 5e-4)
    equal(sys.T0, 1.0)
    near(sys.zeta, 0.119, 5e-4)
    equal(sys.regime, "underdamped")
    near(sys.dead_zone, 0.456, 5e-4)
    nd  = nondimensional{ zeta = 0.119, friction_ratio = 0.418, breakaway_ratio = 0.45 }
    equal(nd.T0, 1.0)
end)

test("any Lua function is an excitation, also of the state", function()
    M = function(t) return math.sin(2*math.pi*t) end
    equal(nd:simulate{ M = M, t_end = 1, dt = 0.25 }.M[2], 1.0)
    M = function(t, theta, velocity) return -3*velocity end
    equal(nd:simulate{ M = M, velocity0 = 1, t_end = 1, dt = 0.25 }.M[1], -3.0)
end)

test("native terms add and scale, and know their own break times", function()
    M = excitation.harmonic{ amplitude = 1, frequency = 1, phase = 0 }
        + 0.5*excitation.pulse{ at = 1.5, width = 0.2 }
    equal(M:next_break(0), 1.5)
    equal(M:next_break(1.5), 1.7)
    near(M(1.6), 0.5 + math.sin(2 * math.pi * 1.6), 1e-14)
    near(excitation.harmonic{ omega = 2*math.pi }(0.25), 1, 1e-15)
    support.raises_here(function() excitation.harmonic{ omega = 1, frequency = 1 } end, "omega", "frequency")
end)

test("hints for a function, both optional", function()
    M = excitation.scripted(function(t) return math.sin(t) end, { breaks = {0.5, 2}, period = 3 })
    equal(M:next_break(2), 3.5)
    M = excitation.scripted(function(t) return t % 3 < 0.5 and 1 or 0 end, { breaks = {0.5, 2}, period = 3 })
    equal(M:next_break(2), 3.0) -- what is read is a break, too
    M = excitation.scripted(function(t) return t end)
    equal(M(2), 2.0)
end)

test("samples from a file or from tables", function()
    local name = support.temporary ".csv"
    support.write(name, "t,M\n0,0\n1,2\n3,0\n")
    M = excitation.samples(name, { time = "t", value = "M" })
    equal(M(0.5), 1.0)
    equal(M:next_break(0.5), 1.0)
    equal(excitation.samples{ t = {0, 1, 3}, M = {0, 2, 0} }(2), 1.0)
end)

test("a run, its summary, its columns and events", function()
    M = excitation.harmonic{ frequency = 1 }
    run = nd:simulate{ M = M, theta0 = 1, velocity0 = 0, t_end = 20, dt = 0.01 }
    local driven = nd:simulate{ M = M, t_end = 20, dt = 0.01, integrator = integrator.rk4{ h = 0.001 } }
    equal(#driven, 2001)
    local turns = run.events:filter(function(e) return e.kind == "turn" end)
    local head = ("2001 rows, t 0 … 20; %d events (%d turns"):format(#run.events, #turns)
    equal(tostring(run):sub(1, #head), head)
    assert(tostring(run):find("moving at the end; peak |theta| 1.96", 1, true), tostring(run))
    for _, name in ipairs { "t", "theta", "velocity", "M", "friction", "damping" } do
        local v = run[name]
        assert(#v == 2001 and v[1] and v:max() >= v:min() and v:mean() and (2 * v + v)[1] == 3 * v[1] and v:sin()[1] == math.sin(v[1]))
    end
    local e = run.events[1]
    assert(e.t and e.kind and e.theta)
    equal(run.outcome, "reached the end")
    local theta, velocity = run:at(3.21)
    assert(theta and velocity)
end)

test("files by ending", function()
    local csv, dat = support.temporary ".csv", support.temporary ".dat"
    run:save(csv)
    run:save(dat)
    assert(load(csv).theta == run.theta)
    assert(load(dat).theta == run.theta)
end)

test("integrators by name", function()
    equal(integrator.rk4{ h = 0.001 }.h, 0.001)
    equal(integrator.dinal1989{ h = 0.01 }.h, 0.01)
end)

test("help with parentheses and without", function()
    local name = support.temporary ".lua"
    support.write(name, 'sys = nondimensional{}\nhelp(sys.simulate)\nhelp "friction"\n')
    local pipe <close> = io.popen(('"%s" %s 2>&1'):format(support.program(), name))
    local text = pipe:read "a"
    assert(text:find("sys:simulate{ M = 0", 1, true) and text:find("friction.stribeck", 1, true), text)
end)

test("everything lives in the table dinal", function()
    equal(dinal.system, system)
    local run = dinal.nondimensional{ zeta = 0.1 }:simulate{ t_end = 1, dt = 0.5 }
    equal(#run, 3)
end)


test("springs and end stops", function()
    sys = system{ I = 1, k = 4, Rd = .1, spring = function(theta) return 0.5*theta^3 end }
    local native = sys:with{ spring = spring.polynomial{ [3] = 0.5 } }
    near(sys:simulate{ theta0 = 1, t_end = 3, dt = 1 }.theta[4], native:simulate{ theta0 = 1, t_end = 3, dt = 1 }.theta[4], 1e-12)
    sys = system{ I = 1, k = 0, walls = { lower = -0.8, upper = 0.8, restitution = 0.7 } }
    run = sys:simulate{ velocity0 = 1, t_end = 3, dt = 1 }
    equal(run.events[1].kind, "impact")
    near(run.events[1].t, 0.8, 1e-13)
    near(run.velocity[2], -0.7, 1e-13)
end)

support.finish()
