-- Figure 16: free motion without dry friction, zeta = 0.239, underdamped: a spiral into the origin.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

case.title(16, "free, zeta = 0.239 (underdamped), h = 0.01")
local old, run, sys = case.run{ zeta = 0.239, velocity0 = 1, t_end = 3, h = 0.01 }
local exact = theory.free_response{ system = sys, velocity0 = sys.omega0, t = run.t }

case.head("1989", "true motion", "closed form")
for _, n in ipairs{ 25, 50, 100, 200 } do
  case.line(string.format("theta at t = %.2f", n / 100), old.theta[n + 1], run.theta[n + 1], exact[n + 1])
end
case.line("largest theta", old.theta:max(), run.theta:max(), exact:max())
case.save(16, old, run)

--[[ prints
Figure 16: free, zeta = 0.239 (underdamped), h = 0.01
                                        1989     true motion     closed form
theta at t = 0.25                0.706767084     0.706766953     0.706766953
theta at t = 0.50                0.044161535     0.044161437     0.044161437
theta at t = 1.00               -0.041512778    -0.041512671    -0.041512671
theta at t = 2.00               -0.018188501    -0.018188441    -0.018188441
largest theta                    0.720859664     0.720859556     0.720859556
fig16.csv, fig16.dat: 301 rows
]]
