-- No script runs longer than it may, whatever it tries.
dofile "tests/lua/support.lua"
local strangers = dofile "tests/lua/strangers.lua"

-- In that time a long run needs more than 64M of memory.
local options = "--safe --max-time 0.1 --max-memory 512M"

--- What Lua or the integrator itself can stop, where it is.
strangers.check({
    ["an endless loop is stopped"] = "while true do end",
    ["goto"] = "::again:: goto again",
    ["a for loop without end"] = "for i = 1, math.huge do end",
    ["recursion in a tail"] = "local function f() return f() end f()",
    ["a loop in a wrapped coroutine"] = "coroutine.wrap(function() while true do end end)()",
    ["a loop in a coroutine that is resumed"] = "coroutine.resume(coroutine.create(function() while true do end end)) while true do end",
    ["endless new coroutines"] = "while true do coroutine.resume(coroutine.create(function() end)) end",
    ["a coroutine that yields for ever"] = "local f = coroutine.wrap(function() while true do coroutine.yield() end end) while true do f() end",
    ["pcall around a loop"] = "pcall(function() while true do end end) print 'escaped'",
    ["a loop of pcalls"] = "while true do pcall(function() while true do end end) end",
    ["pcall of pcall"] = "pcall(pcall, pcall, function() while true do end end) print 'escaped'",
    ["a coroutine of pcalls"] = "coroutine.wrap(function() while true do pcall(function() while true do end end) end end)()",
    ["an xpcall whose handler loops"] = "xpcall(function() while true do end end, function() while true do end end) print 'escaped'",
    ["an xpcall whose handler calls xpcall"] = "local function f() while true do end end local function g() xpcall(f, g) end while true do xpcall(f, g) end",
    ["__close that loops"] = "local x <close> = setmetatable({}, { __close = function() while true do end end })",
    ["__close of what is being stopped"] = "pcall(function() local x <close> = setmetatable({}, { __close = function() while true do end end }) while true do end end) print 'escaped'",
    ["__close in a coroutine that is stopped"] = "coroutine.wrap(function() local x <close> = setmetatable({}, { __close = function() while true do end end }) while true do end end)()",
    ["coroutine.close that loops"] = "local co = coroutine.create(function() local x <close> = setmetatable({}, { __close = function() while true do end end }) coroutine.yield() end) coroutine.resume(co) coroutine.close(co)",
    ["the closing value of a for loop"] = "for _ in next, {}, nil, setmetatable({}, { __close = function() while true do end end }) do end",
    ["an iterator that never ends"] = "for _ in function() return 1 end do end",
    ["__index, __newindex and __call that go on for ever"] = "local t = setmetatable({}, {}) getmetatable(t).__index = function(t, k) return t[k + 1] or 1 end while true do pcall(function() return t[1] end) end",
    ["pictures in the terminal"] = "local p = plot{ { vector.linspace(0, 1, 1e5), vector.linspace(0, 1, 1e5) }, show = false } while true do tostring(p) end",
    ["pictures in files, behind pcall"] = "local file = os.date 'dinal-safe-mode-test-%H%M%S.svg' while true do pcall(plot, { { { 0, 1 }, { 0, 1 } }, file = 'no/such/folder/' .. file }) end",
    ["__eq, __lt, __concat, __len that loop"] = "local m = {} for _, n in ipairs { 'eq', 'lt', 'concat', 'len', 'unm' } do m['__' .. n] = function() while true do end end end local a, b = setmetatable({}, m), setmetatable({}, m) local x = a == b",
    ["an error object whose __tostring loops"] = "error(setmetatable({}, { __tostring = function() while true do end end }))",
    ["print of what does not stop"] = "print(setmetatable({}, { __tostring = function() while true do end end }))",
    ["__name and __tostring of another type"] = "while true do pcall(tostring, setmetatable({}, { __tostring = function() return 1 end, __name = 2 })) end",
    ["a reader of load that never ends"] = "load(function() while true do end end) print 'escaped'",
    ["an order function that never ends"] = "table.sort({ 3, 2, 1 }, function() while true do end end)",
    ["a replacement that never ends"] = "string.gsub('x', 'x', function() while true do end end)",
    ["a table whose __index loops in gsub"] = "string.gsub('x', 'x', setmetatable({}, { __index = function() while true do end end }))",
    ["M that never returns"] = "nondimensional{}:simulate{ M = function(t) while true do end end, t_end = 1, dt = 0.1 }",
    ["M within pcall within M"] = "nondimensional{}:simulate{ M = function(t) pcall(function() while true do end end) return 1 end, t_end = 1, dt = 0.1 } print 'escaped'",
    ["M that calls simulate, which calls M"] = "local n = nondimensional{} local function M(t) return (n:simulate{ M = M, t_end = 1, dt = 0.1 }:at(0.5)) end while true do pcall(M, 0) end",
    ["a callable table for M"] = "nondimensional{}:simulate{ M = setmetatable({}, { __call = function() while true do end end }), t_end = 1, dt = 0.1 }",
    ["a long run"] = "nondimensional{ zeta = 0.1 }:simulate{ M = excitation.harmonic{ frequency = 0.7 }, t_end = 1e9, times = {} } print 'escaped'",
    ["a run with tiny steps"] = "nondimensional{}:simulate{ theta0 = 1, t_end = 1, times = {}, integrator = integrator.rk4{ h = 1e-12 } }",
    ["a run of dinal1989 with tiny steps"] = "nondimensional{}:simulate{ theta0 = 1, t_end = 1, times = {}, integrator = integrator.dinal1989{ h = 1e-12 } }",
    ["a run with feedback"] = "nondimensional{}:simulate{ M = function(t, theta, v) return -v end, theta0 = 1, t_end = 1e9, times = {} }",
    ["a run in a coroutine in a pcall"] = "pcall(coroutine.wrap(function() nondimensional{ zeta = 0.1 }:simulate{ M = 1, theta0 = 1, t_end = 1e9, dt = 1e6, integrator = integrator.rk4{ h = 0.001 } } end)) print 'escaped'",
    ["a search for a steady motion"] = "nondimensional{ friction_ratio = 0.01 }:steady{ M = excitation.harmonic{ frequency = 1e-9 } } print 'escaped'",
    ["run:at again and again"] = "local r = nondimensional{}:simulate{ theta0 = 1, t_end = 1000, times = {} } while true do pcall(r.at, r, 999.9) end",
    ["vectors of vectors"] = "local v = vector.linspace(0, 1, 2e6) while true do pcall(v.sin, v) pcall(function() return v ^ 0.3 end) end",
    ["the energy, the story and plots of a run"] = "local run = nondimensional{}:simulate{ theta0 = 1, t_end = 1e4, dt = 1 } while true do pcall(run.energy, run) pcall(run.explain, run) pcall(run.plot, run, { show = false }) end",
    ["a run that goes on and on"] = "local run = system{ I = 1, k = 0, C = 1 }:simulate{ M = 5, velocity0 = 1, t_end = 1, times = {}, dense = false, integrator = integrator.rk4{ h = 0.001 } } while true do pcall(run.continue, run, { t_end = 1e8 }) end",
    ["values in a loop"] = "local e, t = excitation.harmonic{ frequency = 1 }, vector.linspace(0, 1, 100) while true do pcall(e.values, e, t) end",
}, options, 1, "dinal: stopped at [^\n]*script:1: it ran longer than the 0.1 s that %-%-max%-time allows\n")

