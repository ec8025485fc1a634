-- 268: backlash in a gear: two wheels with a gap of 2 x 0.01 rad between their teeth. The driven one rattles when the torque
-- turns round.

local rig = system{
  bodies = { driver = { I = 0.1, C = 0.05 }, driven = { I = 0.2, Rd = 0.3, Re = 0.4 } },
  links = { teeth = { "driver", "driven", walls = { lower = -0.01, upper = 0.01, restitution = 0.4 } } } }
local run = rig:simulate{ M = { driver = excitation.square{ amplitude = 1, period = 2 } }, t_end = 4 }
local impacts = run.events:filter(function(e) return e.kind == "impact" end)
print(run)
print(string.format("%d impacts, the hardest at %.3f rad per time unit", #impacts, math.max(impacts.velocity:max(), -impacts.velocity:min())))

--[[ prints
2 bodies, 1001 rows, t 0 … 4; 79 events (6 turns, 4 sticks, 4 slips, 65 impacts); moving at the end
65 impacts, the hardest at 0.612 rad per time unit
]]
