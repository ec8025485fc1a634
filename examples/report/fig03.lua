-- Figure 3: the magnification without dry friction, and where damping does not matter.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("03", "magnification without dry friction", ...)
local r = vector.linspace(0, 2.5, 501)
local picture = {
  xlabel = "ω/ω₀", ylabel = "Φ", ylim = { 0, 6 }, xlim = { 0, 2.5 }, xticks = 0.5, size = { 8.5, 7 },
}
for _, zeta in ipairs{ 0, 0.1, 0.2, 0.3, 0.5, 1 } do
  picture[#picture + 1] = { r, theory.magnification{ r = r, zeta = zeta }, label = string.format("ζ = %g", zeta) }
end

-- "less than 5 % if zeta = 0 is taken where it is 1": the ratio of the two is (1 + r^2)/|1 - r^2|
local function error_in_percent(x)
  return 100 * (theory.magnification{ r = x } / theory.magnification{ r = x, zeta = 1 } - 1)
end
fig:head("error in %")
fig:line("ratio of frequencies 0.156", error_in_percent(0.156))
fig:line("ratio of frequencies 6.4", error_in_percent(6.4))
local below, above = 1 / math.sqrt(41), math.sqrt(41) -- (1 + r^2)/|1 - r^2| = 1.05
assert(math.abs(error_in_percent(below) - 5) < 1e-12 and math.abs(error_in_percent(above) - 5) < 1e-12)
fig:line("it is 5 % at", below, above)
local summit = math.sqrt(1 - 2 * 0.3^2) -- not at 1
local peak = theory.magnification{ r = summit, zeta = 0.3 }
fig:line("zeta = 0.3 is highest at", summit, peak)

fig:quote{ 0, 1, 5, 0.156, 6.4, error_in_percent(0.156), 0.156, error_in_percent(6.4), 6.4, 5, below, above,
  0.3, summit, peak, 1, theory.magnification{ r = 1, zeta = 0.3 } }
return fig:draw(picture)

--[[ prints
Figure 3: magnification without dry friction
                                  error in %
ratio of frequencies 0.156       4.988602634
ratio of frequencies 6.4         5.005005005
it is 5 % at                     0.156173762     6.403124237
zeta = 0.3 is highest at         0.905538514     1.747141395
fig03.svg
]]
