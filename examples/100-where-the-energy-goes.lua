-- 100: where the energy goes. What M puts in is what the two frictions take out, in total and for each half cycle.

local sys = nondimensional{ zeta = 0.119, friction_ratio = 0.418 } -- figure 27 of the report
local run = sys:simulate{ M = excitation.harmonic{ frequency = 1 }, theta0 = 1, t_end = 40, dt = 0.01 }

-- Integrated over the motion itself, not summed over rows: dt does not matter.
local energy = run:energy()
local total = energy.total
print(string.format("40 periods: M put in %.4f, dry friction took %.4f, viscous damping %.4f, the rest is stored",
  total.input, total.dry, total.viscous))
print("what does not add up is less than 1e-12 of what flowed: " .. tostring(total.closure < 1e-12))
print()

-- From one velocity zero to the next. The first half cycles still gain; then M puts in exactly what is lost.
local half_cycles = energy.half_cycles
print("half cycle     input       dry   viscous    stored")
for _, i in ipairs{ 1, 2, 3, 4, 10, 20 } do
  local half = half_cycles[i]
  print(string.format("%10d %9.4f %9.4f %9.4f %9.4f", i, half.input, half.dry, half.viscous,
    half.kinetic + half.spring))
end
print()

-- One period is two half cycles. Friction is constant and the way is 4 X, whatever the curve looks like: 4 Rd X is
-- exact. The damper's pi C omega X^2 is that of a sinusoid, which the motion is not quite.
local a, b = half_cycles[#half_cycles - 2], half_cycles[#half_cycles - 1]
local X = math.abs(b.theta_end - b.theta_start) / 2
print(string.format("amplitude X      %8.4f", X))
print(string.format("dry friction     %8.4f   4 Rd X          %8.4f", a.dry + b.dry, 4 * sys.Rd * X))
print(string.format("viscous damping  %8.4f   pi C omega X^2  %8.4f", a.viscous + b.viscous,
  math.pi * sys.C * 2 * math.pi * X^2))

-- Columns stand beside run.t: here the power of dry friction at its greatest, from one row to the next.
local power = 0
for i = 2, #run do
  power = math.max(power, (energy.dry[i] - energy.dry[i - 1]) / (run.t[i] - run.t[i - 1]))
end
print(string.format("most power lost to dry friction %.2f, Rd |velocity| at its greatest %.2f", power,
  sys.Rd * run.velocity:abs():max()))

--[[ prints
40 periods: M put in 239.4355, dry friction took 127.1505, viscous damping 110.8623, the rest is stored
what does not add up is less than 1e-12 of what flowed: true

half cycle     input       dry   viscous    stored
         1   -0.0543    0.0454    0.0030   -0.1028
         2    1.6496    0.8829    0.4189    0.3479
         3    2.1091    1.1178    0.6801    0.3112
         4    2.4184    1.2819    0.8918    0.2448
        10    3.0196    1.6024    1.3854    0.0318
        20    3.0875    1.6386    1.4481    0.0007

amplitude X        1.9611
dry friction       3.2790   4 Rd X            3.2790
viscous damping    2.8993   pi C omega X^2    2.8756
most power lost to dry friction 5.21, Rd |velocity| at its greatest 5.21
]]
