-- Figure 20: resonance without dry friction, zeta = 1, critical. The steady amplitude is 1/(2 zeta).
-- The report: the shortest transient of the three.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("20", "resonance, zeta = 1 (critical), h = 0.01", ...)
local old, run, sys = case.run{ zeta = 1, r = 1, theta0 = 1, t_end = 12, h = 0.01 }

fig:head("1989", "true motion", "1/(2 zeta)", "report")
fig:line("steady amplitude", case.row_amplitude(old, 100), case.amplitude(run),
  theory.magnification{ r = 1, zeta = sys.zeta }, "")

local steady = theory.magnification{ r = 1, zeta = sys.zeta }
local settled = case.transient(sys, 0.05)
fig:line("within 0.05 of it from t =", "", "", settled)

fig:quote{ 20, 1, steady, case.row_amplitude(old, 100), settled }
return fig:draw{
  case.columns(run, { "theta", "M/k" }, { xlim = { 0, 6 }, ylim = { -2.3, 2.3 } }),
  case.plane(run, 2.3),
  size = case.page,
}

--[[ prints
Figure 20: resonance, zeta = 1 (critical), h = 0.01
                                        1989     true motion      1/(2 zeta)          report
steady amplitude                 0.499999667     0.500000000     0.500000000
within 0.05 of it from t =                                       0.832000000
fig20.svg
]]
