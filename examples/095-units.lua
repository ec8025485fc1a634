-- 095: units. A block of 2 kg on a table, at a spring of 800 N/m, let go 5 cm off: everything says in what it is measured.
-- Numbers do not change: they are right in any consistent units, and units are words for tables, axes and files.

local weight = 2*9.81
local block = system{ I = 2, k = 800, Rd = 0.3*weight, Re = 0.4*weight, units = { theta = "m", t = "s", M = "N" } }
local run = block:simulate{ theta0 = 0.05, t_end = 1, dt = 0.01 }

print(run.events)
print()
run:plot{ width = 60, height = 10, ascii = true }
print()
print((tostring(run:energy()):match "[^\n]*"))
print(string.format("friction took %.4f N m of it", run:energy().total.dry))

-- What follows from them: a velocity in m/s, an amplitude over cycles a second.
print(run:poincare{ period = 0.25 })

-- The file says it, too, to who reads it and to the run that is read from it.
local file = os.tmpname() .. ".csv"
run:save(file)
for line in io.lines(file) do
  if line:find "units:" then print(line) end
end
print("read back, M is in " .. load(file).units.M)
os.remove(file)

-- The same block in millimetres; here the run says so.
local wide = system{ I = 2e-3, k = 0.8, Rd = 0.3*weight, Re = 0.4*weight }
local same = wide:simulate{ theta0 = 50, t_end = 1, dt = 0.01, units = { theta = "mm", t = "s", M = "N" } }
print(same.events:select("t", "theta"))

--[[ prints
3 events: 2 turns, 1 rest
  i      t, s  kind   theta, m  M, N  velocity, m/s
  1   0.15708  turn  -0.035285     0              0
  2  0.314159  turn    0.02057     0              0
  3  0.471239  rest  -0.005855     0              0

theta, m
 0.05 +':.
      |  ':          ....
 0.00 +- -': - - - .:' -'':..- - - - - - - - - - - - - -
      |    ':.   .:'        '''''''''''''''''''''''''''''
      |      '::''
      ++------------------------+-----------------------+
stuck                         ===========================
      0.0                      0.5                     1.0
                              t, s

energy in N m, t 0 … 1 s: input = kinetic + spring + viscous + dry
friction took 0.9863 N m of it
data: 5 rows of t, theta, velocity
  i  t, s     theta, m  velocity, m/s
  1     0         0.05              0
  2  0.25  0.000564476       0.535607
  3   0.5    -0.005855              0
  4  0.75    -0.005855              0
  5     1    -0.005855              0
# -- units: theta in m, t in s, M in N
read back, M is in N
data: 3 rows of t, theta
  i      t, s  theta, mm
  1   0.15708    -35.285
  2  0.314159      20.57
  3  0.471239     -5.855
]]
