-- Whatever a user's M does, the outcome is clear and the session goes on.
dofile "tests/lua/support.lua"

local nd = nondimensional { zeta = 0.1, friction_ratio = 0.1 }

local function simulate(M)
    return nd:simulate { M = M, theta0 = 1, t_end = 2, dt = 0.01 }
end

local function works_still()
    equal(simulate(0).outcome, "at rest")
end

test("an error in M arrives unchanged, and names the line of M", function()
    local line
    local function M(t)
        line = debug.getinfo(1, "l").currentline + 1
        if t > 0.5 then error("oh no") end
        return 0
    end
    local message = raises(function() simulate(M) end, "oh no")
    equal(message, ("%s:%d: oh no"):format(debug.getinfo(1, "S").short_src, line))
    works_still()
end)

test("an error value that is not a string arrives as the same value", function()
    for _, value in ipairs { {}, 42, false, print, setmetatable({}, { __tostring = error }) } do
        local ok, found = pcall(simulate, function(t) if t > 0.1 then error(value) end return 0 end)
        assert(not ok and rawequal(found, value))
    end
    local ok, found = pcall(simulate, function() error() end)
    assert(not ok and found == nil)
    works_still()
end)

test("the rows before an error are kept in dinal.partial", function()
    pcall(simulate, function(t) if t > 0.505 then error "x" end return 0 end)
    local partial = dinal.partial
    assert(#partial >= 50 and #partial <= 52, #partial)
    assert(partial.t[#partial] <= 0.51)
    has(partial.outcome, "M failed")
    near((partial:at(0.3)), simulate(0).theta[31], 1e-12)
end)

test("a result of M that is not a finite number is an error with the line of M, the value and the time", function()
    local here = debug.getinfo(1, "S").short_src
    for text, value in pairs { ['the string "1.5"'] = "1.5", ["a table"] = {}, ["true"] = true, ["inf"] = math.huge, ["-inf"] = -math.huge, ["nan"] = 0 / 0 } do
        local M = function(t) return t > 0.35 and value or 0 end
        local line = debug.getinfo(M, "S").linedefined
        raises(function() simulate(M) end, ("%s:%d: M returned %s at t = 0.3"):format(here, line, text), "; it must return a finite number")
        assert(#dinal.partial >= 34 and #dinal.partial <= 37, #dinal.partial)
    end
    refused {
        { "simulate(function() return nil end)", "M returned nil at t = 0; it must return a finite number" },
        { "simulate(function() end)", "M returned nil at t = 0" },
    }
    local function late(t) return t < 1.23 and #tostring(1) or nil end -- called for many times at once
    raises(function() excitation.scripted(late):values { 0, 1, 1.3, 2 } end, "M returned nil at t = 1.3;")
    works_still()
end)

test("an M that yields gets an error that explains it", function()
    local function M(t) if t > 0.2 then coroutine.yield(t) end return 0 end
    raises(function() simulate(M) end, "yield")
    local ok, message = coroutine.resume(coroutine.create(function() simulate(M) end))
    assert(not ok, message)
    has(message, "yield")
    works_still()
end)

test("a run inside a coroutine works, and M may use coroutines of its own", function()
    local expected = simulate(function(t) return math.sin(t) end)
    local run = coroutine.wrap(function() return simulate(function(t) return math.sin(t) end) end)()
    assert(run.theta == expected.theta)
    local source = coroutine.wrap(function(t)
        while true do t = coroutine.yield(math.sin(t)) end
    end)
    near(simulate(source).theta, expected.theta, 1e-13) -- a function that is no formula is sampled
    -- M belongs to a coroutine that is dead when the run is asked again
    local later
    coroutine.wrap(function() later = simulate(function(t) return math.sin(t) end) end)()
    collectgarbage()
    near((later:at(0.505)), (expected:at(0.505)), 1e-15)
end)

test("M may call simulate itself, and fail there", function()
    local inner = function(t) return nondimensional {}:simulate { M = 1, t_end = 1, times = {} }:at(0.5) end
    local run = nd:simulate { M = inner, t_end = 0.1, dt = 0.1, integrator = integrator.rk4 { h = 0.05 } }
    near(run.M[1], 2, 1e-9)
    raises(function() simulate(function(t) return simulate(function() error "deep inside" end) end) end, "deep inside")
    local caught = simulate(function() pcall(simulate, function() error "x" end) return 1 end)
    equal(caught.outcome, "stuck at the end")
    works_still()
end)

test("M that calls simulate without end is an error and does not crash", function()
    local function M() return simulate(M) end
    raises(function() simulate(M) end, "50 levels deep")
    works_still()
end)

test("M may change globals, the system's name and its own name while it runs", function()
    counter = 0
    M = function(t)
        counter = counter + 1
        M, nd_global, sys, math_old = nil, nil, nil, math
        return 1
    end
    nd_global = nd
    local run = nd_global:simulate { M = M, t_end = 1, dt = 0.1 }
    equal(M, nil)
    assert(counter > 1)
    equal(run.M[11], 1.0)
end)

test("M may drop the run, the system and collect garbage", function()
    local holder = { nondimensional { zeta = 0.1 } }
    local run = holder[1]:simulate { M = function() holder[1] = nil collectgarbage() return 1 end, t_end = 0.01, dt = 0.01 }
    equal(#run, 2)
    local other = { simulate(function(t) return math.sin(t) end) }
    local drop = { simulate(function(t) other[1] = nil drop_now = nil collectgarbage() return 0 end) }
    drop_now = drop[1]
    drop[1] = nil
    drop_now:at(0.123)
    works_still()
end)

test("errors of M do not leak: hundreds of them leave the stack and the registry as they were", function()
    local before
    for i = 1, 400 do
        pcall(simulate, function() error "x" end)
        if i == 200 then
            collectgarbage() collectgarbage()
            before = collectgarbage "count"
        end
    end
    collectgarbage() collectgarbage()
    assert(collectgarbage "count" < before + 12, collectgarbage "count" - before)
end)

test("an error in what an object with __call returns names the line of that function", function()
    local M = setmetatable({}, { __call = function(self, t) return "x" end })
    local line = debug.getinfo(1, "l").currentline - 1
    raises(function()
        system { I = 1, k = 1 }:simulate { M = M, t_end = 1 }
    end, (":%d: M returned the string \"x\" at t = 0"):format(line))
end)

finish()
