-- Figure 16: free motion without dry friction, zeta = 0.239, underdamped: a spiral into the origin.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("16", "free, zeta = 0.239 (underdamped), h = 0.01", ...)
local old, run, sys = case.run{ zeta = 0.239, velocity0 = 1, t_end = 3, h = 0.01 }
local exact = theory.free_response{ system = sys, velocity0 = sys.omega0, t = run.t }

fig:head("1989", "true motion", "closed form")
for _, n in ipairs{ 25, 50, 100, 200 } do
  fig:line(string.format("theta at t = %.2f", n / 100), old.theta[n + 1], run.theta[n + 1], exact[n + 1])
end
local missed = (old.theta - exact):abs():max()
local t, top = theory.extremes{ system = sys, velocity0 = sys.omega0, count = 1 }
local fine = vector.linspace(0, 6, 6001)
local settled = case.settled(fine, theory.free_response{ system = sys, velocity0 = sys.omega0, t = fine }, 0.01)
fig:line("largest theta", old.theta:max(), run.theta:max(), top[1])
fig:line("at t/T0 =", "", "", t[1] / sys.T0)
fig:line("within 0.01 from t =", "", "", settled)
fig:line("largest error", missed)

fig:quote{ 0.01, 0.01, 16, 0.239, top[1], t[1] / sys.T0, settled, missed }
return fig:draw{
  case.response{ { run.t, run.theta }, xlim = { 0, 3 }, ylim = { -0.6, 0.8 }, yticks = 0.2 },
  case.plane(run, 1.1),
  size = case.page,
}

--[[ prints
Figure 16: free, zeta = 0.239 (underdamped), h = 0.01
                                        1989     true motion     closed form
theta at t = 0.25                0.706767084     0.706766953     0.706766953
theta at t = 0.50                0.044161535     0.044161437     0.044161437
theta at t = 1.00               -0.041512778    -0.041512671    -0.041512671
theta at t = 2.00               -0.018188501    -0.018188441    -0.018188441
largest theta                    0.720859664     0.720859556     0.720922134
at t/T0 =                                                        0.217905189
within 0.01 from t =                                             2.937000000
largest error                    0.000000203
fig16.svg
]]
