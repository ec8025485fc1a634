-- 290 Which system was it: viscous damping, dry friction and the zero of a noisy decay, with their errors.

-- A record as a phone camera makes it: 30 samples a second, 2 % of noise, and nobody knows where zero is.
local sys = system{ I = 1, k = 30, C = 0.1, Rd = 1.2 }
local run = sys:simulate{ theta0 = 1, t_end = 6, dt = 1/30 }
local record = data{ t = run.t, theta = run.theta + vector.normal{ n = #run, seed = 4, std = 0.02 } - 2 }

local fit = identify{ data = record, velocity0 = 0 }
print("             found   error if right    true")
print(string.format("%-9s %8.3f %7.3f %8.3f %7.3f", "omega0", fit.omega0, fit.std_error.omega0, fit.error_if_right.omega0, sys.omega0))
print(string.format("%-9s %8.3f %7.3f %8.3f %7.3f", "Rd/k", fit.Rd_over_k, fit.std_error.Rd_over_k, fit.error_if_right.Rd_over_k, sys.Rd / sys.k))
print(string.format("%-9s %8.3f %7.3f %8.3f %7.3f", "offset", fit.offset, fit.std_error.offset, fit.error_if_right.offset, -2))
print("the record says nothing about " .. table.concat(fit.silent, ", "))

--[[ prints
             found   error if right    true
omega0       5.480   0.002    0.002   5.477
Rd/k         0.041   0.012    0.001   0.040
offset      -1.996   0.003    0.003  -2.000
the record says nothing about Re
]]
