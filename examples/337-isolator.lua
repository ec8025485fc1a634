-- 337: an isolator of wire rope under a shaking floor: the harder the floor shakes, the softer the rope, and the more it damps.

local rope = {}
for i = 1, 3 do rope[i] = friction.jenkins{ stiffness = 2, Rd = 0.2 * i } end
local isolator = system{ I = 1, k = 1, friction = rope }

print "floor moves by   greatest deflection of the rope   at frequency   ratio"
for _, floor in ipairs{ 0.05, 0.2, 0.5 } do
  local c = isolator:response{ over = { omega = vector.linspace(1, 3, 21) }, at = function(p)
    return { base = floor * p.omega^2 * excitation.harmonic{ omega = p.omega } }
  end }
  local best = c.amplitude:argmax()
  print(string.format("%14.2f %33.4f %14.4f %7.2f", floor, c.amplitude[best], c.omega[best] / (2 * math.pi), c.amplitude[best] / floor))
end
-- With all strands held the rope is a spring of 7, with all of them slipping of 1.
print(string.format("natural frequencies: %.4f held, %.4f slipping", math.sqrt(7) / (2 * math.pi), 1 / (2 * math.pi)))

--[[ prints
floor moves by   greatest deflection of the rope   at frequency   ratio
          0.05                            0.2584         0.3820    5.17
          0.20                            0.4696         0.3342    2.35
          0.50                            0.9422         0.2706    1.88
natural frequencies: 0.4211 held, 0.1592 slipping
]]
