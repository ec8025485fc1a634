-- Names in a stranger's file cannot control the terminal on which they are printed.
dofile "tests/lua/support.lua"

local evil = "\27]0;owned\7\27[2J\27[8m"
local file, words = temporary ".csv", temporary ".csv"
write(file, '# -- units: theta in \27[2J\nt,"' .. evil .. '"\n0,1\n1,2\n')
write(words, 'a,"b' .. evil .. '"\n1,"' .. evil .. '"\n2,x\n')

local function harmless(text, what)
    for _, sequence in ipairs { "\27]", "\7", "\27[2J", "\27[8m" } do
        assert(not text:find(sequence, 1, true), what .. ": " .. ("%q"):format(text))
    end
end

test("a loaded run with names that are control sequences, its card, story and errors are harmless", function()
    write(file, "# -- dinal 1\n" .. read(file))
    local run = load(file)
    equal(#run.names, 2)
    harmless(tostring(run), "tostring")
    harmless(run:explain(), "explain")
    harmless(tostring(run:plot{ show = false, width = 60, ascii = true }), "plot")
    for what, call in pairs { field = function() return run.nothing end, plot = function() run:plot{ y = "M" } end,
        columns = function() run:columns "x" end, spectrum = function() run:spectrum "x" end,
        save = function() run:save("x.csv", { columns = { "x" } }) end } do
        local ok, message = pcall(call)
        assert(not ok, what)
        harmless(message, what)
    end
end)

test("loaded data with names that are control sequences, their rows, tables and errors are harmless", function()
    local d = load(words)
    equal(#d, 2)
    harmless(tostring(d), "tostring")
    harmless(tostring(d[1]), "row")
    harmless(d:markdown(), "markdown")
    local ok, message = pcall(function() return d.nothing end)
    assert(not ok)
    harmless(message, "field")
end)

test("events that the user names by control sequences are harmless, and their raw names can be read", function()
    local run = system{ I = 1, k = 1 }:simulate{ theta0 = 1, t_end = 3, dt = 1,
        events = { { when = function(t) return t - 1 end, name = "limit" .. evil } } }
    harmless(tostring(run.events), "events")
    harmless(tostring(run.events[1]), "event")
    equal(run.events[1].name, "limit" .. evil)
end)

finish()
