-- 263: the heat of a clutch that locks is the energy of the relative motion, I J/(I + J) w^2/2, however fast it closes,
-- as long as nothing else acts; with a load on the shaft it takes more.

local I, J, w = 0.2, 1.5, 100
print(string.format("energy of the relative motion: %.4f", I*J/(I + J)*w^2/2))
print "closing time   load   locked at       heat   closure"
for _, load in ipairs{ 0, 5 } do
  for _, closing in ipairs{ 0.1, 1 } do
    local rig = system{
      bodies = { engine = { I = I }, car = { I = J } },
      links = { clutch = { "engine", "car", Rd = 40, normal = function(t) return math.min(t/closing, 1) end } } }
    local run = rig:simulate{ velocity0 = { engine = w }, M = { car = -load }, t_end = 4 }
    local energy = run:energy()
    print(string.format("%12.1f %6.0f %11.5f %10.4f   %s", closing, load, run.events.t[1], energy.clutch.dry,
      energy.total.closure < 1e-11 and "< 1e-11" or energy.total.closure))
  end
end

--[[ prints
energy of the relative motion: 882.3529
closing time   load   locked at       heat   closure
         0.1      0     0.49118   882.3529   < 1e-11
         1.0      0     0.93934   882.3529   < 1e-11
         0.1      5     0.49851   898.4544   < 1e-11
         1.0      5     0.95416   920.0684   < 1e-11
]]
