-- 010: a free decay. One push, the turns that follow, and the damping read back from them.

local sys = system{ I = 0.02, k = 8, C = 0.08 } -- kg m^2, N m/rad, N m s/rad
print(string.format("omega0 = %.1f rad/s, T0 = %.4f s, zeta = %.3f: %s", sys.omega0, sys.T0, sys.zeta, sys.regime))

local run = sys:simulate{ velocity0 = 2, t_end = 2, dt = 0.01 } -- no M: nobody pushes after the start
print(run)

-- At a turn the velocity is zero and theta at an extreme. Turns are located, not read off the rows, so they need no
-- fine dt.
print "turn      t, s   theta, rad"
for i = 1, 4 do
  local turn = run.events[i]
  print(string.format("%4d  %8.5f   %+10.7f", i, turn.t, turn.theta))
end

-- Without dry friction each extreme is exp(-pi zeta / sqrt(1 - zeta^2)) times the one before, and half a period
-- pi / omega1 later.
local first, second = run.events[1], run.events[2]
local decrement = math.log(-first.theta / second.theta)
print(string.format("damping ratio from two extremes:    zeta = %.7f", decrement / math.sqrt(math.pi^2 + decrement^2)))
print(string.format("half a period between them:    pi/omega1 = %.7f s, not pi/omega0 = %.7f s",
  second.t - first.t, math.pi / sys.omega0))

--[[ prints
omega0 = 20.0 rad/s, T0 = 0.3142 s, zeta = 0.100: underdamped
201 rows, t 0 … 2; 13 events (13 turns); moving at the end; peak |theta| 0.086
turn      t, s   theta, rad
   1   0.07390   +0.0862600
   2   0.23177   -0.0629049
   3   0.38964   +0.0458733
   4   0.54751   -0.0334530
damping ratio from two extremes:    zeta = 0.1000000
half a period between them:    pi/omega1 = 0.1578710 s, not pi/omega0 = 0.1570796 s
]]
