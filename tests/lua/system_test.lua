dofile "tests/lua/support.lua"

test("a system shows its given values; C and Rd are zero and Re is Rd unless given", function()
    local function shown(sys) return table.concat({ sys.I, sys.k, sys.C, sys.Rd, sys.Re }, " ") end
    equal(shown(system { I = 2, k = 8, C = 0.5, Rd = 1, Re = 1.5 }), "2.0 8.0 0.5 1.0 1.5")
    equal(shown(system { I = 1, k = 1 }), "1.0 1.0 0.0 0.0 0.0")
    equal(system { I = 1, k = 1, Rd = 3 }.Re, 3.0)
end)

test("the regime is decided exactly, and only a swinging system has omega1", function()
    for C, regime in pairs { [0] = "undamped", [12 - 2 ^ -49] = "underdamped", [12] = "critical", [12 + 2 ^ -49] = "overdamped" } do
        local sys = system { I = 4, k = 9, C = C }
        equal(sys.regime, regime)
        equal(sys.omega1 ~= nil, C < 12)
    end
    equal(system { I = 4, k = 9, C = 12 }.zeta, 1.0)
end)

test("the report's system has the values that DINAL printed, and parameters too far apart are refused", function()
    local sys = system { I = 1, k = 39.48, C = 3, Rd = 6.6 }
    for name, value in pairs { omega0 = 6.283311, T0 = 0.99998, zeta = 0.2387276 } do near(sys[name] / value, 1, 1e-6) end
    local Mc = sys:characteristic_torque(0, 6.2832) -- k sqrt(theta0^2 + (v0/w0)^2)
    near(Mc, 39.4793, 4e-4)
    near(sys:friction_ratio(Mc), 0.167176, 2e-6)
    equal(sys:friction_ratio(-Mc), sys:friction_ratio(Mc))
    equal(sys:characteristic_torque(-2), 2 * 39.48)
    local tiny = system { I = 1e-200, k = 1e-200, C = 2e-200 }
    near(tiny.omega0 + tiny.zeta, 2, 1e-12)
    refuses(system, { { { I = 1e-300, k = 1e300 }, "too far apart" }, { { I = 1e300, k = 1e-300 }, "too far apart" } })
end)

test("the nondimensional system has k = 1, T0 = 1, and the given ratios", function()
    local nd = nondimensional { zeta = 0.119, friction_ratio = 0.418, breakaway_ratio = 0.45 }
    equal(nd.k, 1.0)
    equal(nd.T0, 1.0)
    near(nd.zeta, 0.119, 1e-16)
    equal(nd.Rd, 0.418)
    equal(nd.Re, 0.45)
    equal(nondimensional { friction_ratio = 0.3 }.Re, 0.3)
    equal(nondimensional().regime, "undamped")
    equal(nondimensional { zeta = 1 }.regime, "critical")
end)

test("friction ratio and characteristic torque are those of the report", function()
    local sys = system { I = 1, k = 4, Rd = 0.5 }
    equal(sys:friction_ratio(-2), 0.25)
    equal(sys:characteristic_torque(3), 12.0)
    refused {
        { "sys:friction_ratio(0)", "Mc = 0" },
        { "sys.friction_ratio(2)", "use a colon", "sys:friction_ratio(Mc)" },
    }
end)

test("a system cannot be changed", function()
    local sys = system { I = 1, k = 4 }
    refused { { "sys.I = 2", "a system cannot be changed, so 'I' cannot be set; make a new one" } }
end)

test("a misspelt field is an error with a suggestion", function()
    local sys = system { I = 1, k = 4 }
    refused {
        { "sys.omga0", "a system has no field 'omga0'; did you mean 'omega0'?" },
        { "sys[1]", "a system has no field [1]" },
    }
end)

test("the integrator objects show themselves and cannot be changed", function()
    equal(tostring(integrator.rk4 { h = 0.001 }), "integrator.rk4{ h = 0.001 }")
    equal(tostring(integrator.dinal1989 { h = 0.01, stop = "text", slip = true }),
        'integrator.dinal1989{ h = 0.01, stop = "text", slip = true }')
    equal(integrator.rk4 { h = 0.5 }.name, "rk4")
    refused { { "integrator.rk4 { h = 1 }.h = 2", "an integrator cannot be changed" } }
    equal(tostring(integrator.spectral {}), "integrator.spectral{}")
    equal(tostring(integrator.spectral { tolerance = 1e-9, max_panel = 0.25 }), "integrator.spectral{ tolerance = 1e-09, max_panel = 0.25 }")
    equal(integrator.spectral { max_panel = 0.25 }.max_panel, 0.25)
    equal(integrator.spectral {}.h, nil)
    refused { { "integrator.rk5", "did you mean 'rk4'?" } }
end)

