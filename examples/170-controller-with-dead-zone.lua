-- 170: a controller with a dead zone. A motor turns a flap to 30 degrees. Near enough is good enough: within the dead
-- zone it stays quiet, lest it hum for ever about the last tenth. Its law has corners and jumps that depend on where
-- the flap is, not on the time; they are found as those of M(t) are.

local degree = math.pi / 180
local target = 30 * degree
local flap = system{ I = 0.01, k = 0.05, Rd = 0.02, Re = 0.03 } -- kg m^2, N m/rad, N m

-- A torque proportional to what the error has beyond the zone, a brake on the velocity, and what the spring needs.
local gain, brake = 2, 0.05
local function proportional(zone)
  return function(t, theta, velocity)
    local e = target - theta
    local beyond = e > zone and e - zone or e < -zone and e + zone or 0
    return flap.k * target + gain * beyond - brake * velocity
  end
end

print "zone, degrees   turns   stuck from, s   off by   at most   (degrees)"
for _, zone in ipairs{ 0, 1, 2, 5 } do
  local run = flap:simulate{ M = proportional(zone * degree), t_end = 20, times = {} }
  local rest = run.events[#run.events]
  assert(rest.kind == "stick")
  -- it stays where k e + gain (e - zone) is within Re
  local bound = (flap.Re + gain * zone * degree) / (gain + flap.k) / degree
  print(string.format("%13d %7d %15.6f %+8.3f %9.3f", zone, #run.events - 1, rest.t,
    (target - rest.theta) / degree, bound))
end

-- On or off: full torque outside of 2 degrees, nothing inside. The motor looks ahead by `lead` seconds: it judges the
-- angle that the flap will have then. `slope` is the width over which it goes from off to on.
local function on_off(lead, slope)
  return function(t, theta, velocity)
    local e = target - (theta + lead * velocity)
    local beyond = math.max(0, math.abs(e) - 2 * degree)
    local torque = slope > 0 and math.min(1, beyond / slope) or beyond > 0 and 1 or 0
    return e > 0 and 0.2 * torque or -0.2 * torque
  end
end
print "\nlead, s   slope, degrees   turns   ends at, s  off by   outcome"
for _, case in ipairs{ { 0, 0 }, { 0.05, 0 }, { 0.05, 1 } } do
  local lead, slope = case[1], case[2]
  local run = flap:simulate{ M = on_off(lead, slope * degree), t_end = 20, dt = 0.01 }
  local turns, rest = 0
  for _, event in ipairs(run.events) do
    if event.kind == "turn" then turns = turns + 1 end
    if event.kind == "stick" then rest = event end
  end
  print(string.format("%7.2f %16.1f %7d %12.1f %+7.3f   %s", lead, slope, turns, rest and rest.t or run.t[#run],
    (target - run.theta[#run]) / degree, run.outcome))
end
-- Blind to the velocity, only friction stops it. Looking ahead with a bare switch it slides along the edge of what it
-- foresees, on and off endlessly: M is the mixture of both that keeps it there, until it has come to the edge of the
-- zone. One degree from off to on stops it sooner.

--[[ prints
zone, degrees   turns   stuck from, s   off by   at most   (degrees)
            0       4        1.114208   +0.080     0.838
            1       3        0.980298   -0.195     1.814
            2       2        0.808696   -2.739     2.790
            5       2        0.860228   +4.826     5.717

lead, s   slope, degrees   turns   ends at, s  off by   outcome
   0.00              0.0      12          3.3  -1.171   stuck at the end
   0.05              0.0       1          2.5  +2.000   stuck at the end
   0.05              1.0       1          0.6  +2.046   stuck at the end
]]
