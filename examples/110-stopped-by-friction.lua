-- 110: stopped by friction. A question from a newsgroup on MATLAB: a mass of 1 on a spring of 1, pushed off at 5, with
-- a dry friction of 10. It moves for half a second; the computation took "more than half an hour".
--
-- For a solver that knows no sticking, friction is the force -10 sgn(velocity). At velocity zero that jumps between +10
-- and -10, throws the mass to and fro, and the steps become as short as they may. Here standing still is a state of its
-- own: the mass stays as long as |M - k theta| <= Re.

local sys = system{ I = 1, k = 1, Rd = 10 }
local run = sys:simulate{ velocity0 = 5, t_end = 100, dt = 0.1 }
print(run)

-- Moving, the mass feels a constant -10: it swings about x = -10, and stops where that circle meets velocity zero.
local rest = run.events[1]
print(string.format("at rest from t = %.12f at x = %.12f", rest.t, rest.theta))
print(string.format("closed form  t = %.12f    x = %.12f", math.atan(1 / 2), math.sqrt(125) - 10))

-- "At rest" is no small number: the velocity is zero and x does not change in any digit.
local x, velocity = run:at(100)
print(string.format("at t = 100: moved since by %g, velocity %g", x - rest.theta, velocity))

-- The spring pulls back with 1.18, friction could hold 10. After a push of more than sqrt(300) the spring wins.
print "push    at rest from t     at x    turns   theory: t         x"
for _, push in ipairs{ 5, 15, 25, 35, 60 } do
  local events = sys:simulate{ velocity0 = push, t_end = 100, times = {} }.events
  local last = events[#events]
  print(string.format("%4d %14.6f %12.6f %5d %14.6f %10.6f", push, last.t, last.theta, #events - 1,
    theory.time_to_rest{ system = sys, velocity0 = push }, theory.rest_position{ system = sys, velocity0 = push }))
end

--[[ prints
1001 rows, t 0 … 100; 1 event (1 rest); at rest; peak |theta| 1.18
at rest from t = 0.463647609001 at x = 1.180339887499
closed form  t = 0.463647609001    x = 1.180339887499
at t = 100: moved since by 0, velocity 0
push    at rest from t     at x    turns   theory: t         x
   5       0.463648     1.180340     0       0.463648   1.180340
  15       0.982794     8.027756     0       0.982794   8.027756
  25       4.331883     3.074176     1       4.331883   3.074176
  35       4.434089    -6.400549     1       4.434089  -6.400549
  60      10.830426     9.172375     3      10.830426   9.172375
]]
