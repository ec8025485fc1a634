-- 323: where a brake squeals, over the speed of the belt and the damping: two curves part the plane. Below the Hopf
-- points the sliding is unstable. Below the folds there is stick-slip, so between the two curves both are possible.

local Rd, Re, v0 = 0.3, 0.6, 0.3
local brake = system{ I = 1, k = 4, C = 0.1, friction = friction.stribeck{ Rd = Rd, Re = Re, speed = v0 } }
local c = brake:response{ over = { C = vector.linspace(0.15, 0.4, 6), speed = vector.linspace(0.3, 0.9, 13) },
    at = function(p) return { belt = p.speed, system = brake:with{ C = p.C } } end }

-- The sliding is unstable where friction falls by more than C: (Re - Rd) 2 v/v0^2 exp(-(v/v0)^2).
local function fall(v) return (Re - Rd) * 2*v/v0^2 * math.exp(-(v/v0)^2) end
print "C      sliding unstable below   fall of friction there   squeal below"
for _, p in ipairs(c.points:filter(function(p) return p.kind == "hopf" end)) do
    local fold = c.points:filter(function(q) return q.kind == "fold" and q.C == p.C end)
    print(string.format("%.2f   speed = %.6f         %.6f                 speed = %.6f", p.C, p.speed, fall(p.speed), fold.speed[1]))
end

-- The map shows the amplitude of the squeal where there is one: the greatest stable motion.
c:plot{ width = 60, height = 16, ascii = true }
c:plot{ overlay = "points", file = "figsqueal.svg" }
print("figsqueal.svg shows both curves in it")

--[[ prints
C      sliding unstable below   fall of friction there   squeal below
0.15   speed = 0.533848         0.150000                 speed = 0.868343
0.20   speed = 0.503889         0.200000                 speed = 0.704556
0.25   speed = 0.478768         0.250000                 speed = 0.599407
0.30   speed = 0.456683         0.300000                 speed = 0.527503
0.35   speed = 0.436628         0.350000                 speed = 0.475775
0.40   speed = 0.417965         0.400000                 speed = 0.437255
speed   amplitude:   . 0.0 to 0.2   + 0.2 to 0.4   # > 0.4
    |...................................................
    |#########..........................................
0.8 +#########..........................................
    |+++++++++..........................................
    |++++++++++++++++++.................................
    |++++++++++++++++++.................................
0.6 +++++++++++++++++++.................................
    |++++++++++++++++++++++++++.........................
    |+++++++++++++++++++++++++++++++++++................
    |+++++++++++++++++++++++++++++++++++++++++++........
0.4 ++++++++++++++++++++++++++++++++++++++++++++++++++++
    |++++++++++++++++++++++++++.........................
    |...................................................
    +-------------+----------------+----------------+----
                 0.2              0.3              0.4   C
figsqueal.svg shows both curves in it
]]