local folder = os.tmpname()
os.execute(("rm '%s' && mkdir '%s'"):format(folder, folder))
local removed <close> = setmetatable({}, { __close = function() os.execute("rm -rf '" .. folder .. "'") end })
strangers.check({
    ["a file that grows"] = "local run = nondimensional{}:simulate{ theta0 = 1, t_end = 100, dt = 1e-2 } local c = {} for i = 1, 1e4 do c[i] = 'theta' end while true do pcall(run.save, run, 'big.csv', { columns = c }) end",
}, options, 1, "dinal: stopped at script:1: it ran longer than the 0.1 s that %-%-max%-time allows\n", folder)
test("a file that was not completely written is removed", function()
    equal(io.popen(("ls -A '%s'"):format(folder)):read "a", "")
end)

-- C code that looks at nothing: the program ends a second later.
strangers.check({
    ["a pattern that never ends"] = "print 'seen' local s = ('a'):rep(40) s:find(('.-'):rep(40) .. 'b')",
    ["a pattern within gsub, in a coroutine, in a pcall"] = "print 'seen' pcall(coroutine.wrap(function() (('a'):rep(40)):gsub(('a-'):rep(40) .. 'b', '') end))",
    ["table.move without end"] = "print 'seen' table.move({}, 1, 1e15, 2)",
    ["table.concat, insert and remove of a table that says it is long"] = "print 'seen' local t = setmetatable({}, { __len = function() return math.maxinteger end }) pcall(table.remove, t, 1) table.insert(t, 1, 1)",
    ["table.sort of a table that says it is long"] = "print 'seen' table.sort(setmetatable({}, { __len = function() return 1 << 30 end, __index = type, __newindex = rawequal }))",
}, options, 1, "seen\ndinal: stopped[^\n]*: it ran longer than the 0.1 s that %-%-max%-time allows\n")

-- The same limit for any script; finalizers, which only safe mode forbids, are ended with the program.
strangers.check({
    ["--max-time without safe mode"] = "while true do pcall(function() while true do end end) end",
    ["a script that waits"] = "io.popen('sleep 5'):read() while true do end",
    ["a finalizer that never ends"] = "setmetatable({}, { __gc = function() while true do end end }) collectgarbage()",
    ["a finalizer that never ends, at the end"] = "setmetatable({}, { __gc = function() while true do end end })",
}, "--max-time 0.1", 1, "dinal: stopped[^\n]*: it ran longer than the 0.1 s that %-%-max%-time allows\n")

-- A busy machine must not decide: what only waits may do so ten times as long.
strangers.check({
    ["a script that waits a little"] = "os.execute 'sleep 2' print 'done'",
}, "--max-time 1", 0, "done\n")

-- Without a limit of memory, so that the endless events of such a run are not what ends it.
strangers.check({
    ["a run with more breaks than steps"] = "nondimensional{}:simulate{ M = excitation.square{ frequency = 1e13 }, t_end = 1, dt = 1, integrator = integrator.rk4{ h = 0.01 } }",
    ["a run of dinal1989 with more breaks than steps"] = "nondimensional{}:simulate{ M = excitation.square{ frequency = 2e5 }, t_end = 1e9, dt = 1e9, integrator = integrator.dinal1989{ h = 0.1 } }",
}, "--max-time 0.1", 1, "dinal: stopped at script:1: it ran longer than the 0.1 s that %-%-max%-time allows\n")

finish()
