-- 332: a planetary gear with a brake on its ring: free, the ring runs back and the output stands; braked, the output turns.

-- 60 teeth on the ring and 40 on the sun: (1 + 1.5) theta_carrier = theta_sun + 1.5 theta_ring.
local function closing(t) return math.max(0, math.min((t - 1) / 0.5, 1)) end
local gear = system{
  bodies = { sun = { I = 0.02 }, ring = { I = 0.1, Rd = 8, normal = closing }, carrier = { I = 0.5, C = 0.2, Rd = 1.5 } },
  links = { teeth = { carrier = 2.5, sun = -1, ring = -1.5, rigid = true } } }
local run = gear:simulate{ M = { sun = function(t, theta, velocity) return 1.2 * math.max(0, 1 - velocity.sun / 60) end }, t_end = 8 }

print "  t     sun    ring  carrier   torque of the teeth"
for _, t in ipairs{ 0.9, 1.3, 2, 8 } do
  local theta, velocity = run:at(t)
  local row = math.floor(t / run.t[2] + 1.5)
  print(string.format("%4.1f %7.3f %7.3f %8.4f %9.4f", t, velocity.sun, velocity.ring, velocity.carrier, run.teeth.torque[row]))
end
local held = run.ring.events:filter(function(e) return e.kind == "stick" end)
print(string.format("the brake holds the ring from t = %.4f on, and the sun turns %.1f times as fast as the output",
  held.t[#held], run.sun.velocity[#run] / run.carrier.velocity[#run]))

--[[ prints
  t     sun    ring  carrier   torque of the teeth
 0.9  15.143  -9.483   0.3675    0.6196
 1.3  14.118  -7.844   0.9411    1.4990
 2.0   6.696   0.000   2.6784    1.0157
 8.0  11.325   0.000   4.5299    0.9713
the brake holds the ring from t = 1.5105 on, and the sun turns 2.5 times as fast as the output
]]
