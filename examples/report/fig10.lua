-- Figure 10: h raised above the admissible step. The report raises h in figures 10 to 13 and does not say to what; we
-- take 0.15, 0.2, 0.3 and 0.4, of which this is h = 0.15: with the slip of chapter 6 it still decays.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("10", "zeta = 0.02387, h = 0.15, 80 steps with the slip of chapter 6: still decays", ...)
local number, picture = case.raised_step(0.15, 80)
fig:raised_step(number)

fig:quote{ 10, 0.15, number.slip, number.rk4, number.exact }
return fig:draw(picture)

--[[ prints
Figure 10: zeta = 0.02387, h = 0.15, 80 steps with the slip of chapter 6: still decays
                               with the slip  RK4 as printed           exact
factor per step                  0.988652178     0.973981612     0.977754224
largest h without divergence     0.196155805     0.457267120
largest |theta|, last steps          0.40535         0.13874         0.17047
fig10.svg
]]
