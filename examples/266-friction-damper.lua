-- 266: a friction damper between a machine and a second mass. Too little friction takes no energy, too much glues the two
-- together; the best slip torque lies between.

local function amplitude(Rd)
  local rig = system{
    bodies = { machine = { I = 1, k = 1, C = 0.01 }, damper = { I = 0.1 } },
    links = { joint = { "machine", "damper", Rd = Rd } } }
  local run = rig:simulate{ M = { machine = excitation.harmonic{ amplitude = 0.1, omega = 0.976 } }, t_end = 400, times = vector.linspace(350, 400, 2001) }
  return run.machine.theta:max()
end
print "slip torque   amplitude of the machine"
for _, Rd in ipairs{ 0.001, 0.01, 0.02, 0.04, 0.08, 1 } do print(string.format("%11.3f %12.5f", Rd, amplitude(Rd))) end

--[[ prints
slip torque   amplitude of the machine
      0.001      2.32921
      0.010      2.15772
      0.020      2.04452
      0.040      1.94966
      0.080      2.02243
      1.000      2.36176
]]
