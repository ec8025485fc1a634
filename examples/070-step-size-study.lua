-- 070: what a step size buys. The error against a closed form, for rk4 and for the program of 1989.
--
-- Free motion with dry friction, theta0 = 0, velocity0 = 2 pi: arcs of circles in the phase plane, about +gamma and
-- -gamma by turns, until a turn falls within gamma of the middle (figure 22 of the report).

local gamma = 0.167
local sys = nondimensional{ friction_ratio = gamma }

local function exact(t)
  local A, phi = math.sqrt(1 + gamma^2), math.atan(1, gamma)
  local start, X = phi / (2 * math.pi), A - gamma -- the first turn
  if t < start then return -gamma + A * math.cos(2 * math.pi * t - phi) end
  while math.abs(X) > gamma do
    local centre = X > 0 and gamma or -gamma
    if t < start + 0.5 then return centre + (X - centre) * math.cos(2 * math.pi * (t - start)) end
    start, X = start + 0.5, 2 * centre - X
  end
  return X -- at rest for good
end

local function error_of(method)
  local run = sys:simulate{ velocity0 = 2 * math.pi, t_end = 2.5, dt = 0.1, integrator = method }
  local worst = 0
  for i = 1, #run do
    worst = math.max(worst, math.abs(run.theta[i] - exact(run.t[i])))
  end
  return worst
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

--[[ prints
       h     rk4      order   dinal1989  order
0.050000  1.8e-04          9.9e-03
0.025000  1.1e-05    4.0   8.3e-03     0.3
0.012500  6.8e-07    4.0   4.0e-03     1.1
0.006250  4.3e-08    4.0   1.8e-03     1.1
0.003125  2.7e-09    4.0   1.7e-03     0.1
]]
