-- Figure 18: free motion without dry friction, zeta = 2.387, overdamped: less displacement than in figure 17, and a
-- longer way home.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("18", "free, zeta = 2.387 (overdamped), h = 0.01", ...)
local old, run, sys = case.run{ zeta = 2.387, velocity0 = 1, t_end = 5, h = 0.01 }
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

fig:quote{ 18, 2.387, top[1], t[1] / sys.T0, settled, missed }
return fig:draw{
  case.response{ { run.t, run.theta }, xlim = { 0, 3 }, ylim = { -0.6, 0.8 }, yticks = 0.2 },
  case.plane(run, 1.1),
  size = case.page,
}

--[[ prints
Figure 18: free, zeta = 2.387 (overdamped), h = 0.01
                                        1989     true motion     closed form
theta at t = 0.25                0.163213449     0.163213540     0.163213540
theta at t = 0.50                0.115730179     0.115730179     0.115730179
theta at t = 1.00                0.058059077     0.058059077     0.058059077
theta at t = 2.00                0.014612216     0.014612216     0.014612216
largest theta                    0.188297370     0.188299585     0.188306201
at t/T0 =                                                        0.111327510
within 0.01 from t =                                             2.274000000
largest error                    0.000005968
fig18.svg
]]
