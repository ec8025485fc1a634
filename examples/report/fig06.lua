-- Figure 6: the stop rule. When is a velocity that jumps over zero "zero"? Left, a turn and the two rules of the report
-- (the text takes the nearer of two points, the listing both); right, what they make of the stop of figure 22, h = 0.01.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("06", "the stop rule, free, gamma = 0.167, h = 0.01", ...)
local sys = case.system(0, 0.167)
local function by(rule)
  local run = sys:simulate{ velocity0 = sys.omega0, t_end = 1.8, dt = 0.01,
    integrator = integrator.dinal1989{ h = 0.01, stop = rule } }
  return run.t, run.velocity / sys.omega0, run.theta
end
local t, listing, theta = by "listing"
local _, text, theta_text = by "text"
local run = sys:simulate{ velocity0 = sys.omega0, t_end = 1.8, dt = 0.001 }
local velocity = run.velocity / sys.omega0

-- when it froze: the first row whose state is the last one's
local function frozen(v)
  local i = #v
  while v[i - 1] == v[#v] do i = i - 1 end
  return i
end
local first, second = frozen(listing), frozen(text)
local rest = run.events[#run.events]
fig:head("listing", "text", "true motion")
fig:line("stops at t =", t[first], t[second], rest.t)
fig:line("at theta =", theta[first], theta_text[second], rest.theta)
fig:line("with velocity/2 pi =", listing[first], text[second], 0)

fig:quote{ 0.01, listing[first], text[second], t[first], t[second], rest.t, theta[first], theta_text[second], rest.theta }
local step = math.abs(listing[23] - listing[24]) -- across the first turn
local x = { 0.205, 0.245 }
local function band(from, to, colour, label)
  return { x, { to, to }, base = { from, from }, style = "fill", colour = colour, label = label }
end
local rules = { band(step / 2, step, 6, "|v| < Δv"), band(-step, -step / 2, 6), -- side by side: none hides another
  band(-step / 2, step / 2, 3, "|v| < Δv/2"), { run.t, velocity, colour = 1, dashes = "solid", label = "true" },
  { t:slice(20, 27), listing:slice(20, 27), style = "points", colour = 2, label = "steps" },
  xlim = x, ylim = { -0.15, 0.15 }, xticks = 0.01, yticks = 0.05, ylabel = "θ*'/2π", title = "a turn" }
return fig:draw{
  case.response(rules),
  case.response{
    { run.t, velocity, colour = 1, dashes = "solid", label = "true" },
    { t, listing, style = "points", colour = 2, label = "listing" },
    { t, text, style = "points", colour = 3, label = "text" },
    xlim = { 1.54, 1.78 }, ylim = { -0.012, 0.003 }, xticks = 0.05, ylabel = "θ*'/2π", title = "a stop",
  },
  size = case.page,
}

--[[ prints
Figure 6: the stop rule, free, gamma = 0.167, h = 0.01
                                     listing            text     true motion
stops at t =                     1.610000000     1.650000000     1.723629613
at theta =                       0.152320407     0.151980290     0.155151392
with velocity/2 pi =            -0.001459352    -0.001232893     0.000000000
fig06.svg
]]
