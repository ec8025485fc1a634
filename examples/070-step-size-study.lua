-- 070: what a step size buys. The error against a closed form, for rk4 and for the program of 1989; and without steps.
--
-- Free motion with dry friction, theta0 = 0, velocity0 = 2 pi: arcs of circles in the phase plane, about +gamma and
-- -gamma by turns, until a turn falls within gamma of the middle (figure 22 of the report).

local sys = nondimensional{ friction_ratio = 0.167 }
local start = 2 * math.pi

local function error_of(method)
  local run = sys:simulate{ velocity0 = start, t_end = 2.5, dt = 0.1, integrator = method }
  return (run.theta - theory.free_response{ system = sys, velocity0 = start, t = run.t }):abs():max()
end

print "       h     rk4      order   dinal1989  order"
local before
for _, h in ipairs{ 0.05, 0.025, 0.0125, 0.00625, 0.003125 } do
  local now = { error_of(integrator.rk4{ h = h }), error_of(integrator.dinal1989{ h = h }) }
  local order = { "", "" }
  for i = 1, 2 do
    if before then order[i] = string.format("%.1f", math.log(before[i] / now[i], 2)) end
  end
  print(string.format("%8.6f  %.1e  %5s   %.1e  %6s", h, now[1], order[1], now[2], order[2]))
  before = now
end
-- The listing is RK4, too; but it lets a step run across the change of sign of the friction, and stops at the nearest
-- row instead of at velocity zero. That leaves it order 1 (with luck and bad luck by turns). rk4 ends its step exactly
-- there, so order 4 holds through every turn and into the final stop.

-- The default has no step to choose. Its panels end at the events, and on each the motion is right to rounding.
print("spectral: error below 1e-13: " .. tostring(error_of(integrator.spectral{}) < 1e-13))

--[[ prints
       h     rk4      order   dinal1989  order
0.050000  1.8e-04          9.9e-03
0.025000  1.1e-05    4.0   8.3e-03     0.3
0.012500  6.9e-07    4.0   4.0e-03     1.1
0.006250  4.3e-08    4.0   1.8e-03     1.1
0.003125  2.7e-09    4.0   1.7e-03     0.1
spectral: error below 1e-13: true
]]
