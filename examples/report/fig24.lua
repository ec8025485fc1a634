-- Figure 24: resonance with dry friction, gamma = 0.836 > pi/4: no growth any more, but a stop in every half cycle.
-- Figure 5a predicts an amplitude of 0.14, says the report; it is 0.129.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("24", "resonance, gamma = 0.836, h = 0.01", ...)
local old, run, sys = case.run{ gamma = 0.836, r = 1, theta0 = 1, t_end = 30, h = 0.01 }

fig:head("1989", "true motion", "exact", "report")
fig:line("amplitude", case.row_amplitude(old, 100), case.amplitude(run), 0.1291703518, "0.14")

-- the last stop and the slip that ends it, counted from the half cycle they belong to
local events = run.events
local n = #events
while events[n].kind ~= "slip" do n = n - 1 end
local stick, slip = events[n - 1].t / sys.T0 % 0.5, events[n].t / sys.T0 % 0.5
fig:line("sticks at t/T0 = n/2 +", "", stick, "0.45017942")
fig:line("slips at t/T0 = n/2 +", "", slip, "0.12493764")
local stuck = (slip + 0.5 - stick) / 0.5
fig:line("part of the time stuck", "", stuck)
local last = old.theta:slice(#old - 100, #old)
local fine = case.run{ gamma = 0.836, r = 1, theta0 = 1, t_end = 30, h = 0.001 }
fig:line("highest, lowest, h = 0.01", last:max(), last:min())
fig:line("amplitude, h = 0.001", case.row_amplitude(fine, 1000))

-- The listing has SIN(6.28*T): at this step the amplitude is another one in each period.
local listed = sys:simulate{ M = excitation.harmonic{ amplitude = sys.k, omega = 6.28 }, theta0 = 1, t_end = 30, dt = 0.01,
  integrator = integrator.dinal1989{ h = 0.01 } }
local least, most = math.huge, 0
for period = 10, 29 do
  local theta = listed.theta:slice(100 * period + 1, 100 * period + 101)
  local amplitude = (theta:max() - theta:min()) / 2
  least, most = math.min(least, amplitude), math.max(most, amplitude)
end
fig:line("sin(6.28 t), h = 0.01, least", least)
fig:line("sin(6.28 t), h = 0.01, most", most)

fig:quote{ 0.836, 0.14, stick, slip, 100 * stuck, case.amplitude(run), 0.14, 0.01, last:max(), last:min(),
  6.28, least, most, 0.14, 0.001, case.row_amplitude(fine, 1000) }
return fig:draw{ case.columns(run, { "theta", "M/k" }, { xlim = { 0, 10 } }), case.plane(run), size = case.page }

--[[ prints
Figure 24: resonance, gamma = 0.836, h = 0.01
                                        1989     true motion           exact          report
amplitude                        0.158242517     0.129170352     0.129170352            0.14
sticks at t/T0 = n/2 +                           0.450179423      0.45017942
slips at t/T0 = n/2 +                            0.124937635      0.12493764
part of the time stuck                           0.349516424
highest, lowest, h = 0.01        0.158242517    -0.146906724
amplitude, h = 0.001             0.133535467
sin(6.28 t), h = 0.01, least     0.130102103
sin(6.28 t), h = 0.01, most      0.165784434
fig24.svg
]]
