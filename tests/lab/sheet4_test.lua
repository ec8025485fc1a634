-- Sheet 4: which number can you believe.
package.path = "tests/lab/?.lua;" .. package.path
local walk = require "walk"
local support = require "support"

--- The start script of the student with both slips built in where task 4.3 says.
local function scheme()
  local text = support.read "sheets/4-belief.lua":match "tasks = .*"
  local step = text:match "local (function step.-\nend)\n"
  step = step:gsub("local Q13, Q23 = [^\n]*", "local wrong = slip == 3 and Q21 or Q22\n" ..
    "  local Q13, Q23 = h*(v + wrong/2), h*f(u + Q12/2, v + wrong/2)")
  step = step:gsub("f%(u %+ Q13, v %+ Q23%)", "f(u + (slip == 4 and Q11 or Q13), v + Q23)")
  local factor = text:match "local (function factor.-\nend)\n"
  local session = setmetatable({}, { __index = _G })
  assert(load(step .. "\n" .. factor, "=student", "t", session))()
  return session.step, session.factor
end

walk.sheet("4-belief", function(session)
  local given, free, rest = session.given, session.free, session.rest
  local h, zeta = given.h, given.zeta
  local function half(how)
    return free:simulate{ theta0 = given.theta0, t_end = 0.5, dt = 0.5, integrator = how }.theta[2]
  end
  local function six(x) return tonumber(string.format("%.6f", x)) end
  local listing = half(integrator.dinal1989{ h = h })
  local slipped = half(integrator.dinal1989{ h = h, slip = true })
  walk.right("4a", six(listing))
  walk.right("4b", six(slipped))

  local step, factor = scheme()
  local u, v = 1, 0
  for _ = 1, 5 do u, v = step(u, v, 0.1, 0, 4) end
  support.near(u, -1.01436, 2e-6)
  walk.right("4c", six(factor(h, zeta, 3)))
  walk.right("4d", six(factor(h, zeta, 4)))

  -- as the sheet says: a step that does not diverge, one that does, and the middle between them
  local low, high = 0.15, 0.25
  for _ = 1, 12 do
    local middle = (low + high)/2
    if factor(middle, zeta, 3) > 1 then high = middle else low = middle end
  end
  walk.right("4e", high)

  local truth = rest()
  local got = rest(integrator.dinal1989{ h = 0.01 })
  support.near(truth, theory.rest_position{ system = session.dry, velocity0 = 2*math.pi }, 1e-12)
  walk.right("4f", truth)
  walk.right("4g", got - truth)
  local behind = math.deg(given.periods*(2*math.pi - 6.28))
  walk.right("4h", behind)

  walk.mistakes{
    { "4a", -given.theta0, "that is the truth" },
    { "4a", slipped, "with the slip" },
    { "4a", -listing, "the sign is not" },
    { "4a", tonumber(string.format("%.4f", listing)), "six digits" },
    { "4b", listing, "as it is printed" },
    { "4c", six(factor(h, zeta, 4)), "the slip in stage 4" },
    { "4c", six(factor(h, zeta)), "without a slip" },
    { "4c", factor(h, 0, 3), "without damping" },
    { "4c", factor(h, zeta, 3)^2, "that is the determinant" },
    { "4d", six(factor(h, zeta, 3)), "the slip in stage 3" },
    { "4d", math.exp(-2*math.pi*zeta*h), "that is the truth" },
    { "4e", zeta, "the bound of the report" },
    { "4f", got, "what the listing gets" },
    { "4f", -truth, "the side is not" },
    { "4g", truth - got, "what was got less what is true" },
    { "4g", got, "its error is asked for" },
    { "4h", math.rad(behind), "that is in radians" },
    { "4h", behind/given.periods, "in each period" },
    { "4h", -behind, "behind is positive" },
  }
end)