test("dinal is a table whose members are globals, and a user may overwrite these", function()
    equal(require "dinal", dinal)
    for _, name in ipairs { "system", "nondimensional", "excitation", "integrator", "theory", "vector", "help" } do
        assert(_G[name] ~= nil and rawget(dinal, name) == _G[name], name)
    end
    local saved = {}
    for name in pairs(dinal) do
        saved[name] = _G[name]
        _G[name] = nil
    end
    local d, s = dinal, string
    dinal, string, math = nil, nil, nil
    local ok, problem = pcall(function()
        local run = d.nondimensional { zeta = 0.1 }:simulate { M = function() return 1 end, t_end = 1, dt = 0.5 }
        assert(#run == 3 and run.t[3] == 1 and run.events and tostring(run))
        local failing = pcall(run.system.simulate, run.system, { M = function() error("x") end, t_end = 1, dt = 1 })
        assert(not failing and d.partial)
    end)
    dinal, string, math = d, s, package.loaded.math
    for name, value in pairs(saved) do
        _G[name] = value
    end
    assert(ok, problem)
end)

test("a spring of -0 counts as none, and infinite friction is an error", function()
    local block = system{ I = 1, k = -0.0, Rd = 0.5 }
    equal(tostring(block.k), "0.0")
    local r = block:simulate{ velocity0 = 1, t_end = 3, dt = 1 }  -- it stops at v^2/(2 Rd) = 1
    near(r.theta[4], 1, 1e-12)
    refused {
        { "nondimensional{ friction_ratio = 1e308 }", "nondimensional: friction of 1e+308 and k = 1 are too far apart for double precision" },
        { "system{ I = 1e-10, k = 0, Rd = 1e300 }", "friction of 1e+300 and I = 1e-10" },
    }
    -- What is a thousandth of that holds the mass where it is.
    assert(nondimensional{ friction_ratio = 1e300 }:simulate{ velocity0 = 6, t_end = 3, dt = 1 }.theta:abs() < 1e-12)
end)

test("a constant normal load makes an ordinary system with scaled friction", function()
    local sys, same = system { I = 1, k = 4, C = 0.1, Rd = 0.25, Re = 0.5, normal = 2 }, system { I = 1, k = 4, C = 0.1, Rd = 0.5, Re = 1 }
    equal(sys.dead_zone, same.dead_zone)
    equal(sys.Rd, 0.25)
    equal(sys.normal, 2.0)
    equal(sys:friction_ratio(1), 0.5)
    equal(tostring(sys), "system{ I = 1, k = 4, C = 0.1, Rd = 0.25, Re = 0.5, normal = 2 }")
    equal(tostring(sys:with { Rd = 0.5 }), "system{ I = 1, k = 4, C = 0.1, Rd = 0.5, Re = 0.5, normal = 2 }")
    equal(tostring(sys:with { normal = 1 }), "system{ I = 1, k = 4, C = 0.1, Rd = 0.25, Re = 0.5 }")
    local M = excitation.harmonic { amplitude = 2, omega = 1.3 }
    for _, by in ipairs { integrator.exact {}, integrator.spectral {}, integrator.rk4 { h = 0.01 } } do
        local function theta(of) return of:simulate { M = M, t_end = 20, integrator = by }.theta end
        equal((theta(sys) - theta(same)):abs():max(), 0.0)
    end
    equal(sys:steady { M = M }.amplitude, same:steady { M = M }.amplitude)
    equal(repeated(sys:simulate { M = M, t_end = 5 }).system.normal, 2.0)
    local law = friction.law(function(v) return v < 0.5 and 0.3 or 0.2 end)
    local double = friction.law(function(v) return v < 0.5 and 0.6 or 0.4 end)
    local a = system { I = 1, k = 4, friction = law, normal = 2 }:simulate { theta0 = 3, t_end = 9 }
    local b = system { I = 1, k = 4, friction = double }:simulate { theta0 = 3, t_end = 9 }
    near((a.theta - b.theta):abs():max(), 0, 1e-12)
end)

test("a system with varying friction has the fields that need no constant law", function()
    local Rd = function(t) return 1 + t end
    local sys = system { I = 1, k = 4, C = 1, Rd = Rd }
    equal(sys.k, 4.0)
    equal(sys.omega0, 2.0)
    equal(sys.regime, "underdamped")
    equal(sys.units.theta, "rad")
    equal(sys.Rd, Rd)
    refused {
        { "sys.dead_zone", "this system has no constant dead_zone: its Rd is a function" },
        { "sys.friction", "this system has no constant friction: its Rd is a function" },
    }
    equal(sys:with { k = 9 }.omega0, 3.0)
    equal(tostring(sys:with { Rd = 1 }), "system{ I = 1, k = 4, C = 1, Rd = 1, Re = 1 }")
    equal(system { I = 1, k = 4, Rd = 1 }:with { normal = Rd }.normal, Rd)
    refused { { "sys:with { bodies = {} }", "bodies are of a system with names" } }
end)

finish()
