-- Lab 4: which number can you believe (docs/lab/4-belief.md). Copy it to 4-NUMBER.lua (NUMBER is yours) and fill it in.
-- dinal --report 4-NUMBER.lua makes the page to hand in.
lab.number(4711) -- your own number
local page = report{ title = "Which number can you believe?", author = "your name" }

local given = lab.given(4)

-- 4.2 Half a swing
-- check("4a", )
-- check("4b", )

-- 4.3 Two suspects. The scheme as it is printed; build the slips in where slip is 3 or 4.
local function step(u, v, h, zeta, slip)
  local function f(x, y) return -4*math.pi^2*x - 4*math.pi*zeta*y end
  local Q11, Q21 = h*v, h*f(u, v)
  local Q12, Q22 = h*(v + Q21/2), h*f(u + Q11/2, v + Q21/2)
  local Q13, Q23 = h*(v + Q22/2), h*f(u + Q12/2, v + Q22/2)
  local Q14, Q24 = h*(v + Q23), h*f(u + Q13, v + Q23)
  return u + (Q11 + 2*Q12 + 2*Q13 + Q14)/6, v + (Q21 + 2*Q22 + 2*Q23 + Q24)/6
end

local function factor(h, zeta, slip)
  local a, b = step(1, 0, h, zeta, slip)
  local c, d = step(0, 1, h, zeta, slip)
  return math.sqrt(a*d - b*c)
end

local u, v = 1, 0
for _ = 1, 5 do u, v = step(u, v, 0.1, 0) end
print(string.format("after half a swing: %.6f; factor a step: %.6f", u, factor(0.1, 0)))
page:add("after half a swing", u)
-- check("4c", )
-- check("4d", )

-- 4.4 When does it diverge?
-- check("4e", )

-- 4.5 Where does it stop?
-- check("4f", )
-- check("4g", )

-- 4.6 6.28
-- check("4h", )

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
