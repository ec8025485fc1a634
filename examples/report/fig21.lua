-- Figure 21: resonance without dry friction, zeta = 2.387, overdamped. The steady amplitude is 1/(2 zeta).
-- The report: the more damping, the smaller the circle in the phase plane.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("21", "resonance, zeta = 2.387 (overdamped), h = 0.01", ...)
local old, run, sys = case.run{ zeta = 2.387, r = 1, theta0 = 1, t_end = 12, h = 0.01 }

fig:head("1989", "true motion", "1/(2 zeta)", "report")
fig:line("steady amplitude", case.row_amplitude(old, 100), case.amplitude(run),
  theory.magnification{ r = 1, zeta = sys.zeta }, "")

local steady = theory.magnification{ r = 1, zeta = sys.zeta }
local settled = case.transient(sys, 0.05)
fig:line("within 0.05 of it from t =", "", "", settled)

fig:quote{ 21, 2.387, steady, case.row_amplitude(old, 100), settled,
  0.239, 3, sys.omega0 / 3, 2.12, 100 * (2.12 / 2.0921 - 1),
  1, case.transient(case.system(0.75), 0.05), 0.75 }
return fig:draw{
  case.columns(run, { "theta", "M/k" }, { xlim = { 0, 6 }, ylim = { -2.3, 2.3 } }),
  case.plane(run, 2.3),
  size = case.page,
}

--[[ prints
Figure 21: resonance, zeta = 2.387 (overdamped), h = 0.01
                                        1989     true motion      1/(2 zeta)          report
steady amplitude                 0.209467965     0.209467869     0.209467951
within 0.05 of it from t =                                       2.345000000
fig21.svg
]]
