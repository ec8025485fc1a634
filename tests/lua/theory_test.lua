-- theory.*: numbers and vectors in, the same shape out; the numbers themselves are tested in tests/core.
dofile "tests/lua/support.lua"

local nd = nondimensional { zeta = 0.119, friction_ratio = 0.06 }

--- Arguments with which each function works, all of them numbers.
local calls = {
    free_response = { system = nd, theta0 = 1, velocity0 = 0, t = 0.3 },
    time_to_rest = { system = nd, theta0 = 1, velocity0 = 0.5 },
    rest_position = { system = nd, theta0 = 1, velocity0 = 0.5 },
    logarithmic_decrement = { zeta = 0.1 },
    identify = { X0 = 1, X1 = -0.7, X2 = 0.45 },
    magnification = { r = 0.5, zeta = 0.1 },
    phase_lag = { r = 0.5, zeta = 0.1 },
    linearised = { r = 0.5, friction_ratio = 0.1, zeta = 0.05 },
    den_hartog = { r = 0.75, friction_ratio = 0.2, zeta = 0.1, breakaway_ratio = 0.25 },
    den_hartog_fundamental = { r = 0.75, friction_ratio = 0.2, zeta = 0.1, breakaway_ratio = 0.25 },
    stop_boundary = { r = 0.75, zeta = 0.1, Re_over_Rd = 1.25 },
    step_limit = { system = nd },
}
local two_results = { free_response = true, identify = true, linearised = true, den_hartog = true,
    den_hartog_fundamental = true }

test("theory is in the table dinal and a global, and all of its functions are tested here", function()
    equal(theory, dinal.theory)
    for name in pairs(theory) do
        assert(calls[name] or name == "extremes", name)
    end
end)

test("numbers give numbers, and a vector or a table in any option gives vectors of the same numbers", function()
    for name, arguments in pairs(calls) do
        local wanted = table.pack(theory[name](arguments))
        equal(wanted.n, two_results[name] and 2 or 1, name)
        for i = 1, wanted.n do equal(math.type(wanted[i]), "float", name) end
        for option, value in pairs(arguments) do
            -- values so near to each other that they are good for every function
            local values = type(value) == "number" and { value, 1.01 * value, 0.99 * value } or {}
            local many = { vector(values), values }
            for k, one in ipairs(values) do
                wanted = table.pack(theory[name](merged(arguments, { [option] = one })))
                for j = 1, 2 do
                    local found = table.pack(theory[name](merged(arguments, { [option] = many[j] })))
                    equal(found.n, wanted.n, name)
                    for i = 1, wanted.n do equal(found[i][k], wanted[i], name .. " with many " .. option) end
                end
            end
        end
    end
end)

test("where a closed form does not hold the result is nil, and nan in a vector", function()
    equal(theory.den_hartog { r = 2, friction_ratio = 0.6 }, nil)
    equal(select("#", theory.den_hartog { r = 2, friction_ratio = 0.6 }), 2)
    local A, lag = theory.den_hartog { r = { 2, 2 }, friction_ratio = { 0.5, 0.6 } }
    near(A[1], 0.220479276, 0.51e-9)
    assert(A[2] ~= A[2] and lag[2] ~= lag[2])
    assert(theory.den_hartog { r = 2, friction_ratio = 0.57 })
    equal(theory.den_hartog { r = 2, friction_ratio = 0.57, breakaway_ratio = 1.25 * 0.57 }, nil)
    equal(theory.linearised { r = 0.5, friction_ratio = 0.8 }, nil)
    equal(theory.identify { X0 = 1, X1 = 1.2, X2 = 0.5 }, nil)
    equal(theory.rest_position { system = nondimensional {}, theta0 = 1 }, nil)
    equal(theory.time_to_rest { system = nondimensional {}, theta0 = 1 }, math.huge)
end)

test("a nan in a vector stays in its place", function()
    local A = theory.den_hartog { r = { 0.5, 0.9, 1.3 }, friction_ratio = 0.4 }
    assert(A[1] ~= A[1])
    local phi = theory.magnification { r = A }
    assert(phi[1] ~= phi[1])
    near(phi[2], 1 / math.abs(1 - A[2] ^ 2), 1e-12)
end)

test("a free response is known before t = 0 as well", function()
    local theta, velocity = theory.free_response { system = system { I = 1, k = 4 }, theta0 = 1, t = { -0.5, 0, 1 } }
    near(theta[3], math.cos(2), 1e-15)
    near(velocity[1], 2 * math.sin(1), 1e-15)
    near(theory.free_response { system = system { I = 1, k = 4, C = 4 }, theta0 = 1, t = 1 }, 3 * math.exp(-2), 1e-15)
end)

test("extremes end at rest or at count, which is required otherwise", function()
    local sys = nondimensional { friction_ratio = 0.1 }
    equal(#theory.extremes { system = sys, theta0 = 0.55, count = 2 }, 2)
    equal(#theory.extremes { system = nondimensional {}, theta0 = 1, count = 5 }, 5)
    equal(#theory.extremes { system = sys, theta0 = 0.55, count = 9 }, #theory.extremes { system = sys, theta0 = 0.55 })
    refuses(theory.extremes, {
        { { system = nondimensional {}, theta0 = 1 }, "theory.extremes: count is needed, because this motion never comes to rest" },
        { { system = nondimensional { friction_ratio = 1e-12 }, theta0 = 1 }, "count is needed, because there are 5e+11 extremes until rest" },
        { { theta0 = 1 }, "theory.extremes needs system, for example" },
    })
end)

test("wrong values are refused with the option, the element and the limit", function()
    refuses(theory.magnification, {
        { { r = { 1, 2, -3 } }, "theory.magnification: r[3] = -3 must not be" },
        { { r = vector { 1, 2 }, zeta = { 1, 2, 3 } }, "r and zeta have 2 and 3 numbers; they must be equally long" },
        { { r = "1" }, 'r must be a finite number or a vector, got the string "1"' },
        { { r = { 1, "2" } }, 'r[2] must be a finite number, got the string "2"' },
        { {}, "theory.magnification needs r, for example" },
    })
    refuses(theory.free_response, {
        { { t = 1, theta0 = 1 }, "theory.free_response needs system, for example" },
        { { t = { 1, -1 }, system = nd, theta0 = 1 }, "t[2] = -1 must not be negative" },
        { { t = 1, system = nd:with { walls = { upper = 2 } } }, "the closed forms do not include walls" },
        { { t = 1, system = nd:with { spring = spring.polynomial { [3] = 1 } } }, "include only the spring k theta" },
        { { t = 1, system = nd:with { friction = friction.stribeck { Rd = 1, Re = 2, speed = 1 } } }, "include only Coulomb friction" },
    })
    refuses(theory.logarithmic_decrement, {
        { { zeta = 1.2 }, "zeta = 1.2 must be from 0 to less than 1" },
    })
    raises_here(function() theory.den_hartog { r = 0.5, friction_ratio = 0.3, breakaway_ratio = { 0.4, 0.2 } } end,
        "breakaway_ratio[2] = 0.2 must be at least friction_ratio = 0.3")
    raises_here(function() theory.den_hartog { r = 1e-5, friction_ratio = 0.3 } end, "r = 1e-05 must be 0 or from 0.0001 to 1e6")
    raises_here(function() theory.identify { X0 = 0, X1 = 0, X2 = 0 } end, "X0 = 0 must not be zero")
end)

finish()
