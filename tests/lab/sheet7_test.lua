-- Sheet 7: the friction damper: two bodies, the best slip torque.
package.path = "tests/lab/?.lua;" .. package.path
local walk = require "walk"
local support = require "support"

walk.sheet("7-friction-damper", function(session)
  local given, steady = session.given, session.steady
  local omega = math.sqrt(2/(2 + given.mu))
  local alone = steady(0, 1).machine.amplitude
  walk.right("7a", alone)
  walk.right("7a", given.M0/given.C)
  local glued = 1/math.sqrt(1 + given.mu)
  walk.right("7b", glued)

  support.near(given.M0/(1 - omega^2), given.M0/((1 + given.mu)*omega^2 - 1), 1e-9)
  walk.right("7c", omega)
  local limit = given.mu*omega^2*steady(100, omega).machine.amplitude
  walk.right("7d", limit)
  support.equal(steady(1.01*limit, omega).joint.status, "adheres")
  assert(steady(0.97*limit, omega).joint.stuck < 1)

  local torque, peaks = vector.linspace(0.4, 1.6, 13)*given.M0, {}
  for i = 1, #torque do peaks[i] = session.peak(torque[i]) end
  local at = vector(peaks):argmin()
  local best = { Rd = torque[at], value = peaks[at] }
  walk.right("7e", best.Rd)
  walk.right("7f", best.value)
  assert(best.value < alone/3, "a damper that is worth it")
  assert(best.value < session.peak(0.5*best.Rd) and best.value < session.peak(2*best.Rd))
  local energy = steady(best.Rd, omega).run:energy()
  assert(energy.joint.dry > energy.machine.viscous)
  support.near(energy.joint.dry + energy.machine.viscous, energy.machine.input, 1e-9*energy.total.flow)

  if 2*given.M0 > 1.011*limit then walk.mistakes{ { "7d", 2*given.M0, "without C" } } end
  walk.mistakes{
    { "7a", given.M0, "at rest" },
    { "7a", given.C/given.M0, "upside down" },
    { "7b", 1/(1 + given.mu), "the root" },
    { "7b", math.sqrt(1 + given.mu), "slower" },
    { "7c", omega^2, "that is omega^2" },
    { "7d", limit/given.mu, "the inertia mu" },
    { "7d", limit/omega^2, "acceleration" },
    { "7e", limit, "glues them" },
    { "7e", 1.5*best.Rd, "too tight" },
    { "7e", 0.5*best.Rd, "too loose" },
    { "7f", alone, "without the damper" },
    { "7f", alone/glued, "glued together" },
  }
end, { 20260017 })  -- it takes seconds; draws_test.lua has other draws
