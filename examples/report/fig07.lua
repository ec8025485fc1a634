-- Figure 7: zeta = 0.02387 without dry friction, the analytic solution: what figures 8 to 13 are to be compared with.
-- The report does not print the start; its remark "-1.014360 instead of -1" (undamped) says theta0 = 1, velocity0 = 0.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

case.title(7, "zeta = 0.02387, the analytic solution")
local old, run, sys = case.run{ zeta = 0.02387, theta0 = 1, t_end = 20, h = 0.005 }

case.head("analytic", "simulated")
for n = 1, 5 do
  case.line("theta at t = " .. n, (theory.free_response{ system = sys, theta0 = 1, t = n }), (run:at(n)))
end
case.line("a pseudoperiod multiplies by", math.exp(-theory.logarithmic_decrement{ zeta = sys.zeta }))
case.save(7, old, run)

--[[ prints
Figure 7: zeta = 0.02387, the analytic solution
                                    analytic       simulated
theta at t = 1                   0.860687522     0.860687522
theta at t = 2                   0.740780957     0.740780957
theta at t = 3                   0.637577392     0.637577392
theta at t = 4                   0.548750341     0.548750341
theta at t = 5                   0.472297334     0.472297334
a pseudoperiod multiplies by     0.860688715
fig07.csv, fig07.dat: 4001 rows
]]
