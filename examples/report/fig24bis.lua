-- Figure 24 bis: the last two periods of figure 24, as they are and as the program of 1989 computed them.
local case = dofile((debug.getinfo(1, "S").source:match("^@(.*/)") or "") .. "case.lua")

local fig = case.figure("24bis", "resonance, gamma = 0.836, the last two periods", ...)
local old, run, sys = case.run{ gamma = 0.836, r = 1, theta0 = 1, t_end = 30, h = 0.01 }

local function last(of, label)
  local from = #of - 200
  local t, theta, velocity = of.t:slice(from, #of), of.theta:slice(from, #of), of.velocity:slice(from, #of)
  fig:line(label .. ": highest, lowest", theta:max(), theta:min())
  return { t, theta, label = label }, { theta, velocity/sys.omega0, label = label }
end
local true_curve, true_loop = last(run, "true")
local old_curve, old_loop = last(old, "1989")
return fig:draw{
  case.response{ true_curve, old_curve, xticks = 0.5, yticks = 0.1 },
  plot{ true_loop, old_loop, equal = true, xlim = { -0.27, 0.27 }, ylim = { -0.27, 0.27 }, xticks = 0.1, yticks = 0.1,
    xlabel = "θ*", ylabel = "θ*'/2π", show = false },
  size = case.page,
}

--[[ prints
Figure 24 bis: resonance, gamma = 0.836, the last two periods
true: highest, lowest            0.129170352    -0.129170352
1989: highest, lowest            0.159404637    -0.148459345
fig24bis.svg
]]
