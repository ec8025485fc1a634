-- Figure 19: resonance without dry friction, zeta = 0.239, underdamped. The steady amplitude is 1/(2 zeta).
-- The report reads 2.12 off its drawing.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("19", "resonance, zeta = 0.239 (underdamped), h = 0.01", ...)
local old, run, sys = case.run{ zeta = 0.239, r = 1, theta0 = 1, t_end = 12, h = 0.01 }

fig:head("1989", "true motion", "1/(2 zeta)", "report")
fig:line("steady amplitude", case.row_amplitude(old, 100), case.amplitude(run),
  theory.magnification{ r = 1, zeta = sys.zeta }, "2.12")
fig:say(string.format("(With C = 3, which is zeta = %.5f, the amplitude is %.4f.)", 3 / (2 * sys.omega0), sys.omega0 / 3))

local steady = theory.magnification{ r = 1, zeta = sys.zeta }
local settled = case.transient(sys, 0.05)
fig:line("within 0.05 of it from t =", "", "", settled)

fig:quote{ 1, 2.12, 0.05, 0.01, 19, 0.239, steady, case.row_amplitude(old, 100), settled }
return fig:draw{
  case.columns(run, { "theta", "M/k" }, { xlim = { 0, 6 }, ylim = { -2.3, 2.3 } }),
  case.plane(run, 2.3),
  size = case.page,
}

--[[ prints
Figure 19: resonance, zeta = 0.239 (underdamped), h = 0.01
                                        1989     true motion      1/(2 zeta)          report
steady amplitude                 2.092048865     2.092050245     2.092050209            2.12
(With C = 3, which is zeta = 0.23873, the amplitude is 2.0944.)
within 0.05 of it from t =                                       2.690000000
fig19.svg
]]
