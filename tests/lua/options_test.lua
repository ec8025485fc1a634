-- The options that a signature lists are those that the function takes: completion and hints believe the signature.
package.path = "tests/lua/?.lua;" .. package.path
local support = require "support"
local test, equal = support.test, support.equal

--- The names in a piece of a signature: "M = 0, t_end, dt | times" has M, t_end, dt and times.
local function names_in(braces)
    local names = {}
    local flat = braces:gsub("%b{}", "nil")
    for part in flat:gmatch "[^,|]+" do
        names[#names + 1] = part:match "^%s*([%a_][%w_]*)"
    end
    table.sort(names)
    return table.concat(names, " ")
end

--- The options that the function itself says it has when it is given a wrong one.
local function names_taken(...)
    local message = support.raises(...)
    local list = message:match "has no option 'xyzzy' among ([^;]*)"
    assert(list, message)
    local names = {}
    for name in list:gsub(" and ", ", "):gmatch "[^, ]+" do
        names[#names + 1] = name
    end
    table.sort(names)
    return table.concat(names, " ")
end

local signatures = {} -- by the name before the bracket: the texts between braces
do
    local pipe <close> = io.popen(('"%s" --manual'):format(support.program()))
    for signature in pipe:read("a"):gmatch "\n`([^\n`]*)`\n" do
        for name, arguments in signature:gsub("%->.*", ""):gmatch "([%a_][%w_.:]*)(%b{})" do
            if not arguments:find("...", 1, true) then -- the entry of a whole module shortens
                signatures[name] = signatures[name] or arguments:sub(2, -2)
            end
        end
        for name, arguments in signature:gsub("%->.*", ""):gmatch "([%a_][%w_.:]*)%(([^()]*%b{})%)" do
            signatures[name .. "()"] = arguments:match "%b{}":sub(2, -2)
        end
    end
end

local wrong = { xyzzy = 1 }
local sys = nondimensional {}
local checked = 0

test("modules and functions take what their signatures list", function()
    for _, owner in ipairs { dinal, excitation, integrator } do
        for name, f in pairs(owner) do
            local prefix = owner == excitation and "excitation." or owner == integrator and "integrator." or ""
            local listed = signatures[prefix .. name]
            if type(f) == "function" and listed and listed:find "%w" then
                equal(names_in(listed), names_taken(function() f(wrong) end), prefix .. name)
                checked = checked + 1
            end
        end
    end
    assert(checked >= 15, checked)
end)

test("so do the calls with a table behind other arguments", function()
    equal(names_in(signatures["sys:simulate"]), names_taken(function() sys:simulate(wrong) end))
    equal(names_in(signatures["excitation.scripted()"]), names_taken(function() excitation.scripted(print, wrong) end))
    equal(names_in(signatures["excitation.samples()"]), names_taken(function() excitation.samples("x.csv", wrong) end))
    local run = sys:simulate { t_end = 1, dt = 1 }
    equal(names_in(signatures["run:save()"]), names_taken(function() run:save("x.csv", wrong) end))
end)

support.finish()
