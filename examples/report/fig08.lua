-- Figure 8: the same motion by the program, h = 0.005. The report: "no visible differences".
-- Chapter 6 was not computed with the printed RK4: stage 3 reads Q21 where it must read Q22. slip = true does the same.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("08", "zeta = 0.02387, h = 0.005, with the slip of chapter 6", ...)
local zeta, h = 0.02387, 0.005
local slipped, old = case.scheme(zeta, h, 4000, true)
local _, rk4 = case.scheme(zeta, h, 4000, false)
local exact = theory.free_response{ system = case.system(zeta), theta0 = 1, t = old.t }
local old_error, rk4_error = old.theta - exact, rk4.theta - exact
local missed, rk4_missed = old_error:abs():max(), rk4_error:abs():max()

fig:head("with the slip", "RK4 as printed", "report")
fig:line("largest error of theta", missed, rk4_missed, "invisible")
fig:head("with the slip", "RK4 as printed", "exact")
local factor, printed = case.growth(zeta, h, true), (case.growth(zeta, h, false))
fig:line("factor per step", factor, printed, math.exp(-2 * math.pi * zeta * h))

local seen = old.t:find(function(_, i) return i % 50 == 1 end) -- four points a swing
local points = { old.t[seen], old.theta[seen], style = "points", colour = 2, label = "chapter 6" }
fig:quote{ missed, rk4_missed,
  zeta / math.pi, -- in T0, of an argument that holds for the scheme of Euler
  case.largest_step(zeta, false) }
return fig:draw{
  case.response{ case.exact(zeta, 20), points, xlim = { 0, 20 }, ylim = { -1, 1 } },
  case.response{
    { old.t, old_error, label = "chapter 6", colour = 2, dashes = "solid" },
    { old.t, rk4_error, label = "RK4 as printed", colour = 3, dashes = "solid" },
    ylabel = "error of θ*",
  },
  size = case.page,
}

--[[ prints
Figure 8: zeta = 0.02387, h = 0.005, with the slip of chapter 6
                               with the slip  RK4 as printed          report
largest error of theta           0.000634321     0.000000125       invisible
                               with the slip  RK4 as printed           exact
factor per step                  0.999250280     0.999250383     0.999250383
fig08.svg
]]
