-- Figure 24: resonance with dry friction, gamma = 0.836 > pi/4: no growth any more, but a stop in every half cycle.
-- Figure 5a predicts an amplitude of 0.14, says the report; it is 0.129.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

case.title(24, "resonance, gamma = 0.836, h = 0.01")
local old, run, sys = case.run{ gamma = 0.836, r = 1, theta0 = 1, t_end = 30, h = 0.01 }

case.head("1989", "true motion", "exact", "report")
case.line("amplitude", case.row_amplitude(old, 100), case.amplitude(run), 0.1291703518, "0.14")

-- the last stop and the slip that ends it, counted from the half cycle they belong to
local events = run.events
local n = #events
while events[n].kind ~= "slip" do n = n - 1 end
local stick, slip = events[n - 1].t / sys.T0 % 0.5, events[n].t / sys.T0 % 0.5
case.line("sticks at t/T0 = n/2 +", "", stick, "0.45017942")
case.line("slips at t/T0 = n/2 +", "", slip, "0.12493764")
case.line("part of the time stuck", "", (slip + 0.5 - stick) / 0.5)
case.save(24, old, run)

--[[ prints
Figure 24: resonance, gamma = 0.836, h = 0.01
                                        1989     true motion           exact          report
amplitude                        0.158242517     0.129170352     0.129170352            0.14
sticks at t/T0 = n/2 +                           0.450179423      0.45017942
slips at t/T0 = n/2 +                            0.124937635      0.12493764
part of the time stuck                           0.349516424
fig24.csv, fig24.dat: 3001 rows
]]
