-- 145: two engines. Closed forms where M has them, panels for every M; each is a second opinion on the other.

local sys = nondimensional{ zeta = 0.02, friction_ratio = 0.15 }

-- A load of native terms: a sine close to resonance, a push that fades, and a staircase of a square wave.
local M = excitation.harmonic{ amplitude = 0.4, omega = 2*math.pi * 0.9999 }
  + excitation.exponential{ amplitude = 0.8, tau = 1.5, at = 2 }
  + excitation.square{ amplitude = 0.1, period = 3.7 }:window(5, 20)

-- A function of t alone would be read as the same terms. What is called with theta is a torque that depends on the
-- motion, which has no closed form.
local function feedback(t, theta) return M(t) - 0.1*theta end

print("native M is taken by", sys:simulate{ M = M, t_end = 1, dt = 1 }.integrator)
print("feedback is taken by", sys:simulate{ M = feedback, t_end = 1, dt = 1 }.integrator)

-- Both, on the same load.
local function run(method) return sys:simulate{ M = M, theta0 = 1, t_end = 40, dt = 0.01, integrator = method } end
local exact, spectral = run(integrator.exact{}), run(integrator.spectral{})
print(string.format("%d and %d events; angles differ by less than 1e-12: %s", #exact.events, #spectral.events,
  (exact.theta - spectral.theta):abs():max() < 1e-12))
local latest = 0
for i, event in ipairs(exact.events) do
  assert(event.kind == spectral.events[i].kind)
  latest = math.max(latest, math.abs(event.t - spectral.events[i].t))
end
print("all of one kind, in one order; their times differ by less than 1e-12 T0: " .. tostring(latest < 1e-12))

-- What exact cannot take, it refuses, and says what takes it.
local ok, message = pcall(sys.simulate, sys, { M = feedback, t_end = 1, dt = 1, integrator = integrator.exact{} })
print(ok, message:match("integrator.exact.*"))

--[[ prints
native M is taken by	integrator.exact{}
feedback is taken by	integrator.spectral{}
80 and 80 events; angles differ by less than 1e-12: true
all of one kind, in one order; their times differ by less than 1e-12 T0: true
false	integrator.exact{} supports only native terms other than chirp and gaussian: use integrator.spectral{}, which supports every M
]]
