-- Figure 15: undamped, h = 0.1: "diverges violently". After half a period the report prints -1.014360 instead of -1.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

case.title(15, "undamped, h = 0.1, with the slip of chapter 6")
local old, run = case.run{ theta0 = 1, t_end = 50, h = 0.1, slip = true }
local printed = case.system():simulate{
  theta0 = 1,
  t_end = old.t[6],
  dt = old.t[2],
  integrator = integrator.dinal1989{ h = old.t[2] }, -- without the slip
}

case.head("1989", "RK4 as printed", "exact", "report")
case.line("theta at t = 0.5", old.theta[6], printed.theta[6], "-1", "-1.014360")
case.line("factor per step", case.growth(0, 0.1, true), case.growth(0, 0.1, false), "1")
case.line("largest |theta| to t = 50", old.theta:abs():max(), "", "1")
case.save(15, old, run)

--[[ prints
Figure 15: undamped, h = 0.1, with the slip of chapter 6
                                        1989  RK4 as printed           exact          report
theta at t = 0.5                -1.014360024    -0.997964037              -1       -1.014360
factor per step                  1.003028741     0.999593719               1
largest |theta| to t = 50        4.290262482                               1
fig15.csv, fig15.dat: 501 rows
]]
