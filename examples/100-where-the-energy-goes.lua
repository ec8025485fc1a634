-- 100: where the energy goes. Steady motion, one period: what M puts in is what the two frictions take out.

local sys = nondimensional{ zeta = 0.119, friction_ratio = 0.418 } -- figure 27 of the report
local run = sys:simulate{
  M = excitation.harmonic{ frequency = 1 },
  theta0 = 1,
  t_end = 40,
  dt = 0.001,
}

-- The last period: 1000 rows, the last one not counted twice. Torque times velocity is power; its mean over a whole
-- period, times the period, is the work (the trapezoidal rule is at its best on periodic curves).
local function last_period(column)
  return column:slice(#column - 999, #column)
end
local function work(torque)
  local power = last_period(torque) * last_period(run.velocity)
  return power:mean() * 1
end

local input, dry, viscous = work(run.M), work(run.friction), work(run.damping)
local X = last_period(run.theta):abs():max()
print(string.format("amplitude X             %8.4f", X))
print(string.format("work of M               %8.4f", input))
print(string.format("work of dry friction    %8.4f   -4 Rd X          %8.4f", dry, -4 * sys.Rd * X))
print(string.format("work of viscous damping %8.4f   -pi C omega X^2  %8.4f (of a sinusoid)",
  viscous, -math.pi * sys.C * 2 * math.pi * X^2))
print(string.format("sum                     %8.4f", input + dry + viscous))
-- -4 Rd X is exact whatever the curve looks like: friction is constant and the way is 4 X.

--[[ prints
amplitude X               1.9611
work of M                 6.1783
work of dry friction     -3.2790   -4 Rd X           -3.2790
work of viscous damping  -2.8993   -pi C omega X^2   -2.8756 (of a sinusoid)
sum                       0.0000
]]
