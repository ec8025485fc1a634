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
    if not os.getenv "DINAL_ORACLE_CASES" then support.test(sentence, body) end
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
    if not (total.closure < (within or 1e-11)) then
        error(("%senergy closes to %.3g of %.6g"):format(what and what .. ": " or "", total.closure, total.flow), 2)
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

--- How many of n cases by lot are looked at: fewer where a sanitizer makes them slow, or somebody says so.
function support.lots(n)
    return math.min(n, tonumber(os.getenv "DINAL_ORACLE_CASES") or n)
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

--- The angles of a run with noise, which is the same for the same seed.
function support.noisy(run, seed, std)
    return run.theta + vector.normal { n = #run, seed = seed, std = std }
end

--- The record of a run: its angles with noise, about that zero.
function support.record(run, seed, std, zero)
    return { t = run.t, theta = support.noisy(run, seed, std) + (zero or 0) }
end

--- Each of these numbers of the fit is within so many of its errors (4) of the truth.
function support.fits(fit, truth, errors)
    for name, value in pairs(truth) do support.near(fit[name], value, (errors or 4) * fit.std_error[name]) end
end

-- What z = (found - true) / error must be: 95 % of all within 1.96, and its root mean square, which is the ratio to the
-- bound of Cramer and Rao (errors are computed from the derivatives at the fit), at most 1.3.
function support.judge()
    local inside, all, square = 0, 0, 0
    return function(fit, truth)
        for name, true_value in pairs(truth) do
            if (fit.std_error[name] or 0) > 0 then
                local z = (fit[name] - true_value) / fit.std_error[name]
                inside, all, square = inside + (math.abs(z) <= 1.96 and 1 or 0), all + 1, square + z * z
            end
        end
        return inside / all, (square / all)^0.5
    end
end

for name, word in pairs(support) do _G[name] = word end
return support
