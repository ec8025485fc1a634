-- The documentation cannot lie: it is complete, its examples run and print what they say, docs/manual.md is up to date.
dofile "tests/lua/support.lua"

local function printed(option)
    local pipe <close> = io.popen(('"%s" %s'):format(program(), option))
    return pipe:read "a"
end
local manual, index = printed "--manual=all", printed "--manual"
local pages, page = {}, ""
for name in index:gmatch "%*%*%[[^%]]*%]%(manual/(%l+)%.md%)" do
    pages[name] = printed("--manual=" .. name)
    page = page .. pages[name]
end

--- The entries of the manual: heading, signature, summary, example.
local entries = {}
for part in (manual .. "\n## "):gsub("\n###? ", "\n\0"):gmatch "%z([^\0]*)" do
    local heading, signature, summary, example = part:match "^([^\n]+)\n\n`([^\n]*)`\n\n(.-)\n\n```lua\n(.-)\n```\n"
    if heading then
        entries[#entries + 1] = { heading = heading, signature = signature, summary = summary, example = example }
    elseif part ~= "" then
        entries[#entries + 1] = { heading = part:match "[^\n]+", broken = true }
    end
end

test("a page that the manual does not have is refused with those that it has", function()
    local pipe <close> = io.popen(('"%s" --manual=nothing 2>&1'):format(program()))
    has(pipe:read "a", "the manual has no page 'nothing': the pages are systems, ")
end)

test("the index of the manual names everything, and links to entries with options", function()
    for _, name in ipairs { "sys:simulate", "run:at", "vector.linspace", "sweep", "theory.den_hartog", "check", "r:save", "fit.silent" } do
        assert(index:find(" " .. name .. "[,.]") or index:find("[" .. name .. "](manual/", 1, true), name)
    end
    for file, place in index:gmatch "%(manual/(%l+)%.md#([^)]*)%)" do
        local there = false
        for heading in pages[file]:gmatch "\n##+ ([^\n]*)" do
            there = there or heading:lower():gsub("[^%w_%- ]", ""):gsub(" ", "-") == place
        end
        assert(there, file .. "#" .. place)
    end
end)

test("the page has entries without options as rows, and options of several calls once", function()
    has(page, "\n- `sys.I -> number`: The moment of inertia.\n")
    has_not(page, "\n### sys.I\n")
    equal(select(2, index:gsub("\n%- `units`: names of the units, for cards", "")), 1)
    has(page, "- [shared](../manual.md#options-of-several-calls): `M`, `theta0`, `velocity0`")
    for _, entry in ipairs(entries) do assert(entry.heading:find "^tostring" or page:find("`" .. entry.signature:match "^[^({ ]+", 1, true), entry.heading) end
end)

test("every entry has a signature, a summary that is a sentence, and an example", function()
    assert(#entries > 80, #entries)
    for _, entry in ipairs(entries) do
        assert(not entry.broken, entry.heading)
        assert(#entry.signature > 0, entry.heading .. " has no signature")
        assert(#entry.summary > 10 and entry.summary:gsub("\n\n%-.*", ""):find "%.$", entry.heading .. " has no summary")
        assert(#entry.example > 0, entry.heading .. " has no example")
    end
end)

test("everything visible in Lua has an entry", function()
    local described = {}
    for _, entry in ipairs(entries) do
        described[entry.heading] = true
    end
    local function check(owner, separator, members)
        for name in pairs(members) do
            local heading = separator and owner .. separator .. name or name
            assert(described[heading], "no entry for " .. heading)
        end
    end
    for name, value in pairs(dinal) do
        if type(value) == "table" then
            check(name, ".", value)
        elseif type(value) == "function" then
            assert(described[name], name)
        else
            assert(described["dinal." .. name], name)
        end
    end
    local sys = nondimensional {}
    local run = sys:simulate { t_end = 1, dt = 1 }
    for owner, object in pairs { sys = sys, run = run, integrator = run.integrator, e = run.excitation, v = run.t } do
        local index = debug.getmetatable(object).__index
        local _, methods = debug.getupvalue(index, 1)
        local _, fields = debug.getupvalue(index, 2)
        check(owner, ":", methods)
        check(owner, ".", fields)
        assert(next(methods) or next(fields), owner)
        for name in pairs(debug.getmetatable(object)) do
            local own = { __index = true, __newindex = true, __gc = true, __name = true, __metatable = true }
            assert(type(name) ~= "string" or own[name] or name:find "^__", name)
        end
    end
end)

test("every example runs on its own and prints the text after -->", function()
    for _, entry in ipairs(entries) do
        local printed, wanted = {}, {}
        for line in entry.example:gmatch "[^\n]+" do
            wanted[#wanted + 1] = line:match "%-%->%s?(.*)$"
        end
        local environment = setmetatable({}, { __index = _G })
        function environment.print(...)
            local values = table.pack(...)
            for i = 1, values.n do
                values[i] = tostring(values[i])
            end
            printed[#printed + 1] = table.concat(values, "\t")
        end
        function environment.help() end -- writes to stdout
        local ok, problem = pcall(assert(load(entry.example, "=example", "t", environment)))
        assert(ok, ("the example of %s fails: %s"):format(entry.heading, problem))
        equal(table.concat(printed, "\n"), table.concat(wanted, "\n"), "example of " .. entry.heading)
    end
end)

test("help knows functions, methods, modules, objects and names", function()
    local said = prints {
        { "help(excitation.harmonic)", "excitation.harmonic{ amplitude = 1, frequency | omega | period, phase = 0 } ->" },
        { 'help "excitation.harmonic"' }, { 'help "harmonic"' },
        { "help(nondimensional{}.simulate)" }, { 'help "sys.simulate"' }, { 'help "sys:simulate"' }, { 'help "system.simulate"' },
        { 'help "simulate"' },
        { "help(nondimensional{})", "sys.dead_zone" },
        { 'help "excitation"', "excitation.pulse" },
        { 'help "sys.omega0"', "natural frequency" },
        { 'help "system"', "system{ I, k, C = 0" },
        { "help(help)", "help(x)" },
    }
    for _, same in ipairs { "excitation.harmonic", "harmonic" } do
        equal(said[('help "%s"'):format(same)], said["help(excitation.harmonic)"])
    end
    local simulate = said["help(nondimensional{}.simulate)"]
    for _, same in ipairs { "sys.simulate", "sys:simulate", "system.simulate" } do
        equal(said[('help "%s"'):format(same)], simulate)
    end
    local both = said['help "simulate"']
    assert(#simulate > 100 and both:find(simulate, 1, true) == 1, both)
end)

test("help searches words, suggests names, and has a starting point", function()
    local said = prints {
        { 'help "the"', "more: use more of the word" },
        { 'help "wall "' },
        { 'help "run.enrgy"', "did you mean 'energy'?" },
        { 'help "rig:simulate"', "sys:simulate{" }, -- a user's object may have any name
        { 'help "rig:bogus"', "nothing about 'rig:bogus'" },
        { 'help "thta0"', "did you mean 'theta0'?" },
        { "help()", "sys = system{", "help(2)" }, { "help(1)" }, { 'help " "' },
        { "help(7)", "pages 1 to 6" },
        { 'help "contents"', "excitation.harmonic" }, { "help(dinal)" },
        { 'help "brakaway"', "did you mean 'breakaway'?" },
        { 'help "elseif"', "if condition then ... elseif" },
        { "help(nil)", "in quotes" },
        { "help(3.5)", "in quotes" },
        { "help(print)" }, { 'help "print"' }, { "help(math.cos)" }, { 'help "math.cos"' },
        { "help(function() end)", "no help" },
    }
    local many = said['help "the"']
    assert(select(2, many:gsub("\n  %S", "")) <= 10, many)
    local left = said['help "wall "']:match "and (%d+) more: use"
    assert(tonumber(left) < 10, left) -- those beyond the ten that are shown
    for one, other in pairs { ["help()"] = "help(1)", ['help " "'] = "help()", ["help(dinal)"] = 'help "contents"',
        ["help(print)"] = 'help "print"', ["help(math.cos)"] = 'help "math.cos"' } do
        equal(said[one], said[other])
    end
end)

test("help shows control sequences, and does not send them to the terminal", function()
    local said = output [[help("\27]0;title\7") help "how do I \27[2J"]]
    assert(not said:find "[%z\1-\9\11-\31\127]" and said:find([['\x1B]0;title\x07']], 1, true), said)
end)

test("an entry names related entries, and help knows these names", function()
    local function pages(names)
        local codes, all = {}, {}
        for i, name in ipairs(names) do codes[i] = ("help %q"):format(name) end
        local said = outputs(codes)
        for i, name in ipairs(names) do all[name] = said[codes[i]] end
        return all
    end
    has(pages{ "simulate" }.simulate:match "See also: (.+)", "integrator.")
    local headings, wanted, named_by = {}, {}, {}
    for _, entry in ipairs(entries) do
        if not entry.heading:find "[ #%-]" and #entry.heading > 1 then headings[#headings + 1] = entry.heading end
    end
    for heading, page in pairs(pages(headings)) do
        for name in (page:match "See also: ([^\n]+)" or ""):gmatch "[^, ]+" do
            if not named_by[name] then wanted[#wanted + 1] = name end
            named_by[name] = heading
        end
    end
    assert(#wanted > 30, #wanted)
    local known = pages(wanted)
    for _, name in ipairs(wanted) do
        assert(known[name], named_by[name] .. " names " .. name)
        has_not(known[name], "nothing about")
    end
end)

test("Lua's words are explained in a line, with an example that runs", function()
    local words = {}
    for _, name in ipairs{ "math", "string", "table" } do
        for key in pairs(_G[name]) do words[#words + 1] = name .. "." .. key end
    end
    for word in ([[and break do else elseif end false for function goto if in local nil not or repeat return then true until while
        print type pairs ipairs tostring tonumber error assert pcall require load dofile select setmetatable ans
        list dictionary string number comment lambda import range slice mask]]):gmatch "%S+" do
        words[#words + 1] = word
    end
    local codes, examples, wanted = {}, {}, {}
    for i, word in ipairs(words) do codes[i] = ("help %q"):format(word) end
    local pages = outputs(codes)
    for i, word in ipairs(words) do
        local page = pages[codes[i]]
        examples[i], wanted[i] = page:match "\n\n    ([^\n]-)  %-%-> ([^\n]*)\n"
        assert(examples[i], word .. " has no example: " .. page)
        has_not(page, "nothing about")
    end
    local printed = outputs(examples)
    for i, word in ipairs(words) do
        equal(printed[examples[i]]:gsub("\n$", ""):gsub("\n", ", "), wanted[i], "example of " .. word)
    end
end)

finish()
