-- Maps of columns and bifurcation diagrams: pictures, and refused input.
dofile "tests/lua/support.lua"

local map = sweep { over = { x = vector.linspace(0, 1, 11), y = vector.linspace(0, 2, 9) }, run = function(p)
    return { steps = math.floor(p.x + p.y), slope = p.x + p.y }
end }

test("a map shows digits if z has only a few whole numbers", function()
    local text = tostring(map:plot { z = "steps", show = false, width = 40, height = 12 })
    has(text, "steps:   0   1   2   3")
    local lines = {}
    for line in text:gmatch("[^\n]+") do lines[#lines + 1] = line end
    assert(lines[2]:find("[│┤]2+3") or lines[2]:find("2+3"), lines[2])
    has(lines[#lines - 2], "0000")
end)

test("a map shows shades of other values, in ASCII too", function()
    local text = tostring(map:plot { z = "slope", show = false })
    has(text, "█", "·", "slope:")
    local plain = tostring(map:plot { z = "slope", show = false, ascii = true })
    assert(not plain:find("[\128-\255]"), plain)
    has(plain, "###")
end)

test("points over two parameters are a map, or a curve for each value of the first", function()
    local function text(options) options.show = false return tostring(map:plot(options)) end
    local result = "slope" -- which comes first is for sweep to say, by the alphabet
    equal(text{}, text{ x = "x", y = "y", z = result })
    equal(text{ z = "steps" }, text{ x = "x", y = "y", z = "steps" })
    equal(tostring(map:sort(result):plot{ show = false }), text{})
    -- A line from the end of one curve to the beginning of the next would cross the corner below the diagonal of the last.
    local family = sweep{ over = { a = { 1, 2 }, b = vector.linspace(0, 1, 30) }, run = function(p) return { v = p.a * 10 + p.b * 0 } end }
    local lines, rows = tostring(family:plot{ y = "v", show = false, ascii = true }), 0
    for line in lines:gmatch("[^\n]+") do
        if line:find("|.*[^%s|+-]") or line:find("%+.*[^%s|+%d-]") then rows = rows + 1 end
    end
    assert(rows <= 3, lines) -- two straight lines lie on two rows
    -- Of one value of a parameter it is a curve over the other.
    local one = family:filter(function(p) return p.a == 2 end)
    equal(tostring(one:plot{ show = false }), tostring(data{ b = one.b, v = one.v }:plot{ x = "b", y = "v", show = false }))
    local three = sweep{ over = { a = { 1, 2 }, b = { 1, 2 }, c = { 1, 2 } }, run = function(p) return { v = p.a } end }
    refused { { "three:plot{ show = false }", "points over a, b, c are not a map" } }
    has(three:filter(function(p) return p.a == 1 end):plot{ show = false }, "v:")
end)

test("on logarithmic axes a map omits values that are not positive", function()
    local with = sweep { over = { x = { -1, 0, 1, 10 }, y = { 0, 1, 2 } }, run = function(p) return { z = p.x + p.y } end }
    local without = with:filter(function(p) return p.x > 0 and p.y > 0 end)
    local function text(d) return tostring(d:plot { z = "z", xlog = true, ylog = true, show = false }) end
    equal(text(with), text(without))
    refused { { 'data { x = { 0, 0 }, y = { 1, 2 }, z = { 1, 2 } }:plot { z = "z", xlog = true, show = false }', "0 different values of x" } }
end)

test("a map goes into files with a legend, and an SVG of a fine one stays small", function()
    local fine = sweep { over = { x = vector.linspace(0.1, 2, 150), y = vector.linspace(0, 1, 120) }, run = function(p)
        return { z = math.sin(9 * p.x) * math.cos(7 * p.y) }
    end }
    local file = temporary ".svg"
    fine:plot { z = "z", file = file }
    local svg = read(file)
    assert(#svg < 300000, #svg)
    assert(svg:find "rgb%(99%.2%d*%%, ?90%.5%d*%%, ?14%.5%d*%%%)", "the bright end of the colours is there")
    has(svg, "<image")
end)

test("data that are not a grid are refused", function()
    local d = data { x = { 1, 2, 2 }, y = { 1, 1, 1 }, z = { 1, 2, 3 } }
    refused { { 'd:plot { x = "x", y = "y", z = "z" }', "two rows with x = 2, y = 1" } }
    local v = vector.linspace(0, 1, 100)
    refused {
        { 'data { x = v, y = v, z = v }:plot { x = "x", y = "y", z = "z" }', "x and y form no grid" },
        { "d:plot { zlim = { 0, 1 } }", "zlim is for maps" },
    }
    refuses(function(o) map:plot(o) end, {
        { { z = "steep" }, "no column 'steep'" },
        { { z = "error" }, "holds words" },
        { { z = "steps", zlim = { 1, 0 } }, "zlim must be two increasing numbers" },
        { { z = "steps", y = { "x", "y" } }, "y must be one column" },
    })
end)

test("maps of one row, one column or without finite values can be drawn", function()
    local function text(d) return tostring(d:plot { x = "x", y = "y", z = "z", show = false }) end
    text(data { x = { 1, 2 }, y = { 1, 1 }, z = { 1, 2 } })
    text(data { x = { 0 }, y = { 1 }, z = { 5 } })
    text(data { x = { 1, 2 }, y = { 1, 2 }, z = { 1 / 0, -1 / 0 } })
end)

-- ---- bifurcation

test("a linear oscillator settles to one point a period, of the size that theory predicts", function()
    local zeta, f = 0.2, 1.3
    local b = bifurcation { over = { a = { 0.5, 1, 2 } }, period = 1 / f, skip = 60, keep = 5, at = function(p)
        return { system = nondimensional { zeta = zeta }, M = excitation.harmonic { amplitude = p.a, frequency = f } }
    end }
    equal(table.concat(b.names, " "), "a theta velocity error")
    equal(#b, 15)
    -- M = a k sin(2 pi f t), with k = omega0^2 = (2 pi)^2 and I = 1: theta = a V sin(2 pi f t - lag), at whole periods.
    local lag = theory.phase_lag { r = f, zeta = zeta }
    local scale = theory.magnification { r = f, zeta = zeta } / nondimensional { zeta = zeta }.k
    for i, row in ipairs(b) do
        equal(row.a, ({ 0.5, 1, 2 })[(i - 1) // 5 + 1])
        -- What is left of the start: exp(-2 pi zeta 60/1.3) = 6e-26; the rest is the integrator's.
        near(row.theta, -row.a * scale * math.sin(lag), 1e-9)
        near(row.velocity, row.a * scale * 2 * math.pi * f * math.cos(lag), 1e-8)
    end
end)

test("its plot shows points", function()
    local b = bifurcation { over = { a = vector.linspace(1, 2, 30) }, period = 1, skip = 2, keep = 3, at = function(p)
        return { system = nondimensional { zeta = 0.1 }, M = excitation.harmonic { amplitude = p.a, frequency = 1.3 } }
    end }
    local text = tostring(b:plot { show = false, ascii = true })
    has(text, "theta", "a")
    local file = temporary ".svg"
    b:plot { file = file }
    has(read(file), "90 points")
end)

test("the file of a bifurcation with other samples is refused", function()
    local options = { over = { a = { 1, 2 } }, period = 1, skip = 1, keep = 2, file = temporary ".csv", at = function(p)
        return { system = nondimensional { zeta = 0.1 }, M = excitation.harmonic { amplitude = p.a, frequency = 1 } }
    end }
    equal(tostring(bifurcation(options)), tostring(bifurcation(options)))
    for name, other in pairs { period = 2, skip = 2, keep = 3 } do
        refused { { "bifurcation(merged(options, { [name] = other }))", "is not the result of this sweep" } }
    end
end)

test("points of a bifurcation that fail still have a row", function()
    local b = bifurcation { over = { a = { 1, 2, 3, 4 } }, period = 1, skip = 3, keep = 2, workers = 2, at = function(p)
        if p.a == 2 then error("not this one", 0) end
        if p.a == 3 then return { system = nondimensional {}, M = "x" } end
        return { system = nondimensional { friction_ratio = 0.1 }, M = excitation.harmonic { amplitude = p.a, frequency = 1.3 } }
    end }
    equal(#b, 6)
    equal(b.error[3], "not this one")
    has(b.error[4], "M must be a function, a number or an excitation")
end)

test("a bifurcation in a file has the same rows, and the same call reads them", function()
    local file = temporary ".csv"
    local function diagram(keep)
        return bifurcation { over = { a = { 1, 2, 3 } }, period = 1, skip = 3, keep = keep, file = file, workers = 1, at = function(p)
            if p.a == 2 then error("no two") end
            return { system = nondimensional { zeta = 0.2 }, M = excitation.harmonic { amplitude = p.a, frequency = 1 } }
        end }
    end
    local b = diagram(2)
    local kept = load(file)
    equal(#b, 5)
    assert(kept.theta[1] == b.theta[1] and kept.velocity[5] == b.velocity[5])
    has(kept.error[3], "no two")
    local again = diagram(2)
    equal(tostring(again), tostring(b))
    raises(function() diagram(3) end, "is not the result of this sweep")
    refused { { 'bifurcation { over = { a = { 1 } }, period = 1, file = "b.txt", at = print }', "must end in .csv" } }
end)

test("mistakes in a bifurcation are errors with a reason", function()
    local function at() return { system = nondimensional {}, M = 1 } end
    local function returns(more) return { over = { a = { 1 } }, period = 1, at = function() return more end } end
    refuses(bifurcation, {
        { { over = { a = { 1 } }, at = at }, "bifurcation needs period" },
        { { over = { a = { 1 } }, period = 1, keep = 0, at = at }, "keep = 0 must be" },
        { { period = 1, at = at }, "bifurcation needs over" },
        { { over = { theta = { 1 } }, period = 1, at = at }, "is a column of the result" },
        { { over = { a = { 1 } }, period = 1, run = at }, "bifurcation has no option 'run'" },
        { { a = { 1 }, period = 1, at = at }, "bifurcation has no option 'a'" },
        { returns(1), "at must return a table such as { system = sys, M = M }, got 1" },
        { returns { M = 1 }, "at must return a table with system = ..., got nil there" },
        { returns { system = nondimensional {}, omega = -1 }, "at returned omega = -1" },
        { returns { system = nondimensional {}, t_end = 5 }, "at returned t_end, which bifurcation sets itself" },
        { returns { system = nondimensional {}, dt = 0.1 }, "at returned dt, which bifurcation sets itself" },
        { returns { system = nondimensional {}, times = { 1 } }, "at returned times, which bifurcation sets itself" },
        { { over = { a = { 1 } }, period = 1, skip = 1, keep = 2, at = function()
            return { system = nondimensional {}, events = { { when = function(t) return t - 1.5 end, stop = true } } }
        end }, "a = 1 failed: the run ended before the last sample: stopped at" },
    })
end)

test("a bifurcation accepts the period of each point in any of its forms", function()
    for _, given in ipairs { { period = 0.5 }, { frequency = 2 }, { omega = 4 * math.pi } } do
        local b = bifurcation { over = { a = { 1 } }, skip = 0, keep = 1, at = function(p)
            return { system = nondimensional {}, theta0 = p.a, period = given.period, frequency = given.frequency, omega = given.omega }
        end }
        near(b.theta[1], -1, 1e-9) -- half a period of cos(2 pi t)
    end
end)

finish()
