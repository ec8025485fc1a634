-- Wrong values get a sentence with the value, the limit and the user's line; simulate_test.lua has those of simulate.
dofile "tests/lua/support.lua"

test("a system that cannot exist is refused with the parameter and its value", function()
    refuses(system, { -- option_rows_test.lua has those of one option alone
        { { I = 0, k = 1 }, "system: I = 0 must be positive" },
        { { I = 1, k = 1, Rd = 2, Re = 1 }, "Re = 1 must be at least Rd = 2" },
        { { I = 1e-300, k = 1e300 }, "too far apart" },
    })
    refused { { "nondimensional { friction_ratio = 0.5, breakaway_ratio = 0.4 }", "nondimensional: breakaway_ratio = 0.4 must be at least friction_ratio = 0.5" } }
end)

test("a missing parameter is named, with an example", function()
    refuses(system, {
        { { I = 1 }, "system needs k, for example system{ I = 1, k = 39.5" },
        { {}, "system needs I" },
    })
    refused {
        { "system()", "system takes one table of named options, for example system{" },
        { "system(1, 2)", "one table of named options" },
        { "system { 1, 2 }", "named options only" },
        { "system({ I = 1, k = 1 }, 3)", "one table" },
    }
end)

test("a misspelt parameter gets a suggestion and the list", function()
    refuses(system, {
        { { i = 1, k = 1 }, "system has no option 'i' among I, k, C, Rd, Re, friction, normal, spring, walls, bodies, links and units; did you mean 'I'?" },
    })
    refuses(nondimensional, {
        { { zetta = 1 }, "did you mean 'zeta'?" },
        { { friction = 1 }, "did you mean 'friction_ratio'?" },
    })
    refused {
        { "theory.magnificaton", "there is no theory.magnificaton; did you mean 'magnification'?" },
        { "theory[3]", "there is no theory[3]" },
    }
end)

test("a table of options may have a metatable, but options hidden in it do not count", function()
    local tricky = setmetatable({ I = 1 }, { __index = function() return 5 end })
    refused { { "system(tricky)", "needs k" } }
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

test("a list with a number that is not finite is refused", function()
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

test("arguments that are wrong in other ways than by an option are refused in the words of their call", function()
    local record = { t = vector.range(0, 9), theta = vector.range(0, 9):abs() }
    local guess = system { I = 1, k = 1, Rd = 0.1 }
    local function fit(options) return function() identify(merged({ data = record, system = guess, free = { "k" } }, options)) end end
    local d, sine = data { x = { 1, 2 }, y = { 3, 4 } }, excitation.harmonic { omega = 1 }
    local function extremes(options)
        return function() theory.extremes { system = system(merged({ I = 1, k = 4 }, options)), theta0 = 1 } end
    end
    for sentence, call in pairs {
        ["data takes one table of columns"] = function() data(1) end,
        ["load reads CSV files, not .xlsx"] = function() load "x.xlsx" end,
        ["progress needs the number of steps"] = function() progress "x" end,
        ["progress: the label must be a string, got 4"] = function() progress(3, 4) end,
        ["rows are selected by d:filter"] = function() return d[true] end,
        ["'x.dat' is a name for the record of 1989"] = function() d:save "x.dat" end,
        ["x must be one column"] = function() d:plot { x = { "x", "y" } } end,
        ["an excitation cannot be scaled by inf"] = function() return math.huge * sine end,
        ["speed must begin with 0: friction at standstill"] = function() friction.table { speed = { 1, 2 }, torque = { 1, 2 } } end,
        ["speed[3] = 2 is not greater than speed[2] = 2"] = function() friction.table { speed = { 0, 2, 2 }, torque = { 1, 2, 2 } } end,
        ["torque[1] = -1 must not be negative"] = function() friction.table { speed = { 0, 2 }, torque = { -1, 2 } } end,
        ["walls: restitution = 2 must be from 0 to 1"] = function() system { I = 1, k = 1, walls = { lower = -1, upper = 1, restitution = 2 } } end,
        ["I = 1e-200 and C = 1e+200 are too far apart"] = function() system { I = 1e-200, k = 0, C = 1e200 } end,
        ["coefficients is empty; give at least one"] = function() excitation.polynomial { coefficients = {} } end,
        ["a measured column is constant"] = fit { data = { t = record.t, theta = 0 * record.t } },
        ["a measured column needs at least 8 numbers"] = fit { data = { t = vector.range(0, 4), theta = vector.range(0, 4) } },
        ["times must increase, but t = 9 is followed by 8"] = fit { data = { t = vector.range(9, 0, -1), theta = record.theta } },
        ["measured must be \"theta\", \"velocity\" or"] = fit { measured = { 3 } },
        ["needs rigid walls, and those of this system are elastic"] = extremes { walls = { upper = 1, stiffness = 9 } },
        ["that of this system acts one way or through springs"] = extremes { friction = friction.jenkins { stiffness = 3, Rd = 1 } },
        ["needs constant friction, and that of this system varies"] = extremes { Rd = math.cos },
        ["the friction of this system is a function: give both Rd and Re"] = function()
            system { I = 1, k = 4, friction = function(v) return 0.3 end }:with { Rd = 1 }
        end,
    } do
        raises_here(call, sentence)
    end
    local sys = system { I = 1, k = 4, friction = function(v) return 0.3 end }:with { k = 5 }
    equal(tostring(sys), "system{ I = 1, k = 5, friction = function(v) return 0.3 end }")
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
