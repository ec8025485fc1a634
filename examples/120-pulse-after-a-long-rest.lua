-- 120: a pulse after a long rest. The mass waits off centre, held by friction; after 20 periods somebody hits it.
-- General solvers take long steps while nothing happens, and step over the pulse: no motion at all.

local sys = nondimensional{ friction_ratio = 0.167 } -- T0 = 1; without a load it can stay anywhere within 0.167
local t_end = 25

local function pulse(width) -- always the same push, amplitude times width
  return excitation.pulse{ amplitude = 0.05 / width, at = 20, width = width }
end
local run = sys:simulate{ M = pulse(0.05), theta0 = 0.1, t_end = t_end, dt = 0.1 }
print(run)
for _, event in ipairs(run.events) do
  print(string.format("%-4s  t = %.9f  theta = %.9f", event.kind, event.t, event.theta))
end

-- The same pulse as a Lua function. A function that is a formula is read, and its conditions become events: nothing is
-- missed. Of any other function (this one makes a table) only values are known, at 20 points of each 0.6 T0. What is
-- narrower than the gaps between them (run.gap) may be missed.
local function rest(M, method)
  return (sys:simulate{ M = M, theta0 = 0.1, t_end = t_end, times = {}, integrator = method }:at(t_end))
end
print "\nwidth, T0   native pulse        formula  bare function       breaks    narrowest"
for _, width in ipairs{ 0.05, 0.02, 0.01, 0.005 } do
  local height = 0.05 / width
  local function formula(t)
    if t >= 20 and t < 20 + width then return height end
    return 0
  end
  local function M(t)
    local values = { formula(t) }
    return values[1]
  end
  -- two cures: say when it happens, or say how short the shortest thing is that happens
  local announced = excitation.scripted(M, { breaks = { 20, 20 + width } })
  local patient = integrator.spectral{ narrowest = width }
  print(string.format("%9g %14.9f %14.9f %14.9f %12.9f %12.9f", width,
    rest(pulse(width)), rest(formula), rest(M), rest(announced), rest(M, patient)))
end
-- Still at 0.1: the bare function's pulse was not seen. breaks cost nothing, narrowest costs calls of M all the time.

--[[ prints
251 rows, t 0 … 25; 3 events (1 turn, 1 slip, 1 rest); at rest; peak |theta| 0.209
slip  t = 20.000000000  theta = 0.100000000
turn  t = 20.152198493  theta = 0.211206487
rest  t = 20.652198493  theta = 0.122793513

width, T0   native pulse        formula  bare function       breaks    narrowest
     0.05    0.122793513    0.122793513    0.122793513  0.122793513  0.122793513
     0.02    0.101840433    0.101840433    0.100000000  0.101840433  0.101840433
     0.01    0.095187305    0.095187305    0.100000000  0.095187305  0.095187305
    0.005    0.091925485    0.091925485    0.100000000  0.091925485  0.091925485
]]
