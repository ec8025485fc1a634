-- M must depend on its arguments only: violations of this are detected.
dofile "tests/lua/support.lua"

local asked = dofile "tests/lua/asked.lua"
local sys, methods, runs = asked.sys, asked.methods, asked.runs

local function found_out(make, more)
    for i, run in runs(make, more) do
        has(run.outcome, "M depends on more than its arguments: at t = ")
        has(run.outcome, "and, evaluated again, ")
        has(run.outcome, "states, excitation.sampled, excitation.relay or excitation.delayed")
        for _, theta in ipairs(run.theta) do assert(theta == theta) end
    end
end

local memories = {
    ["an integral"] = function()
        local last, sum = 0, 0
        return function(t, theta)
            sum = sum + 1e-6 * (0.2 - theta) * (t - last) -- a slow one: what is quick is found sooner
            last = t
            return math.sin(t) + sum
        end
    end,
    ["a relay with hysteresis"] = function()
        local on = true
        return function(_, theta)
            if theta > 0.05 then on = false elseif theta < -0.05 then on = true end
            return on and 10 or -10
        end
    end,
    ["a zero-order hold, of a function of time"] = function()
        local next_time, held = 0, 0
        return function(t)
            if t >= next_time then
                held = 5 * math.sin(4 * t)
                next_time = next_time + 0.15
            end
            return held
        end
    end,
    ["a trip that stays tripped"] = function()
        local tripped = false
        return function(_, theta)
            tripped = tripped or theta > 2
            return tripped and 1 or 5 - theta
        end
    end,
    ["rare random numbers"] = function() return function(t) return math.sin(t) + 1e-12 * math.random() end end,
    ["a coin"] = function() return function() return math.random(2) - 1.5 end end,
    ["a generator"] = function()
        return coroutine.wrap(function()
            local n = 0
            while true do
                n = n + 0.001
                coroutine.yield(n)
            end
        end)
    end,
}
for what, make in pairs(memories) do
    test(what .. " is found out", function()
        math.randomseed(42)
        found_out(make)
    end)
end

test("a function whose table is changed elsewhere is detected", function()
    found_out(function()
        gain = { value = 1 }
        return function(t)
            return gain.value * math.sin(t)
        end
    end, { events = { { when = function(t) return t - 5 end, act = function() gain.value = 2 end } } })
    gain = nil
end)

test("an impure function among several terms is detected, also delayed or windowed", function()
    local function counted()
        local calls = 0
        return excitation.scripted(function() calls = calls + 1 return 1e-9 * calls end)
    end
    found_out(function() return excitation.harmonic { frequency = 0.8 } + 0.5 * counted() end)
    found_out(function() return excitation.harmonic { frequency = 0.8 } + counted():delay(0.3) end)
    found_out(function() return excitation.harmonic { frequency = 0.8 } + counted():window(1, 6) end)
    found_out(function() return excitation.scripted(math.sin) + counted() end)
end)

test("a function that reads what a sampled one changes is detected, whether it is read or called", function()
    for _, as in ipairs { function(f) return f end, unread } do
        local x = 0
        local M = excitation.sampled(function(_, theta) x = 0.5 * theta return 0 end, { every = 0.5 })
            + as(function(t) return math.sin(t) - x end)
        has(system { I = 1, k = 1, C = 0.1 }:simulate { M = M, t_end = 6, dt = 1 }.outcome, "M depends on more than its arguments")
    end
end)

test("delayed functions must be pure, too", function()
    local calls = 0
    local M = excitation.delayed(function(t, theta) calls = calls + 1 return -theta + 1e-9 * calls end, { by = 0.1 })
    for _, method in ipairs(methods) do
        local run = sys:simulate { M = M, theta0 = 1, t_end = 5, dt = 0.1, integrator = method }
        has(run.outcome, "M depends on more than its arguments")
    end
end)

