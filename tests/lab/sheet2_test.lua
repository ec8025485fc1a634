-- Sheet 2: sticking, dead zone, breakaway.
package.path = "tests/lab/?.lua;" .. package.path
local walk = require "walk"

walk.sheet("2-sticking", function(session)
  local given = session.given
  local function breakaway(slope)
    return lab.experiment(2, slope):filter(function(row) return row.theta > 0 end).M[1]
  end
  local sum = 0
  for i = 0, 9 do sum = sum + breakaway(1 + i/10) end
  local Re = sum/10
  walk.right("2a", Re)
  walk.right("2b", Re/given.k)

  local full = system{ I = given.I, k = given.k, Rd = given.Rd, Re = Re }
  local run = full:simulate{ theta0 = given.theta0, t_end = 10*full.T0, dt = full.T0/50 }
  local rest = run.events[#run.events].theta
  walk.right("2c", rest)

  local events = session.drawn(Re).events
  walk.right("2d", events[1].t)
  walk.right("2e", events[2].theta - events[1].theta)
  walk.right("2f", events[3].t - events[1].t)

  local simple = session.run.events
  local Rd, k, v = given.Rd, given.k, given.speed
  local a = (Re - Rd)/k
  walk.mistakes{
    { "2a", Rd, "that is Rd" },
    { "2a", Re/k, "that is an angle" },
    { "2a", 1.1*Re, "pull more slowly" },
    { "2a", 0.95*Re, "take several pulls" },
    { "2a", -Re, "the sign is not" },
    { "2a", math.deg(Re), "not one of the usual mistakes" }, -- a torque is not in degrees, nor in turns
    { "2a", Re/(2*math.pi), "not one of the usual mistakes" },
    { "2a", Re/2, "where does the factor 2 come in" },
    { "2b", 2*Re/k, "its whole width" },
    { "2b", Rd/k, "what holds a resting mass is Re" },
    { "2b", Re, "divide by the stiffness" },
    { "2b", math.deg(Re/k), "that is in degrees" },
    { "2c", simple[#simple].theta, "that is with Re = Rd" },
    { "2c", -rest, "the side is not" },
    { "2c", 0, "nothing brings it back" },
    { "2d", Rd/(k*v), "where M passes Rd" },
    { "2d", Re/v, "the stiffness is missing" },
    { "2e", 2*a, "the limit of pulling slowly" },
    { "2e", Re/k, "when it slipped" },
    { "2f", events[2].t - events[1].t, "that is how long it s" }, -- slips; sticking may last as long,
    { "2f", events[3].t - events[2].t, "that is how long it s" },
  }

  -- A quick pull is read too late, by what sheet and hint say; the bench refuses what it cannot do.
  assert(breakaway(2000) > 1.02*Re, breakaway(2000))
  local ok, message = pcall(lab.experiment, 2)
  assert(not ok and message:find("give it a slope", 1, true), message)
  ok, message = pcall(lab.experiment, 2, -1)
  assert(not ok and message:find("slopes from 0.1 to 2000", 1, true), message)
end)
