-- Excitations: terms, operators, user functions and messages about mistakes. The examples of the manual, which
-- help_test.lua runs, have the plain values.

dofile "tests/lua/support.lua"

-- The line of the caller.
local function line() return debug.getinfo(2, "l").currentline end
local e = excitation

near(e.harmonic{ amplitude = 2, omega = 3, phase = 0.5 }(0.1), 2 * math.sin(0.8), 1e-14)
-- A periodic term takes frequency, omega or period, one of them.
for name, wave in pairs{ harmonic = e.harmonic, square = e.square, triangle = e.triangle, sawtooth = e.sawtooth } do
    near(wave{ period = 2.5 }(0.7), wave{ frequency = 0.4 }(0.7), 1e-14)
    near(wave{ omega = 0.8 * math.pi }(0.7), wave{ frequency = 0.4 }(0.7), 1e-14)
    raises(function() wave{ period = 1, omega = 2 } end, "excitation." .. name .. ": ", " exclude each other; give one of them")
    raises(function() wave{} end, "period", "omega", " is needed")
end
-- The values at many times, and a number alone where one option is meant.
assert(e.ramp{}(vector{ 1, 2 }) == vector{ 1, 2 } and tostring(e.constant(3)) == "excitation.constant{ amplitude = 3 }")
-- The names of before lead to the new ones.
for wanted, call in pairs{ amplitude = function() e.step{ level = 1 } end, sigma = function() e.gaussian{ at = 1, width = 1 } end,
    duration = function() e.ramp{ width = 1 } end } do
    raises(call, "did you mean '" .. wanted .. "'?")
end
has(e.relay{ on = 1, off = 2, amplitude = 3 }, "amplitude = { 3, -3 }")
assert(e.pulse{ width = 1 }(0.5) == 1 and e.pulse{ amplitude = 3, at = 1, width = 1 }(2) == 0)
assert(e.half_sine{ amplitude = 2, at = 1, width = 2 }(2) == 2 and e.ramp{}(7) == 7)
near(e.chirp{ amplitude = 2, from = 1, to = 3, duration = 4, at = 1, phase = 0.1 }(2), 2 * math.sin(0.1 + 2.5 * math.pi), 1e-14)
near(e.exponential{ amplitude = 2, tau = 0.5, at = 1 }(2), 2 * math.exp(-2), 1e-14)
assert(e.polynomial{ coefficients = vector{ 1, 2, 3 }, at = 1 }(3) == 17)
assert(e.samples{ t = vector{ 0, 2 }, M = vector{ 1, 5 } }(3) == 5)

-- e:value and e(t) are the same; breaks are told; a block is what its values are.
local train = e.pulse{ at = 0.3, width = 0.5 } + e.pulse{ at = 2, width = 0.5 }
assert(train:next_break(0) == 0.3 and train:next_break(0.3) == 0.8 and train:next_break(2.5) == math.huge)
assert(train:values{ 0, 0.5, 1, 2 } == vector{ 0, 1, 0, 1 })

-- Operators, with numbers and functions on either side.
local step = e.step{}
local double = function(t) return 2 * t end
assert((2 + step)(1) == 3 and (double + step)(3) == 7 and (step - 2)(1) == -1 and (double - step)(3) == 5 and (step * 3)(1) == 3)
assert((2 * (step + double - 1) / 4)(3) == 3)
assert(step(1) == 1, "the operands stay as they are")
raises(function() return step * step end, "excitation_test.lua:" .. line() .. ": ", "multiplied by a number only, got an excitation")
raises(function() return step * double end, "got a function")
raises(function() return 1 / step end, "divided by a number only, got 1 / an excitation")
raises(function() return step / 0 end, "divided by zero")
raises(function() return step + "3" end, "must be a function, a number or an excitation", 'got the string "3"')
raises(function() return step + math.huge end, "must be finite, got inf")

-- Delay and window, in either order.
assert((step + double):delay(1)(3) == 5)
assert(tostring(e.ramp{}:window(-math.huge, 3)):find("window(-math.huge, 3", 1, true) and e.ramp{}:window(-math.huge, 3)(2) == 2 and e.ramp{}:window(1, math.huge)(1e6) == 1e6)
raises(function() return step:window(3, 1) end, "to = 1 must be after from = 3")
raises(function() return step:window(3) end, "to must be a number, got nil")
raises(function() return step.delay(1) end, "use a colon: e:delay(d)")

