-- 340 Den Hartog's plane: amplitude and stops per cycle over frequency and friction, on all cores, and response curves.

-- Every point of the plane is a steady motion, found without a transient. g = Rd/(k a), r = f/f0.
local map = sweep{ over = { r = vector.linspace(0.1, 2, 96), g = vector.linspace(0, 1, 51) }, run = function(p)
    local s = nondimensional{ friction_ratio = p.g }:steady{ M = excitation.harmonic{ frequency = p.r } }
    return { A = s.amplitude, stops = s.stops, lag = math.deg(s.lag) }
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

-- Pictures: the plane, and the curves of the report's figures 5a and 5b: dotted where the
-- mass stops, with the boundary, and what becomes of one of them when friction is taken for viscous.
map:plot{ x = "r", y = "g", z = "A", zlim = { 0, 3 }, xlabel = "r", ylabel = "Rd/(k a)",
          title = "amplitude", file = "figamplitude.svg" }
local none = 0/0
local amplitudes = { xlabel = "r", ylabel = "amplitude", ylim = { 0, 3 }, file = "fig5a.svg" }
local lags = { xlabel = "r", ylabel = "lag, degrees", ylim = { 0, 180 }, yticks = 45, file = "fig5b.svg" }
for i, g in ipairs{ 0, 0.2, 0.4, 0.6, 0.7, 0.8 } do
    local c = nondimensional{ friction_ratio = g }:response{ over = { frequency = vector.linspace(0.05, 2, 118) }, between = true }
    for _, figure in ipairs{ { amplitudes, c.amplitude }, { lags, c.lag:abs() } } do
        local moving, stopping = {}, {}
        for j = 1, #c do
            -- A line across the jump of the lag at resonance would be no motion.
            local y = (figure[1] == lags and g == 0 and math.abs(c.frequency[j] - 1) < 0.01) and none or figure[2][j]
            moving[j] = c.stops[j] == 0 and y or none
            stopping[j] = c.stops[j] ~= 0 and y or none
        end
        table.insert(figure[1], { c.frequency, moving, label = "Rd/(k a) = " .. g, colour = i, dashes = "solid" })
        if g > 0 then table.insert(figure[1], { c.frequency, stopping, colour = i, dashes = "dotted" }) end
    end
    if g == 0.6 then
        table.insert(amplitudes, { c.linearised.frequency, c.linearised.amplitude, label = "0.6 as viscous", colour = 7, dashes = "dashed" })
        table.insert(lags, { c.linearised.frequency, c.linearised.lag*(180/math.pi), label = "0.6 as viscous", colour = 7, dashes = "dashed" })
    end
end
local r = vector.linspace(0.05, 2, 300)
table.insert(amplitudes, { r, theory.den_hartog{ r = r, friction_ratio = theory.stop_boundary{ r = r } * (1 - 1e-9) },
                           label = "stop boundary", colour = 7, dashes = "solid" })
plot(amplitudes)
plot(lags)
print("figamplitude.svg, fig5a.svg and fig5b.svg show them")

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
figamplitude.svg, fig5a.svg and fig5b.svg show them
]]
