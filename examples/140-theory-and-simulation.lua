-- 140: theory against simulation. Closed forms on numbers and on whole curves, and where each of them ends.

-- Free motion with both frictions: the half-cycle map knows every turn and the place of rest without a step.
local sys = nondimensional{ zeta = 0.119, friction_ratio = 0.06 }
local run = sys:simulate{ velocity0 = 2*math.pi, t_end = 3, dt = 0.01 }
local t, X = theory.extremes{ system = sys, velocity0 = 2*math.pi }
print "free motion   t theory    t run         theta theory  theta run"
for i, event in ipairs(run.events) do
  print(string.format("  %-6s %12.6f %10.6f %16.6f %12.6f", event.kind, t[i], event.t, X[i], event.theta))
end
local theta = theory.free_response{ system = sys, velocity0 = 2*math.pi, t = run.t } -- a vector in, a vector out
assert((theta - run.theta):abs():max() < 1e-12)

-- Three extremes, as one would read them off a record, give both frictions back.
print(string.format("from the first three: zeta = %.4f, Rd/k = %.4f",
  theory.identify{ X0 = X[1], X1 = X[2], X2 = X[3] }))

-- Steady motion under sin(2 pi r t): exact (Den Hartog), with friction taken for viscous, and simulated.
-- The amplitude is half of what lies between the extremes of two periods near the end.
local function simulated(r, gamma, zeta)
  local driven = nondimensional{ zeta = zeta, friction_ratio = gamma }
  local steady = driven:simulate{ M = excitation.harmonic{ frequency = r }, t_end = 60 / r, times = {} }
  local least, most, stops = math.huge, -math.huge, 0
  for _, event in ipairs(steady.events) do
    if 57.9 / r < event.t and event.t <= 59.9 / r then -- two periods
      least, most = math.min(least, event.theta), math.max(most, event.theta)
      if event.kind == "stick" then stops = stops + 1 end
    end
  end
  return (most - least) / 2, stops
end

local zeta, gamma = 0.05, 0.5
local r = vector{ 0.4, 0.6, 0.8, 1, 1.35, 2 }
local exact = theory.den_hartog{ r = r, friction_ratio = gamma, zeta = zeta } -- nan where the mass stops
local viscous = theory.linearised{ r = r, friction_ratio = gamma, zeta = zeta }
local boundary = theory.stop_boundary{ r = r, zeta = zeta }
print(string.format("\nzeta = %g, gamma = %g\n   r   simulated   Den Hartog  linearised  stops from gamma =",
  zeta, gamma))
for i = 1, #r do
  local amplitude, stops = simulated(r[i], gamma, zeta)
  local formula = exact[i] == exact[i] and string.format("%10.6f", exact[i]) or " it stops "
  print(string.format("%5.2f %10.6f  %s  %10.6f  %10.6f", r[i], amplitude, formula, viscous[i], boundary[i]))
  assert((stops > 0) == (gamma > boundary[i]))
end

-- Just below the boundary the mass turns without a stop, just above it stops.
print "\n   r   boundary   stops in 2 periods, 1 % below and 1 % above"
for _, x in ipairs{ 0.45, 0.7, 1, 1.5 } do
  local limit = theory.stop_boundary{ r = x, zeta = zeta }
  local _, below = simulated(x, 0.99 * limit, zeta)
  local _, above = simulated(x, 1.01 * limit, zeta)
  print(string.format("%5.2f %10.6f %4d %4d", x, limit, below, above))
end

-- Three limits for the step, one of them true.
local plain = nondimensional{ zeta = 0.02387 }
for _, rule in ipairs{ { "report", plain.zeta }, { "corrected", plain.zeta/math.pi }, { "rk4", theory.step_limit{ system = plain } } } do
  print(string.format("%-10s h < %.4f T0", rule[1], rule[2]))
end

--[[ prints
free motion   t theory    t run         theta theory  theta run
  turn       0.223198   0.223198         0.793829     0.793829
  turn       0.726777   0.726777        -0.443584    -0.443584
  turn       1.230355   1.230355         0.203232     0.203232
  rest       1.733933   1.733933        -0.038292    -0.038292
from the first three: zeta = 0.1190, Rd/k = 0.0600

zeta = 0.05, gamma = 0.5
   r   simulated   Den Hartog  linearised  stops from gamma =
 0.40   1.005938   it stops     0.881728    0.120921
 0.60   1.379055   it stops     1.110819    0.468804
 0.80   1.929322    1.929322    1.749934    0.729441
 1.00   3.631386    3.631386    3.633802    0.726207
 1.35   0.734178    0.734178    0.809748    0.644480
 2.00   0.206227    0.206227    0.242792    0.581053

   r   boundary   stops in 2 periods, 1 % below and 1 % above
 0.45   0.205966    0    4
 0.70   0.637763    0    4
 1.00   0.726207    0    4
 1.50   0.622173    0    4
report     h < 0.0239 T0
corrected  h < 0.0076 T0
rk4        h < 0.4573 T0
]]