-- Samples may be splines, and periodic.
do
    local t, M = { 0, 1, 2, 3 }, { 0, 1, 0, -1 }
    local s = e.samples{ t = t, M = M, interpolation = "cubic", period = 4 }
    assert(s(0.5) == 0.6875 and s(4.5) == 0.6875 and s(-3.5) == 0.6875 and s:next_break(3.5) == 4)
    assert(s:delay(1)(1.5) == 0.6875)
    assert(tostring(s) == 'excitation.samples{ t = { 0, 1, 2, 3 }, M = { 0, 1, 0, -1 }, interpolation = "cubic", period = 4 }', tostring(s))
    assert(e.samples{ t = t, M = M, period = 4 }(3.5) == -0.5)
    assert(e.samples{ t = { 0, 1, 2, 3, 4 }, M = { 0, 1, 0, -1, 0 }, interpolation = "cubic", period = 4 }(0.5) == 0.6875)
    -- A sweep carries it; a run writes it into its file, and the period is known to sys:steady.
    local map = sweep{ over = { x = { 0.5, 4.5 } }, run = function(p) return { y = s(p.x) } end }
    assert(map.y[1] == 0.6875 and map.y[2] == 0.6875)
    local sys = nondimensional{ zeta = 0.1 }
    assert(sys:steady{ M = s }.period == 4)
    has(sys:simulate{ M = s, t_end = 3, dt = 1 }.integrator, "exact")
    raises(function() return e.samples{ t = t, M = M, period = 2 } end, "period = 2 is shorter than the points")
    raises(function() return e.samples{ t = t, M = M, period = 3 } end, "M = 0 at t = 0, but -1 one period later")
end
for message, points in pairs{
    ["samples: t[3] = 0.3 is not after t[2] = 0.4; times must increase"] = { t = { 0, 0.4, 0.3 }, M = { 0, 0, 0 } },
    ["t has 2 values and M has 1"] = { t = { 0, 1 }, M = { 0 } },
    ["there are no points"] = { t = {}, M = {} },
    ["the name of a file or a table of points, got 3"] = 3,
} do
    raises(function() e.samples(points) end, message)
end
raises(function() return e.puls end, "there is no excitation.puls", "did you mean 'pulse'?")
raises(function() return step.valeu end, "an excitation has no field 'valeu'", "'value'")
raises(function() step.at = 3 end, "cannot be changed")
raises(function() return step("1") end, 'e:value(t): t must be a finite number, got the string "1"')

-- A function is called as its parameter list says.
local function arguments(...) return select("#", ...) end
local function called_with(f) return e.scripted(f)(5, 6, 7) end
assert(called_with(function() return 1 end) == 1)
assert(called_with(function(t) return t end) == 5)
assert(called_with(function(t, theta) return theta end) == 6)
assert(called_with(function(t, theta, velocity) return velocity end) == 7)
assert(called_with(arguments) == 3)
assert(called_with(math.sin) == math.sin(5))
assert(called_with(setmetatable({}, { __call = function(self, t) return t end })) == 5)
assert(called_with(setmetatable({ 10 }, { __call = function(self, t, theta) return self[1] + theta end })) == 16)
local generator = coroutine.wrap(function(t)
    while true do t = coroutine.yield(2 * t) end
end)
assert((step + generator)(4) == 9)
raises(function() return (step + function(t, theta, v) return v end):values{ 0, 1 } end, "needs theta and velocity")

-- Hints.
local hinted = e.scripted(function(t) return t % 3 < 2 and 1 or 0 end, { breaks = { 0, 2 }, period = 3 })
assert(hinted:next_break(0) == 2 and hinted:next_break(2) == 3 and hinted:delay(0.5):next_break(2.5) == 3.5)
raises(function() return e.scripted(double, { breaks = { 2, 1 } }) end, "breaks[2] = 1 is not after breaks[1] = 2")
raises(function() return e.scripted(double, { breaks = { 0, 4 }, period = 3 }) end, "span more than the period 3")
raises(function() return e.scripted(3) end, "excitation.scripted needs a function, got 3")

-- The first failure counts, and no function is called after it.
local calls = 0
local both = e.scripted(function(t) return t < 3 and 1 or nil end) + function(t)
    calls = calls + 1
    return t < 2 and 1 or error("late")
end
raises(function() return both:values{ 0, 1, 2, 3, 4 } end, "late")
assert(calls == 3)
assert(both(1) == 2, "and the next call starts afresh")

-- A function may call another excitation, or itself up to a depth, catch an error in there, and replace itself.
local inner = e.scripted(function(t) if t > 5 then error("too late", 0) end return t end)
local outer = e.scripted(function(t)
    local good, value = pcall(inner, t)
    return good and value or -1
end)
assert(outer:values{ 4, 6, 5 } == vector{ 4, -1, 5 })
local depth
depth = e.scripted(function(t) return t <= 0 and 0 or 1 + depth(t - 1) end)
assert(depth(20) == 20)
raises(function() return depth(1e6) end, "50 levels deep")
function Replaced(t) Replaced = nil return 3 end
local replacing = e.scripted(Replaced)
assert(replacing(1) == 3 and replacing(2) == 3 and Replaced == nil)

-- Functions are kept as long as they are needed, and no longer.
local weak = setmetatable({}, { __mode = "k" })
do
    local f = function(t) return t end
    weak[f] = true
    local kept = e.scripted(f):delay(1) + 1
    f = nil
    collectgarbage()
    assert(next(weak) and kept(3) == 3)
    kept = nil
end
collectgarbage()
collectgarbage()
assert(next(weak) == nil)

