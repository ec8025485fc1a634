-- Figure 20: resonance without dry friction, zeta = 1, critical. The steady amplitude is 1/(2 zeta).
-- The report: the shortest transient of the three.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

case.title(20, "resonance, zeta = 1 (critical), h = 0.01")
local old, run, sys = case.run{ zeta = 1, r = 1, theta0 = 1, t_end = 12, h = 0.01 }

case.head("1989", "true motion", "1/(2 zeta)", "report")
case.line("steady amplitude", case.row_amplitude(old, 100), case.amplitude(run),
  theory.magnification{ r = 1, zeta = sys.zeta }, "")
case.save(20, old, run)

--[[ prints
Figure 20: resonance, zeta = 1 (critical), h = 0.01
                                        1989     true motion      1/(2 zeta)          report
steady amplitude                 0.499999667     0.500000000     0.500000000
fig20.csv, fig20.dat: 1201 rows
]]
