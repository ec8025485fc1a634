-- 324: the route to chaos of a driven double well with friction: a beam between two magnets (Moon and Holmes 1979),
-- I theta'' + C theta' + Rd sgn(theta') - theta + theta^3 = M0 cos(w t), looked at once a period. Periods double, and
-- double again, until none is left; dry friction puts that off.

local w, keep = 1.2, 24
local period = 2*math.pi / w
local function well(Rd)
    return system{ I = 1, k = 0, C = 0.3, Rd = Rd, spring = spring.polynomial{ [1] = -1, [3] = 1 } }
end
local function load(M0) return excitation.harmonic{ amplitude = M0, omega = w, phase = math.pi/2 } end
local function diagram(Rd, M0, skip)
    return bifurcation{ over = { M0 = M0 }, period = period, skip = skip, keep = keep, at = function(p)
        return { system = well(Rd), M = load(p.M0), theta0 = 1 }
    end }
end

-- How many different places the motion is seen at: its period in those of M.
local function periods(b, first)
    local seen = {}
    for i = first, first + keep - 1 do
        local new = true
        for _, x in ipairs(seen) do new = new and math.abs(x - b.theta[i]) > 1e-4 end
        if new then seen[#seen + 1] = b.theta[i] end
    end
    return #seen <= keep/2 and #seen or "chaos"
end
local M0 = { 0.20, 0.28, 0.29, 0.30, 0.31, 0.37, 0.50 }
local title = "  M0:"
for _, x in ipairs(M0) do title = title .. string.format("%7.2f", x) end
print(title)
for _, Rd in ipairs{ 0, 0.01, 0.02 } do
    local b, line = diagram(Rd, M0, 200), string.format("%.2f:", Rd)
    for i = 1, #b, keep do line = line .. string.format("%7s", periods(b, i)) end
    print(line)
end

-- What chaos looks like: one motion, looked at once a period, and all of the route.
local run = well(0.01):simulate{ M = load(0.5), theta0 = 1, t_end = 1000*period, times = vector.linspace(50, 1000, 951)*period }
plot{ { run.theta, run.velocity, style = "points" }, xlabel = "theta", ylabel = "velocity", title = "once a period",
      file = "figstrange.svg" }
diagram(0.01, vector.linspace(0.2, 0.5, 61), 60):plot{ title = "Rd = 0.01", file = "figroute.svg" }
print("figstrange.svg and figroute.svg show the rest")

--[[ prints
  M0:   0.20   0.28   0.29   0.30   0.31   0.37   0.50
0.00:      1      2      4  chaos  chaos      5  chaos
0.01:      1      2      2      4  chaos      5  chaos
0.02:      1      1      2      2      4      5  chaos
figstrange.svg and figroute.svg show the rest
]]
