-- plot, run:plot, run:phase_plot: pictures, results, and messages about wrong input.
dofile "tests/lua/support.lua"

local nd = nondimensional { friction_ratio = 0.1, breakaway_ratio = 0.12, units = { theta = "rad" } }
local run = nd:simulate { M = excitation.harmonic { frequency = 0.7 }, theta0 = 1, t_end = 5, dt = 0.01 }
local free = nd:simulate { theta0 = 1, t_end = 5, dt = 0.01 }
local line = { { 0, 1, 2 }, { 0, 1, 4 } }

local function vectors(options)
    return tostring(plot(merged({ show = false, width = 60, ascii = true }, options)))
end

test("great ticks with many equal digits are written out", function()
    local t = vector.linspace(1e6, 1e6 + 5, 6)
    has(tostring(plot{ { t, t:sin() }, show = false }), "1000000", "1000004")
    has(tostring(plot{ { 1e3*t, t:sin() }, show = false }), "1.000004e9")
end)

test("a motion at rest has a phase plane as high as it is wide", function()
    local rest = system{ I = 1, k = 4, Rd = 0.3 }:simulate{ theta0 = 0.05, t_end = 5 }
    local picture = tostring(rest:phase_plot{ show = false })
    has(picture, "0.05")
    assert(not picture:find("1.0", 1, true), picture)
end)

test("the plot of a driven run shows theta and M/k, of a free one only theta, and when it sticks", function()
    has(picture(run), "a theta", "b M/k", " t")
    has(picture(nd:simulate { M = excitation.harmonic { amplitude = 0.2, frequency = 0.3 }, theta0 = 1, t_end = 9, dt = 0.01 }),
        "b M/k", "stuck")
    has(picture(free), "theta, rad", "stuck", "=")
    has_not(picture(free), "M/k")
    has_not(picture(nondimensional {}:simulate { theta0 = 1, t_end = 1, dt = 0.1 }), "stuck")
end)

test("a straight motion between coarse rows is drawn as a line, and a motion between rows as it is", function()
    local function ramped(dt) return system { I = 1, k = 1, Rd = 9 }:simulate { M = excitation.ramp {}, t_end = 4, dt = dt } end
    equal(picture(ramped(4), { y = "friction" }), picture(ramped(0.01), { y = "friction" }))
    -- The phase plane is the same for motions that are alike in another time.
    local function struck(rate)
        local sys = system { I = 1, k = rate ^ 2, walls = { upper = 0.5, restitution = 0.6 } }
        return picture(sys:simulate { theta0 = -1, t_end = 8 / rate, dt = 8 / rate }, {}, "phase_plot")
    end
    equal(struck(4), struck(1))
    local x, y = vector.range(0, 9), vector { 3, 1, 4, 1, 5, 9, 2, 6, 5, 3 }
    local function area(options) return tostring(plot { merged({ x, y }, options), show = false, width = 60, ascii = true }) end
    equal(area { style = "fill", base = y }, area {})
end)

test("x and y choose columns by name or number, torques over k as in the record of 1989", function()
    has(picture(run, { x = "theta", y = "friction" }), "friction", "theta, rad")
    has(picture(run, { y = { "friction/k", "damping/k", "M/k", "velocity/omega0" } }), "a friction/k", "d theta'/omega0")
    has(picture(run, { x = 1, y = { 2, 4 } }), "theta, rad", "M")
    refuses(function(o) run:plot(o) end, {
        { { y = "frction" }, "frction", "did you mean 'friction'?" },
        { { y = "M/kk" }, "M/kk" },
        { { x = 9 }, "9" },
        { { y = {} }, "y must name a column" },
        { { x = { "t", "theta" } }, "x must be one column" },
    })
end)

test("the phase plane shows start, end and dead zone", function()
    has(picture(free, { height = 20 }, "phase_plot"), "theta'/omega0, rad", "o start", "@ end", "= dead zone")
    has_not(picture(nondimensional {}:simulate { theta0 = 1, t_end = 1, dt = 0.1 }, {}, "phase_plot"), "dead zone")
end)

--- What the picture says to those who do not see it.
local function description(draw)
    local file = temporary ".svg"
    draw(file)
    return io.open(file):read("a"):match "<desc>(.-)</desc>"
end

