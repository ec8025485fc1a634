-- Figure 3 bis: the phase lag without dry friction. "arctg" alone has the wrong branch above resonance.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("03bis", "phase lag without dry friction", ...)
local r = vector.linspace(0, 2.5, 501)
local picture = {
  xlabel = "ω/ω₀", ylabel = "α, degrees", xlim = { 0, 2.5 }, ylim = { 0, 180 }, xticks = 0.5, yticks = 45,
  size = { 8.5, 7 },
}
for _, zeta in ipairs{ 0, 0.1, 0.2, 0.3, 0.5, 1 } do
  local lag = (theory.phase_lag{ r = r, zeta = zeta } * (180 / math.pi)):table()
  if zeta == 0 then lag[201] = 0 / 0 end -- it jumps at r = 1
  picture[#picture + 1] = { r, lag, label = string.format("ζ = %g", zeta) }
end

local zeta, x = 0.242, 1.35 -- of figure 25
local lag = math.deg(theory.phase_lag{ r = x, zeta = zeta })
local arctg = math.deg(math.atan(2 * zeta * x / (1 - x^2)))
fig:head("atan2", "arctg")
fig:line("lag, zeta = 0.242, r = 1.35", lag, arctg)

fig:quote{ zeta, x, arctg, lag }
return fig:draw(picture)

--[[ prints
Figure 3 bis: phase lag without dry friction
                                       atan2           arctg
lag, zeta = 0.242, r = 1.35    141.536114761   -38.463885239
fig03bis.svg
]]
