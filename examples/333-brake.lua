-- 333: a brake whose pad hangs on a torsion bar: the wheel slows down, sticks to the pad, and both swing as one mass.

print "stiffness of the bar   sticks at   pad at most   period after that   in closed form"
for _, k in ipairs{ 40, 160, 640 } do
  local brake = system{
    bodies = { wheel = { I = 2 }, pad = { I = 0.1, k = k, C = 0.4 } },
    links = { lining = { "wheel", "pad", Rd = 6, Re = 8, normal = function(t) return math.min(2 * t, 1) end } } }
  local run = brake:simulate{ velocity0 = { wheel = 5 }, t_end = 8, events = {
    { name = "turn", direction = "down", when = function(t, theta, velocity) return velocity.wheel end } } }
  local stick = run.events:filter(function(e) return e.kind == "stick" and e.where == "lining" end)
  local turns = run.events:filter(function(e) return e.name == "turn" end).t
  local omega1 = math.sqrt(k / 2.1 - (0.4 / (2 * 2.1))^2) -- of wheel and pad together on the bar
  print(string.format("%20d %11.4f %13.4f %19.6f %16.6f", k, stick.t[1], run.pad.theta:max(),
    turns[#turns] - turns[#turns - 1], 2 * math.pi / omega1))
end

--[[ prints
stiffness of the bar   sticks at   pad at most   period after that   in closed form
                  40      1.9244        0.1671            1.440002         1.440002
                 160      1.9155        0.0390            0.719872         0.719872
                 640      1.9162        0.0097            0.359920         0.359920
]]
