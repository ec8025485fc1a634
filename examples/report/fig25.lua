-- Figure 25: away from resonance, r = 1.35: dry friction gamma = 0.5 against the viscous zeta = 0.242 that takes out as
-- much energy. "Excellent coincidence", says the report: of the phase, yes; the amplitude is 10 % too large.
-- The report does not say how many periods it waited; dry friction alone forgets slowly, so we take 60. Nor does it
-- print h; we take 100 steps a period of M.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local r = 1.35
local period = case.system().T0 / r
local fig = case.figure("25", "r = 1.35, gamma = 0.5 against zeta = 0.242, 100 steps a period", ...)
local old, dry, sys = case.run{ gamma = 0.5, r = r, theta0 = 1, t_end = 60 * period, h = period / 100 }
local old_viscous, viscous = case.run{ zeta = 0.242, r = r, theta0 = 1, t_end = 60 * period, h = period / 100 }

-- lag of the fundamental behind M, over the last period of M (100 rows): theta ~ sin(angle - lag)
local function lag(run)
  local theta, angle = run.theta:slice(#run - 99, #run), run.t:slice(#run - 99, #run) * (r * sys.omega0)
  return math.deg(math.atan(-(theta * angle:cos()):sum(), (theta * angle:sin()):sum()))
end

local amplitude = theory.den_hartog{ r = r, friction_ratio = 0.5 }
local _, dry_lag = theory.den_hartog_fundamental{ r = r, friction_ratio = 0.5 }
fig:head("1989", "true motion", "closed form")
fig:line("amplitude, gamma = 0.5", case.row_amplitude(old, 100), case.amplitude(dry), amplitude)
local damped = theory.magnification{ r = r, zeta = 0.242 }
fig:line("amplitude, zeta = 0.242", case.row_amplitude(old_viscous, 100), case.amplitude(viscous), damped)
local linear = theory.linearised{ r = r, friction_ratio = 0.5 }
fig:line("amplitude, linearised", "", "", linear)
fig:line("lag in degrees, gamma = 0.5", lag(old), lag(dry), math.deg(dry_lag))
local damped_lag = math.deg(theory.phase_lag{ r = r, zeta = 0.242 })
fig:line("lag in degrees, zeta = 0.242", lag(old_viscous), lag(viscous), damped_lag)

-- the damper that takes as much energy as dry friction, by the amplitude one believes in
local function equivalent_zeta(magnification) return 2*0.5/(math.pi*r*magnification) end
local by_formula, by_truth = equivalent_zeta(linear), equivalent_zeta(amplitude)
local better = theory.magnification{ r = r, zeta = by_truth }
fig:head("linearised", "exact")
fig:line("amplitude", linear, amplitude)
fig:line("its equivalent zeta", by_formula, by_truth)
fig:line("amplitude with that zeta", theory.magnification{ r = r, zeta = by_formula }, better)

fig:quote{ r, 0.5, 0.242, math.deg(dry_lag), damped_lag, damped, amplitude, 100 * (damped / amplitude - 1),
  linear, by_formula, 0.242, 2 * 0.5 / (math.pi * r * 0.242), by_truth, better, 100 * (better / amplitude - 1) }
local function steady(of) -- the last period
  return of.theta:slice(#of - 100, #of), of.velocity:slice(#of - 100, #of) / sys.omega0
end
local x, y = steady(dry)
local x_viscous, y_viscous = steady(viscous)
local t = dry.t / sys.T0
return fig:draw{
  case.response{ { t, dry.theta, label = "γ = 0.5" }, { t, viscous.theta, label = "ζ = 0.242" },
    { t, dry.M / sys.k, label = "M*", dashes = "dotted", colour = 5 }, xlim = { 41, 44 } },
  plot{ { x, y, label = "γ = 0.5" }, { x_viscous, y_viscous, label = "ζ = 0.242" }, equal = true,
    xlabel = "θ*", ylabel = "θ*'/2π", show = false },
  size = case.page,
}

--[[ prints
Figure 25: r = 1.35, gamma = 0.5 against zeta = 0.242, 100 steps a period
                                        1989     true motion     closed form
amplitude, gamma = 0.5           0.876129589     0.860792180     0.860792180
amplitude, zeta = 0.242          0.951788929     0.951976153     0.951976153
amplitude, linearised                                            0.937602241
lag in degrees, gamma = 0.5    140.380040613   140.686248785   140.686249614
lag in degrees, zeta = 0.242   141.536123761   141.536114761   141.536114761
                                  linearised           exact
amplitude                        0.937602241     0.860792180
its equivalent zeta              0.251476682     0.273916407
amplitude with that zeta         0.937602241     0.904070301
fig25.svg
]]
