-- 040: an excitation from a file. A ground motion shakes the frame; what does the mass feel?
--
-- data/record.csv is synthetic: data/make-record.lua computed it to look like an accelerogram. No earthquake was
-- recorded, so do not design anything with it.

local here = debug.getinfo(1, "S").source:match("^@(.*/)") or "" -- the folder of this script
local ground = excitation.samples(here .. "data/record.csv", { time = "t", value = "acceleration" }) -- s, m/s^2

-- With x the displacement relative to the shaking frame: m x'' + c x' + k x = -m a(t). A mass on a spring is the same
-- equation as a wheel on a torsion bar: I is the mass, theta the displacement.
local mass, T0 = 1000, 0.5                       -- kg, s
local k = mass * (2 * math.pi / T0)^2            -- N/m
local critical = 2 * math.sqrt(k * mass)         -- N s/m
local force = -mass * ground

print(string.format("the ground at t = 4 s: %+.3f m/s^2", ground(4)))
print "zeta   friction/weight   peak displacement   left at the end"
for _, case in ipairs{ { 0.02, 0 }, { 0.05, 0 }, { 0.20, 0 }, { 0.02, 0.02 }, { 0.02, 0.1 } } do
  local zeta, mu = case[1], case[2]
  local sys = system{ I = mass, k = k, C = zeta * critical, Rd = mu * mass * 9.81 }
  local run = sys:simulate{ M = force, t_end = 40, dt = 0.01 }
  print(string.format("%.2f %14.2f %16.1f mm %14.1f mm",
    zeta, mu, 1000 * run.theta:abs():max(), 1000 * run.theta[#run]))
end
-- Dry friction holds the mass off centre for ever; viscous damping never does.

--[[ prints
the ground at t = 4 s: +0.891 m/s^2
zeta   friction/weight   peak displacement   left at the end
0.02           0.00             61.5 mm            0.0 mm
0.05           0.00             48.4 mm            0.0 mm
0.20           0.00             24.4 mm            0.0 mm
0.02           0.02             47.9 mm           -0.3 mm
0.02           0.10             16.5 mm           -0.5 mm
]]