--- A run with rows that meet each swing at the same place, or nearly so.
local function with_rare_rows(options)
    return system { I = 1, k = 4*math.pi^2, C = 1.5, Rd = 16.5, Re = 18 }:simulate(merged(
        { M = function(t) return 30*math.sin(2*math.pi*t) end, theta0 = 1, t_end = 1003, dt = 1.003 }, options))
end

long_test("pictures of a run show its motion, even with few rows", function()
    local rare, close = with_rare_rows {}, with_rare_rows { dt = 0.01 }
    local function half_swings(run, what)
        return tonumber(description(function(file) run:plot { y = what, file = file } end):match "(%d+) half swings")
    end
    for _, what in ipairs { "theta", "velocity", "M" } do
        assert(half_swings(close, what) > 1900, what)
        near(half_swings(rare, what), half_swings(close, what), 3)
    end
    assert(half_swings(with_rare_rows { dense = false }, "theta") < 20) -- only the rows are known
    for _, options in ipairs { {}, { xlim = { 500, 502 } } } do
        for _, call in ipairs { "plot", "phase_plot" } do
            if call == "plot" or not options.xlim then
                local size = merged({ width = 60, height = 16 }, options)
                equal(picture(rare, size, call), picture(close, size, call))
            end
        end
    end
    equal(vectors { rare, width = 70 }, vectors { close, width = 70 })
    local pair = system { bodies = { a = { I = 1, k = 4*math.pi^2 }, b = { I = 1 } }, links = { rod = { "a", "b", k = 20 } } }
    local function of_pair(dt) return pair:simulate { theta0 = { a = 1 }, t_end = 1003, dt = dt } end
    equal(picture(of_pair(1.003), {}), picture(of_pair(0.01), {}))
    equal(picture(of_pair(1.003).a, {}), picture(of_pair(0.01).a, {}))
end)

test("a picture of a run shows its events as corners, and needs no rows", function()
    local ball = system { I = 1, k = 1, walls = { lower = -1, upper = 0.5, restitution = 0.5 } }
    local function drawn(options) return description(function(file)
        ball:simulate(merged({ theta0 = -0.9, t_end = 3 }, options)):plot { y = "velocity", file = file }
    end) end
    local top = drawn { dt = 0.001 }:match "up from [^.]*%.%d+ to [^.]*%.%d+"
    equal(drawn { dt = 1 }:match "up from [^.]*%.%d+ to [^.]*%.%d+", top)
    equal(drawn { times = {}, t_end = 3 }, drawn { dt = 1 })
end)

test("a picture of a run shows the M of the run, not what its function does now", function()
    local force = 1
    local run = system { I = 1, k = 1, Rd = 0.1 }:simulate { t_end = 9, dt = 0.1,
        M = unread(function(t) return force*math.sin(t) end) }
    for _, now in ipairs { 1, 2 } do
        force = now
        local top = description(function(file) run:plot { y = "M", file = file } end):match "Up: M, [^ ]+ to (%S+)%. "
        near(tonumber(top), 1.1, 0.01) -- with some air
    end
end)

test("the dead zone is drawn where the mass can rest, and not at all if it changes", function()
    local sys = system { I = 1, k = 2, Rd = 1, walls = { lower = -3, upper = 3.25 } }
    local function zone(options, other)
        options.t_end = 20
        local run = (other or sys):simulate(options)
        return description(function(file) run:phase_plot { file = file } end):match "Dead zone from ([-%d.]+ to [-%d.]*%d)"
    end
    equal(zone { theta0 = 1 }, "-0.5 to 0.5")
    equal(zone { M = 5 }, "2 to 3")
    equal(zone({ M = function() return 5 end }, system { I = 1, k = 2, Rd = 1 }), "2 to 3")
    equal(zone { base = -5 }, "2 to 3")
    equal(zone { M = 6, belt = 0 }, "2.5 to 3.25")
    local uneven = { forward = { Rd = 1 }, backward = { Rd = 0.5 } } -- the spring pulls forward where theta < 0
    equal(zone({ theta0 = 1 }, system { I = 1, k = 2, friction = friction.asymmetric(uneven) }), "-0.5 to 0.25")
    equal(zone { M = math.sin }, nil)
    equal(zone { M = excitation.pulse { amplitude = 5, at = 1, width = 1 } }, nil)
    equal(zone { base = math.sin }, nil)
    equal(zone { theta0 = 1, belt = 0.1 }, nil)
end)

