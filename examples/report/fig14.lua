-- Figure 14: undamped, h = 0.01, up to t = 50. "Always divergent", says the report of the undamped case, though not yet
-- to the naked eye. With the slip that is true; the printed RK4 would lose amplitude.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

case.title(14, "undamped, h = 0.01, with the slip of chapter 6")
local old, run, sys = case.run{ theta0 = 1, t_end = 50, h = 0.01, slip = true }

case.head("1989", "exact", "report")
case.line("theta at t = 0.5", old.theta[51], "-1", "sixth figure")
case.line("theta at t = 50", old.theta[#old], math.cos(50 * sys.omega0))
case.head("with the slip", "RK4 as printed")
case.line("factor per step", string.format("%.12f", case.growth(0, 0.01, true)),
  string.format("%.12f", case.growth(0, 0.01, false)))
case.save(14, old, run)

--[[ prints
Figure 14: undamped, h = 0.01, with the slip of chapter 6
                                        1989           exact          report
theta at t = 0.5                -1.000016061              -1    sixth figure
theta at t = 50                  0.999943892     0.999980180
                               with the slip  RK4 as printed
factor per step               1.000000324483  0.999999999573
fig14.csv, fig14.dat: 5001 rows
]]
