-- Figure 26: free motion with both frictions, zeta = 0.119, gamma = 0.06, h = 0.002. The mass stays off centre.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("26", "free, zeta = 0.119, gamma = 0.06, h = 0.002", ...)
local old, run, sys = case.run{ zeta = 0.119, gamma = 0.06, velocity0 = 1, t_end = 3, h = 0.002 }
local known_t, known = theory.extremes{ system = sys, velocity0 = sys.omega0 } -- the half-cycle map

fig:head("1989", "true motion", "closed form")
local rough, extremes = case.row_extremes(old), case.extremes(run)
for i = 1, 3 do
  fig:line("extreme " .. i, rough[i].theta, extremes[i].theta, known[i])
end
fig:line("at rest at theta =", old.theta[#old], extremes[4].theta, known[4])
fig:line("from t/T0 =", "", extremes[4].t, known_t[4] / sys.T0)
fig:say(tostring(run))

local half = extremes[2].t - extremes[1].t
local zeta, x_f = theory.identify{ X0 = known[1], X1 = known[2], X2 = known[3] }
fig:line("from turn to turn, in T0", "", half, math.pi / sys.omega1 / sys.T0)
fig:line("zeta, gamma from extremes", "", zeta, x_f)

fig:quote{ 0.119, 0.06, known[1], known[2], known[3], known[4], known_t[4] / sys.T0, half, 0.002,
  old.theta[#old] }
return fig:draw{
  case.columns(run, { "theta", "friction/k" }, { ylim = { -0.6, 1 }, yticks = 0.2 }),
  case.plane(run, 1.1),
  size = case.page,
}

--[[ prints
Figure 26: free, zeta = 0.119, gamma = 0.06, h = 0.002
                                        1989     true motion     closed form
extreme 1                        0.793818222     0.793829171     0.793829171
extreme 2                       -0.443579942    -0.443584361    -0.443584361
extreme 3                        0.203231245     0.203231680     0.203231680
at rest at theta =              -0.038261161    -0.038291587    -0.038291587
from t/T0 =                                      1.733933195     1.733933195
1501 rows, t 0 … 3; 4 events (3 turns, 1 rest); at rest; peak |theta| 0.794
from turn to turn, in T0                         0.503578299     0.503578299
zeta, gamma from extremes                        0.119000000     0.060000000
fig26.svg
]]
