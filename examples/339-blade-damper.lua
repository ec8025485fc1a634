-- 339: a damper pressed against a turbine blade: the clamping force that leaves the lowest resonance.

-- The greatest amplitude over frequency; the damper is a spring of 0.4 that slips at Rd.
local function peak(Rd)
  local blade = system{ I = 1, k = 1, C = 0.02, friction = friction.jenkins{ stiffness = 0.4, Rd = Rd } }
  local c = blade:response{ over = { omega = vector.linspace(0.95, 1.25, 61) }, at = function(p)
    return { M = excitation.harmonic{ amplitude = 0.1, omega = p.omega } }
  end }
  return c.amplitude:max()
end

print "    Rd   peak"
for _, Rd in ipairs{ 0.01, 0.05, 0.1, 0.13, 0.15, 0.2, 0.5, 2 } do print(string.format("%6.2f %6.3f", Rd, peak(Rd))) end
-- A damper that never slips only makes the blade stiffer: the peak is about M0/(C omega).
print(string.format("without slip %.3f", 0.1 / (0.02 * math.sqrt(1.4))))

--[[ prints
    Rd   peak
  0.01  4.367
  0.05  2.004
  0.10  0.737
  0.13  0.671
  0.15  0.676
  0.20  0.743
  0.50  1.397
  2.00  4.154
without slip 4.226
]]
