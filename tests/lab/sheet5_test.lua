-- Sheet 5: what made this record.
package.path = "tests/lab/?.lua;" .. package.path
local walk = require "walk"

walk.sheet("5-identification", function(session)
  local given, fit, record, pull = session.given, session.fit, session.record, session.pull
  walk.right("5a", fit.omega0)
  walk.right("5b", fit.zeta)
  walk.right("5c", fit.Rd_over_k)
  walk.right("5d", fit.offset)
  local k = given.I*fit.omega0^2
  walk.right("5e", k)
  walk.right("5f", fit.error_if_right.zeta)

  local known = identify{ data = record, velocity0 = 0, I = given.I }
  local driven = identify{ data = pull, M = excitation.ramp{ slope = given.slope }, I = given.I, k = known.k, C = known.C,
    Rd = known.Rd, theta0 = 0, velocity0 = 0, offset = 0, free = { "Re" } }
  local Re = driven.Re
  walk.right("5g", Re)

  local viscous = identify{ data = record, velocity0 = 0, I = given.I, Rd = 0 }
  walk.mistakes{
    { "5a", fit.omega0/(2*math.pi), "2 pi" },
    { "5a", 2*math.pi/fit.omega0, "that is the period" },
    { "5b", viscous.zeta, "takes all damping for viscous" },
    { "5b", 100*fit.zeta, "percent" },
    { "5b", fit.zeta/2, "that is half of it" },
    { "5b", 0.001, "not one of the usual mistakes" }, -- within the error bar of a thousandth of it
    { "5b", fit.zeta/1000, "a thousand times too small" },
    { "5c", 2*fit.Rd_over_k, "2 Rd/k" },
    { "5d", -fit.offset, "the size is right" },
    { "5d", record.theta[#record], "came to rest" },
    { "5e", fit.omega0^2, given.I == 1 and "right" or "that is k/I" },
    { "5f", fit.std_error.zeta, "any law of friction" },
    { "5f", 2*fit.error_if_right.zeta, "two of them" },
    { "5f", fit.error_if_right.zeta/fit.zeta, "relative to zeta" },
    { "5g", fit.Rd_over_k*k, "that is Rd" },
    { "5g", Re/k, "that is an angle" },
  }
  local ok, message = pcall(lab.experiment, 5, 3)
  assert(not ok and message:find("there are two records", 1, true), message)
end)
