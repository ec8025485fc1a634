-- 280 Steady motion: the periodic motion without waiting for it, and the whole response curve with its stops.

local sys = nondimensional{ friction_ratio = 0.5 }

-- One question, one answer: no transient is run.
local s = sys:steady{ M = excitation.harmonic{ frequency = 1.35 } }
print(s)
print(string.format("lag of the fundamental %.2f degrees, of the peak %.2f degrees", math.deg(s.lag), math.deg(s.peak_lag)))
print(string.format("theory: amplitude %.9f, found %.9f", theory.den_hartog{ r = 1.35, friction_ratio = 0.5 }, s.amplitude))

-- At resonance this friction is too weak, and the answer says by how much.
print(sys:steady{ M = excitation.harmonic{ frequency = 1 } })

-- A response curve is data: columns to sort, filter, plot and save.
local c = sys:response{ over = { frequency = vector.linspace(0.2, 0.9, 8) } }
print("   r   amplitude   stops")
for _, row in ipairs(c) do print(string.format("%.2f %11.6f %7d", row.frequency, row.amplitude, row.stops)) end

--[[ prints
steady: period 0.740741 T0, amplitude 0.860792 Mc/k, 0 stops a period
lag of the fundamental 140.69 degrees, of the peak 135.07 degrees
theory: amplitude 0.860792180, found 0.860792180
grows: by 1.14159 Mc/k in each period of M
   r   amplitude   stops
0.20    0.554175       2
0.30    0.825616       2
0.40    1.079074       2
0.50    1.303429       2
0.60    1.486582       0
0.70    1.744254       0
0.80    2.332235       0
0.90    4.215904       0
]]
