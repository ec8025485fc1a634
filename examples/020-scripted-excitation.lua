-- 020: M(t) is any Lua function. In 1989 another M(t) meant another line of Fortran and another compilation.

local sys = nondimensional{ zeta = 0.05 } -- T0 = 1, k = 1: theta in units of Mc/k

-- Push at resonance, then take the hands off in the middle of a push.
local off = 1.777
local function M(t)
  if t < off then return math.sin(2 * math.pi * t) end
  return 0
end

local run = sys:simulate{ M = M, t_end = 6, dt = 0.01 }
print(run)
print(string.format("peak while pushed: %.4f, after that: %.4f",
  run.theta:slice(1, 178):abs():max(), run.theta:slice(179, #run):abs():max()))

-- M jumps at t = off, in the middle of the motion, and nobody said so. The default integrator finds the jump by itself.
-- It costs fewer calls of M when it is told, and with native terms, which know their jumps, no call of Lua at all.
local calls = 0
local function counted(t)
  calls = calls + 1
  return M(t)
end
local function print_end(name, excitation_of_t, method)
  calls = 0
  local theta = sys:simulate{ M = excitation_of_t, t_end = 6, times = {}, integrator = method }:at(6)
  print(string.format("%-32s theta(6) = %.9f  %4.1f thousand calls of M", name, theta, calls / 1000))
end
local announced = excitation.scripted(counted, { breaks = { off } })
local native = excitation.harmonic{ frequency = 1 }:window(0, off)
print_end("a bare function", counted)
print_end("breaks = { off }", announced)
print_end("harmonic:window(0, off)", native)

-- A method with fixed steps smears what it is not told about over a step, and is far from its fourth order.
print_end("rk4, h = 0.002, a bare function", counted, integrator.rk4{ h = 0.002 })
print_end("rk4, h = 0.002, breaks", announced, integrator.rk4{ h = 0.002 })

--[[ prints
601 rows, t 0 … 6; 12 events (12 turns); moving at the end; peak |theta| 4.12
peak while pushed: 3.7618, after that: 4.1160
a bare function                  theta(6) = -1.164157311   0.3 thousand calls of M
breaks = { off }                 theta(6) = -1.164157311   0.2 thousand calls of M
harmonic:window(0, off)          theta(6) = -1.164157311   0.0 thousand calls of M
rk4, h = 0.002, a bare function  theta(6) = -1.163082326   6.1 thousand calls of M
rk4, h = 0.002, breaks           theta(6) = -1.164157313   6.1 thousand calls of M
]]
