-- 240: a dead time. A damper that acts on what was measured a while ago feeds the swing when it is late by more than a
-- quarter of the period.

local sys = nondimensional{ zeta = 0.01, friction_ratio = 0.02 }
print "late by, T0   after 20 T0"
for _, late in ipairs{ 0.01, 0.1, 0.2, 0.25, 0.3 } do
  local M = excitation.delayed(function(t, theta, velocity) return -0.03*velocity end, { by = late })
  local run = sys:simulate{ M = M, theta0 = 1, t_end = 20, dt = 0.01 }
  local last = run.theta[run.t:find(function(t) return t > 19 end)]
  print(string.format("%11.2f   %s", late, run.outcome == "stuck at the end" and "stuck" or string.format("amplitude %.3f", last:abs():max())))
end

--[[ prints
late by, T0   after 20 T0
       0.01   stuck
       0.10   stuck
       0.20   stuck
       0.25   stuck
       0.30   amplitude 28.201
]]
