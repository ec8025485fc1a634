-- Lab 6: the governor, friction in a loop, hunting (docs/lab/6-governor.md). Copy it to 6-NUMBER.lua (NUMBER is yours) and fill it in.
-- dinal --report 6-NUMBER.lua makes the page to hand in.
lab.number(4711) -- your own number
local page = report{ title = "The governor", author = "your name" }

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
page:plot(turbine{ t_end = 60 }:plot{ show = false })
-- check("6a", )

-- 6.3 Stability
-- check("6b", )

-- 6.4 Friction
-- check("6c", )
-- check("6d", )
-- check("6e", )

-- 6.5 What makes it hunt
-- check("6f", )

-- Questions: write your answers here; an empty line begins a paragraph
page:heading "Questions"
page:text [[
1.

2.

3.

4.

5.
]]
page:save "answers.html"
print(lab.marks())
