-- 245: M must depend on its arguments only, because it is asked out of order, ahead and again. A function that remembers
-- something is found out: the run ends and says so. Here are four such traps, and what to write instead.

local block = system{ I = 1, k = 1, C = 0.3, Rd = 0.05, Re = 0.08 }
local function simulate(M, states)
  return block:simulate{ M = M, states = states, t_end = 30, dt = 0.1 }
end
local function show(trap, cure)
  -- Which values it was caught with depends on how the machine rounds.
  print((trap.outcome:gsub("%-?%d[%d.e+-]*", "..."):gsub("; ", ";\n  ")))
  print(string.format("  instead: %s, theta = %.6f at the end", cure.outcome, cure.theta[#cure]))
end

print "An integral in an upvalue: a state of the run."
local last, sum = 0, 0
local trap = simulate(function(t, theta)
  sum = sum + (1 - theta) * (t - last)
  last = t
  return 2 * (1 - theta) + 0.4 * sum
end)
local cure = simulate(function(t, theta, velocity, z) return 2 * (1 - theta) + 0.4 * z.e end,
  { e = { rate = function(t, theta) return 1 - theta end } })
show(trap, cure)

print "A switch that remembers its side: excitation.relay."
local on = true
trap = simulate(function(t, theta)
  if theta > 0.1 then on = false elseif theta < -0.1 then on = true end
  return on and 0.4 or -0.4
end)
cure = simulate(excitation.relay{ on = -0.1, off = 0.1, amplitude = 0.4 })
show(trap, cure)

print "A value that is held: excitation.sampled, which is asked in order and may remember what it likes."
local next_time, held = 0, 0
trap = simulate(function(t, theta, velocity)
  if t >= next_time then
    held = 2 * (1 - theta) - velocity
    next_time = next_time + 0.2
  end
  return held
end)
cure = simulate(excitation.sampled(function(t, theta, velocity) return 2 * (1 - theta) - velocity end, { every = 0.2 }))
show(trap, cure)

print "Random numbers: a table of them, made before the run."
trap = simulate(function(t) return math.random() end)
local t, M, x = {}, {}, 1989
for i = 1, 61 do
  x = (16807 * x) % 2147483647
  t[i], M[i] = (i - 1) / 2, x / 2147483647
end
cure = simulate(excitation.samples{ t = t, M = M })
print((trap.outcome:gsub("at t = .*", "...")))
print(string.format("  instead: %s, theta = %.6f at the end", cure.outcome, cure.theta[#cure]))

-- What does not change the value is nobody's business: counters, logs, a cache.
local calls = 0
print(simulate(function(t) calls = calls + 1 return math.sin(t) end).outcome, calls > 100)

--[[ prints
An integral in an upvalue: a state of the run.
M depends on more than its arguments: at t = ... it returned ... and, evaluated again, ...;
  put memory into states, excitation.sampled, excitation.relay or excitation.delayed, and random numbers into a table
  instead: stuck at the end, theta = 0.996894 at the end
A switch that remembers its side: excitation.relay.
M depends on more than its arguments: at t = ... it returned ... and, evaluated again, ...;
  put memory into states, excitation.sampled, excitation.relay or excitation.delayed, and random numbers into a table
  instead: reached the end, theta = -0.008145 at the end
A value that is held: excitation.sampled, which is asked in order and may remember what it likes.
M depends on more than its arguments: at t = ... it returned ... and, evaluated again, ...;
  put memory into states, excitation.sampled, excitation.relay or excitation.delayed, and random numbers into a table
  instead: stuck at the end, theta = 0.659459 at the end
Random numbers: a table of them, made before the run.
M depends on more than its arguments: ...
  instead: reached the end, theta = 0.492826 at the end
reached the end	true
]]
