-- Figure 5b: the lag of the peak with dry friction, exact where the mass never stops, simulated where it stops once in
-- each half cycle; and what becomes of it when friction is taken for viscous. Where it stops several times the peak jumps
-- from one stop to another, so there is no curve.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("05b", "phase lag under sin(omega t) with dry friction", ...)
local picture = {
  ends = true,
  xlabel = "ω/ω₀", ylabel = "α, degrees", xlim = { 0, 2 }, ylim = { -45, 180 }, xticks = 0.5, yticks = 45,
  size = { 12, 9 },
}

local degree = math.pi / 180
local r = case.ratios()
-- In degrees, without a line across the jump at resonance.
local function with_jump(lag)
  local list = (lag / degree):table()
  for i = 1, #r do
    if r[i] == 1 then list[i] = 0 / 0 end
  end
  return list
end

local colours = { [0] = 1, [0.2] = 2, [0.4] = 3, [0.6] = 4, [0.7] = 7, [0.8] = 6 }
for _, gamma in ipairs{ 0, 0.2, 0.4, 0.6, 0.7, 0.8 } do
  local amplitude, exact = theory.den_hartog{ r = r, friction_ratio = gamma }
  local x, _, simulated, stops = case.where_it_stops(r, amplitude, gamma)
  for i = 1, #x do
    if stops[i] > 1 then simulated[i] = 0 / 0 end
  end
  picture[#picture + 1] = { r, with_jump(exact), label = "γ = " .. gamma, dashes = "solid",
    colour = colours[gamma] }
  if #x > 0 then picture[#picture + 1] = { x, simulated, dashes = "dotted", colour = colours[gamma] } end
end
picture[#picture + 1] = case.dotted "with a stop"
local _, linear = theory.linearised{ r = r, friction_ratio = 0.6 }
picture[#picture + 1] = { r, with_jump(linear), label = "0.6 as viscous", dashes = "dashed", colour = 5 }

local amplitude, peak = theory.den_hartog{ r = 1.35, friction_ratio = 0.5 }
local _, fundamental = theory.den_hartog_fundamental{ r = 1.35, friction_ratio = 0.5 }
fig:head("peak", "fundamental", "as viscous")
local _, viscous = theory.linearised{ r = 1.35, friction_ratio = 0.5 }
fig:line("degrees, gamma 0.5, r = 1.35", peak / degree, fundamental / degree, viscous / degree)
local _, early = theory.den_hartog{ r = 0.7, friction_ratio = 0.6 }
local _, below = theory.linearised{ r = 0.7, friction_ratio = 0.6 }
local _, above = theory.linearised{ r = 1.35, friction_ratio = 0.6 }
fig:line("gamma = 0.6, r = 0.7", early / degree, "", below / degree)
fig:line("gamma = 0.6, r = 1.35", "", "", above / degree)

fig:quote{ 0.5, 1.35, peak / degree, fundamental / degree, viscous / degree, 0.6, below / degree, above / degree,
  early / degree, 0.7 }
return fig:draw(picture)

--[[ prints
Figure 5b: phase lag under sin(omega t) with dry friction
                                        peak     fundamental      as viscous
degrees, gamma 0.5, r = 1.35   135.072549137   140.686249614   140.459776252
gamma = 0.6, r = 0.7            33.240859257                    49.813112602
gamma = 0.6, r = 1.35                                          130.186887398
fig05b.svg
]]
