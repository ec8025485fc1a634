-- 284: a drill string: the bit sticks and slips while a motor on top turns evenly. The steady motion over the speed.

local function string_of(C)
  return system{
    bodies = { top = { I = 2 }, bit = { I = 0.1, C = C, friction = friction.stribeck{ Rd = 0.5, Re = 1, speed = 0.5 } } },
    links = { pipe = { "top", "bit", k = 1, C = 0.02 } } }
end
print "  speed      status    period    twist   stuck"
for _, speed in ipairs{ 0.5, 1, 1.5, 3 } do
  local s = string_of(0.02):steady{ M = { top = function(t, theta, velocity) return 20*(speed - velocity.top) end },
    velocity0 = { top = speed, bit = 0 } }
  print(string.format("%7.1f %11s %9s %8.5f %7.3f", speed, s.status,
    s.period and string.format("%.5f", s.period) or "none", s.pipe.amplitude, s.bit.stuck))
end

--[[ prints
  speed      status    period    twist   stuck
    0.5      steady   3.42498  0.54155   0.581
    1.0      steady   2.46439  0.63209   0.398
    1.5      steady   2.19364  0.72143   0.286
    3.0      steady   2.01726  1.02094   0.086
]]
