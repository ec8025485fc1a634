-- Lab 2: sticking, dead zone, breakaway (docs/lab/2-sticking.md). Take a copy and fill it in.
lab.number(4711) -- your own number

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

-- 2.5 Stick-slip
-- check("2d", )
-- check("2e", )
-- check("2f", )

print(lab.marks())
