-- Figure 12: h raised above the admissible step. The report raises h in figures 10 to 13 and does not say to what; we
-- take 0.15, 0.2, 0.3 and 0.4, of which this is h = 0.3: with the slip of chapter 6 it diverges.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

case.title(12, "zeta = 0.02387, h = 0.3, 80 steps with the slip of chapter 6: diverges")
local old, run = case.run{ zeta = 0.02387, theta0 = 1, t_end = 80 * 0.3, h = 0.3, slip = true }

case.head("with the slip", "RK4 as printed", "exact")
case.line("factor per step", case.growth(0.02387, 0.3, true), case.growth(0.02387, 0.3, false),
  math.exp(-2 * math.pi * 0.02387 * 0.3))
case.line("largest h without divergence", case.largest_step(0.02387, true), case.largest_step(0.02387, false))
case.head("1989", "true motion")
case.line("largest |theta|, last steps", string.format("%.5g", case.row_amplitude(old, 6)),
  string.format("%.5g", case.row_amplitude(run, 6)))
case.save(12, old, run)

--[[ prints
Figure 12: zeta = 0.02387, h = 0.3, 80 steps with the slip of chapter 6: diverges
                               with the slip  RK4 as printed           exact
factor per step                  1.037511249     0.767446243     0.956003323
largest h without divergence     0.196155805     0.457267120
                                        1989     true motion
largest |theta|, last steps           16.906        0.034177
fig12.csv, fig12.dat: 81 rows
]]
