-- Figure 26: free motion with both frictions, zeta = 0.119, gamma = 0.06, h = 0.002. The mass stays off centre.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

case.title(26, "free, zeta = 0.119, gamma = 0.06, h = 0.002")
local old, run, sys = case.run{ zeta = 0.119, gamma = 0.06, velocity0 = 1, t_end = 3, h = 0.002 }
local known_t, known = theory.extremes{ system = sys, velocity0 = sys.omega0 } -- the half-cycle map

case.head("1989", "true motion", "closed form")
local rough, extremes = case.row_extremes(old), case.extremes(run)
for i = 1, 3 do
  case.line("extreme " .. i, rough[i].theta, extremes[i].theta, known[i])
end
case.line("at rest at theta =", old.theta[#old], extremes[4].theta, known[4])
case.line("from t/T0 =", "", extremes[4].t, known_t[4] / sys.T0)
print(run)
case.save(26, old, run)

--[[ prints
Figure 26: free, zeta = 0.119, gamma = 0.06, h = 0.002
                                        1989     true motion     closed form
extreme 1                        0.793818222     0.793829171     0.793829171
extreme 2                       -0.443579942    -0.443584361    -0.443584361
extreme 3                        0.203231245     0.203231680     0.203231680
at rest at theta =              -0.038261161    -0.038291587    -0.038291587
from t/T0 =                                      1.733933195     1.733933195
1501 rows, t 0 … 3; 4 events (3 turns, 1 rest); at rest; peak |theta| 0.794
fig26.csv, fig26.dat: 1501 rows
]]
