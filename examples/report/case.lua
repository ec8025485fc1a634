-- What the figures of the report share: its system, and each motion computed twice: as the program of 1989 computed
-- it, and truly. The scripts fig07.lua ... fig27.lua say only what is theirs.
--
-- The report works with I = 1, k = 39.48 (about 4 pi^2, so that T0 = 0.99998 is about 1) and Mc = k. Then theta is
-- theta* and t nearly t*. zeta is the ratio of viscous damping, gamma = Rd/Mc that of dry friction (the report swaps
-- these letters freely). Steps and times are in time units, as they were typed in 1989.

local case = {}

local I, k = 1, 39.48

-- The report always takes Re = Rd.
function case.system(zeta, gamma)
  return system{ I = I, k = k, C = 2 * (zeta or 0) * math.sqrt(I * k), Rd = (gamma or 0) * k }
end

-- M*(t*) = sin(2 pi r t*), that is M = k sin(r omega0 t). The listing has SIN(6.28*T), which is r = 0.9995, not 1.
function case.harmonic(sys, r)
  return excitation.harmonic{ amplitude = k, omega = (r or 1) * sys.omega0 }
end

-- case.run{ zeta, gamma, r, theta0, velocity0, t_end, h, slip } -> the motion of 1989, the true one, the system.
-- r nil is a free motion; velocity0 is theta*' in units of omega0 (the report's 2 pi per T0 is 1); a row every h.
function case.run(p)
  local sys = case.system(p.zeta, p.gamma)
  local function with(method)
    return sys:simulate{
      M = p.r and case.harmonic(sys, p.r),
      theta0 = p.theta0,
      velocity0 = (p.velocity0 or 0) * sys.omega0,
      t_end = p.t_end,
      dt = p.h,
      integrator = method,
    }
  end
  return with(integrator.dinal1989{ h = p.h, slip = p.slip or false }),
    with(integrator.spectral{}), sys
end

-- The true extremes: { t in T0, theta, kind } of each time the velocity comes to zero.
function case.extremes(run)
  local list = {}
  for _, event in ipairs(run.events) do
    if event.kind ~= "slip" then
      list[#list + 1] = { t = event.t / run.system.T0, theta = event.theta, kind = event.kind }
    end
  end
  return list
end

-- The extremes as one reads them off the rows of 1989: the larger of two neighbours between which the velocity changes
-- sign. The program never knew the turns themselves.
function case.row_extremes(run)
  local list = {}
  for i = 2, #run do
    local theta, before = run.theta[i], run.theta[i - 1]
    if run.velocity[i] * run.velocity[i - 1] < 0 then
      if math.abs(before) > math.abs(theta) then theta = before end
      list[#list + 1] = { t = run.t[i] / run.system.T0, theta = theta }
    end
  end
  return list
end

-- The largest |theta| of the last n rows, all that one had in 1989; and |theta| at the last turn or stop.
function case.row_amplitude(run, n)
  return run.theta:slice(#run - n, #run):abs():max()
end
function case.amplitude(run)
  local list = case.extremes(run)
  return math.abs(list[#list].theta)
end

-- By how much one step h of the scheme of 1989 multiplies a free motion without dry friction: two single steps give
-- the 2 x 2 matrix of the step, its larger eigenvalue the factor. slip = false is plain RK4.
function case.growth(zeta, h, slip)
  local sys = nondimensional{ zeta = zeta }
  local method = integrator.dinal1989{ h = h, slip = slip }
  local function step(theta, velocity)
    local run = sys:simulate{ theta0 = theta, velocity0 = velocity, t_end = h, dt = h, integrator = method }
    return run.theta[2], run.velocity[2]
  end
  local a, c = step(1, 0)
  local b, d = step(0, 1)
  local trace, determinant = a + d, a * d - b * c
  local discriminant = trace^2 / 4 - determinant
  if discriminant < 0 then return math.sqrt(determinant) end
  return math.abs(trace) / 2 + math.sqrt(discriminant)
end

-- Where that factor passes 1: the largest h that does not diverge, in T0. For the printed scheme theory knows it.
function case.largest_step(zeta, slip)
  if not slip then return theory.step_limit{ system = nondimensional{ zeta = zeta } } end
  local low, high = 0.02, 0.6
  for _ = 1, 40 do
    local h = (low + high) / 2
    if case.growth(zeta, h, slip) <= 1 then low = h else high = h end
  end
  return low
end

-- Lines of the table on the screen.
function case.title(figure, text)
  print(string.format("Figure %d: %s", figure, text))
end
function case.head(...)
  print(string.format("%-28s" .. string.rep("%16s", select("#", ...)), "", ...))
end
function case.line(what, ...)
  local text = string.format("%-28s", what)
  for i = 1, select("#", ...) do
    local value = select(i, ...)
    text = text .. string.format("%16s", type(value) == "number" and string.format("%.9f", value) or value)
  end
  print((text:gsub("%s+$", "")))
end

-- The folder to write into: the first argument of the script, else the current one.
function case.path(name)
  local folder = arg and arg[1] or "."
  return folder .. "/" .. name
end

-- Columns side by side: case.write_csv("fig22.csv", "what they are", { t = vector, ... }, { "t", ... })
function case.write_csv(name, remark, names, columns)
  local file = assert(io.open(case.path(name), "w"))
  file:write("# ", remark, "\n", table.concat(names, ","), "\n")
  local row = {}
  for i = 1, #columns[1] do
    for j = 1, #columns do
      row[j] = string.format("%.17g", columns[j][i])
    end
    file:write(table.concat(row, ","), "\n")
  end
  assert(file:close())
end

-- figNN.csv with both motions (angles and torques over k, as the report draws them) and figNN.dat, the record that
-- the program of 1989 left on unit 13.
function case.save(figure, old, run)
  local name = string.format("fig%02d", figure)
  local sys = run.system
  case.write_csv(name .. ".csv",
    "theta in Mc/k, velocity over omega0, M and friction over Mc; _1989: as the program of 1989 computes it",
    { "t", "theta_1989", "velocity_1989", "friction_1989", "theta", "velocity", "friction", "M" },
    { run.t, old.theta, old.velocity / sys.omega0, old.friction / sys.k,
      run.theta, run.velocity / sys.omega0, run.friction / sys.k, run.M / sys.k })
  old:save(case.path(name .. ".dat"))
  print(string.format("%s.csv, %s.dat: %d rows", name, name, #run))
end

return case
