-- 334: a ratchet: a lever that swings to and fro turns a flywheel in one direction only, through a freewheel.

-- A freewheel turns forward and holds backward: the wheel may run ahead of the lever, and is never behind it.
local rig = system{
  bodies = { lever = { theta = function(t) return 0.3 * math.sin(6 * t) end }, wheel = { I = 2, C = 0.05, Rd = 0.3 } },
  links = { pawl = { "wheel", "lever", friction = friction.freewheel{ Rd = 0.02 } } } }
local run = rig:simulate{ t_end = 30 }
print(run)
local caught = run.pawl.events:filter(function(e) return e.kind == "stick" end)
print(string.format("the pawl catches %d times; the wheel turns at %.3f at most, as the lever does, and has turned %.1f times round",
  #caught, run.wheel.velocity:max(), run.wheel.theta[#run] / (2 * math.pi)))
local needed = run.lever.torque
print(string.format("what swings the lever needs between %.2f and %.2f", needed:min(), needed:max()))

--[[ prints
2 bodies, 1001 rows, t 0 … 30; 57 events (28 sticks, 29 slips); moving at the end
the pawl catches 28 times; the wheel turns at 1.800 at most, as the lever does, and has turned 7.9 times round
what swings the lever needs between -0.02 and 10.12
]]
