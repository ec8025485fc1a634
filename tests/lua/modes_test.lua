-- sys:modes{ ... }: eigenvalues beside rests and even slidings, against closed forms. Run by dinal.
dofile "tests/lua/support.lua"

local function near(found, wanted, what)
    assert(math.abs(found - wanted) <= 1e-9 * math.max(1, math.abs(wanted)), ("%s: %.12g, not %.12g"):format(what or "", found, wanted))
end

--- The imaginary and real parts, as they are listed.
local function values(modes, ...)
    local wanted = { ... }
    equal(#modes, #wanted / 2)
    for i, m in ipairs(modes) do
        near(m.re, wanted[2 * i - 1], "re of " .. i)
        near(m.im, wanted[2 * i], "im of " .. i)
    end
end

test("one body: damped, overdamped, sliding block, and held by friction", function()
    local m = system { I = 2, k = 8, C = 0.8 }:modes()
    values(m, -0.2, math.sqrt(4 - 0.04))
    near(m[1].zeta, 0.1)
    near(m[1].frequency, math.sqrt(4 - 0.04) / (2 * math.pi))
    near(m[1].shape[1].re, 1)
    values(system { I = 1, k = 1, C = 2.5 }:modes(), -0.5, 0, -2, 0)
    equal(#system { I = 1, k = 1, Rd = 1 }:modes { theta0 = 0.3 }, 0)
    values(system { I = 1, k = 1, spring = spring.polynomial { [3] = 1 } }:modes { M = 2 }, 0, 2) -- theta + theta^3 = 2, slope 4
end)

test("two bodies and a link have the modes of their matrices, and shapes", function()
    local rig = system { bodies = { a = { I = 1, k = 3 }, b = { I = 1, k = 3 } }, links = { rod = { "a", "b", k = 3 } } }
    local m = rig:modes()
    values(m, 0, math.sqrt(3), 0, 3)
    near(m[1].shape.a.re / m[1].shape.b.re, 1)
    near(m[2].shape.a.re / m[2].shape.b.re, -1)
    -- A free pair: one mode of the link, and two of turning on.
    m = system { bodies = { a = { I = 1 }, b = { I = 3 } }, links = { rod = { "a", "b", k = 3 } } }:modes()
    near(m[#m].im, 2)
    for i = 1, #m - 1 do assert(math.abs(m[i].re) < 1e-6 and m[i].im < 1e-6) end
end)

test("contacts that hold are rigid, those on a belt have the slope of their law", function()
    local rig = system { bodies = { a = { I = 1, k = 8 }, b = { I = 1 } }, links = { clutch = { "a", "b", Rd = 100 } } }
    local m = rig:modes()
    near(m[#m].im, 2)
    local C, k, v, Rd, Re, speed = 0.1, 1, 0.6, 0.5, 1, 0.3
    local function beside(at)
        return system { I = 1, k = k, C = C, friction = friction.stribeck { Rd = Rd, Re = Re, speed = speed } }:modes { belt = at }
    end
    local slope = -(Re - Rd) * 2 * v / speed ^ 2 * math.exp(-(v / speed) ^ 2)
    local re = -(C + slope) / 2
    values(beside(v), re, math.sqrt(k - re * re))
    assert(beside(v)[1].zeta < 0 and beside(0.65)[1].zeta > 0)
    -- The Hopf point of the response is where the real part passes zero.
    local low, high = 0.55, 0.7
    for _ = 1, 40 do
        local middle = (low + high) / 2
        if beside(middle)[1].re > 0 then low = middle else high = middle end
    end
    assert(math.abs(low - 0.6168) < 5e-5, low)
end)

test("states and feedback take part; what depends on the time, or finds no rest, is told", function()
    -- theta'' = -z - 2 theta', z' = theta: lambda^3 + 2 lambda^2 + 1 = 0.
    local m = system { I = 1, k = 0 }:modes { M = function(t, theta, velocity, z) return -z.e - 2 * velocity end,
        states = { e = { start = 0, rate = function(t, theta) return theta end } } }
    equal(#m, 2)
    for _, one in ipairs(m) do
        local re, im = one.re, one.im
        near(re ^ 3 - 3 * re * im ^ 2 + 2 * (re ^ 2 - im ^ 2) + 1, 0)
        near(3 * re ^ 2 * im - im ^ 3 + 4 * re * im, 0)
    end
    raises_here(function() system { I = 1, k = 1 }:modes { M = function(t) return t end } end, "sys:modes: M, belt and base must not depend on the time")
    raises_here(function() system { I = 1, k = 0 }:modes { M = 1 } end, "no rest and no even sliding was found")
end)

finish()
