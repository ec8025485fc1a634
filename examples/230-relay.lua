-- 230: a thermostat is a relay with hysteresis; here it drives an oscillator into a limit cycle. Each switch is an event.

local sys = system{ I = 1, k = 1, C = 0.2, Rd = 0.02, Re = 0.03 }
print "hysteresis   period   amplitude"
for _, width in ipairs{ 0.05, 0.2, 0.5 } do
  local M = excitation.relay{ on = -width/2, off = width/2, amplitude = 0.4 }
  local s = sys:steady{ M = M }
  print(string.format("%10.2f %8.4f %11.4f", width, s.period, s.amplitude))
end

--[[ prints
hysteresis   period   amplitude
      0.05   2.9877      0.1430
      0.20   4.1186      0.3631
      0.50   4.7869      0.6439
]]
