-- Sheet 3: resonance with friction, Den Hartog against linearisation.
package.path = "tests/lab/?.lua;" .. package.path
local walk = require "walk"

walk.sheet("3-resonance", function(session)
  local given, s = session.given, session.s
  local r, g = given.r, given.friction_ratio
  local V = 1/math.abs(1 - r^2)
  local U = math.tan(math.pi/(2*r))/r
  local A = math.sqrt(V^2 - (g*U)^2)
  walk.right("3a", s.amplitude)
  walk.right("3a", A)
  local linear = math.sqrt(1 - (4*g/math.pi)^2)*V
  local error = 100*(linear/A - 1)
  walk.right("3b", linear)
  walk.right("3c", error)
  walk.right("3d", math.deg(s.lag))

  -- the last two extremes on the same side
  local events = session.grows.events
  local growth = events[#events].theta - events[#events - 2].theta
  walk.right("3e", math.abs(growth))

  local low, high = g, 0.8
  for _ = 1, 8 do
    local middle = (low + high)/2
    local tried = nondimensional{ friction_ratio = middle }:steady{ M = excitation.harmonic{ frequency = r } }
    if tried.stops > 0 then high = middle else low = middle end
  end
  walk.right("3f", high)
  local slow = session.sys:steady{ M = excitation.harmonic{ frequency = given.low_r } }
  walk.right("3g", slow.stops)
  local damped = nondimensional{ friction_ratio = given.small_ratio, zeta = given.zeta }
  local held = damped:steady{ M = excitation.harmonic{ frequency = 1 } }
  walk.right("3h", held.amplitude)

  growth = math.abs(growth)
  walk.mistakes{
    { "3a", 2*A, "from peak to peak" },
    { "3a", V, "without friction" },
    { "3a", linear, "that is the linearised one" },
    { "3b", A, "the true one of 3a" },
    { "3b", -linear, "an amplitude is positive" },
    { "3b", (1 - (4*g/math.pi)^2)*V, "the root is missing" },
    { "3b", math.sqrt(1 - (math.pi*g/4)^2)*V, "pi/4" },
    { "3c", error/100, "percent are asked for" },
    { "3c", -error, "a positive error" },
    { "3c", 100*(V/A - 1), "with no friction at all" },
    { "3d", math.deg(s.peak_lag), "how much the greatest angle lags" },
    { "3d", 180 - math.deg(s.lag), "180 degrees less this" },
    { "3d", s.lag, "that is in radians" },
    { "3d", -math.deg(s.lag), "theta comes after M" },
    { "3e", growth/2, "in each half cycle" },
    { "3e", math.pi, "without friction" },
    { "3e", math.pi - given.small_ratio, "4 Rd/k in each period" },
    { "3f", math.pi/4, "the boundary at resonance" },
    { "3g", slow.stops/2, "in half a period" },
    { "3g", 0, "it does stop" },
    { "3g", slow.stops + 0.5, "a whole number" },
    { "3h", 1/(2*given.zeta), "without dry friction" },
    { "3h", 2*held.amplitude, "from peak to peak" },
  }
end)
