-- The words of the Lua tests, which are globals: a test is a sentence and a function, failures are collected, the exit code
-- tells.
local support = {}

local failed, passed = 0, 0

--- Runs one test. Its name is a sentence about behaviour.
function support.test(sentence, body)
    local ok, problem = xpcall(body, debug.traceback)
    if ok then
        passed = passed + 1
    else
        failed = failed + 1
        io.stderr:write("FAILED: ", sentence, "\n  ", tostring(problem):gsub("\n", "\n  "), "\n")
    end
end

--- A test that only goes on and on, which shows a sanitizer nothing new: not run where cases by lot are few.
function support.long_test(sentence, body)
    if support.lots(100) > 30 then support.test(sentence, body) end
end

--- To be called at the end of a test file.
function support.finish()
    if failed > 0 then
        io.stderr:write(failed, " of ", failed + passed, " tests failed\n")
        os.exit(1, true)
    end
    assert(passed > 0, "no tests were run")
end

function support.equal(found, wanted, what)
    if found ~= wanted then
        error(("%swanted %s, found %s"):format(what and what .. ": " or "", tostring(wanted), tostring(found)), 2)
    end
end

--- Of two vectors, their elements.
function support.near(found, wanted, tolerance)
    if type(found) == "userdata" then found, wanted = (found - wanted):abs():max(), 0 end
    if not (type(found) == "number" and math.abs(found - wanted) <= tolerance) then
        error(("wanted %.17g within %g, found %s"):format(wanted, tolerance, tostring(found)), 2)
    end
end

--- The text, or what tostring makes of a value, has each of these pieces (plain text, no patterns) in it.
function support.has(text, ...)
    text = tostring(text)
    for _, piece in ipairs { ... } do
        if not text:find(piece, 1, true) then error(("%q is not in\n%s"):format(piece, text), 2) end
    end
end

function support.has_not(text, ...)
    text = tostring(text)
    for _, piece in ipairs { ... } do
        if text:find(piece, 1, true) then error(("%q is in\n%s"):format(piece, text), 2) end
    end
end

--- The energy of a run adds up, to a part of all that flows; returns it.
function support.closes(run, what, within)
    local energy = run:energy()
    local total = energy.total
    -- Where hardly anything flows only rounding is left.
    if not (total.closure < (within or 1e-11) or total.closure * total.flow < 1e-15) then
        error(("%senergy closes to %.3g of %.6g"):format(what and what .. ": " or "", total.closure, total.flow), 2)
    end
    for _, stored in ipairs { "kinetic", "spring" } do
        support.near(energy.finish[stored] - energy.start[stored], total[stored], 1e-11 * (total.flow + energy.start[stored]))
    end
    return energy
end

--- The story of a run or of a motion has each of these pieces in it, wherever its lines end.
function support.says(run, ...)
    support.has((run:explain():gsub("%s+", " ")), ...)
end

