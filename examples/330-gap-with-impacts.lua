-- 330: a mass in a gap between two walls: it bounces until it lies still, rattles when the gap is shaken, and what the
-- impacts take shows in the balance of energy. Restitution is the part of the velocity that an impact leaves.

print "a ball dropped on a floor: rests after sqrt(2h/g)(1 + e)/(1 - e)"
for _, e in ipairs{ 0.3, 0.5, 0.8, 0 } do
  local ball = system{ I = 1, k = 0, walls = { lower = 0, restitution = e } }
  local run = ball:simulate{ M = -9.81, theta0 = 1, t_end = 10, dt = 0.1 }
  print(string.format("e = %.1f: rest at t = %.9f, by the formula %.9f", e, run.events[#run.events].t,
    math.sqrt(2/9.81)*(1 + e)/(1 - e)))
end

print "a gap of 0.2 that shakes: frequency, impacts a period, hardest, how the work of the support is spent"
local loose = system{ I = 1, k = 0, Rd = 0.05, walls = { lower = -0.1, upper = 0.1, restitution = 0.7 } }
for _, f in ipairs{ 0.4, 1, 1.5 } do
  local run = loose:simulate{ base = excitation.harmonic{ amplitude = 2, frequency = f }, t_end = 40/f, dt = 0.1/f }
  local late = run.events:filter(function(e) return e.kind == "impact" and e.t > 20/f end)
  local energy = run:energy().total
  print(string.format("f = %.1f: %.2f impacts, hardest %.3f; base %.3f = impacts %.3f + friction %.3f + what moves",
    f, #late/20, late.velocity:abs():max(), energy.base, energy.impacts, energy.dry))
end

print "restitution 0: the mass stays at the wall until it is pulled off by more than Re"
local catch = system{ I = 1, k = 0, Rd = 0.1, Re = 0.3, walls = { upper = 1, restitution = 0 } }
local run = catch:simulate{ M = excitation.ramp{ slope = -0.1, at = 2 }, velocity0 = 1, t_end = 8, dt = 0.1 }
for _, e in ipairs(run.events) do print(string.format("%-7s t = %.4f  theta = %.1f  M = %.2f", e.kind, e.t, e.theta, e.M)) end

--[[ prints
a ball dropped on a floor: rests after sqrt(2h/g)(1 + e)/(1 - e)
e = 0.3: rest at t = 0.838543905, by the formula 0.838543905
e = 0.5: rest at t = 1.354570923, by the formula 1.354570923
e = 0.8: rest at t = 4.063712769, by the formula 4.063712769
e = 0.0: rest at t = 0.451523641, by the formula 0.451523641
a gap of 0.2 that shakes: frequency, impacts a period, hardest, how the work of the support is spent
f = 0.4: 4.00 impacts, hardest 0.695; base 13.744 = impacts 12.500 + friction 1.242 + what moves
f = 1.0: 2.00 impacts, hardest 0.692; base 10.618 = impacts 9.783 + friction 0.798 + what moves
f = 1.5: 2.00 impacts, hardest 0.830; base 14.186 = impacts 13.285 + friction 0.778 + what moves
restitution 0: the mass stays at the wall until it is pulled off by more than Re
impact  t = 1.0557  theta = 1.0  M = 0.00
stick   t = 1.0557  theta = 1.0  M = 0.00
slip    t = 5.0000  theta = 1.0  M = -0.30
]]
