-- 060: stick-slip. A block on a table, pulled through a spring at constant speed: it waits, jumps, waits again.
-- Breakaway Re is larger than kinetic friction Rd; without that difference it would still jump once, and then swing about
-- the speed of the pull without ever stopping again. The numbers are those of a case from the field that general
-- simulators get wrong; each has a closed form.

local m, k, speed = 10, 4000, 0.01               -- kg, N/m, m/s
local weight = m * 9.81                          -- N
local block = system{ I = m, k = k, Rd = 0.2 * weight, Re = 0.3 * weight }

-- The far end of the spring is at speed*t, so the force on the block is k*(speed*t - x).
local pull = excitation.ramp{ slope = k * speed }
local run = block:simulate{ M = pull, t_end = 4, dt = 0.01 }
print(run)

print "event       t, s        x, mm   spring force, N"
for i = 1, 6 do
  local event = run.events[i]
  print(string.format("%-5s  %9.6f  %11.6f  %10.4f",
    event.kind, event.t, 1000 * event.theta, event.M - k * event.theta))
end

-- While it slips the equation is linear with M - Rd growing evenly, so the jump has a closed form.
local slip, stick, again = run.events[1], run.events[2], run.events[3]
local omega0, excess = block.omega0, (block.Re - block.Rd) / k
local lasts = 2 * (math.pi - math.atan(omega0 * excess / speed)) / omega0
print(string.format("first slip: t = %.9f s, Re/(k speed) = %.9f s", slip.t, block.Re / (k * speed)))
print(string.format("slip lasts      %.9f s, closed form    %.9f s", stick.t - slip.t, lasts))
local jump = stick.theta - slip.theta
print(string.format("jump            %.9f m, closed form    %.9f m", jump, 2 * excess + speed * lasts))
print(string.format("period          %.9f s, jump/speed     %.9f s", again.t - slip.t, jump / speed))
-- The block is fastest where the spring's force has come down to Rd.
local _, peak = run:at(slip.t + lasts / 2)
local known = speed + math.sqrt(speed^2 + (omega0 * excess)^2)
print(string.format("peak speed    %.11f m/s, closed form  %.11f m/s", peak, known))

--[[ prints
401 rows, t 0 … 4; 10 events (5 sticks, 5 slips); stuck at the end; peak |theta| 0.0334
event       t, s        x, mm   spring force, N
slip    0.735750     0.000000     29.4300
stick   0.912941     6.676914      9.8100
slip    1.403441     6.676914     29.4300
stick   1.580633    13.353827      9.8100
slip    2.071133    13.353827     29.4300
stick   2.248324    20.030741      9.8100
first slip: t = 0.735750000 s, Re/(k speed) = 0.735750000 s
slip lasts      0.177191371 s, closed form    0.177191371 s
jump            0.006676914 m, closed form    0.006676914 m
period          0.667691371 s, jump/speed     0.667691371 s
peak speed    0.06005899020 m/s, closed form  0.06005899020 m/s
]]
