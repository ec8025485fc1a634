-- sweep{ ... }: the grid, what is carried to the workers, errors of points.
dofile "tests/lua/support.lua"

--- All columns as one text, every bit of every number.
local function bits(d)
    local all = {}
    for _, name in ipairs(d.names) do
        local column = d:column(name)
        for i = 1, #column do
            local x = column[i]
            all[#all + 1] = type(x) == "number" and (x ~= x and "nan" or ("%a"):format(x)) or x
        end
    end
    return table.concat(all, "|")
end

--- What the function gives at one point.
local function at_one_point(run)
    return sweep { over = { x = { 7 } }, run = run }.y[1]
end

test("a sweep has a row for each point, the last parameter changing fastest", function()
    for names, over in pairs { ["a b"] = { b = { 1, 2 }, a = vector { 10, 20 } }, ["b a"] = { { "b", { 1, 2 } }, { "a", { 10, 20 } } } } do
        local d = sweep { over = over, run = function(p) return { s = p.a + p.b } end }
        equal(table.concat(d.names, " "), names .. " s error")
        equal(d.s, names == "a b" and vector { 11, 12, 21, 22 } or vector { 11, 21, 12, 22 })
    end
    local words = sweep { over = { word = { "a", "bcd" } }, run = function(p) return { n = #p.word } end }
    equal(table.concat(words.word, " "), "a bcd")
    equal(words.n, vector { 1, 3 })
end)

test("the result is the same to the last bit for any number of workers", function()
    local function map(workers)
        return bits(sweep { over = { r = vector.linspace(0.3, 1.5, 13), g = vector.linspace(0, 0.9, 10) }, workers = workers, run = function(p)
            if p.r > 1.4 and p.g > 0.8 then error("far away") end
            local s = nondimensional { friction_ratio = p.g }:steady { M = excitation.harmonic { frequency = p.r } }
            return { A = s.amplitude, stops = s.stops, chance = math.random(), found = s.amplitude ~= nil }
        end })
    end
    local one = map(1)
    for workers = 2, 8, 3 do equal(map(workers), one) end
end)

test("math.random differs from point to point and from seed to seed, and is reproducible", function()
    local function draws(seed)
        return sweep { over = { x = vector.linspace(1, 100, 100) }, seed = seed, run = function() return { u = math.random() } end }.u
    end
    local u, seen = draws(), {}
    for i = 1, #u do seen[u[i]] = true end
    local different = 0
    for _ in pairs(seen) do different = different + 1 end
    equal(different, 100)
    equal(bits(data { u = draws(0) }), bits(data { u = u }))
    assert(bits(data { u = draws(1) }) ~= bits(data { u = u }))
end)

test("a missing result is nan, true and false are 1 and 0", function()
    local d = sweep { over = { x = { 1, 2, 3 } }, run = function(p) return { y = p.x > 1 and p.x or nil, big = p.x > 2 } end }
    assert(d.y[1] ~= d.y[1])
    equal(d.y[3], 3.0)
    equal(tostring(d.big), "vector{ 0, 0, 1 }")
    equal(table.concat(d.error), "")
end)

-- ---- what is carried

test("a function keeps its local variables, and those of the functions that it calls", function()
    local a, deep = 2, { { k = 3, [true] = 4, [1.5] = 5 } }
    local function inner(x) return a * x end
    equal(at_one_point(function(p) return { y = inner(p.x) + deep[1].k + deep[1][true] + deep[1][1.5] } end), 26.0)
end)

test("variables that functions share stay shared", function()
    local count = 0
    local function up() count = count + 1 end
    local function get() return count end
    equal(at_one_point(function() up() up() return { y = get() + 10 * count } end), 22.0)
    equal(count, 0, "and the sweep changes nothing outside")
end)

test("functions that call themselves and each other are carried", function()
    local even
    local function odd(n) return n > 0 and even(n - 1) end
    function even(n) return n == 0 or odd(n - 1) end
    local function factorial(n) return n < 2 and 1 or n * factorial(n - 1) end
    equal(at_one_point(function() return { y = factorial(5) + (even(10) and 1 or 0) } end), 121.0)
end)

test("globals that a function names are carried, also those named by functions within it", function()
    factor, helper = 3, function(x) return factor * x end
    equal(at_one_point(function(p) return { y = (function() return helper(p.x) end)() } end), 21.0)
    equal(at_one_point(function(p) return { y = _G.factor + _ENV["factor"] } end), 6.0)
    record = nondimensional {}:simulate { theta0 = 1, t_end = 1, dt = 0.5 }
    equal(at_one_point(function(p) local record = { record = 1 } return { y = record.record } end), 1.0,
        "a global of the same name as a variable or a field is not looked at")
    factor, helper, record = nil, nil, nil
end)

test("a redefined global and an extended library are carried", function()
    local own = print
    print = function() return 5 end
    function string.twice(s) return s .. s end
    equal(at_one_point(function() return { y = print() + #("ab"):twice() } end), 9.0)
    print, string.twice = own, nil
end)

test("a function with an environment of its own keeps it", function()
    local f = load("return { y = x + p }", "=text", "t", { x = 3, p = 4 })
    equal(at_one_point(f), 7.0)
end)

test("a function with more constants than instructions can name finds its globals", function()
    far_away = 42
    local text = { "local t = {" }
    for i = 1, 300 do text[#text + 1] = ("%q,"):format("text " .. i) end
    equal(at_one_point(load(table.concat(text) .. "} return { y = far_away + #t }")), 342.0)
    far_away = nil
end)

test("standard functions and tables are found by their names", function()
    local sin, library, write, print_it = math.sin, string, io.write, print
    equal(at_one_point(function()
        return { y = (sin == math.sin and library == string and write == io.write and print_it == print
            and io.stdout ~= nil) and 1 or 0 }
    end), 1.0)
end)

test("tables keep their metatables, shared parts and cycles", function()
    local class = { get = function(self) return self.value end }
    class.__index = class
    local object = setmetatable({ value = 9 }, class)
    local circle = { object = object, same = object }
    circle.circle = circle
    equal(at_one_point(function()
        return { y = circle.circle.circle.same:get() + (circle.object == circle.same and 1 or 0) }
    end), 10.0)
end)

test("a list of ten thousand links is carried", function()
    local list
    for i = 1, 4000 do list = { next = list, i = i } end
    equal(at_one_point(function()
        local sum, link = 0, list
        while link do sum, link = sum + link.i, link.next end
        return { y = sum }
    end), 4000 * 4001 / 2)
end)

test("vectors, data, systems, laws, springs, rigs, excitations and integrators are carried, with the functions in them", function()
    local a = 2
    local v, d = vector { 1, 2, 3 }, data { u = { 4, 5 } }
    local law = friction.law(function(speed) return 0.1 * a + 0.01 * speed end)
    local sys = system { I = 1, k = 4, friction = law, spring = function(theta) return 0.1 * a * theta ^ 3 end }
    local rig = system { bodies = { b = { I = 1, k = 1, Rd = function() return 0.1 * a end } } }
    local M = (3 * excitation.scripted(function(t) return math.sin(a * t) end, { breaks = { 0.5 } })):window(0, 2)
        + excitation.harmonic { frequency = 1 } + excitation.samples { t = { 0, 1 }, M = { 0, 1 } }
    local method = integrator.rk4 { h = 0.001 }
    local function run()
        local r = sys:simulate { M = M, t_end = 3, dt = 0.1, integrator = method }
        return v:sum() + d.u:sum() + law:torque(0.5) + r.theta:sum() + rig:simulate { theta0 = { b = 1 }, t_end = 3 }.b.theta:sum()
    end
    equal(at_one_point(function() return { y = run() } end), run())
end)

test("a sweep within a sweep works", function()
    local d = sweep { over = { n = { 2, 3 } }, run = function(p)
        return { total = sweep { over = { i = vector.linspace(1, p.n, p.n) }, run = function(q) return { y = q.i } end }.y:sum() }
    end }
    equal(tostring(d.total), "vector{ 3, 6 }")
end)

test("a value that cannot be carried is refused with the path to it", function()
    local run = nondimensional {}:simulate { theta0 = 1, t_end = 1, dt = 0.5 }
    local settings = { last = { run } }
    local function helper() return settings end
    raises_here(function() sweep { over = { x = { 1 } }, run = function() return { y = #helper() } end } end,
        "sweep: run uses helper > settings.last[1], a run, which cannot be in another thread", "run.theta")
    local thread, match, file = coroutine.create(print), ("a b"):gmatch("%a"), io.tmpfile()
    local steady = nondimensional { zeta = 0.1 }:steady { M = excitation.harmonic { frequency = 1 } }
    for message, f in pairs {
        ["run uses thread, a coroutine"] = function() return thread end,
        ["run uses match, a function that is written in C"] = function() return match() end,
        ["run is a function that is written in C"] = match,
        ["run uses file, a userdata"] = function() return file end,
        ["run uses steady, a steady motion"] = function() return steady end,
    } do
        raises(function() sweep { over = { x = { 1 } }, run = f } end, message)
    end
    file:close()
end)

test("endless nesting is refused in a short sentence", function()
    local nested, chain = {}, function() return 1 end
    for _ = 1, 100000 do  -- each level once took some of the stack of C++
        nested = { nested }
        local inner = chain
        chain = function() return inner() end
    end
    for what, run in pairs { nested = function() return nested end, chain = function() return chain end } do
        local fine, message = pcall(sweep, { over = { x = { 1 } }, run = run })
        assert(not fine and #message < 400, #message)
        assert(message:find("run uses " .. what .. ".*%.%.%..*within 5000 others"), message)
    end
end)

test("results may be strings, in files too", function()
    local file = temporary ".csv"
    local words = { "rest", "", "1", "a, \"b\"", "rest", "#" }
    local function swept(workers, name)
        return sweep { over = { i = vector.range(1, 6) }, workers = workers, file = name, run = function(p)
            if p.i == 5 then return { n = p.i } end
            return { n = p.i, word = words[math.tointeger(p.i)], mixed = p.i < 3 and p.i or "more" }
        end }
    end
    words[5] = ""
    for _, d in ipairs { swept(1), swept(2), swept(2, file), swept(1, file), load(file) } do
        equal(d.n, vector.range(1, 6))
        equal(table.concat(d.word, "|"), table.concat(words, "|"))
        equal(table.concat(d.mixed, " "), "1 2 more more  more")
    end
end)

test("points selects a part of the grid", function()
    local function swept(points)
        return sweep { over = { a = { 1, 2, 3 }, b = { 10, 20 } }, points = points, run = function(p)
            if p.a == 2 then error("no", 0) end
            return { y = p.a + p.b, u = math.random() }
        end }
    end
    local whole, part = swept(), swept { 2, 5 }
    for _, name in ipairs { "a", "b", "y", "u" } do
        for i = 1, 4 do assert(part[name][i] == whole[name][i + 1] or part[name][i] ~= part[name][i]) end
    end
    equal(#part, 4)
    equal(swept { 3, 4 }.error[1], "no") -- although all of them fail
    for _, points in ipairs { { 1 }, { 0, 3 }, { 3, 7 }, { 4, 3 } } do
        raises(function() swept(points) end, "sweep: points must be the first and the last one, of 1 to 6")
    end
    refused { { 'sweep { over = { x = { 1 } }, points = { 1, 1 }, file = "a.csv", run = print }', "exclude each other" } }
end)

-- ---- what goes wrong

test("a point that fails keeps its message, the others continue, and the map says so", function()
    local d = sweep { over = { x = { 1, 2, 3, 4, 5 } }, run = function(p)
        if p.x == 2 then error("two is bad", 0) end
        if p.x == 3 then return p.x end
        if p.x == 4 then return { y = { 4 } } end
        if p.x == 5 then error { code = 5 } end
        return { y = p.x }
    end }
    equal(d.error[1], "")
    equal(d.error[2], "two is bad")
    equal(d.error[3], "run must return a table of named numbers such as { A = s.amplitude }, got 3.0")
    equal(d.error[4], "run returned y = a table, which is neither a number nor a string")
    equal(d.error[5], "(error object is a table value)")
    assert(d.y[1] == 1 and d.y[2] ~= d.y[2])
    has(d, "5 points, 4 of them failed; the first one, x = 2: two is bad")
end)

test("when all points fail that is an error, with the message of the first", function()
    refused { { "sweep { over = { x = { 1, 2 } }, run = function() return syst {} end }", "sweep: all 2 points failed; the first one, x = 1: ", "attempt to call a nil value (global 'syst')" } }
    sweep { over = { x = { 1 } }, run = function() return {}, 1 end }
    for message, run in pairs {
        ["the point x = 1 failed: run must return a table"] = function() end,
        ["run must return named numbers"] = function() return { 3 } end,
        ["is the name of a parameter"] = function() return { x = 3 } end,
        ["the column of messages"] = function() return { error = 3 } end,
        ["yield"] = function() coroutine.yield() end,
        ["more than 20000 names"] = function()
            local names = {}
            for i = 1, 20001 do names["n" .. i] = i end
            return names
        end,
    } do
        raises(function() sweep { over = { x = { 1 } }, run = run } end, message)
    end
end)

test("workers do not draw, save, show progress or end the program", function()
    local v = vector { 1, 2 }
    for _, case in ipairs {
        { "a plot", function() plot { { v, v } } end },
        { "a plot", function() plot { { v, v }, file = "never.svg" } end },
        { "d:save", function() data { v = v }:save("never.csv") end },
        { "run:save", function() nondimensional {}:simulate { theta0 = 1, t_end = 1, dt = 0.5 }:save("never.csv") end },
        { "progress", function() for _ in progress(3) do end end },
        { "os.exit", function() os.exit(0) end },
    } do
        raises(function() sweep { over = { x = { 1 } }, run = case[2] } end, case[1] .. " is not possible within ")
    end
    equal(io.open("never.csv"), nil)
    equal(at_one_point(function() return { y = #tostring(plot { { v, v }, show = false }) > 100 } end), 1.0)
end)

test("mistakes in the call are errors at the user's line", function()
    local function run() return {} end
    refuses(sweep, {
        { { over = { x = {} }, run = run }, "sweep: x has no values" },
        { { over = { x = { 0 / 0 } }, run = run }, "sweep: x[1] = nan must be finite" },
        { { over = { x = { 1, y = 2 } }, run = run }, "sweep: x must be a list", "it has y" },
        { { over = { x = { "a", y = 2 } }, run = run }, "sweep: x must be a list", "it has y" },
        { { over = { x = { 1, "a" } }, run = run }, "sweep: x[2] must be a finite number" },
        { { over = { x = { "a", 1 } }, run = run }, "sweep: x[2] must be a string" },
        { { over = { x = { 1 } } }, "sweep needs run" },
        { { run = run }, "sweep needs over" },
        { { over = { x = 3 }, run = run }, "over.x must be a vector or a table of values, got 3" },
        { { x = { 1 }, run = run }, "sweep has no option 'x'" },
    })
    equal(#sweep { over = { seed = { 1, 2 }, file = { "a", "b" } }, run = function(p) return { y = p.seed } end }, 4) -- any name
    refuses(sweep, {
        { { over = { x = { 1 } }, run = run, worker = 2 }, "sweep has no option 'worker' among over, run, workers, seed,", "did you mean 'workers'?" },
        { { over = { 1 }, run = run }, "over[1] must be a name and its values" },
        { { over = { { "x", { 1 } }, x = { 2 } }, run = run }, "two parameters 'x'" },
        { { over = { error = { 1 } }, run = run }, "the column of messages" },
    })
    refused { { "sweep { over = { x = vector.linspace(0, 1, 1e5), y = vector.linspace(0, 1, 1e5) }, run = run }", "1e+10 points are more" } }
end)

test("a point that takes longer than max_time is abandoned, in Lua or in a run, and the others continue", function()
    local d = sweep { over = { x = { 1, 2, 3, 4 } }, workers = 2, max_time = 0.15, run = function(p)
        if p.x == 2 then while true do pcall(function() while true do end end) end end
        if p.x == 3 then nondimensional {}:simulate { M = function(t) return math.sin(t) end, t_end = 1e9, times = {} } end
        return { y = p.x }
    end }
    equal(d.y[1] + d.y[4], 5.0)
    for i = 2, 3 do
        equal(d.error[i], "it ran longer than the 0.15 s that max_time allows")
        assert(d.y[i] ~= d.y[i])
    end
end)

test("a bifurcation begins as its runs do", function()
    local sys, M = system { I = 1, k = 4, C = 0.2 }, excitation.harmonic { omega = 1.3 }
    local b = bifurcation { over = { x = { 1 } }, period = 2, skip = 1, keep = 3, at = function()
        return { system = sys, M = M, t_start = 0.7, theta0 = 0.3 }
    end }
    near(b.theta, sys:simulate { M = M, t_start = 0.7, theta0 = 0.3, times = { 4.7, 6.7, 8.7 } }.theta, 1e-12)
end)

test("a file belongs to one sweep: another option of a controller in its function is another sweep", function()
    local function f() return 0 end
    local function start(x) return function() return { x = x } end end
    local function sampled(o) return excitation.sampled(f, merged({ every = 0.1, start = start(0) }, o)) end
    local function relay(o) return excitation.relay(merged({ on = -1, off = 1, amplitude = 1, of = "theta" }, o)) end
    local scripted = excitation.scripted
    local kinds = {
        { sampled {}, sampled { start = start(1) }, sampled { every = 0.2 }, sampled { delay = 0.05 }, sampled { at = 0.05 } },
        { relay {}, relay { on = -2 }, relay { off = 2 }, relay { amplitude = { 1, 0 } }, relay { of = "velocity" }, relay { start = "off" } },
        { excitation.delayed(f, { by = 0.1 }), excitation.delayed(f, { by = 0.2 }) },
        { scripted(f), scripted(f):delay(1), scripted(f):window(0, 1), 2 * scripted(f), scripted(f, { breaks = { 1 } }), scripted(f, { period = 1 }) },
    }
    for _, kind in ipairs(kinds) do
        local file = temporary ".csv"
        local function swept(M)
            return sweep { over = { x = { 1 } }, workers = 1, file = file, run = function() return { y = M ~= nil } end }
        end
        swept(kind[1])
        swept(kind[1])
        for i = 2, #kind do raises(function() swept(kind[i]) end, "is there, and is not the result of this sweep") end
    end
end)

finish()
