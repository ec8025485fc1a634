-- Figure 13: h raised above the admissible step. The report raises h in figures 10 to 13 and does not say to what; we
-- take 0.15, 0.2, 0.3 and 0.4, of which this is h = 0.4: with the slip of chapter 6 it diverges violently.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

case.title(13, "zeta = 0.02387, h = 0.4, 20 steps with the slip of chapter 6: diverges violently")
local old, run = case.run{ zeta = 0.02387, theta0 = 1, t_end = 20 * 0.4, h = 0.4, slip = true }

case.head("with the slip", "RK4 as printed", "exact")
case.line("factor per step", case.growth(0.02387, 0.4, true), case.growth(0.02387, 0.4, false),
  math.exp(-2 * math.pi * 0.02387 * 0.4))
case.line("largest h without divergence", case.largest_step(0.02387, true), case.largest_step(0.02387, false))
case.head("1989", "true motion")
case.line("largest |theta|, last steps", string.format("%.5g", case.row_amplitude(old, 6)),
  string.format("%.5g", case.row_amplitude(run, 6)))
case.save(13, old, run)

--[[ prints
Figure 13: zeta = 0.02387, h = 0.4, 20 steps with the slip of chapter 6: diverges violently
                               with the slip  RK4 as printed           exact
factor per step                  2.212237282     0.389033644     0.941772206
largest h without divergence     0.196155805     0.457267120
                                        1989     true motion
largest |theta|, last steps       5.2489e+05         0.40649
fig13.csv, fig13.dat: 21 rows
]]
