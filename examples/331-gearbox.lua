-- 331: a gearbox of two gears, each with its clutch: how fast the second one closes decides how far the motor races, and the heat.

print "closing time   motor at most   locked at   heat of the clutch   speed of the car at the end"
for _, closing in ipairs{ 0.1, 0.5, 2 } do
  local gearbox = system{
    bodies = { motor = { I = 0.1 }, car = { I = 20, Rd = 3 } },
    links = {
      first = { "motor", "car", ratio = 4, Rd = 20, normal = function(t) return t < 4 and 1 or 0 end },
      second = { "motor", "car", ratio = 2, Rd = 20, normal = function(t) return math.max(0, math.min((t - 4) / closing, 1)) end } } }
  local run = gearbox:simulate{ M = { motor = function(t, theta, velocity) return 6 - 0.2 * velocity.motor end }, t_end = 10 }
  local locked = run.events:filter(function(e) return e.kind == "stick" and e.where == "second" end)
  print(string.format("%12.1f %15.3f %11.4f %20.3f %29.4f", closing, run.motor.velocity:max(), locked.t[1],
    run:energy().second.dry, run.car.velocity[#run]))
end

--[[ prints
closing time   motor at most   locked at   heat of the clutch   speed of the car at the end
         0.1          12.058      4.0977                3.314                        4.7165
         0.5          13.223      4.2852                7.147                        4.6995
         2.0          16.288      4.7999               19.993                        4.6313
]]
