-- What a script of a stranger can reach: the listed functions, and files in its folder through run:save and its like.
dofile "tests/lua/support.lua"
local strangers = dofile "tests/lua/strangers.lua"

-- A folder of its own below an outer one that must stay as it is.
local outer = os.tmpname()
os.remove(outer)
local folder = outer .. "/lab"
assert(os.execute(("mkdir -p '%s/sub' && cd '%s' && echo 't,M\n0,1\n1,2' >secret.csv && cp secret.csv lab/inside.csv && " ..
    "ln -s ../secret.csv lab/read.csv && ln -s ../new.csv lab/write.csv && ln -s .. lab/up && ln -s inside.csv lab/link.csv && " ..
    "ln -s /dev/stdout lab/out.csv && ln -s loop.csv lab/loop.csv && mkfifo lab/pipe.csv && mkdir lab/folder.csv && " ..
    "echo 'return 1' >lab/module.lua"):format(folder, outer)))
local removed <close> = setmetatable({}, { __close = function() os.execute("rm -rf '" .. outer .. "'") end })

-- --max-time is a clock, and not what is tested here: strangers.lua limits the processor time.
local options = "--safe --max-time 3600"
local run = "local run = nondimensional{}:simulate{ theta0 = 1, t_end = 1, dt = 0.5 } "

