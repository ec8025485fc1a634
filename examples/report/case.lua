-- What the figures of the report share: its system, each motion computed twice (as the program of 1989 computed it, and
-- truly), and how a figure is told and drawn. The scripts fig03.lua ... fig27.lua say only what is theirs.
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

-- From when on (in T0) the angles stay within `limit` of zero, by the rows of t.
function case.settled(t, theta, limit)
  for i = #t, 1, -1 do
    if math.abs(theta[i]) > limit then return t[i] end
  end
  return 0
end

-- The same for how far a motion at resonance, begun at theta = 1, is from its steady state: that is a free motion.
function case.transient(sys, limit)
  local phi, lag = theory.magnification{ r = 1, zeta = sys.zeta }, theory.phase_lag{ r = 1, zeta = sys.zeta }
  local t = vector.linspace(0, 6, 6001)
  return case.settled(t, theory.free_response{ system = sys, theta0 = 1 + phi * math.sin(lag),
    velocity0 = -phi * math.cos(lag) * sys.omega0, t = t }, limit)
end

-- What one step h of the scheme of 1989 does to a free motion without dry friction: two single steps give the 2 x 2
-- matrix of the step; the size of its larger eigenvalue is the factor by which the motion grows, and where it swings, the
-- angle of the eigenvalue gives the period, in T0. slip = false is plain RK4.
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
  if discriminant >= 0 then return math.abs(trace) / 2 + math.sqrt(discriminant) end
  local factor = math.sqrt(determinant)
  return factor, 2 * math.pi * h / math.acos(trace / (2 * factor))
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

-- The curves of chapter 6, for theta0 = 1: the closed form, and a scheme with step h, whose points are joined by lines as
-- the plotter of 1989 joined them.
function case.exact(zeta, t_end)
  local sys = case.system(zeta)
  local t = vector.linspace(0, t_end, 1201)
  return { t, (theory.free_response{ system = sys, theta0 = 1, t = t }), label = "exact", colour = 1, dashes = "solid" }
end
function case.scheme(zeta, h, steps, slip)
  local run = case.system(zeta):simulate{ theta0 = 1, t_end = steps * h, dt = h,
    integrator = integrator.dinal1989{ h = h, slip = slip } }
  return { run.t, run.theta, label = slip and "chapter 6" or "RK4 as printed", colour = slip and 2 or 3,
    dashes = "solid" }, run
end

