-- Vectors at their edges: empty, wrong, large. The examples of the manual, which help_test.lua runs, have the plain values.

dofile "tests/lua/support.lua"

-- The line of the caller.
local function line() return debug.getinfo(2, "l").currentline end

local v = vector{ 1, 2, 4 }

-- Elements are counted from 1, and beyond the end is nil, as in a table.
assert(#v == 3 and v[1] == 1 and v[3] == 4)
assert(v[0] == nil and v[4] == nil and v[1.5] == nil)
assert(math.type(v[1]) == "float")
raises(function() return v[-1] end, "vector_test.lua:" .. line() .. ": ", "v[-1]", "v[#v]")
refused {
    { "v.maxx", "a vector has no field 'maxx'", "did you mean 'max'?" },
    { "v[1] = 3", "cannot be changed" },
}
local seen = {}
for i, x in ipairs(v) do seen[i] = x end
assert(#seen == 3 and seen[2] == 2)

-- What is copied from a table stays when the table changes.
local t = { 5, 6 }
local w = vector(t)
t[1] = 0
assert(w[1] == 5)
assert(vector(w) == w and #vector{} == 0)

refuses(vector, {
    { { 1, "2" }, 'vector[2] must be a finite number, got the string "2"' },
    { { 1, 2, -(0/0) }, "vector[3] = nan must be finite" },  -- whatever its sign
    { 3, "vector{ 1, 2, 3 }" },
    { { [2] = 1 }, "vector must be a list such as { 1, 2, 3 }, but it has [2]" },
    { { 1, x = 2, ["a b"] = 3 }, 'it has [the string "a b"]' },
})
refused { { "vector.linspce", "did you mean 'linspace'?" } }

-- Arithmetic goes element by element, with a number or an equally long vector on either side.
assert(1 + v == v + 1 and v - vector{ 1, 1, 1 } == vector{ 0, 1, 3 })
assert(v * v == v ^ 2 and 2 ^ v == vector{ 2, 4, 16 } and 4 / v == vector{ 4, 2, 1 })
assert(v[1] == 1, "the operands stay as they are")
refused {
    { "v + vector{ 1, 2 }", "v + w have 3 and 2 numbers" },
    { 'v * "2"', 'a vector * the string "2"', "a number or a vector" },
    { "{} + v", "a table" },
}

-- A comparison is true when it holds for every element.
assert(v > 0 and v >= 1 and v < 5 and v <= 4)
assert(not (v > 1) and not (v < 4))
assert(v < v + 1 and not (v < v) and v <= v)
assert(vector{} < 0, "there is no element for which it does not hold")
assert(v == vector{ 1, 2, 4 } and v ~= vector{ 1, 2, 5 } and v ~= vector{ 1, 2 })

-- Mathematics on all elements.
local root = vector{ -1 }:sqrt()[1]
assert(root ~= root)

-- One number out of many.
assert(vector{}:sum() == 0)
refused {
    { "vector{}:max()", "v:max(): the vector is empty" },
    { "v.max()", "use a colon: v:max()" },
}
assert((0.1 + 0 * vector.range(1, 100000)):sum() == 10000, "a plain loop is off by 2e-8")

-- Pieces.
assert(v:slice(2) == vector{ 2, 4 })
assert(#v:slice(3, 2) == 0 and v:slice(1, 3, math.maxinteger) == vector{ 1 } and #vector{}:slice() == 0)
refuses(function(first) v:slice(first, 4) end, { { 1, "elements 1 to 3" }, { 0, "elements 1 to 3" }, { 1.5, "first must be a whole number, got 1.5" } })

-- Even spacing, with exact ends.
local line = vector.linspace(-0.1, 0.7, 81)
assert(#line == 81 and line[1] == -0.1 and line[81] == 0.7 and math.abs(line[41] - 0.3) < 1e-15)
-- Round numbers are exact, equal ends a constant, and the greatest numbers no overflow.
assert(vector.linspace(1, 1000, 1000) == vector.range(1, 1000) and vector.linspace(-1, 1, 21) == vector.range(-10, 10) / 10)
assert(vector.linspace(0.1, 0.1, 8) == 0.1 + 0 * vector.range(1, 8))
assert(vector.linspace(-1e308, 1e308, 5)[3] == 0)
refuses(function(n) vector.linspace(0, 1, n) end, { { 1, "n = 1 must be a whole number" }, { 2.5, "n = 2.5 must be a whole number" } })
refused { { "vector.linspace(0, 1 / 0, 5)", "to must be a finite number, got inf" } }

-- As text.
assert(tostring(vector{}) == "vector{}")

-- The collector knows how long a vector is: 150 times 8 MB pass through a process that never holds them all.
local function resident()
    local file = io.open("/proc/self/statm")
    if not file then return 0 end
    local pages = file:read("a"):match("%d+ (%d+)")
    file:close()
    return tonumber(pages) * 4096
end
local long = vector.linspace(0, 1, 1000000)
local before = resident()
for _ = 1, 150 do local _ = long * 2 end
assert(resident() - before < 6e8, "less than half of what was made")

-- An operator reached by debug.getmetatable, with no vector on either side.
refused { { "debug.getmetatable(vector{ 1 }).__lt(1, 2)", "needs a vector on one side" } }

-- Looking for something, putting together, adding up.
local x = vector{ 3, -1, 2, 3 }
assert(x:map(function(e, i) return e * i end) == vector{ 3, -2, 6, 12 })
assert(x:map(function(e) return e > 0 end) == vector{ 1, 0, 1, 1 })
assert(x:find(function(e) return e == 3 end) == vector{ 1, 4 } and #x:find(function() end) == 0)
assert(math.abs(vector{ 2, 4, 4, 4, 5, 5, 7, 9 }:std() - math.sqrt(32 / 7)) < 1e-15)
assert(math.abs(vector{ 1e9 + 1, 1e9 + 2, 1e9 + 3 }:std() - 1) < 1e-12, "no difference of large sums")
assert(vector{ 1e100, 1, -1e100 }:cumsum()[3] == 1 and #vector{}:diff() == 0)
assert(vector{ -1, 5 }:interp(vector{ 0, 1, 2 }, vector{ 0, 4, 6 }) == vector{ 0, 6 })
assert(0 .. x == vector{ 0, 3, -1, 2, 3 })
assert(x[x:map(function(e) return e == 3 end)] == vector{ 3, 3 } and x[vector{ 4, 4, 2 }] == vector{ 3, 3, -1 })
assert(vector{ 1e100, 1, -1e100 }:dot(vector{ 1, 1, 1 }) == 1)
assert(x:atan()[2] == math.atan(-1) and x:atan(-2)[2] == math.atan(-1, -2))

refused {
    { "x:map(3)", "f must be a function, got 3" },
    { 'x:map(function() return "a" end)', "must return a number, true or false", 'the string "a"' },
    { "vector{ 1 }:std()", "two numbers are needed" },
    { "vector{}:argmax()", "the vector is empty" },
    { "x:interp(vector{ 0, 0 }, vector{ 1, 2 })", "x[2] = 0 is not after x[1] = 0" },
    { "x:interp(vector{ 0, 1 }, vector{ 1 })", "2 and 1 numbers" },
    { "x:dot(vector{ 1 })", "4 and 1 numbers" },
    { "x:dot(3)", "w must be a vector, got 3" },
    { 'x .. "a"', "tostring(v)" },
    { "x[vector{ 5 }]", "w[1] = 5 is not an index" },
    { "vector.logspace(0, 1, 3)", "must be positive" },
}

-- Random numbers: the same for the same seed, on every machine (the first are written down), and of the right kind.
local u, n = vector.random{ n = 20000, seed = 7 }, vector.normal{ n = 20000, seed = 7, mean = 1, std = 2 }
assert(u == vector.random{ n = 20000, seed = 7 } and u ~= vector.random{ n = 20000, seed = 8 })
-- mt19937_64 with its standard seed begins with 14514284786278117030.
assert(vector.random{ n = 1, seed = 5489 }[1] == (0xc96d191cf6f6aea6 >> 11) * 2.0^-53)
assert(u:min() >= 0 and u:max() < 1)
-- Five standard errors: 1/sqrt(12 n) of a mean, std/sqrt(n), std/sqrt(2 n).
assert(math.abs(u:mean() - 0.5) < 5 / math.sqrt(12 * 20000))
assert(math.abs(n:mean() - 1) < 5 * 2 / math.sqrt(20000) and math.abs(n:std() - 2) < 5 * 2 / math.sqrt(40000))
-- Neighbours have nothing to do with each other: they are made in pairs.
local together = 0
for i = 2, #n do together = together + (n[i] - 1) * (n[i - 1] - 1) / 4 end
assert(math.abs(together) < 5 * math.sqrt(20000), together)
refused {
    { "vector.random{ n = 2, seed = 1, from = 0, to = -1 }", "from = 0 must not be greater than to = -1" },
    { "vector.random{ n = 2, seed = 1, from = 3 }", "from = 3 must not be greater than to = 1" },
}

refused { { "nondimensional{}:simulate{ theta0 = 1, times = { 1, from = 2 } }", "times must be a list", "it has from" } }

-- Quantiles lie between the sorted elements, and ranges have their ends.
do
    local v = vector{ 5, 1, 4, 2, 3 }
    for p, wanted in pairs{ [0] = 1, [0.9] = 4.6 } do near(v:quantile(p), wanted, 1e-14) end
    near(vector{ 7 }:quantile(0.3), 7, 0)
    refuses(function(p) v:quantile(p) end, { { 1.5, "p = 1.5 must lie between 0 and 1" }, { "x", "v:quantile(p): p" } })
    refused { { "vector{}:quantile(0.5)", "the vector is empty" } }
    local hole = vector{ 1, -1, 2 }:sqrt()
    assert(hole:max() ~= hole:max() and hole:min() ~= hole:min() and hole:argmax() == 3 and (vector{ 0, 1, 2 } / vector{ 0, 1, 2 }):argmin() == 2)
    for i, x in ipairs(vector.range(1, 1000):table()) do assert(x == i) end
    assert(#vector.range(0, 0.3, 0.1) == 4 and #vector.range(0, 0.3 - 1e-8, 0.1) == 3)
    assert(vector.range(3, 1, -1) == vector{ 3, 2, 1 } and #vector.range(2, 2) == 1)
    refuses(function(step) vector.range(1, 2, step) end, { { -1, "step = -1 does not lead from 1 to 2" }, { 0, "step = 0 does not lead" } })
    refused { { "vector.range(0, 1e12)", "numbers are more than" } }
end

test("v[v > 0] selects the elements for which a comparison holds", function()
  local v, w = vector{ -1, 2, 3, -7 }, vector{ 4, 5, 6, 7 }
  local function same(picked, ...) equal(tostring(picked), tostring(vector{ ... })) end
  same(v[v > 0], 2, 3)
  same(v[v <= 2], -1, 2, -7)
  same(w[v > 0], 5, 6)
  same(w[0 < v], 5, 6)
  same(w[w >= 4], 4, 5, 6, 7)
  same(w[not (w >= 5)], 4)
  same(v[v < w], -1, 2, 3, -7)
  equal(#w[w > 9], 0)
  for i = 4, 7 do equal(#w[w > i], 7 - i) end
  local function refused(code, piece)
    raises(function() load("local v, w = ... return " .. code)(v, w) end, piece)
  end
  local message = "takes one comparison (< <= > >=) with as many elements as v, written in the brackets"
  refused("w[v > 0 and v < 3]", "and or or is not possible there")
  refused("w[v > 0 or v < -3]", "and or or is not possible there")
  refused("w[v == 2]", message)
  refused("w[true]", message)
  refused("w[vector{ 1 } > 0]", message)
  raises(function()
    local positive = v > 0
    return w[positive]
  end, message)
  -- Lua 5.4.4 would index another value than w here
  refused { { "w[v > 0]", "w belongs to an outer function: write local own = w before" } }
  same(load "local w = ... return w[w > 5]" (w), 6, 7)
end)

finish()
