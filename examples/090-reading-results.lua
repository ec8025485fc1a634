-- 090: reading results. Columns are vectors; files are written and read back to the last bit.

local sys = system{ I = 1, k = 39.48, C = 1.5, Rd = 2 }
local run = sys:simulate{
  M = excitation.half_sine{ amplitude = 60, width = 0.5 },
  t_end = 4,
  dt = 0.01,
}
print(run)
print("outcome: " .. run.outcome)

-- A column is a vector: numbered from 1, with arithmetic and functions for all of it at once.
local energy = sys.k / 2 * (run.theta^2 + (run.velocity / sys.omega0)^2)
print(string.format("%d rows, theta %+.4f ... %+.4f, last %+.4f",
  #run.theta, run.theta:min(), run.theta:max(), run.theta[#run]))
print(string.format("largest energy %.4f, at the end %.4f", energy:max(), energy[#energy]))
print(string.format("mean of |velocity| over the first second: %.4f", run.velocity:slice(1, 101):abs():mean()))

-- Between the rows the run knows the motion as well as on them: rows are samples of it, not steps.
local theta, velocity = run:at(0.7654321)
print(string.format("at t = 0.7654321: theta %.6f, velocity %.6f", theta, velocity))

-- READDIN of 1989 picked two of the six columns for the plotter. That is:
local t, angle = run:columns("t", "theta")
print(string.format("two columns of %d and %d numbers", #t, #angle))
local name = os.tmpname() -- a name nobody else uses; in your own work: run:save("run.csv")
run:save(name .. "-two.csv", { columns = { "t", "theta" } })

-- The whole run: .csv for everybody else's program, .dat for the record of 1989 (NPUNT, then t, theta, theta'/w0, M/k,
-- friction/k, damping/k).
run:save(name .. ".csv")
run:save(name .. ".dat")
local csv, dat = load(name .. ".csv"), load(name .. ".dat")
print("the .csv comes back the same: " .. tostring((csv.theta - run.theta):abs():max() == 0))
print("the .dat has velocity_over_omega0: " .. tostring(dat.velocity_over_omega0[51] == run.velocity[51] / sys.omega0))
for _, ending in ipairs{ "", "-two.csv", ".csv", ".dat" } do
  os.remove(name .. ending)
end

--[[ prints
401 rows, t 0 … 4; 8 events (6 turns, 1 slip, 1 rest); at rest; peak |theta| 1.92
outcome: at rest
401 rows, theta -1.2308 ... +1.9208, last -0.0441
largest energy 72.8377, at the end 0.0383
mean of |velocity| over the first second: 5.0249
at t = 0.7654321: theta 0.025714, velocity -9.551245
two columns of 401 and 401 numbers
the .csv comes back the same: true
the .dat has velocity_over_omega0: true
]]
