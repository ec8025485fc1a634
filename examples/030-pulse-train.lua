-- 030: a pulse train. Native terms add and scale, and no step crosses their edges, however short the pulses are.

-- n pushes of 1/20 of a period, one every `spacing` periods, like a parent at a swing
local function train(n, spacing)
  local M = excitation.pulse{ amplitude = 2, at = 0, width = 0.05 }
  for i = 1, n - 1 do
    M = M + excitation.pulse{ amplitude = 2, at = i * spacing, width = 0.05 }
  end
  return M
end

print(train(2, 1.5)) -- an excitation prints as the Lua text that rebuilds it

local swing = nondimensional{ zeta = 0.01 }
local sticky = nondimensional{ zeta = 0.01, friction_ratio = 0.1, breakaway_ratio = 0.15 }

print "spacing   peak |theta|   with dry friction 0.1"
for _, spacing in ipairs{ 0.5, 0.9, 1, 1.25, 1.5, 2 } do
  local M = train(10, spacing)
  local options = { M = M, t_end = 25, dt = 0.01 }
  print(string.format("%6.2f %12.3f %18.3f", spacing,
    swing:simulate(options).theta:abs():max(), sticky:simulate(options).theta:abs():max()))
end
-- In step with the swing (1, 2) the pushes add up; half a period off (0.5, 1.5) each undoes the one before.

-- A pulse below the breakaway torque does not move the mass at all: not slowly, not a little.
local run = sticky:simulate{ M = 0.07 * train(10, 1), t_end = 25, dt = 0.01 }
print(string.format("pulses of 0.14 against Re = %.2f: %s, peak |theta| = %g",
  sticky.Re, run.outcome, run.theta:abs():max()))

--[[ prints
excitation.pulse{ amplitude = 2, at = 0, width = 0.05 } + excitation.pulse{ amplitude = 2, at = 1.5, width = 0.05 }
spacing   peak |theta|   with dry friction 0.1
  0.50        0.616              0.510
  0.90        1.769              0.915
  1.00        4.718              1.908
  1.25        0.845              0.521
  1.50        0.616              0.521
  2.00        3.731              0.521
pulses of 0.14 against Re = 0.15: at rest, peak |theta| = 0
]]
