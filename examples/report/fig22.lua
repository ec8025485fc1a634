-- Figure 22: free motion with dry friction, gamma = 0.167, h = 0.001. In the phase plane a spiral about two centres;
-- the extremes fall by 2 gamma every half period, until one lies within gamma of the middle and the mass stays there.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("22", "free, gamma = 0.167, h = 0.001", ...)
local old, run, sys = case.run{ gamma = 0.167, velocity0 = 1, t_end = 3, h = 0.001 }
local known_t, known = theory.extremes{ system = sys, velocity0 = sys.omega0 } -- the half-cycle map

fig:head("1989", "true motion", "closed form")
local rough, extremes = case.row_extremes(old), case.extremes(run)
for i = 1, 3 do
  fig:line("extreme " .. i, rough[i].theta, extremes[i].theta, known[i])
end
fig:line("at rest at theta =", old.theta[#old], extremes[4].theta, known[4])
fig:line("from t/T0 =", "", extremes[4].t, known_t[4] / sys.T0)
fig:say(tostring(run))
-- The report's formula for the duration is of a start at an extreme, theta* = 1, and must read t* = (1 - A)/(4 gamma),
-- where A, between -gamma and gamma, is what is left: negative on the side it came from.
local left = -theory.rest_position{ system = sys, theta0 = 1 } -- three half cycles: the other side counts as positive
local from_one = theory.time_to_rest{ system = sys, theta0 = 1 } / sys.T0
fig:say(string.format("Let go at theta = 1 it would rest from t/T0 = %.6f; (1 - A)/(4 gamma) = %.6f",
  from_one, (1 - left) / (4 * 0.167)))

local coarse = case.run{ gamma = 0.167, velocity0 = 1, t_end = 3, h = 0.01 }
fig:line("at rest with h = 0.01", coarse.theta[#coarse])

fig:quote{ 0.167, 0.001, known[1], known[2], known[3], 0.334, known_t[1] / sys.T0, known[4], known_t[4] / sys.T0,
  0.167 - known[4], old.theta[#old], known[4] - old.theta[#old], 0.01, known[4] - coarse.theta[#coarse] }
return fig:draw{
  case.columns(run, { "theta", "friction/k" }, { ylim = { -0.6, 1 }, yticks = 0.2 }),
  case.plane(run, 1.1),
  size = case.page,
}

--[[ prints
Figure 22: free, gamma = 0.167, h = 0.001
                                        1989     true motion     closed form
extreme 1                        0.846846290     0.846848608     0.846848608
extreme 2                       -0.512846174    -0.512848608    -0.512848608
extreme 3                        0.178848884     0.178848608     0.178848608
at rest at theta =               0.155142378     0.155151392     0.155151392
from t/T0 =                                      1.723664157     1.723664157
3001 rows, t 0 … 3; 4 events (3 turns, 1 rest); at rest; peak |theta| 0.847
Let go at theta = 1 it would rest from t/T0 = 1.500000; (1 - A)/(4 gamma) = 1.500000
at rest with h = 0.01            0.152320407
fig22.svg
]]
