-- 080: a parameter sweep. The resonance curve with dry friction, against Den Hartog's closed form of 1931.
-- Amplitudes are in units of M0/k under the load M0 sin(2 pi r t/T0).

local gamma = 0.5
local sys = nondimensional{ friction_ratio = gamma } -- no viscous damping at all

local function simulated(r)
  local run = sys:simulate{
    M = excitation.harmonic{ frequency = r },
    t_end = 300 / r,
    times = {},    -- no rows: the turns tell the amplitude
    dense = false, -- nor what is between them
  }
  return math.abs(run.events[#run.events].theta)
end

print "   r    simulated   Den Hartog  without friction"
for _, r in ipairs{ 0.75, 0.9, 1.1, 1.35, 1.5, 2 } do
  print(string.format("%5.2f  %.8f  %.8f  %8.4f", r, simulated(r),
    theory.den_hartog{ r = r, friction_ratio = gamma }, theory.magnification{ r = r }))
end

-- At r = 1 friction does not limit the amplitude as long as gamma < pi/4: it grows by pi - 4 gamma each period.
local run = sys:simulate{ M = excitation.harmonic{ frequency = 1 }, t_end = 30, times = {} }
local n = #run.events
print(string.format("r = 1: grows by %.6f per period; pi - 4 gamma = %.6f",
  math.abs(run.events[n].theta) - math.abs(run.events[n - 2].theta),
  math.pi - 4*gamma))

--[[ prints
   r    simulated   Den Hartog  without friction
 0.75  1.97260145  1.97260145    2.2857
 0.90  4.21590372  4.21590372    5.2632
 1.10  3.56105011  3.56105011    4.7619
 1.35  0.86079218  0.86079218    1.2158
 1.50  0.55377492  0.55377492    0.8000
 2.00  0.22047928  0.22047928    0.3333
r = 1: grows by 1.141593 per period; pi - 4 gamma = 1.141593
]]
