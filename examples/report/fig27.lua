-- Figure 27: resonance with both frictions, zeta = 0.119, gamma = 0.418, h = 0.01: viscous damping limits what dry
-- friction alone would let grow for ever. It stops once in the transient and never again.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("27", "resonance, zeta = 0.119, gamma = 0.418, h = 0.01", ...)
local old, run, sys = case.run{ zeta = 0.119, gamma = 0.418, r = 1, theta0 = 1, t_end = 30, h = 0.01 }

local amplitude = theory.den_hartog{ r = 1, friction_ratio = 0.418, zeta = 0.119 } -- without stops, so it is exact
fig:head("1989", "true motion", "closed form")
fig:line("amplitude", case.row_amplitude(old, 100), case.amplitude(run), amplitude)
-- what dry friction alone would be worth as a viscous damper at this amplitude: 2 gamma/(pi r Phi)
fig:line("dry friction as a zeta", "", 2*0.418/(math.pi*amplitude))
fig:say(tostring(run))

local linear = theory.linearised{ r = 1, friction_ratio = 0.418, zeta = 0.119 }
fig:line("amplitude, linearised", "", "", linear)

fig:quote{ 0.119, 0.418, amplitude, case.row_amplitude(old, 100), linear, 100 * (linear / amplitude - 1) }
return fig:draw{ case.columns(run, { "theta", "M/k" }, { xlim = { 0, 10 } }), case.plane(run), size = case.page }

--[[ prints
Figure 27: resonance, zeta = 0.119, gamma = 0.418, h = 0.01
                                        1989     true motion     closed form
amplitude                        1.961207921     1.961120177     1.961120177
dry friction as a zeta                           0.135691360
3001 rows, t 0 … 30; 61 events (59 turns, 1 stick, 1 slip); moving at the end; peak |theta| 1.96
amplitude, linearised                                            1.965486850
fig27.svg
]]
