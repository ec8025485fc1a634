-- Lab 2: sticking, dead zone, breakaway (docs/lab/2-sticking.md). Copy it to 2-NUMBER.lua (NUMBER is yours) and fill it in.
-- dinal --report 2-NUMBER.lua makes the page to hand in.
lab.number(4711) -- your own number
local page = report{ title = "Sticking, dead zone, breakaway", author = "your name" }

local given = lab.given(2)

-- 2.2 Breakaway: the torque at which the angle is first seen to change
local function breakaway(slope)
  local record = lab.experiment(2, slope)
  return record:filter(function(row) return row.theta > 0 end).M[1]
end
print("breakaway, one reading:", breakaway(5))
-- check("2a", )

-- 2.3 Dead zone
-- check("2b", )

-- 2.4 Where it ends
-- check("2c", )

-- 2.5 Stick-slip: add its picture with page:plot(drawn(Re):plot{ show = false })
-- check("2d", )
-- check("2e", )
-- check("2f", )

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
