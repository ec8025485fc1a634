-- 050: feedback. An M with more than one parameter is M(t, theta, velocity): a control law.

local sys = system{ I = 1, k = 4 * math.pi^2, C = 0.25 } -- T0 = 1, zeta = 0.02: rings for long
local gain = 2.5

local function damper(t, theta, velocity)
  return -gain * velocity
end
-- A real motor has a largest torque.
local limit = 2
local function small_motor(t, theta, velocity)
  return math.max(-limit, math.min(limit, -gain * velocity))
end

local options = { theta0 = 1, t_end = 4, dt = 0.5 }
local function with(M)
  options.M = M
  return sys:simulate(options)
end
local alone, damped, limited = with(nil), with(damper), with(small_motor)

-- The ideal motor is the same as a stiffer dashpot: C + gain.
local dashpot = system{ I = sys.I, k = sys.k, C = sys.C + gain }
local same = dashpot:simulate{ theta0 = 1, t_end = 4, dt = 0.5 }

print "  t     alone    damper   C + gain   small motor"
for i = 1, #alone do
  print(string.format("%4.1f  %+.5f  %+.5f  %+.5f    %+.5f", alone.t[i], alone.theta[i], damped.theta[i], same.theta[i],
    limited.theta[i]))
end
print(string.format("damper against C + gain, largest difference below 1e-12: %s",
  (damped.theta - same.theta):abs():max() < 1e-12))
print(string.format("zeta %.3f -> %.3f", sys.zeta, dashpot.zeta))
-- The small motor takes off about the same amount each cycle at first, as dry friction does, and a fixed part of what
-- is left only when the motion has become small.

--[[ prints
  t     alone    damper   C + gain   small motor
 0.0  +1.00000  +1.00000  +1.00000    +1.00000
 0.5  -0.93940  -0.49280  -0.49280    -0.84147
 1.0  +0.88247  +0.24131  +0.24131    +0.69268
 1.5  -0.82900  -0.11738  -0.11738    -0.55314
 2.0  +0.77876  +0.05669  +0.05669    +0.42250
 2.5  -0.73157  -0.02716  -0.02716    -0.30072
 3.0  +0.68723  +0.01291  +0.01291    +0.18891
 3.5  -0.64559  -0.00607  -0.00607    -0.09505
 4.0  +0.60646  +0.00283  +0.00283    +0.04643
damper against C + gain, largest difference below 1e-12: true
zeta 0.020 -> 0.219
]]
