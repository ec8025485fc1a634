-- Tables with named columns: creation, reading, selection, sorting, saving and loading. Run by dinal.
dofile "tests/lua/support.lua"

local read = load
local function load(text)
    local name = temporary ".csv"
    write(name, text)
    return read(name), name
end

test("columns are vectors or tables of words, rows are tables", function()
    local d = data{ r = { 1, 2, 3 }, A = vector{ 4, 5, 6 }, kind = { "a", "b", "c" } }
    equal(table.concat(d.kind), "abc")
    equal(d[3].kind, "c")
    equal(d[0], nil)
    equal(d[4], nil)
    equal(tostring(d[1]), '{ A = 4, kind = "a", r = 1 }')
    equal(table.concat(d.names, " "), "A kind r")
    equal(table.concat(data{ { "r", { 1 } }, { "A", { 2 } } }.names, " "), "r A")
    equal(table.concat(d:select("r", "A", "r").names, " "), "r A")
    local sum = 0
    for i, row in ipairs(d) do sum = sum + i * row.A end
    equal(sum, 4 + 10 + 18.0)
    equal(data{ plot = { 7 } }:column("plot"), vector{ 7 })
end)

test("rows are filtered by a function or a mask, and sorted by a column with nan last", function()
    local d = data{ r = { 3, 0/0, 1, 2 }, word = { "c", "x", "a", "b" } }
    equal(table.concat(d:sort("r", { descending = true }).word), "cbax")
    equal(table.concat(d:sort("word").word), "abcx")
    equal(table.concat(d:sort("word", { descending = true }).word), "xcba")
    equal(table.concat(d:filter(function(row) return row.r == row.r end).word), "cab")
    equal(table.concat(d:filter(d.r:map(function(x) return x > 1 end)).word), "cb")
    equal(#d:filter(function() return false end), 0)
    refused {
        { 'd:filter(function(row) error("mine") end)', "mine" },
        { "d:filter(vector{ 1 })", "the vector has 1 numbers, but there are 4 rows" },
    }
end)

test("saved data read back to the last bit: gaps, infinities, words that look like numbers", function()
    local d = data{ x = { 1/3, 0/0, -1/0 }, w = { "1.5", "a, \"b\"", "" }, ["a name; #2"] = { 1e-320, -0.0, 1e300 } }
    local back = reloaded(d)
    equal(table.concat(back.names, "|"), table.concat(d.names, "|"))
    equal(back.x[1], 1/3)
    assert(back.x[2] ~= back.x[2] and back.x[3] == -1/0)
    equal(table.concat(back.w, "|"), table.concat(d.w, "|"))
    equal(back["a name; #2"], d["a name; #2"])
end)

test("files of other programs may have decimal commas, empty fields and words; csv_test.cpp has the numbers", function()
    equal(load("t,x\n0,1\n1,\n2,nan\n").t, vector{ 0, 1, 2 })
    local d = load("\xEF\xBB\xBF# made by a phone\r\nTime (s);Angle\r\n0,5;1,25\r\n1;2\r\n")
    equal(d["Time (s)"], vector{ 0.5, 1 })
    equal(d.Time, vector{ 0.5, 1 }) -- without the unit
    refused { { 'load("x [m],x [s]\\n1,2\\n").x', "there is no column 'x' among x [m], x [s]" } }
    equal(table.concat(load("t\tkind\n1\tturn\n2\t\n").kind, "|"), "turn|")
    equal(#load("only,names\n"), 0)
    equal(load("t,x\n1,3d\n2,1-2\n").x[2], "1-2")
    for text, message in pairs{
        ['"a\nb",x\n1,2\n'] = ":1: a double quote is opened and not closed",
        ['t,w\n1,"open\n'] = ":2: a double quote is opened and not closed",
    } do
        raises(function() load(text) end, message)
    end
    equal(load('t,w\n1,5" pipe\n2,"a ""b"""\n').w[1], '5" pipe')
    refused { { 'read("missing.csv")', "load: ", "missing.csv" } }
end)

test("a line of units may have empty cells, also beside a column of words", function()
    for _, order in ipairs{ { 1, 2, 3 }, { 3, 1, 2 }, { 1, 3, 2 } } do
        local function line(...)
            local cells = { ... }
            return table.concat({ cells[order[1]], cells[order[2]], cells[order[3]] }, ";") .. "\n"
        end
        for _, gap in ipairs{ "", '""' } do
            local d = load(line("Zeit", "Weg", "Bemerkung") .. line("ms", "mm", gap) .. line("0", "0,05", "Start") .. line("11", "0,10", ""))
            equal(d.Zeit, vector{ 0, 11 })
            equal(d.Weg, vector{ 0.05, 0.1 })
            equal(table.concat(d.Bemerkung, "|"), "Start|")
            has(tostring(d), "Zeit, ms", "Weg, mm")
        end
    end
    equal(load("t;x;note\ns;;\n0;1;a\n1;2;b\n").x, vector{ 1, 2 })                -- one unit only
    equal(load("t;x;note\ns;m;text\n0;1;\n1;2;\n").t, vector{ 0, 1 })             -- a word for every column
    equal(load("t;x;note\n0;1;a\n1;2;b\n").t, vector{ 0, 1 })                     -- no units
    equal(load("name;note\nAda;\n;late\n").name[1], "Ada")                        -- words with gaps
    equal(load("t;note\n;start\n1;\n2;end\n").note[1], "start")
end)

test("a raw log may have lines before it, names, units, disorder, duplicates and a cut end", function()
    local function log_of(text, options)
        local name = temporary ".csv"
        write(name, text)
        return read(name, options)
    end
    local log = "Logger 7, serial 12\nstarted 10:00\nZeit;Weg;Bemerkung\nms;mm;\n0,3;5;c\n0,1;2;a\n0,2;4;b\n0,1;3;d\n"
    local d = log_of(log, { skip = 2, sort = true, duplicates = "mean" })
    equal(d.Zeit, vector { 0.1, 0.2, 0.3 })
    equal(d.Weg, vector { 2.5, 4, 5 })
    equal(table.concat(d.Bemerkung), "abc")
    equal(d.units.Zeit .. d.units.Weg .. tostring(d.units.Bemerkung), "msmmnil")
    equal(log_of(log, { skip = 2, sort = true }).Weg, vector { 2, 3, 4, 5 })
    for which, kept in pairs { first = { vector { 5, 2, 4 }, "cab" }, last = { vector { 5, 3, 4 }, "cdb" } } do
        d = log_of(log, { skip = 2, duplicates = which })
        equal(d.Weg, kept[1])
        equal(table.concat(d.Bemerkung), kept[2])
    end
    d = log_of("1,2\n3,4\n", { names = { "t", "theta" } })
    equal(d.theta, vector { 2, 4 })
    d = log_of("time,angle\n1,2\n3,4\n", { names = { "t", "x" } })
    equal(d.x, vector { 2, 4 })
    equal(#d, 2)
    -- What a decimal comma is: more or less than three digits behind one of them tell.
    equal(log_of('a,b\n"1,5","2,125"\n"3,25",4\n').b, vector { 2.125, 4 })
    equal(log_of('a,b\n"1,500",2\n"3,250",4\n').a[1], "1,500")
    -- The last line of a logger that was switched off.
    d = log_of("a,b\n1,2\n3,4\n5")
    equal(d.a, vector { 1, 3 })
    has(tostring(d), "data: 2 rows; line 4 of the file ends in the middle and was left out")
    d = log_of("t,theta\n1,2\n3,4\n5")
    has(tostring(d), "line 4 of the file ends in the middle")
    raises(function() log_of("a,b\n1,2\n3\n") end, "csv:3: found 1 field, expected 2")
    raises(function() log_of(log, { skip = 2, names = { "a" } }) end, "csv:3: found 3 columns, and names has 1")
    raises(function() log_of("t,x\n,2\n1,3\n", { sort = true }) end, "load: sort needs a time in each row, and row 1 of column 't' is empty")
    raises(function() log_of("a\nx\ny\n", { sort = true }) end, "load: sort needs a column of numbers")
    raises(function() log_of("t,x\n1,3\nMean,2\n", { sort = true }) end, "load: sort needs times, and the column 't' holds words, such as 'Mean'")
    raises(function() log_of("t,x\n1,3\n", { skip = 5 }) end, "nothing follows the lines that are skipped")
    refused { { "identify { data = log_of('t,x\\n\"1\",3\\n\"2\",4\\n') }", "the column 't' of the record holds words, such as the number 1 in double quotes" } }
    equal(log_of('"t","theta"\n"0","1.5"\n"0.25","-2e-3"\n').theta, vector { 1.5, -2e-3 }) -- in a file with all fields in quotes
    equal(log_of('"t";"x"\n"0";"1,5"\n"0,25";"2"\n').x, vector { 1.5, 2 })
    local back = log_of("t,theta,velocity\n0,1,0\n2,2,1\n1,3,1\n3,4,0\n")
    has(tostring(back), "data: 4 rows; row 3 is earlier than the one before: sort = true puts them in order")
    equal(log_of("t,theta,velocity\n0,1,0\n2,2,1\n1,3,1\n3,4,0\n", { sort = true }):at(1), 3.0)
    refused {
        { 'identify { data = log_of("t,x\\n1,3\\n2,n/a\\n") }', "identify: the column 'x' of the record holds words, such as 'n/a'" },
        { 'read("x.dat", { skip = 1 })', "load: the record of 1989 (.dat) has no skip" },
    }
    raises(function() log_of(log, { skipp = 2 }) end, "load has no option 'skipp'", "did you mean 'skip'?")
    raises(function() log_of(log, { duplicates = "median" }) end, "duplicates must be 'keep', 'mean', 'first' or 'last', got the string \"median\"")
end)

test("words between the names and the numbers are units, unless there are other words below", function()
    local d = load("time;angle;note\n[s];(rad);\n0,5;1,25;\n1;;3\n")
    equal(d.time, vector{ 0.5, 1 })
    equal(d.angle[1], 1.25)
    assert(tostring(d):find("time, s +angle, rad +note\n"), tostring(d))
    equal(load("kind,x\nspring,linear\nwall,2\n").kind[2], "wall")
    equal(load("kind,x\nspring,2\n").x[1], 2.0)
    equal(#load("a,b\nc,d\n"), 1)
end)

test("events have columns and rows, and can be saved and loaded", function()
    local run = nondimensional{ friction_ratio = 0.167 }:simulate{ velocity0 = 2*math.pi, t_end = 3, dt = 1 }
    local events = run.events
    equal(#events.theta, #events)
    near(events.theta[1], 0.846848608, 1e-9) -- docs/report.md, figure 22
    equal(events.kind[#events], "rest")
    equal(events[1].kind, "turn")
    equal(of_kind(run, "turn").t[1], events[1].t)
    assert(tostring(events):find("^4 events: 3 turns, 1 rest\n"), tostring(events))
    refused { { "events.tetha", "did you mean 'theta'?" } }
end)

test("data:plot draws columns", function()
    local d = data{ r = { 1, 2, 3 }, A = { 1, 0/0, 3 }, B = { 2, 2, 2 }, w = { "a", "b", "c" } }
    has(d:plot{ x = "r", y = { "A", "B" }, show = false }, "B")
    has(d:plot{ x = "r", style = "points", title = "T", show = false }, "T")
    refuses(function(o) d:plot(o) end, {
        { { x = "r", y = "w" }, "holds words" },
        { { x = "rr" }, "there is no column 'rr'" },
        { { z = "A", style = "points" }, "style is for curves: leave it out, or z" },
    })
    refused {
        { "data{ r = { 1 } }:plot()", "no other column" },
        { "data{ r = {}, A = {} }:plot()", "no rows" },
    }
end)

test("a value that is not data is refused with a reason", function()
    refuses(data, {
        { {}, "there is no column" },
        { { a = 3 }, "a must be a vector, or a table of numbers or of strings, got 3" },
        { { a = { 1, 2 }, b = { 1 } }, "a has 2 and b has 1" },
        { { a = { 1, {} } }, "a[2] must be a number" },
        { { a = { 1, x = 2 } }, "data: a must be a list such as { 1, 2, 3 }, but it has x" },
        { { { "a", { 1 } }, a = { 2 } }, "two columns 'a'" },
    })
    refused {
        { "data{ a = { 1 } }.a = 2", "be changed" },
        { "data{ a = { 1 } }[-1]", "rows are counted from 1" },
        { "data{ a = { 1 } }:select()", "needs the name" },
        { "data{ a = { 1 } }:save()", "must be a string" },
    }
    for _, name in ipairs{ "x.lua", ".bashrc", "x" } do
        raises_here(function() data{ a = { 1 } }:save(name) end, "the name '" .. name .. "' must end in .csv")
    end
    refused { { 'data{ a = { 1 } }:save("/no/such/folder/x.csv")', "/no/such/folder" } }
end)

test("a long or wide table is cut, and says so", function()
    local columns = {}
    for i = 1, 40 do columns[i] = { "column" .. i, vector.linspace(0, 1, 20) } end
    local text = tostring(data(columns))
    has(text, "more columns", "... 5 more rows")
    for line in text:gmatch("[^\n]+") do assert(#line < 80, line) end
end)

finish()
