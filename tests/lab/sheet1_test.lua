-- Sheet 1: free decay, viscous against dry.
package.path = "tests/lab/?.lua;" .. package.path
local walk = require "walk"

walk.sheet("1-free-decay", function(session)
  local given, viscous, dry, record = session.given, session.viscous, session.dry, session.record
  local T0 = 2*math.pi*math.sqrt(viscous.I/viscous.k)
  walk.right("1a", T0)

  local run = viscous:simulate{ theta0 = given.theta0, t_end = 10*viscous.T0, dt = viscous.T0/100 }
  local decrement = math.log(given.theta0/run.events[2].theta)
  local zeta = decrement/math.sqrt(4*math.pi^2 + decrement^2)
  walk.right("1b", decrement)
  walk.right("1c", zeta)

  run = session.run -- the dry one
  local lost = given.theta0 + run.events[1].theta
  local last = run.events[#run.events]
  walk.right("1d", lost)
  walk.right("1e", last.theta)
  walk.right("1f", last.t)

  local X0, X1, X2 = record.theta[1], -record.theta[2], record.theta[3]
  local q = (X1 - X2)/(X0 - X1)
  local z = -math.log(q)/math.pi
  local x_f = (q*X0 - X1)/(1 + q)
  walk.right("1g", z/math.sqrt(1 + z^2))
  walk.right("1h", x_f)

  walk.mistakes{
    { "1a", 1/T0, "the period is its reciprocal" },
    { "1a", 2*math.pi/T0, "that is omega0" },
    { "1a", math.sqrt(viscous.I/viscous.k), "2 pi is missing" },
    { "1a", 2*math.pi*math.sqrt(viscous.k/viscous.I), "have changed places" },
    { "1a", T0/2, "that is half of it" },
    { "1a", -T0, "the sign is not" },
    { "1a", 1.005*T0, "near, but outside the tolerance" },
    { "1a", 17.77*T0, "not right, and not one of the usual mistakes: read task 1.2 again" },
    { "1b", math.log(-given.theta0/session.viscous:simulate{ theta0 = given.theta0, t_end = T0, dt = T0 }.events[1].theta),
      "half a cycle" },
    { "1b", decrement/math.log(10), "base 10" },
    { "1b", math.exp(decrement), "its logarithm is asked for" },
    { "1b", -decrement, "the sign is not" },
    { "1c", decrement/2/math.sqrt(4*math.pi^2 + decrement^2/4), "half of it" },
    { "1c", decrement, "that is the decrement" },
    { "1c", 100*zeta, "percent" },
    { "1d", 2*lost, "a whole cycle" },
    { "1d", lost/2, "that is Rd/k" },
    { "1d", -lost, "a positive number" },
    { "1d", math.deg(lost), "that is in degrees" },
    { "1e", -last.theta, "the side is not" },
    { "1e", 0, "nothing brings it back" },
    { "1e", dry.dead_zone, "the edge of the dead zone" },
    { "1f", 2*last.t, "half a period" },
    { "1f", last.t - dry.T0/2, "one half swing too early" },
    { "1f", 2*last.t/dry.T0, "number of half swings" },
    { "1g", math.log(X0/X1)/math.pi, "takes all damping for viscous" },
    { "1g", z/2, "half of it" },
    { "1g", -z, "zeta is positive" },
    { "1h", 2*x_f, "that is 2 x_f" },
    { "1h", (X0 - X1)/2, "takes all damping for dry" },
    { "1h", -x_f, "take the extremes without theirs" },
  }
end)
