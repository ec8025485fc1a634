-- Every option of every call: a wrong name, a wrong kind and a number out of its range are each told by a sentence that
-- names the call, the option and the value. The calls and their options are those of the manual, which lists the rows.
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
local record = os.tmpname()
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

local tested = 0
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
                    owner[option.name] = value
                    if partner(option) then
                        owner[partner(option)] = nil
                    end
                end
            end
            refused(example, give(coroutine.create(print)), heading .. ": ", option.name, "a thread")
            if option.meaning:find "must " then
                local told = false
                for _, value in ipairs { -1, 0, 0.5, 2, 1e-9 } do
                    local ok, message = pcall(call_with(example, give(value)))
                    told = told or not ok and message:find("call:1: " .. heading, 1, true) and
                        message:find(("%s = %.6g must "):format(option.name, value), 1, true) ~= nil
                end
                assert(told, option.name .. " may be anything")
            end
            tested = tested + 1
        end
    end)
end

os.remove(record)

test("many options were tested", function() assert(tested > 140, tested) end)

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
