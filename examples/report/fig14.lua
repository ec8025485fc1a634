-- Figure 14: undamped, h = 0.01, up to t = 50. "Always divergent", says the report of the undamped case, though not yet
-- to the naked eye. With the slip that is true; the printed RK4 would lose amplitude.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("14", "undamped, h = 0.01, with the slip of chapter 6", ...)
local slipped, old = case.scheme(0, 0.01, 5000, true)
local omega0 = case.system().omega0

fig:head("1989", "exact", "report")
fig:line("theta at t = 0.5", old.theta[51], "-1", "sixth figure")
fig:line("theta at t = 50", old.theta[#old], math.cos(50 * omega0))
fig:head("with the slip", "RK4 as printed")
local slip, rk4 = case.growth(0, 0.01, true), (case.growth(0, 0.01, false))
fig:line("factor per step", string.format("%.12f", slip), string.format("%.12f", rk4))

fig:quote{ 50, old.theta[51], -1, slip, 5000, slip^5000, rk4 }
return fig:draw{ slipped, xlabel = "t*", ylabel = "θ*", ylim = { -1.2, 1.2 }, size = case.page }

--[[ prints
Figure 14: undamped, h = 0.01, with the slip of chapter 6
                                        1989           exact          report
theta at t = 0.5                -1.000016061              -1    sixth figure
theta at t = 50                  0.999943892     0.999980180
                               with the slip  RK4 as printed
factor per step               1.000000324483  0.999999999573
fig14.svg
]]
