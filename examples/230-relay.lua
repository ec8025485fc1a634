-- 230: a thermostat is a relay with hysteresis; here it drives an oscillator into a limit cycle. Each switch is an event.

local sys = system{ I = 1, k = 1, C = 0.2, Rd = 0.02, Re = 0.03 }
print "hysteresis   switches   period   amplitude"
for _, width in ipairs{ 0.05, 0.2, 0.5 } do
  local M = excitation.relay{ on = -width/2, off = width/2, levels = { 0.4, -0.4 } }
  local run = sys:simulate{ M = M, t_end = 200, dt = 0.05 }
  local switches = run.events:filter(function(e) return e.kind == "switch" end)
  local n = #switches
  local late = run.theta[run.t:find(function(t) return t > 150 end)]
  print(string.format("%10.2f %10d %8.4f %11.4f", width, n, switches[n].t - switches[n - 2].t, (late:max() - late:min())/2))
end

--[[ prints
hysteresis   switches   period   amplitude
      0.05        135   2.9877      0.1430
      0.20         98   4.1186      0.3631
      0.50         84   4.7869      0.6439
]]
