-- Figure 13: h raised above the admissible step. The report raises h in figures 10 to 13 and does not say to what; we
-- take 0.15, 0.2, 0.3 and 0.4, of which this is h = 0.4: with the slip of chapter 6 it diverges violently.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("13", "zeta = 0.02387, h = 0.4, 20 steps with the slip of chapter 6: diverges violently", ...)
local number, picture = case.raised_step(0.4, 20)
fig:raised_step(number)

fig:quote{ 13, 0.4, number.slip, number.rk4, number.exact, -- and what is said below the table
  number.slip_limit, 0.4, number.slip_end, 20, number.rk4_limit }
return fig:draw(picture)

--[[ prints
Figure 13: zeta = 0.02387, h = 0.4, 20 steps with the slip of chapter 6: diverges violently
                               with the slip  RK4 as printed           exact
factor per step                  2.212237282     0.389033644     0.941772206
largest h without divergence     0.196155805     0.457267120
largest |theta|, last steps       5.2489e+05      6.9147e-07         0.40649
fig13.svg
]]
