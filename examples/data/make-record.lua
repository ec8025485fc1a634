-- Writes record.csv into the current folder: a synthetic ground acceleration that looks like an accelerogram.
--
-- It is NOT a recording. Sinusoids of random phase, strongest near 2.5 Hz as on firm soil (the spectrum of Kanai and
-- Tajimi), under an envelope that rises fast, holds and dies away; drift taken out; scaled to a peak of 3.0 m/s^2. The
-- seed is fixed, so that everybody gets the same file: lua make-record.lua

local dt, points = 0.02, 801                  -- s
local ground, damping, peak = 2.5, 0.6, 3.0   -- Hz, -, m/s^2
math.randomseed(1989, 6)

-- Kanai-Tajimi: white noise filtered by a layer of soil; below 0.4 Hz little is left
local function strength(f)
  local r = f / ground
  local soil = (1 + (2 * damping * r)^2) / ((1 - r^2)^2 + (2 * damping * r)^2)
  return math.sqrt(soil) * f^2 / (f^2 + 0.4^2)
end

-- rises as t^2 until 2 s, strong until 6 s, then dies away
local function envelope(t)
  if t < 2 then return (t / 2)^2 end
  if t < 6 then return 1 end
  return math.exp(-0.4 * (t - 6))
end

local waves = {}
for i = 1, 120 do
  local f = 0.2 + 0.1 * i + 0.1 * (math.random() - 0.5)
  waves[i] = { amplitude = strength(f), omega = 2 * math.pi * f, phase = 2 * math.pi * math.random() }
end

local a, sum_a, sum_envelope = {}, 0, 0
for i = 1, points do
  local t = (i - 1) * dt
  a[i] = 0
  for _, wave in ipairs(waves) do
    a[i] = a[i] + wave.amplitude * math.sin(wave.omega * t + wave.phase)
  end
  a[i] = a[i] * envelope(t)
  sum_a, sum_envelope = sum_a + a[i], sum_envelope + envelope(t)
end

-- no velocity left at the end; the ground stops at a quiet zero
local largest = 0
for i = 1, points do
  a[i] = a[i] - sum_a / sum_envelope * envelope((i - 1) * dt)
  largest = math.max(largest, math.abs(a[i]))
end
a[1], a[points] = 0, 0

local file = assert(io.open("record.csv", "w"))
file:write("# SYNTHETIC ground acceleration, computed by make-record.lua: no earthquake, no recording\n")
file:write("# t in s, acceleration in m/s^2, peak 3.0 m/s^2\n")
file:write("t,acceleration\n")
for i = 1, points do
  local rounded = math.floor(a[i] / largest * peak * 1e4 + 0.5) / 1e4 -- never "-0.0000"
  file:write(string.format("%.2f,%.4f\n", (i - 1) * dt, rounded))
end
file:close()
print("wrote record.csv: " .. points .. " points")
