-- Figure 14: undamped, h = 0.01, up to t = 50. "Always divergent", says the report of the undamped case, though not yet
-- to the naked eye. With the slip that is true; the printed RK4 would lose amplitude.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("14", "undamped, h = 0.01, with the slip of chapter 6", ...)
local slipped, old = case.scheme(0, 0.01, 5000, true)
local _, printed = case.scheme(0, 0.01, 5000, false)
local exact = theory.free_response{ system = case.system(), theta0 = 1, t = old.t }
local slip_error, rk4_error = old.theta - exact, printed.theta - exact

fig:head("1989", "exact", "report")
fig:line("theta at t = 0.5", old.theta[51], "-1", "sixth figure")
fig:line("theta at t = 50", old.theta[#old], exact[#exact])
fig:head("with the slip", "RK4 as printed")
local slip, rk4 = case.growth(0, 0.01, true), (case.growth(0, 0.01, false))
fig:line("factor per step", string.format("%.12f", slip), string.format("%.12f", rk4))

fig:line("largest error to t = 50", slip_error:abs():max(), rk4_error:abs():max())

fig:quote{ 0.01, 50, old.theta[51], -1, slip, 5000, slip^5000, slip_error:abs():max(), rk4, rk4_error:abs():max() }
return fig:draw{
  case.response{ slipped, ylim = { -1.2, 1.2 } },
  case.response{
    { old.t, slip_error, label = "chapter 6", colour = 2, dashes = "solid" },
    { old.t, rk4_error, label = "RK4 as printed", colour = 3, dashes = "solid" },
    ylabel = "error of θ*",
  },
  size = case.page,
}

--[[ prints
Figure 14: undamped, h = 0.01, with the slip of chapter 6
                                        1989           exact          report
theta at t = 0.5                -1.000016061              -1    sixth figure
theta at t = 50                  0.999943892     0.999980180
                               with the slip  RK4 as printed
factor per step               1.000000324483  0.999999999573
largest error to t = 50          0.051433049     0.000040604
fig14.svg
]]
