-- 262: a clutch that closes, a drive with two masses behind it: how long it slips, and how hot it gets.

print "closing time   locked at   heat of the clutch   twist of the shaft"
for _, closing in ipairs{ 0.1, 0.5, 1, 2 } do
  local rig = system{
    bodies = { engine = { I = 0.2 }, gearbox = { I = 0.05 }, car = { I = 1.5, Rd = 1 } },
    links = { clutch = { "engine", "gearbox", Rd = 40, Re = 44, normal = function(t) return math.min(t / closing, 1) end },
      shaft = { "gearbox", "car", k = 400, C = 1 } } }
  local run = rig:simulate{ velocity0 = { engine = 100 }, t_end = 4, dt = 0.002, states = { heat = {
    rate = function(t, theta, velocity)
      local slip = velocity.engine - velocity.gearbox
      return 40 * math.min(t / closing, 1) * math.abs(slip)
    end } } }
  local locked
  for _, e in ipairs(run.events) do
    if e.kind == "stick" and e.where == "clutch" then locked = locked or e.t end
  end
  print(string.format("%12.1f %11.5f %20.2f %20.5f", closing, locked, run.states.heat[#run], run.shaft.theta:max()))
end

--[[ prints
closing time   locked at   heat of the clutch   twist of the shaft
         0.1     0.49431               886.71              0.10846
         0.5     0.69478               888.80              0.09860
         1.0     0.94348               891.02              0.09117
         2.0     1.33624               894.76              0.06460
]]
