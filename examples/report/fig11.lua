-- Figure 11: h raised above the admissible step. The report raises h in figures 10 to 13 and does not say to what; we
-- take 0.15, 0.2, 0.3 and 0.4, of which this is h = 0.2: with the slip of chapter 6 it just diverges.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("11", "zeta = 0.02387, h = 0.2, 80 steps with the slip of chapter 6: just diverges", ...)
local number, picture = case.raised_step(0.2, 80)
fig:raised_step(number)

fig:quote{ 11, 0.2, number.slip, number.rk4, number.exact }
return fig:draw(picture)

--[[ prints
Figure 11: zeta = 0.02387, h = 0.2, 80 steps with the slip of chapter 6: just diverges
                               with the slip  RK4 as printed           exact
factor per step                  1.001396074     0.950074336     0.970449487
largest h without divergence     0.196155805     0.457267120
largest |theta|, last steps           1.0931        0.020396         0.10533
fig11.svg
]]
