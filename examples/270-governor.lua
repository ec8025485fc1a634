-- 270: the governor of a turbine, with friction in its linkage (docs/governor.md). A load step; then the friction makes
-- the speed hunt, by as much as Re is more than Rd; a dither that shakes the linkage cures it.

-- The sleeve of the governor is the oscillator: theta closes the valve. The rotor's speed, less the one wanted, is a
-- state: J w' = -theta - load. The flyballs push the sleeve by 2 w.
local J, gain = 5, 2
local function turbine(Rd, Re, dither)
  local governor = system{ I = 1, k = 1, C = 1.2, Rd = Rd, Re = Re }
  return governor:simulate{
    M = function(t, theta, velocity, z) return gain*z.w + (dither or 0)*math.sin(20*t) end,
    states = { w = { start = 0, rate = function(t, theta) return (-theta - (t < 5 and 0 or 0.1))/J end } },
    events = { { when = function(t) return t - 5 end, name = "load step" } },
    t_end = 400, dt = 0.1,
  }
end

-- how far the speed swings in the last quarter, and how often a second it does
local function swing(run)
  local late = run.states.w[run.t:find(function(t) return t > 300 end)]
  return late:max() - late:min()
end

print "  Rd     Re    dither   speed at most   speed swings at last by"
for _, case in ipairs{ { 0, 0 }, { 0.02, 0.02 }, { 0.02, 0.03 }, { 0.02, 0.04 }, { 0.02, 0.06 }, { 0.02, 0.06, 0.3 } } do
  local Rd, Re, dither = table.unpack(case)
  local run = turbine(Rd, Re, dither)
  print(string.format("%5.2f %6.2f %8.1f %15.4f %18.5f", Rd, Re, dither or 0, run.states.w:abs():max(), swing(run)))
end

--[[ prints
  Rd     Re    dither   speed at most   speed swings at last by
 0.00   0.00      0.0          0.0537            0.00000
 0.02   0.02      0.0          0.0637            0.00353
 0.02   0.03      0.0          0.0639            0.02604
 0.02   0.04      0.0          0.0661            0.03208
 0.02   0.06      0.0          0.0721            0.04416
 0.02   0.06      0.3          0.0623            0.00001
]]
