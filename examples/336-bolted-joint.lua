-- 336: a bolted joint as Iwan's model, sliders behind springs that let go one after another: its damping grows with the amplitude.

-- Eight Jenkins elements of one stiffness, with limits that are spread evenly.
local elements, stiffness, n = {}, 2.5, 8
for i = 1, n do elements[i] = friction.jenkins{ stiffness = stiffness, Rd = 0.1 * i } end
local joint = system{ I = 1, k = 10, friction = elements }

-- Masing's rule: in a cycle of the amplitude X each element that slips loses 4 Rd (X - Rd/k).
local function loss(X)
  local sum = 0
  for i = 1, n do sum = sum + math.max(0, 4 * 0.1 * i * (X - 0.1 * i / stiffness)) end
  return sum
end

print "amplitude of M   amplitude   lost in a period   by Masing's rule"
for _, M0 in ipairs{ 0.5, 2, 4 } do
  local T = math.pi / 3
  local run = joint:simulate{ M = excitation.harmonic{ amplitude = M0, period = T }, t_end = 60 * T }
  local last = joint:simulate{ M = excitation.harmonic{ amplitude = M0, period = T }, t_end = 59 * T }:energy().total.dry
  local cycle = run:cycle()
  print(string.format("%14.1f %11.5f %18.6f %18.6f", M0, cycle.amplitude, run:energy().total.dry - last, loss(cycle.amplitude)))
end

--[[ prints
amplitude of M   amplitude   lost in a period   by Masing's rule
           0.5     0.07038           0.012145           0.012151
           2.0     0.18489           0.259540           0.259540
           4.0     0.28373           0.937756           0.937756
]]
