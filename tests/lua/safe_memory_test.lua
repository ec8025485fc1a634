-- No script takes more memory than it may: not in Lua, not in vectors, runs and excitations, which C++ holds.
dofile "tests/lua/support.lua"
local strangers = dofile "tests/lua/strangers.lua"

-- --max-time is a clock, and not what is tested here: strangers.lua limits the processor time.
local options = "--safe --max-time 3600 --max-memory 32M"
local limit = "it needed more than the 32M that %-%-max%-memory allows\n"

strangers.check({
    ["a string that doubles"] = "local s = 'x' while true do s = s .. s end",
    ["a table that grows"] = "local t = {} for i = 1, math.huge do t[i] = {} end",
    ["a table that grows behind pcall"] = "local t = {} while true do pcall(function() for i = 1, math.huge do t[#t + 1] = { i } end end) end",
    ["one string that is too long, behind pcall"] = "while true do pcall(string.rep, 'x', 1e9) end",
    ["table.concat, gsub and format of much"] = "local s = ('x'):rep(1e6) while true do s = s:gsub('x', 'xx') end",
    ["string.format with widths"] = "local t = {} while true do t[#t + 1] = ('%99s'):format(#t) end",
    ["string.pack of much"] = "string.pack('!16 i1 Xi16', 1) local t = {} while true do t[#t + 1] = string.pack('s', ('x'):rep(1e5)) end",
    ["table.pack and unpack"] = "local t = { table.unpack({}, 1, 200) } while true do t = { t, table.unpack({}, 1, 200) } end",
    ["deep recursion"] = "local function f() return f() + 1 end f()",
    ["coroutines that stay"] = "local t = {} while true do local co = coroutine.create(function() coroutine.yield() end) coroutine.resume(co) t[#t + 1] = co end",
    ["a script in a string that is huge"] = "load('return {' .. ('1,'):rep(6e6) .. '}')",
    ["a reader that goes on for ever"] = "load(function() return 'x = 1 ' end)",
    ["names without end"] = "local i = 0 while true do i = i + 1 _G['name' .. i] = i end",
    ["one vector that is too long"] = "vector.linspace(0, 1, 1e9)",
    ["vectors that stay"] = "local t = {} while true do t[#t + 1] = vector.linspace(0, 1, 1e5) end",
    ["vectors behind pcall"] = "local t = {} while true do pcall(function() t[#t + 1] = vector.linspace(0, 1, 1e5) end) end",
    ["a vector of a table"] = "local t = {} for i = 1, 1e6 do t[i] = i end local v = {} while true do v[#v + 1] = vector(t) end",
    ["an excitation that doubles"] = "local e = excitation.harmonic{ frequency = 1 } while true do e = e + e end",
    ["excitations behind pcall"] = "local e, t = excitation.harmonic{ frequency = 1 }, {} while true do pcall(function() e = e + 1 t[#t + 1] = e end) end",
    ["samples that stay"] = "local v, t = vector.linspace(0, 1, 1e4), {} while true do t[#t + 1] = excitation.samples{ t = v, M = v } end",
    ["events without end"] = "nondimensional{ zeta = 0 }:simulate{ theta0 = 1, t_end = 1e8, times = {}, integrator = integrator.rk4{ h = 0.01 } }",
    ["M that keeps all it has seen"] = "local seen = {} nondimensional{}:simulate{ M = function(t) seen[#seen + 1] = { t } return 0 end, theta0 = 1, t_end = 1e6, times = {} }",
    ["the text of an excitation"] = "local e = excitation.harmonic{ frequency = 1 } for i = 1, 15 do e = e + e end local t = {} while true do t[#t + 1] = tostring(e) .. #t end",
    ["an error message"] = "local s = 'x' while true do s = s .. s pcall(error, s) pcall(function() return system[s] end) end",
    ["warnings"] = "local s = 'x' while true do s = s .. s warn('@off', s) end",
    ["pictures that stay"] = "local x, t = {}, {} for i = 1, 1e4 do x[i] = i end while true do t[#t + 1] = plot{ { x, x }, show = false } end",
    ["texts of pictures that stay"] = "local p, t = plot{ { { 0, 1 }, { 0, 1 } }, width = 1000, height = 500, show = false }, {} while true do t[#t + 1] = tostring(p) end",
    ["memory while the chunk is stopped"] = "local t = {} local x <close> = setmetatable({}, { __close = function() while true do t[#t + 1] = {} end end }) while true do t[#t + 1] = {} end",
}, options, 1, "dinal: stopped[^\n]*: " .. limit)

-- Memory that a script no longer uses is available again.
strangers.check({
    ["vectors that are thrown away"] = "local v = vector.linspace(0, 1, 5e5) for i = 1, 100 do v = v + 1 end print 'done'",
    ["runs that are thrown away"] = "for i = 1, 100 do nondimensional{}:simulate{ theta0 = 1, t_end = 10, dt = 1e-3 } end print 'done'",
    ["excitations that are thrown away"] = "local e = excitation.harmonic{ frequency = 1 } for i = 1, 1000 do e = e + 1 end print 'done'",
    ["pictures that are thrown away"] = "local x = {} for i = 1, 1e4 do x[i] = i end for i = 1, 1000 do plot{ { x, x }, show = false } end print 'done'",
    ["tables that are thrown away"] = "for i = 1, 300 do local t = {} for j = 1, 10000 do t[j] = { j } end end print 'done'",
    ["a run that takes most of what there is"] = "print(#nondimensional{}:simulate{ theta0 = 1, t_end = 1, times = vector.linspace(0, 1, 3e5) } == 3e5 and 'done')",
}, options, 0, "done\n")

strangers.check({
    ["a run of 1e15 rows"] = "nondimensional{}:simulate{ theta0 = 1, t_end = 1e15, dt = 1 }",
    ["a run of too many rows, behind pcall"] = "error(select(2, pcall(function() nondimensional{}:simulate{ theta0 = 1, t_end = 1e9, dt = 1 } end)), 0)",
}, options, 1, "dinal: script:1: sys:simulate: 1e%+%d+ rows need [%d.]+ [PG]B and 25%.%d MB are allowed: use dt >= [%d.e+]+, or times = {...}\n.*")
strangers.check({
    ["runs that stay"] = "local t = {} while true do t[#t + 1] = nondimensional{}:simulate{ theta0 = 1, t_end = 1, dt = 1e-4 } end",
    ["M that simulates and keeps the runs"] = "local n, t = nondimensional{}, {} n:simulate{ M = function() t[#t + 1] = n:simulate{ theta0 = 1, t_end = 1, dt = 1e-4 } return 0 end, t_end = 10, dt = 0.1 }",
}, options, 1, "dinal: script:1: sys:simulate: 1e%+04 rows need 480 kB and [%d.]+ kB are allowed: .*")

strangers.check({
    ["--max-memory without safe mode"] = "local t = {} while true do pcall(function() t[#t + 1] = vector.linspace(0, 1, 1e4) end) end",
}, "--max-memory 32M", 1, "dinal: stopped[^\n]*: " .. limit)

finish()