test("rates of states, laws of friction, springs, belts, supports and events of a user must be pure, too", function()
    local function drifting()
        local calls = 0
        return function() calls = calls + 1 return 0.3 + 1e-9 * calls end
    end
    local function told(options, system, who)
        for _, method in ipairs(methods) do
            options.theta0, options.t_end, options.dt, options.integrator = 1, 5, 0.1, method
            local run = system:simulate(options)
            assert(run.outcome:find(who .. " depends on more than its arguments: at ", 1, true), run.outcome)
        end
    end
    told({ states = { e = { rate = drifting() } } }, sys, "states.e.rate")
    told({ belt = drifting() }, sys, "belt")
    told({ base = drifting() }, sys, "base")
    told({ events = { { when = drifting(), name = "limit" } } }, sys, "the event limit")
    told({}, system { I = 1, k = 1, friction = friction.law(drifting(), { Re = 0.4 }) }, "friction")
    told({}, system { I = 1, k = 1, spring = drifting() }, "spring")
end)

test("a continued run is checked again", function()
    local late = false
    local M = function(t) return math.sin(t) + (late and 1e-6 * os.clock() or 0) end
    for _, method in ipairs(methods) do
        late = false
        local run = sys:simulate { M = M, theta0 = 1, t_end = 5, dt = 0.1, integrator = method }
        assert(#run == 51, run.outcome)
        has_not(run.outcome, "depends on more")
        late = true
        run = run:continue { t_end = 15 }
        has(run.outcome, "M depends on more than its arguments")
        near(run.t_start, 0, 0)
        assert(run.t_end >= 5 and #run >= 50)
    end
end)

test("the rows until a contradiction are kept, and the story reports it", function()
    local switched = false
    local run = sys:simulate { theta0 = 1, t_end = 40, dt = 0.1, M = function(t)
        if t > 20 then switched = true end
        return switched and t <= 20 and 3 or math.sin(t)
    end }
    has(run.outcome, "M depends on more than its arguments")
    assert(#run > 100 and run.t_end > 15, run.t_end)
    assert(run:explain():gsub("%s+", " "):find("The run stopped early, at t = [%d.]+.*: M depends on more than its arguments"), run:explain())
    has(run, "evaluated again")
end)

test("both values are reported, to the last digit if they differ only there", function()
    local calls = 0
    local run = sys:simulate { t_end = 5, dt = 1, M = function() calls = calls + 1 return calls > 10 and 0.25 or 0.75 end }
    has(run.outcome, "it returned 0.75 and, evaluated again, 0.25;")
    calls = 0
    run = sys:simulate { t_end = 5, dt = 1, M = function() calls = calls + 1 return calls > 10 and 0.3 or 0.1 + 0.2 end }
    has(run.outcome, "it returned 0.30000000000000004 and, evaluated again, 0.3;")
end)

test("steady states and responses report impure functions, too", function()
    local function drifting()
        local calls = 0
        return function(t) calls = calls + 1 return math.sin(2 * math.pi * t) + 1e-13 * calls end
    end
    refused {
        { "sys:steady { M = drifting(), period = 1 }", "M depends on more than its arguments: at t = " },
        { "sys:response { over = { f = { 1, 2 } }, at = function(p) return { M = drifting(), period = 1 / p.f } end }", "M depends on more than its arguments: at t = " },
    }
    local on = true
    raises(function()
        sys:steady { period = 1, theta0 = 1, M = function(t, theta)
            if theta > 0.05 then on = false elseif theta < -0.05 then on = true end
            return (on and 2 or -2) + 3 * math.sin(2 * math.pi * t)
        end }
    end, "M depends on more than its arguments: at t = ")
end)

test("dinal1989 evaluates M in order, and accepts any function", function()
    local last, sum = 0, 0
    local backwards = 0
    local run = nondimensional { zeta = 0.05 }:simulate { theta0 = 1, t_end = 5, dt = 0.1, integrator = integrator.dinal1989 { h = 0.01 },
        M = function(t)
            if t <= last then backwards = backwards + 1 end
            sum = sum + (t - last)
            last = t
            return sum
        end }
    equal(run.outcome, "reached the end")
    equal(backwards, 1)  -- the first, at t = 0
end)

finish()
