-- Lab 6: the governor, friction in a loop, hunting (docs/lab/6-governor.md). Take a copy and fill it in.
lab.number(4711) -- your own number

local given = lab.given(6)

local function turbine(o)
  local sleeve = system{ I = 1, k = 1, C = given.C, Rd = o.Rd or 0, Re = o.Re or o.Rd or 0 }
  local J, dither = o.J or given.J, o.dither or 0
  local function M(t, theta, velocity, z) return given.gain*z.w + dither*math.sin(20*t) end
  local function rate(t, theta) return (-theta - (t < 5 and 0 or given.load))/J end
  return sleeve:simulate{ M = M, states = { w = { start = 0, rate = rate } },
    events = { { when = function(t) return t - 5 end, name = "load step" } },
    t_end = o.t_end or 400, dt = 0.1 }
end

-- 6.2 No friction
print(turbine{ t_end = 60 })
-- check("6a", )

-- 6.3 Stability
-- check("6b", )

-- 6.4 Friction
-- check("6c", )
-- check("6d", )
-- check("6e", )

-- 6.5 What makes it hunt
-- check("6f", )

print(lab.marks())
