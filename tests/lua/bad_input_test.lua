-- Wrong values get a sentence with the value, the limit and the user's line; simulate_test.lua has those of simulate.
dofile "tests/lua/support.lua"

test("a system that cannot exist is refused with the parameter and its value", function()
    refuses(system, { -- option_rows_test.lua has those of one option alone
        { { I = 0, k = 1 }, "system: I = 0 must be positive" },
        { { I = 1, k = 1, Rd = 2, Re = 1 }, "Re = 1 must be at least Rd = 2" },
        { { I = 1e-300, k = 1e300 }, "too far apart" },
    })
    raises_here(function() nondimensional { friction_ratio = 0.5, breakaway_ratio = 0.4 } end,
        "nondimensional: breakaway_ratio = 0.4 must be at least friction_ratio = 0.5")
end)

test("a missing parameter is named, with an example", function()
    refuses(system, {
        { { I = 1 }, "system needs k, for example system{ I = 1, k = 39.5" },
        { {}, "system needs I" },
    })
    raises_here(function() system() end, "system takes one table of named options, for example system{")
    raises_here(function() system(1, 2) end, "one table of named options")
    raises_here(function() system { 1, 2 } end, "named options only")
    raises_here(function() system({ I = 1, k = 1 }, 3) end, "one table")
end)

test("a misspelt parameter gets a suggestion and the list", function()
    refuses(system, {
        { { i = 1, k = 1 }, "system has no option 'i' among I, k, C, Rd, Re, friction, normal, spring, walls, bodies, links and units; did you mean 'I'?" },
    })
    refuses(nondimensional, {
        { { zetta = 1 }, "did you mean 'zeta'?" },
        { { friction = 1 }, "did you mean 'friction_ratio'?" },
    })
    raises_here(function() return theory.magnificaton end, "there is no theory.magnificaton; did you mean 'magnification'?")
    raises_here(function() return theory[3] end, "there is no theory[3]")
end)

test("a table of options may have a metatable, but options hidden in it do not count", function()
    local tricky = setmetatable({ I = 1 }, { __index = function() return 5 end })
    raises_here(function() system(tricky) end, "needs k")
end)

test("methods and metamethods called on a wrong value raise errors and do not crash", function()
    local sys = system { I = 1, k = 1 }
    local run = sys:simulate { theta0 = 1, t_end = 1, dt = 0.5 }
    local meta = debug.getmetatable(run)
    for _, value in ipairs { 1, "x", {}, sys, run.theta, io.stdout, print } do
        for name, f in pairs(meta) do
            if type(f) == "function" and name ~= "__newindex" then
                pcall(f, value)
                pcall(f)
            end
        end
        assert(not pcall(sys.simulate, value, { t_end = 1, dt = 1 }) or value == sys)
        assert(not pcall(run.at, value, 0.5))
        assert(not pcall(run.save, value, "x.csv"))
    end
    meta.__gc(run)
    assert(not pcall(function() return run.theta end))
    collectgarbage()
end)

test("getmetatable of an object returns a name, so that nobody breaks it by accident", function()
    equal(getmetatable(system { I = 1, k = 1 }), "system")
    assert(not pcall(setmetatable, system { I = 1, k = 1 }, {}))
end)

test("a list of numbers has none that is not finite", function()
    local sys = system { I = 1, k = 1 }
    local run = sys:simulate { theta0 = 1, t_end = 1 }
    for word, number in pairs { inf = math.huge, nan = 0 / 0 } do
        for _, call in ipairs { vector, function(list) return excitation.ramp {}:values(list) end, function(list) return run:at(list) end,
            function(list) return sys:simulate { times = list } end } do
            raises(function() call { 0.5, number } end, "[2] = " .. word .. " must be finite")
        end
    end
end)

test("errors of a call through pcall and in a tail call still name a line", function()
    local function tail() return system { I = 0, k = 1 } end
    raises_here(tail, "system: I = 0")
    local ok, message = pcall(system, { I = 0, k = 1 })
    assert(not ok, message)
    has(message, "system: I = 0")
end)

test("times with powers that overflow are refused", function()
    refuses(system, {
        { { I = 1e200, k = 1 }, "I = 1e+200 and k = 1 are too far apart for double precision: choose other units" },
        { { I = 1e-200, k = 1 }, "too far apart" },
    })
    for _, sys in ipairs { system { I = 1, k = 0 }, system { bodies = { a = { I = 1 } } } } do
        refuses(function(options) return sys:simulate(options) end, {
            { { t_end = 1e71 }, "t_end = 1e+71 is more than 1e+70 after t_start = 0: choose a longer unit of time" },
            { { t_start = 2, t_end = 1 }, "t_end = 1 must be after t_start = 2" },
        })
    end
end)

finish()
