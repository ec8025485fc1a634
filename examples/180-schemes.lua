-- 180: the scheme laboratory. One motion by six schemes: how wrong they are, where they say it stops, what they cost.
--
--     dinal 180-schemes.lua          the table
--     dinal 180-schemes.lua time     with the time of each run, which is never twice the same
--
-- A mass is pushed with a torque of 1 and comes to rest; at t = 1.777 it is let go, breaks away, and rests again, off
-- centre. The truth is a closed form. Any other case will do: see `laboratory` below.

-- Two counter-examples, here and nowhere else. RK4 as one writes it in an afternoon, with a friction that is only a
-- function of the velocity: -Rd sgn(velocity), or -Rd tanh(velocity/v0), smooth so that any solver will take it.
local function rk4_with(friction)
  return function(case, M, h)
    local sys = case.system
    local function acceleration(t, theta, velocity)
      return (M(t) - sys.Rd * friction(velocity) - sys.C * velocity - sys.k * theta) / sys.I
    end
    local theta, velocity, columns = case.theta0, case.velocity0, { t = {}, theta = {}, velocity = {} }
    local every = math.floor(case.dt / h + 0.5) -- steps to a row
    for i = 0, math.floor(case.t_end / h + 0.5) do
      local t = i * h
      if i % every == 0 then
        local row = i // every + 1
        columns.t[row], columns.theta[row], columns.velocity[row] = t, theta, velocity
      end
      local v1, a1 = velocity, acceleration(t, theta, velocity)
      local v2, a2 = velocity + h/2 * a1, acceleration(t + h/2, theta + h/2 * v1, velocity + h/2 * a1)
      local v3, a3 = velocity + h/2 * a2, acceleration(t + h/2, theta + h/2 * v2, velocity + h/2 * a2)
      local v4, a4 = velocity + h * a3, acceleration(t + h, theta + h * v3, velocity + h * a3)
      theta, velocity = theta + h/6 * (v1 + 2*v2 + 2*v3 + v4), velocity + h/6 * (a1 + 2*a2 + 2*a3 + a4)
    end
    return columns
  end
end
local function sgn(velocity) return velocity > 0 and 1 or velocity < 0 and -1 or 0 end
local function tanh(velocity) return 1 - 2 / (math.exp(2 * velocity / 0.01) + 1) end -- v0 = 0.01

local function built_in(method)
  return function(case, M, h)
    return case.system:simulate{ M = M, theta0 = case.theta0, velocity0 = case.velocity0, t_end = case.t_end,
      dt = case.dt, integrator = method(h) }
  end
end

local schemes = {
  { "spectral", built_in(function() return integrator.spectral{} end), no_h = true },
  { "rk4", built_in(function(h) return integrator.rk4{ h = h } end) },
  { "dinal1989", built_in(function(h) return integrator.dinal1989{ h = h } end) },
  { 'stop = "text"', built_in(function(h) return integrator.dinal1989{ h = h, stop = "text" } end) },
  { "RK4 with sgn", rk4_with(sgn) },
  { "RK4 with tanh", rk4_with(tanh) },
}

-- laboratory{ system, M, theta0, velocity0, t_end, dt, steps, truth }: truth(t) is the true theta; each of the steps
-- must go into dt without remainder. With timed the last column says how many ms a run takes.
local function laboratory(case, timed)
  print("scheme            h     error   rest off by  velocity then   1000 calls of M" .. (timed and "     ms" or ""))
  local function line(scheme, h)
    local calls = 0
    local run = scheme[2](case, function(t) calls = calls + 1 return case.M(t) end, h)
    local worst, n = 0, #run.t
    for i = 1, n do worst = math.max(worst, math.abs(run.theta[i] - case.truth(run.t[i]))) end
    local function size(x) return x == 0 and "0" or x < 1e-11 and "< 1e-11" or string.format("%.1e", x) end
    local text = string.format("%-13s %5s  %8s  %12s  %13s %17.1f", scheme[1], h or "", size(worst),
      size(math.abs(run.theta[n] - case.truth(case.t_end))), size(math.abs(run.velocity[n])), calls / 1000)
    if timed then
      local start, runs = os.clock(), 0
      repeat
        scheme[2](case, case.M, h)
        runs = runs + 1
      until os.clock() - start > 0.1
      text = text .. string.format("%8.2f", 1000 * (os.clock() - start) / runs)
    end
    print(text)
  end
  for _, scheme in ipairs(schemes) do
    if scheme.no_h then line(scheme) else for _, h in ipairs(case.steps) do line(scheme, h) end end
  end
end

-- The case. While M is constant, theta - M/k moves as a free oscillator does: two closed forms, one after the other.
-- (Let go at 0.777 it is still moving. Then M jumps within a step of rk4; try it.)
local sys, off = nondimensional{ zeta = 0.02, friction_ratio = 0.167, breakaway_ratio = 0.2 }, 1.777
local function pushed(t) return theory.free_response{ system = sys, theta0 = -1, t = t } end
local theta_off, velocity_off = pushed(off)
local function truth(t)
  if t < off then return 1 + (pushed(t)) end
  return (theory.free_response{ system = sys, theta0 = 1 + theta_off, velocity0 = velocity_off, t = t - off })
end

print(string.format("in truth it rests at theta = %.6f from t = %.6f", truth(10),
  off + theory.time_to_rest{ system = sys, theta0 = 1 + theta_off, velocity0 = velocity_off }))
laboratory({ system = sys, M = function(t) return t < off and 1 or 0 end, theta0 = 0, velocity0 = 0, t_end = 10,
  dt = 0.05, steps = { 0.05, 0.01, 0.002 }, truth = truth }, (arg and arg[1]) == "time")
-- spectral and rk4 stand still, at the right place. The listing of 1989 stops at a row near velocity zero and keeps the
-- velocity it had there; its error falls as h does, at best. With sgn the mass never stands: it trembles, and slides
-- towards the middle as it does. With tanh a smaller h does not help: friction without a breakaway lets the mass creep
-- to the middle, with the time constant Rd/(k v0) = 16.7 T0. And above h = 2.8 I v0/Rd = 0.0043 it trembles, too.

--[[ prints
in truth it rests at theta = 0.178698 from t = 2.777200
scheme            h     error   rest off by  velocity then   1000 calls of M
spectral              < 1e-11       < 1e-11              0               0.4
rk4            0.05   1.8e-04       9.0e-05              0               0.5
rk4            0.01   2.7e-07       2.3e-08              0               2.1
rk4           0.002   4.2e-10       9.2e-11              0              10.1
dinal1989      0.05   7.2e-02       6.1e-02        1.2e+00               0.4
dinal1989      0.01   7.7e-03       2.6e-03        2.6e-01               2.0
dinal1989     0.002   3.3e-03       3.3e-05        2.9e-02              10.0
stop = "text"  0.05   6.5e-02       5.5e-05        5.6e-01               0.4
stop = "text"  0.01   4.8e-03       7.0e-05        1.1e-01               2.0
stop = "text" 0.002   2.7e-03       8.6e-06        2.5e-02              10.0
RK4 with sgn   0.05   1.9e-01       1.8e-01        8.2e-02               0.8
RK4 with sgn   0.01   1.3e-01       1.3e-01        1.7e-02               4.0
RK4 with sgn  0.002   5.5e-02       5.5e-02        6.8e-03              20.0
RK4 with tanh  0.05   1.9e-01       1.8e-01        4.4e-02               0.8
RK4 with tanh  0.01   1.0e-01       1.0e-01        2.0e-02               4.0
RK4 with tanh 0.002   8.7e-02       8.7e-02        6.2e-03              20.0
]]
