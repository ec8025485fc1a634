-- Figure 23: resonance with dry friction, gamma = 0.167 < pi/4: the oscillation grows for ever. Its first swing stops
-- for a moment (0.399 to 0.412 T0): too short to see in 1989, with h = 0.01.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("23", "resonance, gamma = 0.167, h = 0.01", ...)
local old, run, sys = case.run{ gamma = 0.167, r = 1, theta0 = 1, t_end = 20, h = 0.01 }

fig:say "event       t/T0      theta      exact"
local exact = { { 0.265152, 0.664736 }, { 0.399217, 0.690743 }, { 0.412268, 0.690743 }, { nil, -1.907087 },
  { nil, 3.142045 }, { nil, -4.378219 } }
for i, known in ipairs(exact) do
  local event = run.events[i]
  fig:say(string.format("%-5s  %9.6f  %9.6f  %9.6f%s", event.kind, event.t / sys.T0, event.theta, known[2],
    known[1] and string.format(" at %.6f", known[1]) or ""))
end
local n, rough = #run.events, case.row_extremes(old)
fig:head("1989", "true motion", "pi - 4 gamma")
local growth = {
  math.abs(rough[#rough].theta) - math.abs(rough[#rough - 2].theta),
  math.abs(run.events[n].theta) - math.abs(run.events[n - 2].theta),
  math.pi - 4*0.167,
}
fig:line("growth per period", table.unpack(growth))

local event = run.events
fig:quote{ 0.167, math.pi / 4, growth[3], growth[2], growth[1], event[1].theta, event[2].theta, event[2].t / sys.T0,
  event[3].t / sys.T0, event[4].theta, event[5].theta, event[6].theta, 0.01 }
return fig:draw{ case.columns(run, { "theta", "M/k" }), case.plane(run), size = case.page }

--[[ prints
Figure 23: resonance, gamma = 0.167, h = 0.01
event       t/T0      theta      exact
turn    0.265152   0.664736   0.664736 at 0.265152
stick   0.399217   0.690743   0.690743 at 0.399217
slip    0.412268   0.690743   0.690743 at 0.412268
turn    0.989294  -1.907087  -1.907087
turn    1.494453   3.142045   3.142045
turn    1.996382  -4.378219  -4.378219
                                        1989     true motion    pi - 4 gamma
growth per period                2.473567277     2.473590786     2.473592654
fig23.svg
]]
