-- 340 Den Hartog's plane: amplitude and stops per cycle over frequency and friction, on all cores, and response curves.

-- Every point of the plane is a steady motion, found without a transient. g = Rd/(k a), r = f/f0.
local map = sweep{ r = vector.linspace(0.1, 2, 96), g = vector.linspace(0, 1, 51), run = function(p)
    local s = nondimensional{ friction_ratio = p.g }:steady{ M = excitation.harmonic{ frequency = p.r } }
    return { A = s.amplitude, stops = s.stops, lag = s.lag }
end }
print(#map .. " points")

-- In the terminal: how often the mass stops in each cycle. Under a friction ratio of 1 it moves at last.
map:plot{ x = "r", y = "g", z = "stops", title = "stops per cycle", height = 14, width = 60, ascii = true }

-- The boundary below which it never stops is Den Hartog's; the map agrees with it. At r = 1 the motion grows, so there
-- is no steady one, and its numbers are nan.
local agree, beside = 0, 0
for _, row in ipairs(map) do
    if row.r > 0.5 and row.g > 0 and row.g < 1 and row.stops == row.stops then
        local bound = theory.stop_boundary{ r = row.r }
        if math.abs(row.g - bound) < 0.02 then
            beside = beside + 1
        elseif (row.stops == 0) == (row.g < bound) then
            agree = agree + 1
        else
            print("disagreement", row.r, row.g, row.stops)
        end
    end
end
print(string.format("%d points agree with the boundary, %d are too near to it to say", agree, beside))

-- Pictures: the plane with lines of equal amplitude, and response curves.
map:plot{ x = "r", y = "g", z = "A", contours = { 0.5, 1, 2 }, zlim = { 0, 3 }, xlabel = "r", ylabel = "Rd/(k a)",
          title = "amplitude", file = "figamplitude.svg" }
local curves = { xlabel = "r", ylabel = "amplitude", ylim = { 0, 4 }, file = "figresponse.svg" }
for _, g in ipairs{ 0.2, 0.4, 0.6 } do
    local c = nondimensional{ friction_ratio = g }:response{ frequency = { 0.1, 2 }, points = 150 }
    table.insert(curves, { c.frequency, c.amplitude, label = "Rd/(k a) = " .. g })
end
plot(curves)
print("figamplitude.svg and figresponse.svg show them")

--[[ prints
4896 points
                        stops per cycle
   g   stops:   0   2   4   6
1.0 +222222222222222222222222222222222222222222222222222
    |222222222222222222222222222222222222222222222222222
    |422222222222222220000000 00222222222222222222222222
    |442222222222222200000000 00000000000222222222222222
    |444222222222220000000000 00000000000000000000000000
0.5 +644222222222200000000000 00000000000000000000000000
    |464422222222000000000000 00000000000000000000000000
    |442242222200000000000000 00000000000000000000000000
    |224222220000000000000000 00000000000000000000000000
0.0 +220200000000000000000000-00000000000000000000000000
    +-----------+------------+------------+-------------+
               0.5          1.0          1.5           2.0 r
3487 points agree with the boundary, 149 are too near to it to say
figamplitude.svg and figresponse.svg show them
]]