-- Figures 10 to 13: the step raised more and more. The numbers of each, and the curves: left what the report saw, right
-- what its printed scheme does, with the same limits unless chapter 6 diverges too far.
function case.raised_step(h, steps)
  local zeta = 0.02387
  local slipped, old = case.scheme(zeta, h, steps, true)
  local printed, rk4 = case.scheme(zeta, h, steps, false)
  printed.dashes = "dashed"
  local exact = theory.free_response{ system = case.system(zeta), theta0 = 1, t = old.t }
  local limit = 1.2
  local diverged = old.theta:abs():max() > limit
  local limits = { -limit, limit }
  local slip_factor, rk4_factor = case.growth(zeta, h, true), (case.growth(zeta, h, false))
  return {
    slip = slip_factor, rk4 = rk4_factor, exact = math.exp(-2 * math.pi * zeta * h),
    slip_limit = case.largest_step(zeta, true), rk4_limit = case.largest_step(zeta, false),
    slip_end = case.row_amplitude(old, 6), rk4_end = case.row_amplitude(rk4, 6),
    exact_end = exact:slice(#exact - 6, #exact):abs():max(),
  }, {
    case.response{ slipped, ylim = not diverged and limits or nil },
    case.response{ case.exact(zeta, steps * h), printed, ylim = limits, ylabel = diverged and "θ*, enlarged" or nil },
    size = case.page,
  }
end

-- Steady motions under sin(2 pi r t*) whatever number of stops they have, from the events of a run: amplitude, lag of the
-- peak in rad, stops in each half cycle. Where the mass stops for long it forgets how it began, and few periods are
-- enough; near resonance it may stop so shortly that it takes hundreds.
function case.steady(r, gamma)
  local periods, watched = r < 0.3 and 6 or math.abs(r - 1) < 0.1 and 400 or 40, 2
  local run = nondimensional{ friction_ratio = gamma }:simulate{
    M = excitation.harmonic{ frequency = r }, t_end = periods / r, times = {}, dense = false }
  local from, low, high, peak, stops = (periods - watched - 0.13) / r, 0, 0, 0, 0 -- 0.13: not where a stop could be
  for _, event in ipairs(run.events) do
    if event.t > from and event.t <= from + watched / r then
      if event.kind == "stick" then stops = stops + 1 end
      low = math.min(low, event.theta)
      if event.theta > high + 1e-9 then high, peak = event.theta, event.t end
    end
  end
  local lag = (r * peak + 0.25) % 1 - 0.5 -- of a period, from -1/2 to 1/2: the peak may be ahead of that of M
  return (high - low) / 2, 2 * math.pi * lag, stops / (2 * watched)
end

-- Ratios of frequencies for figure 5, closer where curves fall steeply.
function case.ratios()
  local r = {}
  for i = 2, 400 do
    r[#r + 1] = i / 200
    if i > 190 and i < 196 then
      for j = 1, 9 do r[#r + 1] = (i + j / 10) / 200 end
    end
  end
  return vector(r)
end

-- The r for which the formula has nan, and case.steady there: tables of r, amplitude, lag in degrees and stops in each half
-- cycle, with gaps between the pieces.
function case.where_it_stops(r, formula, gamma)
  local x, amplitude, lag, stops = {}, {}, {}, {}
  for i = 1, #r do
    local n = #x + 1
    if formula[i] ~= formula[i] then
      x[n], amplitude[n], lag[n], stops[n] = r[i], case.steady(r[i], gamma)
      lag[n] = math.deg(lag[n])
    elseif n > 1 and amplitude[n - 1] == amplitude[n - 1] then
      x[n], amplitude[n], lag[n], stops[n] = r[i], 0 / 0, 0 / 0, 0
    end
  end
  return x, amplitude, lag, stops
end

-- For the legend: what the dotted lines are, in all colours.
function case.dotted(label)
  return { { 0 / 0 }, { 0 / 0 }, label = label, dashes = "dotted", colour = 5 }
end

-- A figure: its numbers on the screen, and its picture in a file. The name is "05a"; the rest are the arguments of the
-- script: the folder to write into, the current one without it, and whether it is all.lua that runs it, which wants no
-- numbers.
local Figure = {}
Figure.__index = Figure

function case.figure(name, title, folder, quiet)
  local figure = setmetatable({ name = name, title = title, folder = folder or ".", quiet = quiet }, Figure)
  figure:say(string.format("Figure %s: %s", name:gsub("^0", ""):gsub("bis", " bis"), title))
  return figure
end

function Figure:say(text)
  if not self.quiet then print(text) end
end

-- Lines of the table on the screen.
function Figure:head(...)
  self:say(string.format("%-28s" .. string.rep("%16s", select("#", ...)), "", ...))
end
function Figure:line(what, ...)
  local text = string.format("%-28s", what)
  for i = 1, select("#", ...) do
    local value = select(i, ...)
    text = text .. string.format("%16s", type(value) == "number" and string.format("%.9f", value) or value)
  end
  self:say((text:gsub("%s+$", "")))
end

function Figure:raised_step(number)
  self:head("with the slip", "RK4 as printed", "exact")
  self:line("factor per step", number.slip, number.rk4, number.exact)
  self:line("largest h without divergence", number.slip_limit, number.rk4_limit)
  self:line("largest |theta|, last steps", string.format("%.5g", number.slip_end),
    string.format("%.5g", number.rk4_end), string.format("%.5g", number.exact_end))
end

-- The numbers that docs/report.md gives for this figure, in the order of the text: a test compares them.
function Figure:quote(numbers)
  self.quoted = numbers
end

-- Draws what plot{ ... } takes.
function Figure:draw(picture)
  self.file = self.folder .. "/fig" .. self.name .. ".svg"
  picture.file = self.file
  plot(picture)
  self:say(picture.file:match("[^/]*$"))
  return self
end

-- The two panels of the report: what is over t* on the left, of curves or of a run; the phase plane on the right.
function case.response(curves)
  curves.xlabel, curves.ylabel = curves.xlabel or "t*", curves.ylabel or "θ*"
  curves.show = false
  return plot(curves)
end
local symbols = { theta = "θ*", ["M/k"] = "M*", ["friction/k"] = "friction*" }
function case.columns(run, names, options)
  options = options or {}
  local labels = {}
  for i, name in ipairs(names) do labels[i] = symbols[name] end
  options.y, options.xlabel, options.ylabel, options.show = names, "t*", table.concat(labels, ", "), false
  options.labels = #names > 1 and labels or nil
  return run:plot(options)
end
function case.plane(run, size)
  local limits = size and { -size, size }
  return run:phase_plot{ xlabel = "θ*", ylabel = "θ*'/2π", xlim = limits, ylim = limits, show = false }
end
case.page = { 17, 6.5 } -- cm, for two panels

return case
