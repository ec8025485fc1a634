-- Sheet 6: the governor: friction in a loop, hunting.
package.path = "tests/lab/?.lua;" .. package.path
local walk = require "walk"
local support = require "support"

local function swing(run)
  local late = run.states.w[run.t:find(function(t) return t > 300 end)]
  return late:max() - late:min()
end

walk.sheet("6-governor", function(session)
  local given, smooth, hunting = session.given, session.smooth, session.hunting
  local settled = smooth.states.w[#smooth]
  walk.right("6a", settled)
  walk.right("6a", -given.load/given.gain)

  local least = given.gain/given.C
  walk.right("6b", least)
  local function late_peak(J)
    local run = session.turbine{ J = J, t_end = 100 }
    return (run.states.w[run.t:find(function(t) return t > 80 end)] - settled):abs():max()
  end
  assert(late_peak(1.1*least) < 0.8*late_peak(0.9*least))

  walk.right("6c", 2*given.Re/given.gain)
  local late = session.late
  local amount = late:max() - late:min()
  walk.right("6d", amount)
  local slips = hunting.events:filter(function(e) return e.kind == "slip" and e.t > 250 end)
  local period = 2*(slips.t[#slips] - slips.t[1])/(#slips - 1)
  walk.right("6e", period)
  local even = swing(session.turbine{ Rd = given.Rd })
  walk.right("6f", even)
  support.near(swing(session.turbine{ Rd = given.Rd, Re = given.Re, dither = 0.3 }), 0, 0.05*amount)

  walk.mistakes{
    { "6a", -settled, "the sign" },
    { "6a", -given.load, "where the valve settles" },
    { "6a", 0, "an integral" },
    { "6b", 1/least, "upside down" },
    { "6b", given.gain, "where is C" },
    { "6c", given.Re/given.gain, "to one side" },
    { "6c", 2*given.Rd/given.gain, "held by Re" },
    { "6c", 2*given.Re, "divide by the gain" },
    { "6d", amount/2, "that is the amplitude" },
    { "6d", even, "with Re = Rd" },
    { "6d", 2*given.Re/given.gain, "the band of 6c" },
    { "6e", period/2, "half of it" },
    { "6e", 2*math.pi, "governor by itself" },
    { "6f", amount, "with Re > Rd" },
  }
end)
