-- A function of its arguments alone is never reported as having a memory, whatever else it does.
dofile "tests/lua/support.lua"

local asked = dofile "tests/lua/asked.lua"
local sys, methods, runs = asked.sys, asked.methods, asked.runs

local function believed(make, more)
    for i, run in runs(make, more) do
        assert(#run > 10, i .. ": " .. run.outcome)
        has_not(run.outcome, "depends on more")
    end
end

test("a counter, a log and a cache do not make a function impure", function()
    local calls, log, cache = 0, {}, {}
    believed(function()
        return function(t, theta)
            calls = calls + 1
            log[#log % 100 + 1] = t
            local key = math.floor(t * 10)
            cache[key] = cache[key] or math.sin(key)
            return cache[key] - 0.1 * theta
        end
    end)
    assert(calls > 1000)
end)

test("coroutines within M, metatables, string arithmetic, integers and C functions count as pure", function()
    believed(function()
        return function(t)
            local inner = coroutine.wrap(function(x) coroutine.yield(math.sin(x)) end)
            return inner(t)
        end
    end)
    believed(function() return setmetatable({ 3 }, { __call = function(self, t, theta) return self[1] * math.cos(t) - theta end }) end)
    believed(function() return function(t) return tonumber(("%.17g"):format(t)) % 1 end end)
    believed(function() return function(t) return math.floor(t) end end)
    believed(function() return math.sin end)
    believed(function() return math.sqrt end)
end)

test("zeros of both signs, denormals, jumps and noise that is a function count as pure", function()
    local flip = 0
    believed(function()  -- -0 and 0 are one number
        return function()
            flip = 1 - flip
            return flip == 1 and 0.0 or -0.0
        end
    end)
    believed(function() return function(t) return 1e-310 * math.sin(t) end end)
    believed(function() return function(t, theta) return theta > 0 and -1 or 1 end end)
    believed(function() return excitation.scripted(function(t) return t % 1 < 0.5 and 1 or -1 end, { breaks = { 0, 0.5 }, period = 1 }) end)
end)

-- A sampled controller of a block on a spring that sums up how far it is from 0.5.
local spring = system { I = 1, k = 4, C = 0.1, Rd = 0.05, Re = 0.08 }
local function summing(gain)
    local sum = 0
    return excitation.sampled(function(_, theta)
        sum = sum + 0.05 * (0.5 - theta)
        return gain * sum
    end, { every = 0.05 })
end
local another = "the function of excitation.sampled keeps a memory from one run to the next"

test("a sampled controller that remembers a run is refused in another run", function()
    local task = { M = summing(6), t_end = 5, dt = 1 }
    local run = spring:simulate(task)
    raises_here(function() spring:simulate(task) end, another)
    local whole = run:continue { t_end = 7 }:continue { t_end = 10 }
    refused { { "run:continue { t_end = 10 }", "the function of excitation.sampled has been used in another run since" } }
    near(whole:at(10), (spring:simulate { M = summing(6), t_end = 10, dt = 1 }:at(10)), 1e-10)
    raises_here(function() spring:simulate { M = 1 + 2 * task.M, t_end = 5, dt = 1 } end, another)
end)

test("a new controller that shares this memory is refused, unless it was reset; others may be used again", function()
    local sum, gain = 0, 1
    local function task()
        return { M = excitation.sampled(function(_, theta) sum = sum + 0.05 * (0.5 - theta) return gain * sum end, { every = 0.05 }), t_end = 5, dt = 1 }
    end
    local first = spring:simulate(task())
    gain = 2
    raises_here(function() spring:simulate(task()) end, another)
    sum, gain = 0, 1
    equal(spring:simulate(task()).theta[6], first.theta[6])
    local forgetful = { M = excitation.sampled(function(_, theta) return gain * (0.5 - theta) end, { every = 0.05 }), t_end = 5, dt = 1 }
    local once = spring:simulate(forgetful).theta[6]
    gain = 2
    assert(spring:simulate(forgetful).theta[6] ~= once)
    gain = 1
    equal(spring:simulate(forgetful).theta[6], once)
end)

test("a sweep accepts controllers made in its function, and refuses one that its points share", function()
    local shared = summing(1)
    local function swept(run) return sweep { over = { gain = { 1, 2, 3, 4 } }, workers = 2, run = run } end
    raises(function()
        swept(function(p) return { x = spring:simulate { M = p.gain * shared, t_end = 5, dt = 1 }:at(5) } end)
    end, "all 4 points failed", another)
    local found = swept(function(p) return { x = (spring:simulate { M = summing(p.gain), t_end = 5, dt = 1 }:at(5)) } end)
    for _, row in ipairs(found) do equal(row.x, (spring:simulate { M = summing(row.gain), t_end = 5, dt = 1 }:at(5))) end
end)

-- The same controller with a memory that it declares.
local function declared(gain)
    return excitation.sampled(function(_, theta, _, _, memory)
        memory.sum = memory.sum + 0.05 * (0.5 - theta)
        memory.last[1] = theta
        return gain * memory.sum
    end, { every = 0.05, start = function() return { sum = 0, last = {} } end })
end
local function last_of(run) return run.theta[#run.theta] end

test("a memory made by start is new in each run, and continues in a continued run", function()
    for _, method in ipairs { integrator.spectral {}, integrator.rk4 { h = 0.005 } } do
        local function task(t_end, M) return { M = M, t_end = t_end, dt = 1, integrator = method } end
        local M = declared(6)
        local whole = spring:simulate(task(10, M))
        near(last_of(whole), last_of(spring:simulate(task(10, summing(6)))), 0)
        equal(last_of(spring:simulate(task(10, M))), last_of(whole))
        local first = spring:simulate(task(5, M))
        local once = first:continue { t_end = 10 }
        near(last_of(once), last_of(whole), 1e-12)
        spring:simulate(task(7, 2 * M + 1)) -- another run of the same controller between
        for i = 1, 2 do equal(last_of(first:continue { t_end = 10 }), last_of(once)) end
    end
end)

test("steady motions, sweeps and CSV headers include a declared memory", function()
    local M = declared(1)
    local s = spring:steady { M = M + excitation.harmonic { frequency = 0.5 }, period = 2 }
    equal(s.amplitude, spring:steady { M = M + excitation.harmonic { frequency = 0.5 }, period = 2 }.amplitude)
    local found = sweep { over = { gain = { 1, 2, 3, 4, 5, 6 } }, workers = 2, run = function(p)
        return { x = last_of(spring:simulate { M = p.gain * M, t_end = 5, dt = 1 }) }
    end }
    for i = 1, 6 do equal(found.x[i], last_of(spring:simulate { M = i * M, t_end = 5, dt = 1 })) end
    has(M, "start = function() return { sum = 0, last = {} } end")
end)

test("mistakes in start and the memory are errors with a reason", function()
    local function controller(start, f)
        return { M = excitation.sampled(f or function(_, _, _, _, memory) return memory.x end, { every = 0.1, start = start }), t_end = 1 }
    end
    raises(function() controller { x = 1 } end, "start must be a function that returns a table")
    for message, start in pairs {
        ["start of excitation.sampled returned 3; it must return the memory of a run, a table"] = function() return 3 end,
        ["no memory"] = function() error "no memory" end,
        ["the memory of a sampled controller holds numbers"] = function() return { f = print } end,
        ["the sampled function returned nil"] = function() return {} end,
    } do
        raises(function() spring:simulate(controller(start)) end, message)
    end
    local run = spring:simulate(controller(function() return { x = 1 } end, function(_, _, _, _, memory) memory.f = print return 1 end))
    refused { { "run:continue { t_end = 2 }", "the memory of a sampled controller holds numbers" } }
    local sum = 0
    local task = controller(function() return {} end, function() sum = sum + 1 return sum end)
    spring:simulate(task)
    raises(function() spring:simulate(task) end, another)
end)

finish()
