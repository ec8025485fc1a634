-- Figure 9: h = 0.1, "far above the largest admissible". The report sees it decay too slowly and lag behind; the
-- decay is the slip in stage 3, for the printed RK4 would decay a little too fast.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("09", "zeta = 0.02387, h = 0.1, with the slip of chapter 6", ...)
local zeta, h = 0.02387, 0.1
local slipped, old = case.scheme(zeta, h, 200, true)
local printed, rk4 = case.scheme(zeta, h, 200, false)
local exact = theory.free_response{ system = case.system(zeta), theta0 = 1, t = old.t }

local slip_factor, slip_period = case.growth(zeta, h, true)
local rk4_factor, rk4_period = case.growth(zeta, h, false)
local factor, period = math.exp(-2 * math.pi * zeta * h), 1 / math.sqrt(1 - zeta^2)
fig:head("with the slip", "RK4 as printed", "exact")
fig:line("factor per step", slip_factor, rk4_factor, factor)
fig:line("a swing in T0", slip_period, rk4_period, period)
local function largest(theta, n) return theta:slice(10 * n - 9, 10 * n + 1):abs():max() end
for _, n in ipairs{ 5, 10, 20 } do
  fig:line(string.format("largest |theta|, period %d", n), largest(old.theta, n), largest(rk4.theta, n),
    largest(exact, n))
end

slipped.dashes, printed.style = "dashed", "points"
fig:quote{ h, slip_factor, factor, 20, largest(old.theta, 20), largest(exact, 20), slip_period,
  20 / slip_period - 20 / period, rk4_factor, rk4_period }
return fig:draw{ case.exact(zeta, 20), slipped, printed, xlabel = "t*", ylabel = "θ*", xlim = { 0, 20 }, ylim = { -1, 1 },
  size = case.page }

--[[ prints
Figure 9: zeta = 0.02387, h = 0.1, with the slip of chapter 6
                               with the slip  RK4 as printed           exact
factor per step                  0.987197804     0.984795178     0.985113946
a swing in T0                    0.984936350     1.001491873     1.000285010
largest |theta|, period 5        0.560063283     0.540942221     0.548750341
largest |theta|, period 10       0.288908319     0.250468159     0.259158950
largest |theta|, period 20       0.084104190     0.053349907     0.057790791
fig09.svg
]]
