-- Figure 17: free motion without dry friction, zeta = 1, critical: no oscillation, the quickest way home.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

case.title(17, "free, zeta = 1 (critical), h = 0.01")
local old, run, sys = case.run{ zeta = 1, velocity0 = 1, t_end = 3, h = 0.01 }
local exact = theory.free_response{ system = sys, velocity0 = sys.omega0, t = run.t }

case.head("1989", "true motion", "closed form")
for _, n in ipairs{ 25, 50, 100, 200 } do
  case.line(string.format("theta at t = %.2f", n / 100), old.theta[n + 1], run.theta[n + 1], exact[n + 1])
end
case.line("largest theta", old.theta:max(), run.theta:max(), exact:max())
case.save(17, old, run)

--[[ prints
Figure 17: free, zeta = 1 (critical), h = 0.01
                                        1989     true motion     closed form
theta at t = 0.25                0.326532584     0.326532740     0.326532740
theta at t = 0.50                0.135754666     0.135754701     0.135754701
theta at t = 1.00                0.011732248     0.011732246     0.011732246
theta at t = 2.00                0.000043813     0.000043813     0.000043813
largest theta                    0.367874031     0.367874235     0.367874235
fig17.csv, fig17.dat: 301 rows
]]
