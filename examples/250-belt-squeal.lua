-- 250: a mass on a belt, held by a spring, under Stribeck's friction: stuck, it goes with the belt; it lets go, and
-- catches up again. On a fast belt it stands still and trembles no more.

local sys = system{ I = 1, k = 4, C = 0.1, friction = friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 } }
print "belt    amplitude   stuck   work of the belt = damping + friction"
for _, belt in ipairs{ 0.02, 0.1, 0.3, 0.6 } do
  local run = sys:simulate{ belt = belt, t_end = 200, dt = 0.05 }
  local late = run.theta[run.t:find(function(t) return t > 150 end)]
  local stuck, since = 0, nil
  for _, e in ipairs(run.events) do
    if e.kind == "stick" then since = e.t end
    if e.kind == "slip" and since and since > 150 then stuck = stuck + e.t - since end
  end
  local energy = run:energy().total
  print(string.format("%4.2f %11.4f %6.0f %%   %8.4f = %.4f + %.4f + what is stored", belt, (late:max() - late:min())/2,
    100*stuck/50, energy.belt, energy.viscous, energy.dry))
end

--[[ prints
belt    amplitude   stuck   work of the belt = damping + friction
0.02      0.0438     54 %     1.8856 = 0.0213 + 1.8502 + what is stored
0.10      0.1131     42 %     6.7188 = 0.2978 + 6.3468 + what is stored
0.30      0.0001      0 %    18.0224 = 0.0194 + 17.9918 + what is stored
0.60      0.0000      0 %    36.0000 = 0.0112 + 35.9775 + what is stored
]]
