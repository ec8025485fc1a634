-- Figure 8: the same motion by the program, h = 0.005. The report: "no visible differences".
-- Chapter 6 was not computed with the printed RK4: stage 3 reads Q21 where it must read Q22. slip = true does the same.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("08", "zeta = 0.02387, h = 0.005, with the slip of chapter 6", ...)
local zeta, h = 0.02387, 0.005
local slipped, old = case.scheme(zeta, h, 4000, true)
local exact = theory.free_response{ system = case.system(zeta), theta0 = 1, t = old.t }
local missed = (old.theta - exact):abs():max()

fig:head("1989", "report")
fig:line("largest error of theta", missed, "invisible")
fig:head("with the slip", "RK4 as printed", "exact")
local factor, printed = case.growth(zeta, h, true), (case.growth(zeta, h, false))
fig:line("factor per step", factor, printed, math.exp(-2 * math.pi * zeta * h))

slipped.dashes = "dashed"
fig:quote{ missed, h, zeta, theory.step_limit{ system = nondimensional{ zeta = zeta }, rule = "corrected", theta0 = 1 },
  case.largest_step(zeta, false) }
return fig:draw{ case.exact(zeta, 20), slipped, xlabel = "t*", ylabel = "θ*", ylim = { -1, 1 }, size = case.page }

--[[ prints
Figure 8: zeta = 0.02387, h = 0.005, with the slip of chapter 6
                                        1989          report
largest error of theta           0.000634321       invisible
                               with the slip  RK4 as printed           exact
factor per step                  0.999250280     0.999250383     0.999250383
fig08.svg
]]
