-- 160: a square wave with sticking. Thousands of edges, a stop after each, and a map from stop to stop to check them.
--
-- The load is switched between +A and -A so slowly that the mass has come to rest before it is switched again. So each
-- half period is a free motion about A/k or -A/k, from the place where the mass stood.

local sys = nondimensional{ zeta = 0.01, friction_ratio = 0.1, breakaway_ratio = 0.15 }
local edges, half = 2000, 12.3

local function simulated(A)
  local run = sys:simulate{
    M = excitation.square{ amplitude = A, period = 2 * half },
    t_end = edges * half,
    times = {}, -- no rows: events say it all
  }
  local stops, turns = {}, 0
  for _, event in ipairs(run.events) do
    if event.kind == "stick" or event.kind == "rest" then stops[#stops + 1] = event.theta end
    if event.kind == "turn" then turns = turns + 1 end
  end
  return stops, turns
end

-- Where it stops, from where it stood, by the half-cycle map: no steps, no integration.
local function next_stop(theta, level)
  return level / sys.k + theory.rest_position{ system = sys, theta0 = theta - level / sys.k }
end

print "   A    stops   turns a stop   the last two stops    by the map            largest difference < 1e-11"
for _, A in ipairs{ 0.1, 0.2, 0.4, 0.8, 1.2 } do
  local stops, turns = simulated(A)
  local theta, before, worst = 0, 0, 0
  for i = 1, #stops do
    before, theta = theta, next_stop(theta, i % 2 == 1 and A or -A)
    worst = math.max(worst, math.abs(stops[i] - theta))
  end
  local last, last_but_one = stops[#stops] or 0, stops[#stops - 1] or 0
  print(string.format("%5.1f %6d %10.2f %14.6f %10.6f %11.6f %10.6f   %s", A, #stops, turns / math.max(1, #stops),
    last_but_one, last, before, theta, worst < 1e-11))
end
-- Below Re = 0.15 nothing moves. Above it the mass soon does the same for ever: damping makes it forget its beginning.

--[[ prints
   A    stops   turns a stop   the last two stops    by the map            largest difference < 1e-11
  0.1      0       0.00       0.000000   0.000000    0.000000   0.000000   true
  0.2   2000       1.00       0.206232  -0.206232    0.206232  -0.206232   true
  0.4   2000       3.00       0.424608  -0.424608    0.424608  -0.424608   true
  0.8   2000       6.00       0.938187  -0.938187    0.938187  -0.938187   true
  1.2   2000       9.00       1.178906  -1.178906    1.178906  -1.178906   true
]]
