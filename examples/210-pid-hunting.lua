-- 210: a PID controller and dry friction. The integral is a state of the run; while the block sticks short of its goal
-- it goes on growing, until it breaks the block loose and throws it past the goal: hunting.

local Rd = 0.3
local function block(Re) return system{ I = 1, k = 0, Rd = Rd, Re = Re } end
local controller = { M = function(t, theta, velocity, z) return 8*(1 - theta) - 2*velocity + 3*z.e end,
  states = { e = { start = 0, rate = function(t, theta) return 1 - theta end } } }

-- Nothing depends on the time, so the cycle has a period of its own, and steady finds it.
print "  Re   misses the goal by   hunts with a period of"
for _, Re in ipairs{ 0.3, 0.4, 0.5, 0.6 } do
  local s = block(Re):steady(controller)
  print(s.status == "steady" and string.format("%4.1f %20.4f %24.2f", Re, s.amplitude, s.period)
    or string.format("%4.1f   comes to rest", Re))
end

-- Without the integral it does not hunt; it stays short of the goal, anywhere within Re/8.
local s = block(0.5):steady{ M = function(t, theta, velocity) return 8*(1 - theta) - 2*velocity end }
print(string.format("without the integral: %s at %.4f", s.status, s.mean))

--[[ prints
  Re   misses the goal by   hunts with a period of
 0.3   comes to rest
 0.4               0.0086                    53.27
 0.5               0.0173                    30.09
 0.6               0.0259                    22.36
without the integral: rest at 0.9708
]]
