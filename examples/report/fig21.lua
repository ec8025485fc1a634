-- Figure 21: resonance without dry friction, zeta = 2.387, overdamped. The steady amplitude is 1/(2 zeta).
-- The report: the more damping, the smaller the circle in the phase plane.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

case.title(21, "resonance, zeta = 2.387 (overdamped), h = 0.01")
local old, run, sys = case.run{ zeta = 2.387, r = 1, theta0 = 1, t_end = 12, h = 0.01 }

case.head("1989", "true motion", "1/(2 zeta)", "report")
case.line("steady amplitude", case.row_amplitude(old, 100), case.amplitude(run),
  theory.magnification{ r = 1, zeta = sys.zeta }, "")
case.save(21, old, run)

--[[ prints
Figure 21: resonance, zeta = 2.387 (overdamped), h = 0.01
                                        1989     true motion      1/(2 zeta)          report
steady amplitude                 0.209467965     0.209467869     0.209467951
fig21.csv, fig21.dat: 1201 rows
]]