--- The same events in both runs, at the same times.
function support.same_events(a, b, tolerance, what)
    support.equal(#a.events, #b.events, what)
    for i, event in ipairs(b.events) do
        support.equal(a.events[i].kind, event.kind, what)
        support.near(a.events[i].t, event.t, tolerance)
    end
end

-- A system may be given by the table that it is made of.
local function made(of) return type(of) == "table" and system(of) or of end

local function fails(level, ...) error(string.format(...), level + 1) end

--- The times of the events of each kind.
local function event_times(run)
    local times = {}
    for _, event in ipairs(run.events) do
        times[event.kind] = times[event.kind] or {}
        table.insert(times[event.kind], event.t)
    end
    return times
end

--- Both runs have the same rows, but for rounding, and the same events; turns do not count if they may differ.
function support.alike(found, wanted, within, what, turns)
    local what = what and what .. ": " or ""
    local function list(run)
        local kinds, times = {}, {}
        for _, event in ipairs(run.events) do
            if turns ~= false or event.kind ~= "turn" then
                kinds[#kinds + 1], times[#times + 1] = event.kind .. " " .. (event.where or ""), event.t
            end
        end
        return kinds, times
    end
    local kinds, times = list(found)
    local other_kinds, other_times = list(wanted)
    local told, expected = table.concat(kinds, ", "), table.concat(other_kinds, ", ")
    if told ~= expected then fails(2, "%swanted the events %s, found %s", what, expected:sub(1, 300), told:sub(1, 300)) end
    for i, t in ipairs(times) do
        local off = math.abs(t - other_times[i])
        if not (off <= 100 * within * math.max(1, t)) then fails(2, "%s%s at t = %.15g differs by %g", what, kinds[i], t, off) end
    end
    for _, name in ipairs(wanted.names) do
        if name:find "theta$" or name:find "velocity$" then
            local a, b = found:column(name), wanted:column(name)
            local off = #a == #b and #a > 0 and (a - b):abs():max() or #a == #b and 0 or math.huge
            if not (off <= within * math.max(1, #b > 0 and b:abs():max() or 0)) then fails(2, "%s%s differs by %g", what, name, off) end
        end
    end
end

-- A run in two parts.
local function in_parts(sys, task, whole)
    local from, t_end = task.t_start or 0, whole.t_end
    local cut = from + 0.4371 * (t_end - from)
    local first, rest = { t_end = cut }, { t_end = t_end }
    if task.times then
        first.times, rest.times = {}, {}
        for _, t in ipairs(task.times) do table.insert(t <= cut and first.times or rest.times, t) end
    else
        first.dt = task.dt or (t_end - from) / (#whole - 1)
    end
    return sys:simulate(support.merged(task, first)):continue(rest)
end

--- Runs `sys`, a system or its table, and returns the run, which must be as `wanted` says: a column at the end (a number),
-- at each row (a vector, or a function of t and of the run, nil where anything goes), and the times of all events of a kind,
-- or their number. `status` is that of the run, by default one that reached its end; `events` their number, `most` a
-- limit of it; `story` what explain() must say; `within` the tolerance, 1e-12 by default. In two parts the run is the same within
-- `parts` (false: it is not tried), and its energy adds up within `closes` (false: not looked at).
function support.expect(sys, task, wanted, what)
    local sys, wanted, what = made(sys), wanted or {}, what and what .. ": " or ""
    local within, run = wanted.within or 1e-12, sys:simulate(task)
    local ended = run.status == "end" or run.status == "stuck" or run.status == "rest"
    if wanted.status and run.status ~= wanted.status or not wanted.status and not ended then
        fails(2, "%swanted the status %s, found %s: %s", what, wanted.status or "end", run.status, run.outcome)
    end
    if wanted.most and #run.events >= wanted.most or wanted.events and #run.events ~= wanted.events then
        fails(2, "%s%d events", what, #run.events)
    end
    if wanted.story then support.says(run, table.unpack(wanted.story)) end
    local times, kinds = event_times(run), " stick slip rest turn switch impact release open close user "
    local own = { within = true, status = true, most = true, events = true, story = true, parts = true, closes = true }
    for name, value in pairs(wanted) do
        if kinds:find(" " .. name .. " ", 1, true) then
            local found = times[name] or {}
            local count = type(value) == "number" and value or #value
            if #found ~= count then fails(2, "%swanted %d events %s, found %d: %s", what, count, name, #found, table.concat(found, " ")) end
            for i, t in ipairs(type(value) == "table" and found or {}) do
                local off = math.abs(t - value[i])
                if not (off <= within * math.max(1, math.abs(t))) then fails(2, "%s%s at t = %.17g, wanted %.17g", what, name, t, value[i]) end
            end
        elseif not own[name] then
            local column = run:column(name)
            local function check(i, x)
                local found = column[i]
                if x and not (math.abs(found - x) <= within) then
                    fails(3, "%swanted %s = %.17g within %g at t = %.17g, found %.17g", what, name, x, within, run.t[i], found)
                end
            end
            if type(value) == "number" then
                check(#column, value)
            else
                for i, t in ipairs(run.t) do check(i, type(value) == "function" and value(t, run) or type(value) ~= "function" and value[i]) end
            end
        end
    end
    -- The other methods keep no energy, and have other steps where they go on.
    local method = tostring(run.integrator)
    if run.status == "failed" or run.status == "stopped" or not method:find "exact" and not method:find "spectral" then return run end
    if wanted.closes ~= false then support.closes(run, what, wanted.closes) end
    if wanted.parts ~= false then support.alike(in_parts(sys, task, run), run, wanted.parts or 1e-8, what .. "in two parts") end
    return run
end

--- A test of one run, see expect().
function support.moves(sentence, sys, task, wanted)
    support.test(sentence, function() support.expect(sys, task, wanted) end)
end

--- Searches the steady motion of `sys` and returns it. Its members must be as `wanted` says, by their paths as in
-- ["a.rest.upper"]: numbers within `within`, 1e-9 by default; those named in `none` are nil, and `story` is in explain().
-- A motion that comes again in place is where it was after its period.
function support.finds(sys, task, wanted, what)
    local what, within = what and what .. ": " or "", wanted.within or 1e-9
    local s, own = made(sys):steady(task), { within = true, none = true, story = true }
    local function member(path)
        local found = s
        for name in path:gmatch "[^.]+" do found = found[tonumber(name) or name] end
        return found
    end
    for path, value in pairs(wanted) do
        local found = not own[path] and member(path)
        local good = own[path] or found == value or type(value) == "number" and type(found) == "number" and math.abs(found - value) <= within
        if not good then fails(2, "%swanted %s = %s, found %s in\n%s", what, path, tostring(value), tostring(found), s:explain()) end
    end
    for _, path in ipairs(wanted.none or {}) do
        if member(path) ~= nil then fails(2, "%s%s is not nil", what, path) end
    end
    if wanted.story then support.says(s, table.unpack(wanted.story)) end
    local run = s.status == "steady" and s.run
    for _, name in ipairs(run and run.names or {}) do
        local theta = name:find "theta$" and run:column(name)
        local again = not theta or name ~= "theta" and not s[name:match "^(.*)%.theta$"].amplitude or name == "theta" and not s.amplitude
        if not again and not (math.abs(theta[#theta] - theta[1]) <= 1e-6 * math.max(1e-3, theta:abs():max())) then
            fails(2, "%s%s does not come again: %.17g and %.17g", what, name, theta[1], theta[#theta])
        end
    end
    return s
end

--- The function must raise a string with all these pieces (plain text, no patterns) in it. Returns the message.
function support.raises(body, ...)
    local ok, message = pcall(body)
    if ok then
        error("wanted an error, found none", 2)
    end
    if type(message) ~= "string" then
        error("wanted a string as the error, found " .. tostring(message), 2)
    end
    for _, piece in ipairs { ... } do
        if not message:find(piece, 1, true) then
            error(("wanted an error with \"%s\", found: %s"):format(piece, message), 2)
        end
    end
    return message
end

local function raises_in(own, body, ...)
    local about = debug.getinfo(own, "S")
    local message = support.raises(body, ...)
    local line = message:match("^" .. about.short_src:gsub("%p", "%%%0") .. ":(%d+): ")
    if not line or tonumber(line) < about.linedefined or tonumber(line) > about.lastlinedefined then
        error("the message does not begin with the user's line: " .. message, 3)
    end
    return message
end

--- As raises(), and the message must begin with the file and line of the caller's function: the user's own line.
function support.raises_here(body, ...)
    return raises_in(body, body, ...)
end

--- The call must refuse the options that each row begins with, as raises_here() does, with the pieces behind them.
function support.refuses(call, rows)
    local of_lua = type(call) == "function" and debug.getinfo(call, "S").what ~= "C"
    local own = of_lua and call or function(options) call(options) end
    for _, row in ipairs(rows) do
        raises_in(own, function() own(row[1]) end, table.unpack(row, 2))
    end
end

-- What a user sees at the level of the stack above: locals, those of the callers too, and globals.
local function in_sight(level)
    local names = {}
    while debug.getinfo(level, "f") do
        local own, i = {}, 1
        while debug.getlocal(level, i) do
            local name, value = debug.getlocal(level, i)
            own[name], i = value, i + 1
        end
        for name, value in pairs(own) do
            if names[name] == nil then names[name] = value end
        end
        local f
        f, i = debug.getinfo(level, "f").func, 1
        while debug.getupvalue(f, i) do
            local name, value = debug.getupvalue(f, i)
            if names[name] == nil then names[name] = value end
            i = i + 1
        end
        level = level + 1
    end
    return setmetatable(names, { __index = _G })
end

--- Each input, which a user types where this is called, is refused: the message begins with its line and has the pieces
-- behind the input in it.
function support.refused(rows)
    local sight, wrong = in_sight(3), {}
    for _, row in ipairs(rows) do
        local input = row[1]
        local typed = load("return (" .. input .. ")", "=input", "t", sight) or assert(load(input, "=input", "t", sight))
        local ok, message = pcall(typed)
        local good = not ok and type(message) == "string" and message:find("input:1: ", 1, true) == 1
        for _, piece in ipairs { table.unpack(row, 2) } do good = good and message:find(piece, 1, true) end
        if not good then wrong[#wrong + 1] = ("%s\n    %s"):format(input, ok and "is not refused" or tostring(message)) end
    end
    if #wrong > 0 then error("refused otherwise than wanted:\n  " .. table.concat(wrong, "\n  "), 2) end
end

--- The events of that kind, as data.
function support.of_kind(run, kind)
    return run.events:filter(function(event) return event.kind == kind end)
end

--- Two bodies, a and b, with a link between them.
function support.pair(a, b, link)
    link[1], link[2] = "a", "b"
    return system { bodies = { a = a, b = b }, links = { link = link } }
end

--- A new table with what is in both; where both have a name, the second one counts.
function support.merged(a, b)
    local all = {}
    for _, part in ipairs { a, b or {} } do
        for name, value in pairs(part) do all[name] = value end
    end
    return all
end

--- The same function, which is sampled: it calls what cannot be read.
function support.unread(f)
    return function(...) return ({ f(...) })[1] end
end

-- How many cases by lot somebody asks for: few where a sanitizer makes them slow, thousands where time does not matter.
local cases = tonumber(os.getenv "DINAL_ORACLE_CASES")

--- How many of n cases by lot are looked at: a third, unless somebody asks for more or fewer.
function support.lots(n)
    return math.min(n, cases or math.ceil(n / 3))
end

--- A name for a new file with this ending; the file is removed when the tests end.
local files = setmetatable({}, {
    __gc = function(list)
        for _, name in ipairs(list) do
            os.remove(name)
        end
    end,
})
function support.temporary(ending)
    local name = os.tmpname()
    files[#files + 1] = name
    if ending then
        name = name .. ending
        files[#files + 1] = name
    end
    return name
end

function support.write(name, text)
    local file <close> = assert(io.open(name, "wb"))
    assert(file:write(text))
end

function support.read(name)
    local file <close> = assert(io.open(name, "rb"))
    return file:read("a")
end

--- A run or data as it comes back from a file, and the file.
function support.reloaded(object, options, ending)
    local name = support.temporary(ending or ".csv")
    object:save(name, options)
    return load(name), name
end

--- The run that the header of a run's file makes again, and the file.
function support.repeated(run)
    local _, name = support.reloaded(run)
    local lines, world = {}, setmetatable({}, { __index = _G })
    for line in io.lines(name) do lines[#lines + 1] = line:match "^# (.*)" end
    assert(load(table.concat(lines, "\n"), "=header", "t", world))()
    return world.run, name
end

--- The path of the dinal that runs the tests.
function support.program()
    local first = 0
    while arg[first - 1] do
        first = first - 1
    end
    return arg[first]
end

--- What of:plot draws, or another of its methods, as text of 60 columns in ASCII.
function support.picture(of, options, method)
    return tostring(of[method or "plot"](of, support.merged({ show = false, width = 60, ascii = true }, options)))
end

--- What the program prints when it runs this code.
function support.output(code, options)
    local name = support.temporary ".lua"
    support.write(name, code)
    local pipe <close> = io.popen(('"%s" %s %s 2>&1'):format(support.program(), options or "", name))
    return pipe:read "a"
end

--- What the program prints when it runs each of these codes in turn, by code. One process does it: under the sanitizers a
-- start takes longer than most codes.
function support.outputs(codes)
    local list = {}
    for i, code in ipairs(codes) do list[i] = ("%q"):format(code) end
    local printed = support.output("for _, code in ipairs{ " .. table.concat(list, ", ")
        .. " } do print('\\0') local ok, problem = pcall(assert(load(code))) if not ok then print(problem) end end")
    local all, i = {}, 0
    for text in printed:gmatch "%z\n([^\0]*)" do
        i = i + 1
        all[codes[i]] = text
    end
    support.equal(i, #codes, "number of outputs")
    return all
end

--- What the program prints when it runs the code that each row begins with has the pieces behind it in it.
function support.prints(rows)
    local codes = {}
    for i, row in ipairs(rows) do codes[i] = row[1] end
    local said = support.outputs(codes)
    for _, row in ipairs(rows) do support.has(said[row[1]], table.unpack(row, 2)) end
    return said
end

--- The angles of a run with noise, which is the same for the same seed.
function support.noisy(run, seed, std)
    return run.theta + vector.normal { n = #run, seed = seed, std = std }
end

--- The record of a run: its angles with noise, about that zero.
function support.record(run, seed, std, zero)
    return { t = run.t, theta = support.noisy(run, seed, std) + (zero or 0) }
end

--- Each of these numbers of the fit of a right model is within so many of its errors (4) of the truth.
function support.fits(fit, truth, errors)
    for name, value in pairs(truth) do support.near(fit[name], value, (errors or 4) * fit.error_if_right[name]) end
end

-- What z = (found - true) / error must be: 95 % of all within 1.96, and its root mean square, which is the ratio to the
-- bound of Cramer and Rao (errors are computed from the derivatives at the fit), at most 1.3.
function support.judge()
    local inside, all, square = 0, 0, 0
    return function(fit, truth)
        for name, true_value in pairs(truth) do
            if (fit.error_if_right[name] or 0) > 0 then
                local z = (fit[name] - true_value) / fit.error_if_right[name]
                inside, all, square = inside + (math.abs(z) <= 1.96 and 1 or 0), all + 1, square + z * z
            end
        end
        return inside / all, (square / all)^0.5
    end
end

for name, word in pairs(support) do _G[name] = word end
return support
