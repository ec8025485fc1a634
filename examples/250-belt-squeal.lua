-- 250: a mass on a belt, held by a spring, under Stribeck's friction: stuck, it goes with the belt; it lets go, and
-- catches up again. On a fast belt it stands still and trembles no more.

local sys = system{ I = 1, k = 4, C = 0.1, friction = friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 } }
print "belt     period   amplitude   stuck   work of the belt = damping + friction"
for _, belt in ipairs{ 0.02, 0.1, 0.3, 0.6 } do
  local s = sys:steady{ belt = belt }
  if s.status == "rest" then
    print(string.format("%4.2f   rests at %.4f", belt, s.mean))
  else
    local energy = s.run:energy().total -- of one period, which stores nothing
    print(string.format("%4.2f %10.4f %11.4f %5.0f %%   %.5f = %.5f + %.5f", belt, s.period, s.amplitude, 100*s.stuck,
      energy.belt, energy.viscous, energy.dry))
  end
end

--[[ prints
belt     period   amplitude   stuck   work of the belt = damping + friction
0.02     6.5556      0.0438    59 %   0.06259 = 0.00071 + 0.06189
0.10     4.1216      0.1131    42 %   0.13813 = 0.00617 + 0.13196
0.30   rests at 0.0750
0.60   rests at 0.0750
]]
