-- 335: a belt that stretches and slips: its tension decides how long it slips as the motor starts, and what that costs.

-- The forces of the two strands differ by 2 F tanh(mu alpha/2) at most (Eytelwein), F the tension, alpha the angle of wrap.
local mu, alpha = 0.3, 2.6
print "tension   greatest pull   slips from   until   lost by slipping   the fan at 3/4 of its speed"
for _, tension in ipairs{ 60, 80, 120 } do
  local limit = 2 * tension * math.tanh(mu * alpha / 2)
  local drive = system{
    bodies = { motor = { I = 0.02 }, fan = { I = 0.3, C = 0.02 } },
    links = { belt = { motor = 0.05, fan = -0.15, C = 10, friction = friction.jenkins{ stiffness = 2e4, Rd = limit } } } }
  local near = { name = "near", when = function(t, theta, velocity) return velocity.fan - 37.5 end }
  local run = drive:simulate{ M = { motor = function(t, theta, velocity) return 6 - 0.04 * velocity.motor end }, t_end = 4, events = { near } }
  local function first(kind) return run.events:filter(function(e) return e.kind == kind end).t[1] end
  print(string.format("%7d %15.3f %12.4f %7.4f %18.3f %18.4f", tension, limit, first "slip", first "stick",
    run.belt:energy().total.dry, first "user"))
end

--[[ prints
tension   greatest pull   slips from   until   lost by slipping   the fan at 3/4 of its speed
     60          44.563       0.0185  1.0959             27.853             2.0543
     80          59.418       0.0219  0.5541              8.518             1.9950
    120          89.126       0.0286  0.0860              0.553             1.9813
]]
