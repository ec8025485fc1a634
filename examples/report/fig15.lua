-- Figure 15: undamped, h = 0.1: "diverges violently". After half a period the report prints -1.014360 instead of -1.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("15", "undamped, h = 0.1, with the slip of chapter 6", ...)
local slipped, old = case.scheme(0, 0.1, 500, true)
local printed, rk4 = case.scheme(0, 0.1, 500, false)

fig:head("1989", "RK4 as printed", "exact", "report")
fig:line("theta at t = 0.5", old.theta[6], rk4.theta[6], "-1", "-1.014360")
local slip_factor, rk4_factor = case.growth(0, 0.1, true), (case.growth(0, 0.1, false))
fig:line("factor per step", slip_factor, rk4_factor, "1")
fig:line("largest |theta| to t = 50", old.theta:abs():max(), rk4.theta:abs():max(), "1")
fig:line("last |theta|, t = 49 to 50", case.row_amplitude(old, 10), case.row_amplitude(rk4, 10), "1")

local function half_swing(h)
  local _, run = case.scheme(0, h, math.floor(0.5 / h + 0.5), true)
  return run.theta[#run]
end
fig:quote{ -1.01436, -1, 1, 5, 0.1, rk4.theta[6], -1.01436,
  0.1, old.theta[6], -1.01436, 0.01, half_swing(0.01), 0.001, half_swing(0.001),
  slip_factor, 0.1, case.row_amplitude(old, 10), case.row_amplitude(rk4, 10) }
return fig:draw{
  case.response{ slipped, ylim = { -5, 5 } },
  case.response{ printed, ylim = { -5, 5 } },
  size = case.page,
}

--[[ prints
Figure 15: undamped, h = 0.1, with the slip of chapter 6
                                        1989  RK4 as printed           exact          report
theta at t = 0.5                -1.014360024    -0.997964037              -1       -1.014360
factor per step                  1.003028741     0.999593719               1
largest |theta| to t = 50        4.290262482     1.000000000               1
last |theta|, t = 49 to 50       4.290262482     0.785199784               1
fig15.svg
]]
