-- Figure 12: h raised above the admissible step. The report raises h in figures 10 to 13 and does not say to what; we
-- take 0.15, 0.2, 0.3 and 0.4, of which this is h = 0.3: with the slip of chapter 6 it diverges.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("12", "zeta = 0.02387, h = 0.3, 80 steps with the slip of chapter 6: diverges", ...)
local number, picture = case.raised_step(0.3, 80)
fig:raised_step(number)

fig:quote{ 12, 0.3, number.slip, number.rk4, number.exact }
return fig:draw(picture)

--[[ prints
Figure 12: zeta = 0.02387, h = 0.3, 80 steps with the slip of chapter 6: diverges
                               with the slip  RK4 as printed           exact
factor per step                  1.037511249     0.767446243     0.956003323
largest h without divergence     0.196155805     0.457267120
largest |theta|, last steps           16.906      1.9389e-09        0.034177
fig12.svg
]]
