-- Draws the pictures of the pages, except those of report.md: scripts/dinal docs/pictures.lua [FOLDER]. A test compares
-- them with docs/pictures. The block diagram governor-loop.svg is written by hand.
local here = debug.getinfo(1, "S").source:match("^@(.*/)") or ""
local folder = ... or here .. "pictures"
local function file(name) return folder .. "/" .. name .. ".svg" end
local drawn = {}
local function draw(name, picture)
  picture.file = file(name)
  plot(picture)
  drawn[#drawn + 1] = picture.file
end

-- tutorial.md: a block pulled through a spring.
local weight, speed = 10 * 9.81, 0.01
local block = system{ I = 10, k = 4000, Rd = weight / 5, Re = weight / 3, units = { theta = "m", t = "s", M = "N" } }
local pulled = block:simulate{ M = excitation.ramp{ slope = block.k * speed }, t_end = 4, dt = 0.001 }
pulled:plot{ file = file "stick-slip", size = { 12, 6 } }
drawn[#drawn + 1] = file "stick-slip"

-- governor.md: a load step with Re = 0.06, without and with dither.
local function governor_speed(dither)
  local governor = system{ I = 1, k = 1, C = 1.2, Rd = 0.02, Re = 0.06 }
  return governor:simulate{
    M = function(t, theta, velocity, z) return 2*z.w + dither*math.sin(20*t) end,
    states = { w = { start = 0, rate = function(t, theta) return (-theta - (t < 5 and 0 or 0.1))/5 end } },
    t_end = 150, dt = 0.1 }
end
local hunting, shaken = governor_speed(0), governor_speed(0.3)
draw("hunting", { { hunting.t, hunting.states.w, label = "Re = 0.06" },
  { shaken.t, shaken.states.w, label = "with dither" },
  xlabel = "t", ylabel = "speed w", size = { 12, 6 } })

-- bodies.md: its own lines draw its pictures, so they are run as they stand there, with the files in the folder.
local page = assert(io.open(here .. "bodies.md"))
local code = { "local function print() end\n" }
for block in page:read "a":gmatch "\n```lua\n(.-)\n```\n" do
  code[#code + 1] = block:gsub('file = "([%w-]+)%.svg"', function(name)
    drawn[#drawn + 1] = file(name)
    return ("file = %q"):format(file(name))
  end)
end
page:close()
assert(load(table.concat(code, "\n"), "=bodies.md"))()

-- README.md: what dry friction holds does not creep, and a resonance that leans over.
local held, smoothed = system{ I = 1, k = 1, Rd = 1 }, system{ I = 1, k = 1 }
local stays = held:simulate{ M = 0.6, t_end = 150 }
local creeps = smoothed:simulate{ M = function(t, theta, velocity) return 0.6 - math.tanh(velocity/0.01) end, t_end = 150 }
local creep = plot{ { stays.t, stays.theta, label = "dry friction" }, { creeps.t, creeps.theta, label = "tanh(v/0.01)" },
  xlabel = "t", ylabel = "θ, rad", ends = true, title = "Under 60 % of the limit", ylim = { -0.05, 0.6 }, show = false }
local leaning = system{ I = 1, k = 1, C = 0.05, Rd = 0.1, spring = spring.polynomial{ [3] = 0.5 } }
local c = leaning:response{ amplitude = 0.5, over = { frequency = vector.linspace(0.14, 0.45, 80) } }
draw("resonance", { creep, c:plot{ overlay = "jumps", title = "A stiffening spring", xlabel = "frequency, 1/time",
    ylabel = "amplitude, rad", show = false },
  size = { 17, 6.5 } })

-- The manual: where a brake squeals, as in example 323.
local brake = system{ I = 1, k = 4, C = 0.1, friction = friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.3 } }
local squeal = brake:response{ over = { C = vector.linspace(0.15, 0.4, 11), speed = vector.linspace(0.3, 0.9, 25) },
  at = function(p) return { belt = p.speed, system = brake:with{ C = p.C } } end }
squeal:plot{ overlay = "points", ylabel = "speed, rad/time", file = file "map", size = { 12, 7 } }
drawn[#drawn + 1] = file "map"

return drawn
