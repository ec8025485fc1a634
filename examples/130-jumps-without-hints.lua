-- 130: jumps without hints. A function that jumps as it pleases: spectral finds each jump by asking M, to the last bit.

local sys = nondimensional{ zeta = 0.05, friction_ratio = 0.1, breakaway_ratio = 0.15 }

local calls = 0
local function M(t) -- on and off, at times that no program could guess from outside, ever faster
  calls = calls + 1
  return math.sin(t * t) > 0.3 and 1 or 0
end

-- We know them, because we can solve sin(t^2) = 0.3.
local breaks, first = {}, math.asin(0.3)
for n = 0, 15 do
  breaks[#breaks + 1] = math.sqrt(first + 2 * math.pi * n)
  breaks[#breaks + 1] = math.sqrt(math.pi - first + 2 * math.pi * n)
end
local announced = excitation.scripted(M, { breaks = breaks })

local function run(excitation_of_t, method)
  calls = 0
  return sys:simulate{ M = excitation_of_t, t_end = 10, dt = 0.01, integrator = method }, calls
end
local truth, with_hints = run(announced)
local found, without = run(M)
print(truth)
print(string.format("%d jumps; spectral, with hints:    %6.1f thousand calls of M", #breaks, with_hints / 1000))
print(string.format("          spectral, without hints: %6.1f thousand calls, largest difference below 1e-12: %s",
  without / 1000, (found.theta - truth.theta):abs():max() < 1e-12))

-- A method with fixed steps smears each jump over a step: ten times the work, a tenth of the error.
for _, h in ipairs{ 0.01, 0.001, 0.0001 } do
  local smeared, count = run(M, integrator.rk4{ h = h })
  print(string.format("rk4, h = %-6g without hints: %10.1f thousand calls, largest difference %.0e", h, count / 1000,
    (smeared.theta - truth.theta):abs():max()))
end
local exact, count = run(announced, integrator.rk4{ h = 0.001 })
print(string.format("rk4, h = 0.001  with hints: %11.1f thousand calls, largest difference %.0e", count / 1000,
  (exact.theta - truth.theta):abs():max()))
-- A jump is found when two samples of M betray it. A pulse that falls between all of them is another story: see 120.

--[[ prints
1001 rows, t 0 … 10; 32 events (31 turns, 1 slip); moving at the end; peak |theta| 2.48
32 jumps; spectral, with hints:       0.8 thousand calls of M
          spectral, without hints:    3.1 thousand calls, largest difference below 1e-12: true
rk4, h = 0.01   without hints:        2.2 thousand calls, largest difference 3e-02
rk4, h = 0.001  without hints:       20.5 thousand calls, largest difference 2e-03
rk4, h = 0.0001 without hints:      203.4 thousand calls, largest difference 3e-04
rk4, h = 0.001  with hints:        20.6 thousand calls, largest difference 2e-10
]]
