-- 320: Duffing's oscillator, whose spring stiffens with the swing, and dry friction: the wider the faster, a backbone
-- that leans over, and, where it leans, two steady motions at one frequency. Friction alone ends the free swing.

local sys = system{ I = 1, k = 1, C = 0.05, Rd = 0.02, spring = spring.polynomial{ [3] = 0.5 } }

print "a free swing: amplitude and period of each half cycle, and the period without friction"
local free = sys:simulate{ theta0 = 3, t_end = 60, dt = 0.1 }
local ideal = sys:with{ C = 0, Rd = 0 }
local before = 0
for i, e in ipairs(free.events) do
  if i % 4 == 1 then
    local X = math.abs(e.theta)
    local swing = ideal:simulate{ theta0 = X, t_end = 10, times = {} }
    print(string.format("%8.4f %8.4f %8.4f", X, 2*(free.events[i + 1].t - e.t), swing.events[2].t))
  end
  if i > 9 then break end
end

print "under M = 0.5 sin(2 pi f t), from the left and from a wide start"
for _, f in ipairs{ 0.16, 0.22, 0.28, 0.34, 0.40 } do
  local M = excitation.harmonic{ amplitude = 0.5, frequency = f }
  local low, high = sys:steady{ M = M }, sys:steady{ M = M, theta0 = 3.5 }
  print(string.format("f = %.2f: amplitude %.4f and %.4f", f, low.amplitude, high.amplitude))
end

local energy = free:energy().total
print(string.format("the spring gave %.4f: %.4f to the damper, %.4f to friction", -energy.spring, energy.viscous, energy.dry))

--[[ prints
a free swing: amplitude and period of each half cycle, and the period without friction
  2.9092   3.1506   3.1139
  2.5451   3.4729   3.4297
  2.1792   3.8514   3.8009
under M = 0.5 sin(2 pi f t), from the left and from a wide start
f = 0.16: amplitude 1.1199 and 1.1199
f = 0.22: amplitude 1.8009 and 1.8009
f = 0.28: amplitude 0.2400 and 2.5035
f = 0.34: amplitude 0.1401 and 0.1401
f = 0.40: amplitude 0.0938 and 0.0938
the spring gave 14.5794: 12.5251 to the damper, 1.9210 to friction
]]
