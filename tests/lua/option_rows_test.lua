-- Every option of every call: a wrong name, a wrong kind and a number out of its range are each refused with a sentence
-- that names the call, the option and the value. The calls and their options are those of the manual.
dofile "tests/lua/support.lua"

local calls = {} -- heading -> list of { name, meaning }
do
    local pipe <close> = io.popen(('"%s" --manual=all'):format(program()))
    local heading
    local list -- of calls that take one of two tables: "excitation.samples 2" is the second
    for line in pipe:lines() do
        heading = line:match "^### (.+)" or line:match "^## (.+)" or heading
        local name, meaning = line:match "^%- `([%a_][%w_]*)[^`]*`: (.*)"
        if name and not list then
            local key = calls[heading] and heading ~= "plot" and heading .. " 2" or heading
            list = calls[key] or {}
            calls[key] = list
        end
        list = name and list
        if name then
            table.insert(list, { name = name, meaning = meaning })
        end
    end
end

--- What the help on a call says that a number must be, which the manual leaves out: heading and name -> "be positive".
local limits = {}
do
    local headings = {}
    for heading in pairs(calls) do headings[#headings + 1] = ("help %q"):format(heading:gsub(" 2$", "")) end
    table.sort(headings)
    local text = output(table.concat(headings, "\nprint 'next'\n"))
    local n, row = 1, nil
    for line in (text .. "\n"):gmatch "(.-)\n" do
        if line == "next" then n = n + 1 end
        local name = line:match "^  ([%a_][%w_]*)"
        row = name and line or row and line:match "^    +%S" and row .. " " .. line:match "%S.*"
        local must = row and row:match "%(.*must ([^)]*)%)"
        if must then limits[headings[n]:match '"(.*)"' .. " " .. row:match "[%a_][%w_]*"] = must end
    end
end

--- What the examples speak of.
local world = setmetatable({}, { __index = _G })
world.sys = nondimensional { zeta = 0.1, friction_ratio = 0.1 }
world.run = world.sys:simulate { theta0 = 1, t_end = 1, dt = 0.25 }
world.rig = system { bodies = { load = { I = 1 } } }
world.rig_run = world.rig:simulate { t_end = 1 }
world.M = excitation.constant { amplitude = 1 }
world.t, world.theta = world.run.t, world.run.theta
world.fit = identify { data = world.sys:simulate { theta0 = 1, t_end = 3, dt = 0.1 } }
world.r = report { title = "x" }
world.d = data { r = { 1, 2 }, A = { 3, 4 } }
world.f = function() return 1 end
local record, animation = os.tmpname(), temporary ".svg"
assert(io.open(record, "w")):write("t,M\n0,1\n1,2\n"):close()

--- The example in the sentence that refuses a call without a table.
local function example_of(heading)
    local wrong_calls = { ["run:save"] = 'run:save("x.csv", 1)', ["r:animate"] = "r:animate(run, 1)", ["excitation.scripted"] = "excitation.scripted(f, 1)",
        ["excitation.samples 2"] = "excitation.samples{}", ["excitation.constant"] = "excitation.constant{}", ["run:continue"] = "run:continue(true)",
        ["rig_run:save"] = 'rig_run:save("x.csv", 1)', ["rig_run:continue"] = "rig_run:continue(true)", load = 'load("x.csv", 1)' }
    local message = raises(assert(load(wrong_calls[heading] or heading .. "(1)", "=call", "t", world)))
    return assert(message:match "for example (.+)$", message):gsub("record.csv", record)
end

--- The example with one option changed, as a function: f{ ... } becomes f(changed{ ... }).
local function call_with(example, change)
    local before, options, after = example:match "^(.-)(%b{})(%)?)$"
    world.changed = function(options_given)
        change(options_given)
        return options_given
    end
    local text = before:sub(-1):find "[%w_]" and ("%s(changed%s)"):format(before, options) or before .. "changed" .. options .. after
    return (assert(load(text, "=call", "t", world), text))
end

--- The message of the call, which must name all that is asked.
local function refused(example, change, ...)
    local message = raises(call_with(example, change))
    for _, part in ipairs { "call:1: ", ... } do
        assert(message:find(part, 1, true), ("%s\n  does not say %s"):format(message, part))
    end
    return message
end

--- The options of a pair, of which only one may be given.
local function partner(option)
    return option.meaning:match "instead of ([%a_][%w_]*)[,)]" or option.meaning:match "this or ([%a_][%w_]*) is needed"
end

--- The options that may be math.huge, of all: no other takes what is not finite, but for gaps in vectors of theory.
local may_be_endless = { ["excitation.ramp duration"] = true, ["friction.lugre speed"] = true, ["integrator.spectral max_panel"] = true,
    ["integrator.spectral narrowest"] = true }

--- Numbers next to a limit, and whether they are refused.
local function around(limit, is_dear)
    if limit == "be positive" then return { [-1] = true, [0] = true, [2] = false } end
    if limit == "not be negative" then return { [-1e-9] = true, [0] = false } end
    if limit == "not be zero" then return { [0] = true, [-1] = false } end
    if limit == "be 0 or from 0.0001 to 1e6" then return { [-1] = true, [0.9e-4] = true, [1e-4] = false, [1e6] = false, [1.1e6] = true } end
    if limit == "be from 0 to less than 1" then return { [-1e-9] = true, [0] = false, [1] = true } end
    if limit == "be at least 1" then return { [0.99] = true, [1] = false } end
    local least, most = limit:match "^be a whole number from (%d+) to (%S+)$"
    if not least then return { [-0.1] = true, [1.1] = true, [0.5] = false } end -- lie between 0 and 1
    least, most = tonumber(least), most == "2^53" and 2 ^ 53 or tonumber(most)
    local values = { [least - 1] = true, [least + 0.5] = true, [least] = false, [most * 1.01 // 1 + 1] = true }
    if most <= 1000 and not is_dear then values[most] = false end
    return values
end

local tested, limited = 0, 0
for heading, options in pairs(calls) do
    test("the options of " .. heading, function()
        local is_plot = heading == "plot"
        local example = example_of(heading)
        heading = heading:gsub(" 2$", ""):gsub("^rig_run:animate", "run:animate")
        refused(example, function(t) t.xyzzy = 1 end, heading .. " has no option 'xyzzy' among ")
        for _, option in ipairs(options) do
            local function give(value)
                return function(t)
                    local owner = is_plot and ("label style dashes colour base"):find(option.name, 1, true) and t[1] or t
                    if heading:find "plot" then
                        t.file, t.show = nil, false -- nothing is to be drawn where a test forgets to fail
                    end
                    if heading == "run:animate" then t.file = animation end
                    owner[option.name] = value
                    if partner(option) then
                        owner[partner(option)] = nil
                    end
                end
            end
            refused(example, give(coroutine.create(print)), heading .. ": ", option.name, "a thread")
            for _, value in ipairs { math.huge, 0 / 0, { 1, math.huge }, { 1, 0 / 0 } } do
                local is_gap = heading:find "^theory" and type(value) == "table" and value[2] ~= value[2]
                local call = call_with(example, give(value))
                if not (is_gap or may_be_endless[heading .. " " .. option.name] and value == math.huge) then
                    raises(call, "call:1: ")
                end
            end
            local limit = limits[heading .. " " .. option.name]
            for value, bad in pairs(limit and around(limit, option.name == "threads") or {}) do
                local ok, message = pcall(call_with(example, give(value)))
                local told = not ok and message:find(("%s = %.6g must %s"):format(option.name, value, limit), 1, true) ~= nil
                assert(told == bad, ("%s = %g must %s: %s"):format(option.name, value, limit, tostring(message)))
                limited = limited + 1
            end
            tested = tested + 1
        end
    end)
end

os.remove(record)

test("many options and limits were tested", function() assert(tested > 140 and limited > 350, limited) end)

test("misspelt names are all reported at once, in an order that does not change from run to run", function()
    for _ = 1, 20 do
        local given = { zz = 1, Rf = 2, kk = 3, I = 1 }
        given.aa, given.zz = 4, nil -- another order in the table
        local message = raises(function() system(given) end)
        has(message, "system has no options 'Rf', 'aa' and 'kk' among I, k,")
        has(message, "; did you mean 'Rd' for 'Rf'")
    end
end)

test("an option that belongs to the system, or to the run, is refused with the right place", function()
    local sys = system { I = 1, k = 4 }
    local function told(call, sentence)
        local message = raises(call)
        assert(message:sub(-#sentence) == sentence, message)
    end
    told(function() sys:simulate { walls = {}, t_end = 1 } end, "base and units; 'walls' is an option of sys:with")
    told(function() sys:steady { M = 1, spring = {} } end, "belt and base; 'spring' is an option of sys:with")
    told(function() system { I = 1, k = 4, theta0 = 1 } end, "links and units; 'theta0' is an option of sys:simulate")
    told(function() sys:simulate { walls = {}, Rd = 1, t_en = 1 } end,
        "'Rd' and 'walls' are options of sys:with; did you mean 't_end' for 't_en'?")
end)

finish()
