-- Figure 17: free motion without dry friction, zeta = 1, critical: no oscillation, the quickest way home.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("17", "free, zeta = 1 (critical), h = 0.01", ...)
local old, run, sys = case.run{ zeta = 1, velocity0 = 1, t_end = 3, h = 0.01 }
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

fig:quote{ 17, 1, top[1], t[1] / sys.T0, settled, missed }
return fig:draw{
  case.response{ { run.t, run.theta }, xlim = { 0, 3 }, ylim = { -0.6, 0.8 }, yticks = 0.2 },
  case.plane(run, 1.1),
  size = case.page,
}

--[[ prints
Figure 17: free, zeta = 1 (critical), h = 0.01
                                        1989     true motion     closed form
theta at t = 0.25                0.326532584     0.326532740     0.326532740
theta at t = 0.50                0.135754666     0.135754701     0.135754701
theta at t = 1.00                0.011732248     0.011732246     0.011732246
theta at t = 2.00                0.000043813     0.000043813     0.000043813
largest theta                    0.367874031     0.367874235     0.367879441
at t/T0 =                                                        0.159154943
within 0.01 from t =                                             1.030000000
largest error                    0.000000209
fig17.svg
]]