-- As text, which makes the same again.
local function rebuilt(M) return assert(load("return " .. tostring(M)))() end
local all = e.constant{ amplitude = 2 } - e.harmonic{ omega = 2.1, phase = 0.1 } / 3 + 0.5 * e.step{ at = 0.3 }
    + e.pulse{ at = 0.1, width = 0.7 } + e.half_sine{ width = 2 } - e.gaussian{ at = 2, sigma = 0.3 }:delay(0.1) - 2 * e.ramp{} + e.ramp{ duration = 3 }:window(1, math.huge)
    + e.square{ period = 0.3 }:delay(0.1) + e.sawtooth{ frequency = 3 }:window(0, 1) + e.triangle{ period = 0.7 }
    + e.chirp{ from = 0.1, to = 2, duration = 3 } + e.exponential{ tau = 0.7 } - e.polynomial{ coefficients = { 1, 0.1 } }
    + e.samples{ t = { 0, 0.1, 3 }, M = { 1, -1, 2 } } + function(t) return t * t end
    + e.scripted(math.sin, { breaks = { 0.5, 1 }, period = 2 }):delay(0.25)
local again = rebuilt(all)
local times = vector.linspace(-1, 5, 601)
assert(again:values(times) == all:values(times))
for _, at in ipairs{ -1, 0, 0.3, 0.8, 1, 2.5 } do assert(again:next_break(at) == all:next_break(at)) end
assert(tostring(-e.step{} - e.step{} * 2) ==
       "-excitation.step{ amplitude = 1, at = 0 } - 2 * excitation.step{ amplitude = 1, at = 0 }")
assert(tostring(e.scripted(math.sin)) == "excitation.scripted(math.sin)")
local many = vector.range(1, 20)
assert(tostring(e.samples{ t = many, M = many }) == "excitation.samples{ --[[ 20 points, t 1 ... 20 ]] }")

-- The text of a function is found in its file: behind strings and comments, whatever is named `function` there.
local long_one = e.scripted(function(t) -- "function(t) end"
    local text = [[ end function ]] if t > 1 then return #text end
    for i = 1, 3 do while t > i do t = t - 1 end end
    repeat local x <const> = 0xe until true
    return t
end)
local text = tostring(long_one)
assert(text:match('^excitation%.scripted%(function%(t%) %-%- "function') and text:match("return t\nend%)$"))
assert(rebuilt(long_one)(7) == 14 and rebuilt(long_one)(0.5) == 0.5)
local from_text = load("return function(t) return 4 * t end")()
assert(tostring(e.scripted(from_text)) == "excitation.scripted(function(t) return 4 * t end)")
local callable = setmetatable({}, { __call = function(_, t) return t end })
assert(tostring(e.scripted(callable)) == "excitation.scripted(--[[ a table with __call ]])")

-- Samples from a file.
local path = temporary()
write(path, "# a record\nmoment,M,t,other\n0,1,0,9\n1,3,2,8\n2,5,3,7\n")
assert(e.samples(path)(1) == 2, "columns t and M are found by name")
near(e.samples(path, { interpolation = "cubic" })(1), 5/3, 1e-14) -- three points are a parabola
assert(tostring(e.samples(path, { interpolation = "cubic", period = 100 })) ==
       ('excitation.samples("%s", { time = "t", value = "M", interpolation = "cubic", period = 100 })'):format(path))
do
    local again = e.samples(path, { interpolation = "cubic", period = 100 })
    assert(again(3) == 5 and again(103) == 5 and rebuilt(again)(101) == again(101))
end
assert(e.samples(path, { value = "other" })(1) == 8.5)
assert(e.samples(path, { time = "moment" })(0.5) == 2)
assert(e.samples(path, { time = 1, value = 4 })(0.5) == 8.5)
assert(e.samples(path, { time = "moment" }):next_break(0) == 1)
assert(tostring(2 * e.samples(path):delay(3)) ==
       ('2 * excitation.samples("%s", { time = "t", value = "M" }):delay(3)'):format(path))
assert(rebuilt(e.samples(path):delay(3))(4) == 2)
raises(function() return e.samples(path, { value = "mo" }) end, path, "no column 'mo'", "moment")
raises(function() return e.samples(path, { value = 7 }) end, path, "column 7")
raises(function() return e.samples(path, { value = {} }) end, "value must be the name or the number of a column, got a table")
write(path, "0 1\n1 3\n2 5\n")
assert(e.samples(path)(0.5) == 2, "without names, the first two columns")
for text, pieces in pairs{
    ["a,b\n0,1\n2,3\n1,5\n"] = { "row 3", "a = 1", "not after 2", "times must increase" },
    ["a,b\n0,1\n2,x\n"] = { ":3:", "column 2" },
    ["a\n0\n2\n"] = { "only one column" },
    ["a,b\n"] = { "no rows" },
    [""] = { "empty" },
} do
    write(path, text)
    raises(function() e.samples(path) end, path, table.unpack(pieces))
end
os.remove(path)
raises(function() return e.samples(path) end, path)
