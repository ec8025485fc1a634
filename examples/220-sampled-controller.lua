-- 220: a digital controller. It looks once every 50 ms, keeps a memory of its own, and its output comes 20 ms late.

local plant = system{ I = 1, k = 4, C = 0.1, Rd = 0.05, Re = 0.08 }
local goal = 0.5

local function digital(every, delay)
  return excitation.sampled(function(t, theta, velocity, z, memory)
    local miss = goal - theta
    local rate = memory.miss and (miss - memory.miss)/every or 0
    memory.miss, memory.sum = miss, memory.sum + every*miss
    return 12*miss + 2*rate + 6*memory.sum
  end, { every = every, delay = delay, start = function() return { sum = 0 } end })   -- a new memory for each run
end

print "every, ms  delay, ms   overshoot   within 1 % after"
for _, case in ipairs{ { 0.001, 0 }, { 0.05, 0 }, { 0.05, 0.02 }, { 0.1, 0.05 } } do
  local every, delay = table.unpack(case)
  local run = plant:simulate{ M = digital(every, delay), t_end = 20, dt = 0.01 }
  local settled = 0
  for i = 1, #run do
    if math.abs(run.theta[i] - goal) > 0.01*goal then settled = run.t[i] end
  end
  print(string.format("%9g %10g %10.1f %% %14.2f s", 1000*every, 1000*delay, 100*(run.theta:max()/goal - 1), settled))
end

--[[ prints
every, ms  delay, ms   overshoot   within 1 % after
        1          0       21.4 %           8.28 s
       50          0       25.9 %           8.48 s
       50         20       31.0 %           8.78 s
      100         50       53.8 %          14.44 s
]]