test("a run that began stuck, and one that never moved, are drawn as stuck", function()
    local sys = system { I = 1, k = 1, Rd = 1, Re = 2 }
    has(picture(sys:simulate { M = function(t) return t end, t_end = 4, dt = 0.1 }), "stuck  =")
    local still = picture(sys:simulate { theta0 = 0.5, t_end = 4, dt = 0.1 })
    local bar = still:match "stuck  (=+)"
    assert(bar and #bar > 45, still) -- all along the axis of about 50 columns
end)

test("a phase plane without k shows the velocity, and has corners at a wall or a relay", function()
    local well = system { I = 1, k = 0, Rd = 0.01, spring = spring.polynomial { [1] = -1, [3] = 1 } }
    has(picture(well:simulate { theta0 = 1.2, t_end = 5, dt = 0.1 }, {}, "phase_plot"), "theta', rad/time")
    -- Rows far apart: only the impact knows that the mass was at the wall, with the velocity 1 before and -0.5 after it.
    local ball = system { I = 1, k = 1, walls = { upper = 0, restitution = 0.5 } }
    for _, dense in ipairs { true, false } do
        local run = ball:simulate { theta0 = -1, t_end = 3, dt = 1, dense = dense }
        local file = temporary ".svg"
        run:phase_plot { file = file, xlim = { -1, 1 }, ylim = { -1, 1 }, axes = false }
        local points, wall = {}, 0
        for x, y in read(file):match("rgb%(0%%, ?44[^>]*"):gmatch "[ML] ([%d.]+) ([%d.]+)" do
            points[#points + 1] = { x = tonumber(x), y = tonumber(y) }
            wall = math.max(wall, points[#points].x)
        end
        local unit, corner = wall - points[1].x, false -- the run starts at theta = -1, velocity = 0; the wall is at 0
        for i = 2, #points do
            local before, after = (points[1].y - points[i - 1].y) / unit, (points[1].y - points[i].y) / unit
            corner = corner or math.abs(before - 1) < 1e-3 and math.abs(after + 0.5) < 1e-3 and points[i - 1].x == wall
        end
        assert(corner, "the velocity does not jump at the wall")
    end
end)

test("a run from a file is drawn, too", function()
    local csv, dat = reloaded(run), reloaded(run, nil, ".dat")
    has(picture(csv), "theta, rad")
    has(picture(dat), "a theta", "b M/k")
    has(picture(dat, {}, "phase_plot"), "theta'/omega0, rad")
    refused { { "csv:phase_plot()", "needs omega0", "run:plot{ x = \"theta\", y = \"velocity\" }" } }
    local other = temporary ".csv"
    write(other, "time,acceleration\n0,1\n1,2.5\n")
    has(picture(load(other)), "acceleration", "time")
end)

test("a run may be a curve among others: its theta over t", function()
    local other = nd:simulate { theta0 = 0.5, t_end = 4, dt = 0.05 }
    has(vectors { run, { other, label = "half" }, title = "two" }, "two", "theta, rad", "half")
    has(vectors { nondimensional {}:with { units = { theta = "m", t = "s" } }:simulate { theta0 = 1, t_end = 1, dt = 0.1 } }, "theta, m", "t, s")
    has(vectors { run, ylabel = "angle" }, "angle")
    refused {
        { "plot { nd:simulate { theta0 = 1, t_end = 1, times = {}, dense = false } }", "plot: curve 1: the run has no rows to draw" },
        { 'plot { (reloaded(run, { columns = { "theta", "velocity" } })) }', "the run has no column 't'", "{ run.theta, run.velocity }" },
    }
end)

test("a run without rows and dense output says what to do", function()
    local none = nd:simulate { theta0 = 1, t_end = 1, times = {}, dense = false }
    refused { { "none:plot()", "run:plot: the run has no rows to draw", "dt" } }
end)

test("a window of an x other than t does not limit the time", function()
    local swing = nondimensional { zeta = 0.02 }:simulate { theta0 = 1, t_end = 3, dt = 0.01 }
    has(picture(swing, { x = "theta", y = "velocity", xlim = { -0.5, 0.4 } }), " 5 +", "-5 +")
end)

test("a plot has the options of DRAAR: window, divisions, axes or none", function()
    local drawn = picture(run, { xlim = { 1, 2 }, ylim = { -2, 2 }, xticks = 0.25, yticks = { -2, 0, 2 }, title = "window" })
    has(drawn, "window", "1.25", "1.75", "-2 +", " 2 +")
    has_not(drawn, "-1 +")
    local bare = picture(run, { axes = false, y = "theta" })
    has_not(bare, "|")
    has_not(bare, "+")
    has(picture(run, { xlabel = "time, s", ylabel = "angle" }), "time, s", "angle")
end)

test("curves are vectors or tables of numbers; nan and inf are gaps", function()
    has(vectors { line, title = "parabola", xlabel = "x", ylabel = "y" }, "parabola", "4 +")
    has(vectors { { vector { 0, 1 }, vector { 2, 3 }, label = "one" }, { { 0, 1 }, { 3, 0 / 0 }, label = "two" } }, "a one", "b two")
    local v = vector.linspace(-1, 1, 50)
    has(vectors { { v, v:sqrt() } }, "1.0 +")
    has(vectors { { { 0, 1, 2 }, { 1, math.huge, 3 } } }, "3.0 +")
    has(vectors { { {}, {} } }, "(no points)")
    has(vectors { { { 0 / 0 }, { 1 } } }, "(no points)")
end)

test("curves may be points, or fills to zero or to another edge", function()
    has(vectors { { { 0, 1, 2 }, { 0, 1, 4 }, style = "points" } }, "x")
    vectors { { { 0, 1, 2 }, { 0, 1, 4 }, style = "fill", base = { 1, 1, 1 }, colour = 3, dashes = "dashed" } }
end)

test("axes may be logarithmic", function()
    has(vectors { { { 1, 10, 100 }, { 1e-9, 1e-6, 1e-3 } }, xlog = true, ylog = true }, "10", "1e-9")
    has(vectors { { { 1, 10, 100 }, { 0, -1, 5 } }, ylog = true }, "5") -- what is not positive has no place
    refuses(plot, {
        { { line, xlog = true, xlim = { 0, 1 } }, "xlim", "must be positive" },
        { { line, xlog = true, xticks = 2 }, "xticks must be a list" },
        { { line, xlog = true, equal = true }, "equal = true needs linear axes" },
    })
end)

test("show = false returns a picture, which can be printed and combined with another one", function()
    local left = plot { line, title = "left", show = false, width = 60 }
    local right = run:phase_plot { title = "right", show = false }
    has(left, "left")
    local both = tostring(plot { left, right, width = 100, height = 20, show = false })
    assert(both:match "^[^\n]*left[^\n]*right", both)
    local narrow = tostring(plot { left, right, width = 60, height = 20, show = false })
    assert(narrow:match "left.-\n.*right" and not narrow:match "^[^\n]*left[^\n]*right", narrow)
    refused {
        { "plot { left, line }", "curves and pictures cannot be combined" },
        { "left.titel", "a picture has no field 'titel'" },
    }
end)

test("a picture outlives its run", function()
    local picture = nd:simulate { theta0 = 1, t_end = 5, dt = 0.001 }:plot { show = false }
    local before = tostring(picture)
    for _ = 1, 20 do
        collectgarbage()
        nd:simulate { theta0 = 2, t_end = 5, dt = 0.001 }
    end
    equal(tostring(picture), before)
end)

test("errors in curves name the curve's number", function()
    refused { { 'plot(run.t, { run.theta, "a" })', "plot takes one table of curves" } }
    refuses(plot, {
        { {}, "plot needs a curve" },
        { { run.t, run.theta }, "item 1 must be a curve { x, y }, a run or a picture, got a vector" },
        { { { 0, 1 }, { 0, 1 } }, "item 1 must be a curve { x, y }" },
        { { line, { { 1, 2 } } }, "plot: curve 2: y must be a vector or a table of numbers, got nil" },
        { { { { 1, 2 }, { 1 } } }, "plot: curve 1: x has 2 numbers, but y has 1" },
        { { { { 1, 2 }, { 1, "2" } } }, "plot: curve 1: y[2] must be a number, got the string \"2\"" },
        { { { { 1 }, { 1 }, lable = "x" } }, "plot: curve 1 has no option 'lable'", "did you mean 'label'?" },
        { { { { 1 }, { 1 }, { 1 } } }, "plot: curve 1 takes named options only", "{ x, y, label" },
        { { { { 1 }, { 1 }, dashes = "dahsed" } }, "did you mean 'dashed'?" },
        { { { { 1 }, { 1 }, base = { 0 } } }, "base is the second edge of a filled area" },
        { { { { 1 }, { 1 }, base = { 0, 1 }, style = "fill" } }, "but base has 2" },
        { { line, [5] = line }, "named options only" },
    })
    local many = {}
    for i = 1, 1001 do many[i] = line end
    refused { { "plot(many)", "1001 curves are too many, 1000 can be drawn" } }
end)

test("errors in options name their limits", function()
    refused {
        { 'run:plot("x.svg")', "named options" },
        { "run.plot()", "use a colon: run:plot()" },
    }
    refuses(function(o) run:plot(o) end, {
        { { xlim = { 1, 0 } }, "xlim must be two increasing numbers" },
        { { xlim = { 1, 1 + 1e-15 } }, "xlim", "1e-13" },
        { { ylim = { -1e308, 1e308 } }, "ylim", "1e300" },
        { { xticks = 1e-9 }, "xticks makes 5e+09 ticks", "more than 200" },
        { { size = { 8, 6 } }, "size is for files" },
        { { file = "x.svg", size = { 1, 6 } }, "size must be width and height in cm" },
        { { file = "x.svg", show = false }, "file and show = false exclude each other" },
        { { file = "x.svg", width = 50 }, "width is for text" },
        { { file = "x.txt", size = { 8, 6 } }, "size is for .svg, .png and .pdf" },
        { { y = "theta", labels = { "a", "b" } }, "labels has 2 names for 1 column" },
        { { labels = { theta = "angle" } }, "labels must be a list of words" },
        { { file = "x.jpg" }, "'x.jpg' must end in .svg, .png, .pdf or .txt" },
        { { file = "x" }, "'x' must end in .svg" },
        { { file = "/nowhere/at/all.svg" }, "there is no folder '/nowhere/at'" },
        { { file = "x\0.svg" }, "NUL" },
    })
end)

test("files begin with the signature of their format, and an old one is replaced as a whole", function()
    local heads = { svg = "<?xml", png = "\x89PNG", pdf = "%PDF-" }
    for ending, head in pairs(heads) do
        local name = temporary("." .. ending)
        write(name, ("old "):rep(100000))
        run:plot { file = name }
        local bytes = read(name)
        equal(bytes:sub(1, #head), head)
        assert(#bytes < 200000, #bytes)
    end
    local name = temporary ".txt"
    free:plot { file = name, ascii = true, width = 50 }
    equal(read(name), picture(free, { width = 50 }) .. "\n")
    plot { plot { line, show = false }, free:phase_plot { show = false }, file = temporary ".svg", size = { 16, 6 } }
end)

test("plot(run) is plot{ run }, and plot(x, { y, z }) has a curve for each", function()
    local run = system { I = 1, k = 1, Rd = 0.1 }:simulate { theta0 = 1, t_end = 9 }
    local size = { width = 60, height = 12, show = false }
    local function shown(...) return tostring(plot(...)) end
    equal(shown(run, size), shown(merged({ run }, size)))
    local x = vector.linspace(0, 3, 31)
    equal(shown(x, { x:sin(), x:cos() }, size), shown(merged({ { x, x:sin() }, { x, x:cos() } }, size)))
    local list = x:table()
    equal(shown(list, list, size), shown(merged({ { list, list } }, size)))
end)

test("plot(x, y) is plot{ { x, y } }", function()
    local x = vector.linspace(0, 1, 11)
    local options = { width = 40, height = 8, title = "square", show = false }
    local long = plot { { x, x ^ 2 }, width = 40, height = 8, title = "square", show = false }
    equal(tostring(plot(x, x ^ 2, options)), tostring(long))
    equal(tostring(plot(x:table(), (x ^ 2):table(), options)), tostring(long))
    refused {
        { "plot(x, x, { colour = 1 })", "plot has no option 'colour'" },
        { "plot(x, 3)", "plot takes one table of curves" },
    }
    equal(options.show, false)
end)

finish()
