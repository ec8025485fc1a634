-- run:animate into files, and what it says without one.
dofile "tests/lua/support.lua"

local sys = system{ I = 1, k = 4, Rd = 0.3, Re = 0.5 }
local run = sys:simulate{ theta0 = 1, t_end = 10, times = {} }

--- The values of the animations of that kind in the SVG, as lists of words.
local function values(svg, kind)
    local lists = {}
    for list in svg:gmatch(kind .. '"[^>]- values="([^"]*)"') do
        local words = {}
        for word in list:gmatch "[^;]+" do words[#words + 1] = word end
        lists[#lists + 1] = words
    end
    return lists
end
local function animated(of, options)
    options.file = temporary ".svg"
    of:animate(options)
    return read(options.file)
end

test("the mass of an SVG is at the angles of run:at, at equal steps of time", function()
    local svg = animated(run, { speed = 2 })  -- 5 s, 125 steps
    local mass = values(svg, 'type="translate')[1]
    equal(#mass, 126)
    local low, high = math.huge, -math.huge
    for i = 0, 125 do
        local theta = run:at(i * 10 / 125)
        low, high = math.min(low, theta), math.max(high, theta)
    end
    local left, right = tonumber(mass[1]), math.huge
    for i = 1, 126 do right = math.min(right, tonumber(mass[i])) end
    for i = 1, 126 do
        local part = (run:at((i - 1) * 10 / 125) - low) / (high - low)
        near(tonumber(mass[i]), right + part * (left - right), 0.11)  -- a digit behind the point
    end
    has(svg, 'dur="5.000s"', 'role="img"', ">10</text>")
    assert(svg:match("<desc>.-</desc>"):find("Below, θ from %S+ to %S+ over t from 0 to 10%."), "the axes in words")
end)

test("the mass has another colour while it sticks, between the times of the events", function()
    local svg = animated(run, {})
    local times = svg:match('keyTimes="([^"]*)"')
    local stick = run.events[#run.events].t  -- it comes to rest
    near(tonumber(times:match "[^;]+$"), stick / 10, 1 / 250)
    equal(select(2, times:gsub(";", "")) + 1, #values(svg, 'attributeName="fill')[1])
end)

test("a belt moves, walls and springs are there if the system has them", function()
    local block = system{ I = 1, k = 0, Rd = 0.3, walls = { upper = 1 } }
    local slides = block:simulate{ velocity0 = 1, belt = 0.5, t_end = 4, dt = 0.1 }
    local svg = animated(slides, { speed = 4 })
    local belt = values(svg, 'attributeName="patternTransform" type="translate')[1]
    local first, last = tonumber(belt[1]), tonumber(belt[#belt])
    equal(first, 0)
    assert(last > 0)
    near(tonumber(belt[6]), last * 5 / (#belt - 1), 0.11)  -- evenly
    equal(#values(svg, 'attributeName="points'), 0)
    equal(#values(animated(run, {}), 'attributeName="points')[1], 251)
    has(svg, "between walls")
    -- A mass that leans on a wall touches it.
    local leans = system{ I = 1, k = 1, walls = { lower = -1, upper = 1, restitution = 0 } }
    svg = animated(leans:simulate{ M = excitation.step{ at = 5, amplitude = 12 } - 6, t_end = 10 }, {})
    local half = -tonumber(svg:match '<rect x="(%S+)" y="%S+" width="%S+" height="%S+" rx="3"')
    local left, right = math.huge, -math.huge
    for _, x in ipairs(values(svg, 'type="translate')[1]) do left, right = math.min(left, tonumber(x)), math.max(right, tonumber(x)) end
    local edges = {}
    for x, width in svg:gmatch '<rect x="(%S+)" y="%S+" width="(%S+)" height="12"' do edges[#edges + 1] = { x + 0, x + width } end
    near(edges[1][2], left - half, 0.11)
    near(edges[2][1], right + half, 0.11)
    has_not(animated(run, {}), "patternTransform")
end)

test("the axis ends at the extremes of the run, which lie between two frames of the animation", function()
    local swing = system{ I = 1, k = 4, Rd = 0.26, Re = 0.5 }:simulate{ theta0 = 1, t_end = 8, dt = 0.001 }
    local least = swing.events[1].theta
    near(least, -0.87, 1e-12)
    for _, one in ipairs{ swing, (reloaded(swing)) } do
        for _, part in ipairs{ { speed = 8/0.32 }, { speed = 8/0.4, from = 0, to = 8 } } do  -- some ten steps
            local svg = animated(one, part)
            has(svg, ">-0.87</text>")
        end
    end
    local later = animated(swing, { from = 3, to = 8, speed = 20 })  -- the turn is not in this part
    has_not(later, ">-0.87</text>")
end)

test("an animation may show a part of a run or a run from a file, and has units", function()
    local part = animated(run, { from = 2, to = 4, speed = 1 })
    has(part, "t = 2 to 4")
    equal(#values(part, 'type="translate')[1], 51)
    has(animated(reloaded(sys:simulate{ theta0 = 1, t_end = 10, dt = 0.01 }), {}), "</svg>")
    has(animated(run, { units = { theta = "<m>", t = "s" } }), "θ, &lt;m&gt;")
end)

test("bodies without springs are drawn as discs, in metres or with springs side by side", function()
    local function clutch(k, units)
        local rig = system{ bodies = { motor = { I = 1, k = k }, load = { I = 3 } }, links = { clutch = { "motor", "load", Rd = 2 } }, units = units }
        return animated(rig:simulate{ velocity0 = { motor = 3 }, t_end = 1 }, {})
    end
    has(clutch(0), "as discs on one axis")
    has(clutch(4), "side by side")
    has(clutch(0, { theta = "m" }), "side by side")
end)

test("an animation that is impossible is an error", function()
    refused { { "run:animate()", "a terminal does not show animations", 'give file = "run.svg"' } }
    refuses(function(o) run:animate(o) end, {
        { { file = "run.mp4" }, "'run.mp4' must end in .svg" },
        { { file = "x.svg", speed = 0 }, "speed", "positive" },
        { { file = "x.svg", speed = 1e-6 }, "give a greater speed" },
        { { file = "x.svg", from = 3, to = 2 }, "from = 3 and to = 2" },
        { { file = "x.svg", to = 11 }, "goes from 0 to 10" },
        { { sped = 1 }, "did you mean 'speed'?" },
        { { file = "/nowhere/x.svg" }, "/nowhere/x.svg" },
    })
end)

test("bodies are placed along their links in animations and plots, beginning with the first one in links", function()
    local rig = system{ bodies = { brake = { I = 1, k = 9 }, load = { I = 3 }, motor = { I = 1 } },
        links = { clutch = { "motor", "load", Rd = 2 }, rod = { "load", "brake", k = 3 } } }
    local moving = rig:simulate{ velocity0 = { motor = 3 }, t_end = 4 }
    local x = {}
    for at, name in animated(moving, {}):gmatch '<text x="([%d.]+)"[^>]*>(%a+)</text>' do x[name] = tonumber(at) end
    assert(x.motor < x.clutch and x.clutch < x.load and x.load < x.rod and x.rod < x.brake)
    local file = temporary ".txt"
    moving:plot{ file = file }
    local order = {}
    for name in read(file):gmatch "(%a+) θ" do order[#order + 1] = name end
    equal(table.concat(order, " "), "motor load brake clutch")
end)

finish()
