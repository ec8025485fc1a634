-- Figure 7: zeta = 0.02387 without dry friction, the analytic solution: what figures 8 to 13 are to be compared with.
-- The report does not print the start; its remark "-1.014360 instead of -1" (undamped) says theta0 = 1, velocity0 = 0.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("07", "zeta = 0.02387, the analytic solution", ...)
local sys = case.system(0.02387)
local run = sys:simulate{ theta0 = 1, t_end = 20, dt = 0.01 }

fig:head("analytic", "simulated")
for n = 1, 5 do
  fig:line("theta at t = " .. n, (theory.free_response{ system = sys, theta0 = 1, t = n }), (run:at(n)))
end
local decrement = math.exp(-theory.logarithmic_decrement{ zeta = sys.zeta })
fig:line("a pseudoperiod multiplies by", decrement)

fig:quote{ 0.02387, decrement, 1 / math.sqrt(1 - sys.zeta^2), 1 }
return fig:draw{ case.exact(0.02387, 20), xlabel = "t*", ylabel = "θ*", ylim = { -1, 1 }, size = case.page }

--[[ prints
Figure 7: zeta = 0.02387, the analytic solution
                                    analytic       simulated
theta at t = 1                   0.860687522     0.860687522
theta at t = 2                   0.740780957     0.740780957
theta at t = 3                   0.637577392     0.637577392
theta at t = 4                   0.548750341     0.548750341
theta at t = 5                   0.472297334     0.472297334
a pseudoperiod multiplies by     0.860688715
fig07.svg
]]
