-- 150: stick-slip under a ramp. A bow draws a string, a hand a chair, a disc its brake pad: slowly it squeals, fast it
-- does not. Below which speed?

local m, k = 0.5, 2000                       -- kg, N/m: the pad and what holds it
local Rd, Re = 4, 5                          -- N
local T0 = 2 * math.pi * math.sqrt(m / k)

-- The disc drags the pad: seen from the disc, the pad's holder walks away at `speed`, and pulls with k speed t.
local function drawn(C, speed)
  local pad = system{ I = m, k = k, C = C, Rd = Rd, Re = Re }
  local start = Re / (k * speed)             -- until then the spring only loads
  return pad:simulate{ M = excitation.ramp{ slope = k * speed }, t_end = start + 30 * T0, times = {} }, pad
end

-- the last whole cycle, from slip to slip: how often a second, which part of it stuck; nil when it only slides
local function squeal(run)
  local events = run.events
  local n = #events
  while n > 0 and events[n].kind ~= "slip" do n = n - 1 end
  if n < 3 then return nil end
  local before, stick, slip = events[n - 2], events[n - 1], events[n]
  return 1 / (slip.t - before.t), (slip.t - stick.t) / (slip.t - before.t)
end

-- Without viscous damping there is a closed form: stuck for 2a/v, slipping for 2(pi - atan(omega0 a/v))/omega0.
print(string.format("T0 = %.4f s: the free pad would sound at %.2f Hz", T0, 1 / T0))
print "speed, mm/s     Hz   stuck   closed form"
for _, speed in ipairs{ 0.002, 0.01, 0.05, 0.2, 1 } do
  local run, pad = drawn(0, speed)
  local pitch, stuck = squeal(run)
  local a = (Re - Rd) / k
  local waits, slips = 2 * a / speed, 2 * (math.pi - math.atan(pad.omega0 * a / speed)) / pad.omega0
  print(string.format("%11g %6.2f %6.1f %%  %6.2f Hz %5.1f %%", 1000 * speed, pitch, 100 * stuck,
    1 / (waits + slips), 100 * waits / (waits + slips)))
end
-- Without damping it never slides evenly. With a little, it does so from some speed on:
print "\nzeta   squeals below, mm/s"
for _, zeta in ipairs{ 0.01, 0.03, 0.1 } do
  local C = 2 * zeta * math.sqrt(k * m)
  local low, high = 0.001, 1
  while high - low > 1e-6 do
    local speed = (low + high) / 2
    if squeal(drawn(C, speed)) then low = speed else high = speed end
  end
  print(string.format("%.2f %14.2f", zeta, 1000 * low))
end

--[[ prints
T0 = 0.0993 s: the free pad would sound at 10.07 Hz
speed, mm/s     Hz   stuck   closed form
          2   1.81   90.6 %    1.81 Hz  90.6 %
         10   6.28   62.8 %    6.28 Hz  62.8 %
         50   9.85   19.7 %    9.85 Hz  19.7 %
        200  10.06    5.0 %   10.06 Hz   5.0 %
       1000  10.07    1.0 %   10.07 Hz   1.0 %

zeta   squeals below, mm/s
0.01          86.62
0.03          47.31
0.10          21.51
]]
