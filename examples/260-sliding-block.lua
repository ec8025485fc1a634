-- 260: a block without a spring on a base that shakes, Newmark's model of a slope: it slides when the base accelerates
-- by more than the friction can, and what it has slid stays.

local here = debug.getinfo(1, "S").source:match("^@(.*/)") or "" -- the folder of this script
local ground = excitation.samples(here .. "data/record.csv", { time = "t", value = "acceleration" }) -- synthetic, m/s^2
local peak = 3.0
print "friction/peak   slides   residual displacement"
for _, ratio in ipairs{ 0.2, 0.4, 0.6, 0.8, 1.0 } do
  local block = system{ I = 1, k = 0, Rd = ratio*peak }
  local run = block:simulate{ base = ground, t_end = 40, times = { 40 } }
  local slips = run.events:filter(function(e) return e.kind == "slip" end)
  print(string.format("%13.1f %8d %12.5f", ratio, #slips, (run:at(40))))
end

--[[ prints
friction/peak   slides   residual displacement
          0.2       28     -0.00586
          0.4       15      0.00667
          0.6        7      0.00179
          0.8        3      0.00028
          1.0        0      0.00000
]]
