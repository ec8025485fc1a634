-- Figure 5a: the amplitude with dry friction, exact where the mass never stops (Den Hartog), simulated where it does; the
-- boundary between the two, and the corner where it stops several times in each half cycle.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("05a", "amplitude under sin(omega t) with dry friction", ...)
local picture = {
  ends = true,
  xlabel = "ω/ω₀", ylabel = "Φ", xlim = { 0, 2 }, ylim = { 0, 3 }, xticks = 0.5, size = { 12, 9 },
}

-- Where there are several stops in half a cycle: for each r the least and the most friction that has them, found by a
-- scan (the finer the thinner the region is) and then by halving.
local function amplitude_of_several(r, gamma)
  local amplitude, _, stops = case.steady(r, gamma)
  return stops > 1 and amplitude
end
local function edge(r, inside, outside)
  local amplitude = amplitude_of_several(r, inside)
  for _ = 1, 6 do
    local middle = (inside + outside) / 2
    local found = amplitude_of_several(r, middle)
    if found then inside, amplitude = middle, found else outside = middle end
  end
  return amplitude
end
local corner, lowest, highest = {}, {}, {}
for i = 1, 40 do
  local r = i / 100
  local step, least, most = i < 20 and 0.04 or 0.01
  for gamma = step, i < 20 and 0.98 or 0.5, step do
    if amplitude_of_several(r, gamma) then least, most = least or gamma, gamma end
  end
  if least then
    local n = #corner + 1
    corner[n], lowest[n], highest[n] = r, edge(r, most, most + step), edge(r, least, least - step)
  end
end
picture[1] = { corner, highest, base = lowest, style = "fill", colour = 5 }

local r = case.ratios()
local colours = { [0] = 1, [0.2] = 2, [0.4] = 3, [0.6] = 4, [0.7] = 7, [0.8] = 6 }
for _, gamma in ipairs{ 0, 0.2, 0.4, 0.6, 0.7, 0.8 } do
  local exact = theory.den_hartog{ r = r, friction_ratio = gamma } -- nan where it stops
  local x, simulated = case.where_it_stops(r, exact, gamma)
  local name, stops_last = "γ = " .. gamma, #x > 0 and x[#x] == r[#r] -- the name stands where the last part ends
  picture[#picture + 1] = { r, exact, label = not stops_last and name or nil, dashes = "solid", colour = colours[gamma] }
  if #x > 0 then
    picture[#picture + 1] = { x, simulated, label = stops_last and name or nil, dashes = "dotted", colour = colours[gamma] }
  end
end

local boundary = theory.stop_boundary{ r = r }
picture[#picture + 1] = { r, theory.den_hartog{ r = r, friction_ratio = boundary * (1 - 1e-9) },
  label = "stop boundary", dashes = "dashed", colour = 5 }
local stopping = case.steady(1, 0.836)
local moving = theory.den_hartog{ r = 1.35, friction_ratio = 0.5 }
picture[#picture + 1] = { { 1, 1.35 }, { stopping, moving }, style = "points", colour = 5, label = "figures 24, 25" }
picture[#picture + 1] = case.dotted "with stops"
picture[#picture + 1] = { { 0 / 0 }, { 0 / 0 }, style = "fill", colour = 5, label = "several stops" } -- last in the legend

local linear = theory.linearised{ r = 1.35, friction_ratio = 0.5 }
fig:head("exact", "as viscous")
fig:line("amplitude, r = 1.35", moving, linear)
local top, at = 0, 0
for x = 0.8, 0.9, 0.001 do
  local limit = theory.stop_boundary{ r = x }
  if limit > top then top, at = limit, x end
end
fig:line("no stops up to gamma =", top)
fig:line("that is at r =", at)
local edge, foot = theory.den_hartog{ r = 0.9575, friction_ratio = 0.8 }, (case.steady(0.965, 0.8))
fig:line("gamma = 0.8, r = 0.9575", edge)
fig:line("gamma = 0.8, r = 0.965", foot)
local function stops(x) return (select(3, case.steady(x, 0.4))) end
for _, x in ipairs{ 0.1, 0.2, 0.4, 0.6 } do
  fig:say(string.format("gamma = 0.4, r = %g: stops in half a cycle: %g", x, stops(x)))
end
assert(stops(0.4) == 1 and stops(0.6) == 0)

fig:quote{ 0.5, 1.35, moving, linear, 100 * (linear / moving - 1), math.pi / 4, top, at,
  0.4, stops(0.1), 0.1, stops(0.2), 0.2, 0.4, 0.6 }
return fig:draw(picture)

--[[ prints
Figure 5a: amplitude under sin(omega t) with dry friction
                                       exact      as viscous
amplitude, r = 1.35              0.860792180     0.937602241
no stops up to gamma =           0.826447269
that is at r =                   0.849000000
gamma = 0.8, r = 0.9575          1.160238451
gamma = 0.8, r = 0.965           0.530413692
gamma = 0.4, r = 0.1: stops in half a cycle: 3
gamma = 0.4, r = 0.2: stops in half a cycle: 2
gamma = 0.4, r = 0.4: stops in half a cycle: 1
gamma = 0.4, r = 0.6: stops in half a cycle: 0
fig05a.svg
]]
