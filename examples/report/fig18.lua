-- Figure 18: free motion without dry friction, zeta = 2.387, overdamped: less displacement than in figure 17, and a
-- longer way home.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

case.title(18, "free, zeta = 2.387 (overdamped), h = 0.01")
local old, run, sys = case.run{ zeta = 2.387, velocity0 = 1, t_end = 5, h = 0.01 }
local exact = theory.free_response{ system = sys, velocity0 = sys.omega0, t = run.t }

case.head("1989", "true motion", "closed form")
for _, n in ipairs{ 25, 50, 100, 200 } do
  case.line(string.format("theta at t = %.2f", n / 100), old.theta[n + 1], run.theta[n + 1], exact[n + 1])
end
case.line("largest theta", old.theta:max(), run.theta:max(), exact:max())
case.save(18, old, run)

--[[ prints
Figure 18: free, zeta = 2.387 (overdamped), h = 0.01
                                        1989     true motion     closed form
theta at t = 0.25                0.163213449     0.163213540     0.163213540
theta at t = 0.50                0.115730179     0.115730179     0.115730179
theta at t = 1.00                0.058059077     0.058059077     0.058059077
theta at t = 2.00                0.014612216     0.014612216     0.014612216
largest theta                    0.188297370     0.188299585     0.188299585
fig18.csv, fig18.dat: 501 rows
]]