-- Every name of Lua's that a script can see, written down here a second time: a new one is a decision.
strangers.check({
    ["a script sees the listed names and no others"] = [[
        local names = {}
        for _, module in ipairs { "_G", "coroutine", "debug", "io", "math", "os", "string", "table", "utf8" } do
            local own = {}
            for name in pairs(module == "_G" and _G or _G[module]) do
                if module ~= "_G" or rawget(dinal, name) == nil then own[#own + 1] = name end
            end
            table.sort(own)
            print(module .. ": " .. table.concat(own, " "))
        end]],
}, options, 0, [[
_G: _G _VERSION arg assert collectgarbage coroutine debug dinal error getmetatable io ipairs math next os pairs pcall print rawequal rawget rawlen rawset require select setmetatable string table tonumber tostring type utf8 warn xpcall
coroutine: close create isyieldable resume running status wrap yield
debug: traceback
io: read stderr stdout write
math: abs acos asin atan ceil cos deg exp floor fmod huge log max maxinteger min mininteger modf pi rad random randomseed sin sqrt tan tointeger type ult
os: clock date difftime time
string: byte char find format gmatch gsub len lower match pack packsize rep reverse sub unpack upper
table: concat insert move pack remove sort unpack
utf8: char charpattern codepoint codes len offset
]])

-- Each of these prints "nothing" when it does not work.
local blocked = {
    ["no os.exit, os.execute, os.getenv, os.remove, os.rename, os.tmpname, os.setlocale"] = "print(os.exit or os.execute or os.getenv or os.remove or os.rename or os.tmpname or os.setlocale or 'nothing')",
    ["no io.open, io.popen, io.lines, io.output, io.input, io.tmpfile, io.close"] = "print(io.open or io.popen or io.lines or io.output or io.input or io.tmpfile or io.close or 'nothing')",
    ["no dofile, loadfile, package"] = "print(dofile or loadfile or package or 'nothing')",
    ["no debug but traceback"] = "print(debug.getregistry or debug.getmetatable or debug.setmetatable or debug.getupvalue or debug.sethook or debug.getinfo or 'nothing')",
    ["string methods are the same functions as those of the table"] = "print((''):rep(1) == '' and (''):format() == '' and not pcall(function() return (''):dump() end) and ('').rep == string.rep and 'nothing')",
    ["the metatable of strings stays hidden"] = "print(getmetatable('') == 'string' and not pcall(setmetatable, '', {}) and 'nothing')",
    ["the metatables of our own objects stay hidden"] = "local s = nondimensional{} print(getmetatable(s) == 'system' and not pcall(setmetatable, s, {}) and not pcall(rawset, s, 1, 1) and 'nothing')",
    ["bytecode is not loaded, in whatever mode, by whatever function"] = "local code = " .. ("%q"):format(string.dump(function() end)) .. [[
        local parts = { code }
        print(not (load(code) or load(code, "x", "b") or load(code, "x", "bt") or load(code, "x", "b", {}) or load(function() return table.remove(parts) end, "x", "b")) and "nothing")]],
    ["load keeps its other arguments"] = "print(load('return a', 'x', 'bt', { a = 'nothing' })())",
    ["a chunk that claims another mode is text"] = "print(load('return 1', 'x', 'b')() == 1 and 'nothing')",
    ["_ENV of load is the safe one"] = "print(load('return os.exit or io.open or \"nothing\"')())",
    ["finalizers are refused"] = "print(not (pcall(setmetatable, {}, { __gc = function() end }) or pcall(setmetatable, {}, { __gc = true }) or pcall(setmetatable, {}, { __gc = false })) and 'nothing')",
    ["a finalizer that comes after setmetatable is none"] = "local m = {} setmetatable({}, m) m.__gc = function() print 'finalized' end collectgarbage() print 'nothing'",
    ["a metatable that hides its __gc does not pass"] = "local m = setmetatable({}, { __index = function() return nil end }) rawset(m, '__gc', print) print(not pcall(setmetatable, {}, m) and 'nothing')",
    ["collectgarbage cannot be switched off"] = "print(not (pcall(collectgarbage, 'stop') or pcall(collectgarbage, 'incremental', 1000, 1000) or pcall(collectgarbage, 'setpause', 1000)) and collectgarbage 'count' > 0 and collectgarbage() == 0 and 'nothing')",
    ["require gives what is there, and loads nothing"] = "print(require 'dinal' == dinal and require 'string' == string and require '_G' == _G and not pcall(require, 'module') and not pcall(require, 'package') and not pcall(require, './module') and not pcall(require, 1) and 'nothing')",
    ["a file handle is none"] = "print(type(io.stdout) == 'table' and not (io.stdout.seek or io.stdout.close or io.stdout.lines or io.stdout.setvbuf) and not getmetatable(io.stdout) and 'nothing')",
    ["io.write goes to standard output whatever it is given"] = "io.write(1, 2.5, 'x\\n') io.stdout.write({}, 'y\\n') io.stdout:write('z\\n') io.stdout:flush() print(not pcall(io.write, {}) and not pcall(io.stdout.write, 1, 2) and 'nothing')",
    ["io.read gives strings"] = "print(io.read() == nil and io.read 'a' == '' and not pcall(io.read, 'x') and 'nothing')",
    ["a method called without its object"] = "print(not (pcall(nondimensional{}.simulate, {}) or pcall(vector{ 1 }.max, io.stdout) or pcall(excitation.constant{ amplitude = 1 }.value)) and 'nothing')",
    ["a wrong object for a method"] = "local v, s = vector{ 1 }, nondimensional{} print(not (pcall(v.max, s) or pcall(s.simulate, v, {})) and 'nothing')",
    ["errors that are nil or tables"] = "print(not (pcall(error) or pcall(error, nil) or pcall(error, {}) or pcall(error, setmetatable({}, { __tostring = error }))) and 'nothing')",
    ["recursion through coroutines ends in an error"] = "local function f() coroutine.wrap(f)() end print(not pcall(f) and 'nothing')",
    ["brackets without end are an error"] = "print(not load(('('):rep(1e5)) and not load(('{'):rep(1e5)) and not load(('x='):rep(1e5)) and not load(('function f() '):rep(1e5)) and not load('return ' .. ('-'):rep(1e5):gsub('-', 'not ') .. '1') and 'nothing')",
    ["upvalues, locals and constants beyond what Lua can"] = "print(not load(('local a '):rep(300)) and not load('goto ' .. ('x'):rep(1e6)) and 'nothing')",
    ["functions in functions in functions as M"] = "local f = function(t) return 0 end for i = 1, 1e5 do local g = f f = function(t) return g(t) end end print(not pcall(function() return nondimensional{}:simulate{ M = f, t_end = 1, dt = 1 }.t[1] .. nil end) and 'nothing')",
    ["tables in tables in tables as a variable of M"] = "local t = {} for i = 1, 1e5 do t = { t } end nondimensional{}:simulate{ M = function() return #t end, t_end = 1, dt = 1 } print 'nothing'",
    ["names that are very long"] = "local s = ('x'):rep(1e5) print(not (pcall(system, { [s] = 1 }) or pcall(function() return excitation[s] end) or pcall(help, s)) and 'nothing' or 'nothing')",
    ["options with metatables"] = "print(not pcall(function() return system(setmetatable({}, { __index = function() return 1 end, __pairs = error, __len = error })).I end) and 'nothing')",
    ["numbers at the edge"] = "for _, x in ipairs { 0/0, 1/0, -1/0, 2^53, -2^63, 1e308, 5e-324, math.mininteger } do for _, f in ipairs { function() return vector.linspace(0, x, x) end, function() return vector{ 1, 2 }:slice(x, x, x) end, function() return vector{ 1 }[x] end, function() return nondimensional{}:simulate{ theta0 = x, velocity0 = x, t_end = x, dt = x } end, function() return nondimensional{}:simulate{ theta0 = 1, t_end = 1, dt = 1 }:at(x) end, function() return utf8.char(x) end, function() return ('x'):rep(x, ('y'):rep(10)) end, function() return ('%99.99f'):format(x) end, function() return table.unpack({}, x, x) end, function() return table.concat({}, '', x, x) end, function() return string.pack('i16', x) end } do pcall(f) end end print 'nothing'",
    ["formats that are too wide or unknown"] = "print(not (pcall(string.format, '%99999s', 'x') or pcall(string.format, '%y', 1) or pcall(string.format, '%s') or pcall(string.pack, 'i999', 1) or pcall(os.date, '%Ez') or pcall(os.date, ('%'):rep(3)) or pcall(os.date, '*t', 2^60)) and 'nothing')",
    ["counts that are too large"] = "print(not (pcall(table.unpack, {}, 1, 1e8) or pcall(string.rep, 'x', 1 << 60) or pcall(table.concat, {}, '', 1, 1e8) or pcall(string.byte, ('x'):rep(1e7), 1, -1) or pcall(select, -5, 1)) and 'nothing')",
}
strangers.check(blocked, options, 0, ".*nothing\n", folder)

-- Reading and writing: within the folder, never without.
local function saves(name)
    return run .. ("local ok, why = pcall(run.save, run, %q) print(ok and 'saved' or why)"):format(name)
end
local function draws(name)
    return run .. ("local ok, why = pcall(run.plot, run, { file = %q }) print(ok and 'saved' or why)"):format(name)
end
local function reads(name)
    return ("local ok, why = pcall(load, %q) local _, other = pcall(excitation.samples, %q) print(ok and why == nil and 'no file' or ok and 'read' or why) print(other)"):format(
        name, name)
end
local only = "safe mode allows files in the current folder and below only"
local refused, fine = {}, {}
for _, name in ipairs { "../secret.csv", folder .. "/../secret.csv", "/etc/passwd", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1.csv", "/tmp/x.csv", "read.csv", "up/secret.csv", "sub/../../secret.csv", "./../secret.csv", "//etc/passwd.csv", "loop.csv", "nowhere/x.csv", "sub/../up/lab/../secret.csv" } do
    refused["reading " .. name] = reads(name)
end
for _, name in ipairs { "../secret.csv", "../new.csv", folder .. "/../new.csv", "/tmp/dinal-safe-mode.csv", "write.csv", "read.csv", "up/new.csv", "up/new.dat", "out.csv", "loop.csv", "/dev/fd/1.csv", "sub/../../new.csv", "../lab2/x.csv" } do
    refused["writing " .. name] = saves(name)
end
for _, name in ipairs { "../new.svg", folder .. "/../new.svg", "up/new.png", "/tmp/dinal-safe-mode.txt", "sub/../../new.pdf", "../lab2/x.svg" } do
    refused["drawing " .. name] = draws(name)
end
local results = strangers.run(refused, options, folder)
for name, code in pairs(refused) do
    test(name .. " is refused", function()
        local result = results[name]
        equal(result.exit, 0, result.text)
        local file = name:match "%S+$"
        local ends = file:match "%.csv$" or file:match "%.dat$" or name:find "^drawing"
        assert(not ends or result.text:find(only, 1, true) or result.text:find("there is no folder", 1, true), result.text)
        assert(not result.text:find "read\n", result.text)
        has_not(result.text, "saved")
        assert(not result.text:find "excitation.samples *{" and not result.text:find "root:", result.text)
    end)
end
for name, pattern in pairs { ["pipe.csv"] = "it is not a regular file", ["folder.csv"] = "it is not a regular file" } do
    strangers.check({ ["reading " .. name] = reads(name), ["writing " .. name] = saves(name) }, options, 0, ".*" .. pattern .. ".*", folder)
end
for _, name in ipairs { "a.csv", "sub/b.csv", "./c.dat", folder .. "/d.csv", "sub/../e.csv", "link.csv", "up/lab/f.csv" } do
    fine["writing and reading " .. name] = saves(name) .. reads(name)
end
strangers.check(fine, options, 0, "saved\nread\n.*", folder)
strangers.check({
    ["drawing within the folder"] = draws "a.svg" .. draws "sub/b.png" .. draws "c.pdf" .. draws "e.txt",
}, options, 0, ("saved\n"):rep(4), folder)

test("files outside of the folder are unchanged", function()
    local listing = io.popen(("cd '%s' && ls && cat secret.csv"):format(outer)):read "a"
    equal(listing, "lab\nsecret.csv\nt,M\n0,1\n1,2\n")
end)

-- The source of a function comes from a file: which one is up to the chunk's name, and that is up to the script.
strangers.check({
    ["a chunk named after a file outside does not show it"] = run .. [[
        local f = load("return function(t) return 0 end", "@../secret.csv")()
        local run = nondimensional{}:simulate{ M = f, theta0 = 1, t_end = 1, dt = 1 }
        run:save "source.csv" print(load "source.csv".names[1])]],
}, options, 0, "t\n", folder)

finish()
