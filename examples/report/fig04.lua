-- Figure 4: a free motion with dry friction: half waves of cosine about +Rd/k and -Rd/k by turns, between straight lines.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("04", "free, gamma = 0.12, let go at theta = 1", ...)
local gamma = 0.12 -- the report does not print its own
local sys = case.system(0, gamma)
local t = vector.linspace(0, 3, 601)
local theta = theory.free_response{ system = sys, theta0 = 1, t = t * sys.T0 }
local turn, extreme = theory.extremes{ system = sys, theta0 = 1 }
local run = sys:simulate{ theta0 = 1, t_end = 3 * sys.T0, times = {} }

fig:head("t/T0", "half-cycle map", "simulated")
fig:line("start", turn[1], extreme[1])
for i, event in ipairs(run.events) do
  fig:line(event.kind, turn[i + 1] / sys.T0, extreme[i + 1], event.theta)
end

local last = turn[#turn] / sys.T0
fig:quote{ gamma, extreme[1], extreme[2], extreme[3], extreme[4], extreme[5], last }
return fig:draw{
  { t, theta, label = "θ*" },
  { { 0, last }, { 1, 1 - 4 * gamma * last }, dashes = "dashed", colour = 2, label = "±(1 − 4γt*)" },
  { { 0, last }, { -1, -1 + 4 * gamma * last }, dashes = "dashed", colour = 2 },
  { { 0, 3 }, { gamma, gamma }, dashes = "dotted", colour = 5, label = "±Rd/k" },
  { { 0, 3 }, { -gamma, -gamma }, dashes = "dotted", colour = 5 },
  xlabel = "t*", ylabel = "θ*", ylim = { -1.1, 1.1 }, xlim = { 0, 3 }, yticks = 0.5, size = { 8.5, 6.5 },
}

--[[ prints
Figure 4: free, gamma = 0.12, let go at theta = 1
                                        t/T0  half-cycle map       simulated
start                            0.000000000     1.000000000
turn                             0.500000000    -0.760000000    -0.760000000
turn                             1.000000000     0.520000000     0.520000000
turn                             1.500000000    -0.280000000    -0.280000000
rest                             2.000000000     0.040000000     0.040000000
fig04.svg
]]
