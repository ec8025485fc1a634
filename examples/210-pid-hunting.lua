-- 210: a PID controller and dry friction. The integral is a state of the run; while the block sticks short of its goal
-- it goes on growing, until it breaks the block loose and throws it past the goal: hunting.

local Rd = 0.3
local function controlled(Re, Ki)
  local block = system{ I = 1, k = 0, Rd = Rd, Re = Re }
  return block:simulate{
    M = function(t, theta, velocity, z) return 8*(1 - theta) - 2*velocity + Ki*z.e end,
    states = { e = { start = 0, rate = function(t, theta) return 1 - theta end } },
    t_end = 2000, dt = 0.5, -- the cycle itself, long after the start is forgotten: after 200 it is still changing
  }
end

-- The farther of the last two stops, one on each side of the goal, and the time between the last two stops on one side.
-- The two stops before them must give the same period: then the run has reached its cycle.
local function hunting(run)
  local stops = run.events:filter(function(e) return e.kind == "stick" or e.kind == "rest" end)
  local n = #stops
  if n < 4 then return nil end
  local period = stops[n].t - stops[n - 2].t
  assert(math.abs(period - (stops[n - 1].t - stops[n - 3].t)) < 1e-6, "the hunting is still changing: choose a later t_end")
  return math.max(stops[n].theta, stops[n - 1].theta) - 1, period
end

print "  Re   misses the goal by   hunts with a period of"
for _, Re in ipairs{ 0.3, 0.4, 0.5, 0.6 } do
  local miss, period = hunting(controlled(Re, 3))
  print(miss and string.format("%4.1f %20.4f %24.2f", Re, miss, period) or string.format("%4.1f   comes to rest", Re))
end

-- Without the integral it does not hunt; it stays short of the goal, anywhere within Re/8.
local run = controlled(0.5, 0)
print(string.format("without the integral: %s at %.4f", run.outcome, (run:at(2000))))

--[[ prints
  Re   misses the goal by   hunts with a period of
 0.3   comes to rest
 0.4               0.0086                    53.27
 0.5               0.0173                    30.09
 0.6               0.0259                    22.36
without the integral: stuck at the end at 0.9708
]]
