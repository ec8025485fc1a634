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

-- M jumps at t = off. A method of fourth order is only that where M is smooth; with steps as coarse as these it shows.
-- Say where the jump is and a step ends there, or build M from native terms, which know it themselves.
local coarse = integrator.rk4{ h = 0.02 }
local function theta_at_the_end(excitation_of_t)
  return sys:simulate{ M = excitation_of_t, t_end = 6, times = {}, integrator = coarse }:at(6)
end
print(string.format("theta(6), h = 0.02, a bare function:      %.6f", theta_at_the_end(M)))
print(string.format("theta(6), h = 0.02, breaks = { off }:     %.6f",
  theta_at_the_end(excitation.scripted(M, { breaks = { off } }))))
print(string.format("theta(6), h = 0.02, harmonic:window():    %.6f",
  theta_at_the_end(excitation.harmonic{ frequency = 1 }:window(0, off))))
print(string.format("theta(6), as it should be:                %.6f",
  sys:simulate{ M = excitation.harmonic{ frequency = 1 }:window(0, off), t_end = 6, times = {},
    integrator = integrator.rk4{ h = 0.0005 } }:at(6)))

--[[ prints
601 rows, t 0 … 6; 12 events (12 turns); moving at the end; peak |theta| 4.12
peak while pushed: 3.7618, after that: 4.1160
theta(6), h = 0.02, a bare function:      -1.163650
theta(6), h = 0.02, breaks = { off }:     -1.164167
theta(6), h = 0.02, harmonic:window():    -1.164167
theta(6), as it should be:                -1.164157
]]
