-- 172: conditions on the motion. dinal reads a function that is a formula, and locates each change of its conditions,
-- also of those on theta and velocity: the place is exact, and no visit beyond a condition is too short.

local mass = system{ I = 1, k = 0 }

-- Bang-bang: the torque always points back to theta = 0. From rest at A the period is 4 sqrt(2 A/a).
local A, a = 0.5, 1
local run = mass:simulate{ M = function(t, theta) return theta > 0 and -a or a end, theta0 = A, t_end = 100, dt = 1 }
local T = 4 * math.sqrt(2 * A / a)
print(string.format("bang-bang:  off by less than 1e-12 after %d periods: %s", 100 // T,
  math.abs(run:at(100 // T * T) - A) < 1e-12))

-- A clearance: between -0.2 and 0.2 nothing acts, beyond it a spring does. Its period at speed v is known, too.
local gap, k, v = 0.2, 9, 1
local function clearance(t, theta)
  return -k * (math.max(theta - gap, 0) + math.min(theta + gap, 0))
end
run = mass:simulate{ M = clearance, velocity0 = v, t_end = 100, dt = 1 }
T = 4 * gap / v + 2 * math.pi / math.sqrt(k)
print(string.format("clearance:  off by less than 1e-12 after %d periods: %s", 100 // T,
  math.abs(run:at(100 // T * T)) < 1e-12))

-- A trip at 0.999 of the greatest angle: the mass is beyond it for 1.4 % of a period only, and the trip pushes it far away.
local pendulum = system{ I = 1, k = 1 }
local function trip(t, theta)
  return theta > 0.999 and 100 or 0
end
run = pendulum:simulate{ M = trip, velocity0 = 1, t_end = 4, dt = 0.01 }
print(string.format("trip:       largest angle %.6f", run.theta:max()))
print(run:explain():match "M is read[^.]*%.")

--[[ prints
bang-bang:  off by less than 1e-12 after 25 periods: true
clearance:  off by less than 1e-12 after 34 periods: true
trip:       largest angle 177.770219
M is read as a formula: the times at which its conditions change, also those on
theta, velocity or states, are located.
]]
