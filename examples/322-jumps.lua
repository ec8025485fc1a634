-- 322: the jumps of a resonance that leans over: Duffing's spring with dry friction, swept up and down in frequency. The
-- response curve knows both jumps and the unstable motion between them; two sweeps of runs see what it says.

local M0 = 0.5
local function resonance(Rd) return system{ I = 1, k = 1, C = 0.05, Rd = Rd, spring = spring.polynomial{ [3] = 0.5 } } end

-- Friction shortens the overhang: it takes 4 Rd X a cycle, the damper pi C w X^2.
print "Rd     jumps down at      from    to   | jumps up at        from    to"
for _, Rd in ipairs{ 0.02, 0.1, 0.2 } do
    local c = resonance(Rd):response{ amplitude = M0, over = { frequency = vector.linspace(0.14, 0.5, 80) }, between = true }
    local text = string.format("%.2f", Rd)
    for _, sweep in ipairs{ "up", "down" } do
        for _, jump in ipairs(c.jumps) do
            if jump.sweep == sweep then
                text = text .. string.format("   f = %.5f %9.3f %5.3f  ", jump.frequency, jump.from, jump.to)
            end
        end
    end
    print(text)
end

-- A sweep by hand: each run begins where the one before ended.
local sys = resonance(0.1)
local function swept(from, to, step)
    local theta, velocity, seen = 0, 0, {}
    for f = from, to, step do
        local M = excitation.harmonic{ amplitude = M0, frequency = f }
        local run = sys:simulate{ M = M, theta0 = theta, velocity0 = velocity, t_end = 40/f, dt = 0.25/f }
        theta, velocity = run.theta[#run], run.velocity[#run]
        local A = sys:steady{ M = M, theta0 = theta, velocity0 = velocity }.amplitude
        seen[#seen + 1] = { f = f, A = A }
    end
    return seen
end
for _, way in ipairs{ { "up", 0.20, 0.40, 0.005 }, { "down", 0.40, 0.20, -0.005 } } do
    local seen = swept(way[2], way[3], way[4])
    for i = 2, #seen do
        local a, b = seen[i - 1], seen[i]
        if math.abs(a.A - b.A) > 0.4 then
            print(string.format("swept %s: from %.3f to %.3f between f = %.3f and %.3f", way[1], a.A, b.A, a.f, b.f))
        end
    end
end

local c = sys:response{ amplitude = M0, over = { frequency = vector.linspace(0.14, 0.4, 80) }, between = true }
c:plot{ overlay = "jumps", title = "Rd = 0.1", width = 72, height = 18, ascii = true }
c:plot{ overlay = "jumps", title = "Rd = 0.1", ylabel = "amplitude", file = "figjumps.svg" }
print("figjumps.svg shows it")

--[[ prints
Rd     jumps down at      from    to   | jumps up at        from    to
0.02   f = 0.40148     3.851 0.093     f = 0.21658     0.877 1.761  
0.10   f = 0.35830     3.351 0.116     f = 0.21446     0.865 1.717  
0.20   f = 0.29645     2.604 0.159     f = 0.20866     0.822 1.603  
swept up: from 3.324 to 0.115 between f = 0.355 and 0.360
swept down: from 0.777 to 1.665 between f = 0.215 and 0.210
                                Rd = 0.1
amplitude   a stable   b unstable   c jumps
  |                                                     aaa
  |                                               aaaaaaa c
3 +                                        aaaaaaabb      c
  |                                   aaaaabbb            c
  |                            aaaaaaabbb                 c
2 +                      aaaaaabbbbb                      c
  |                aaaaaa   bbb                           c
  |          aaaaaa   c bbbb                              c
  |   aaaaaaa         abb                                 c          b
1 +aaa                a                                   c
  |                   aaaaa                               c
  |                        aaaaaaaaaaaaaaaaaaaaaaaaa      c
0 +- - - - - - - - - - - - - - - - - - - - - - - - -aaaaaaaaaaaaaaaaaac
  +---+-----------+-----------+------------+------------+-----------+
    0.15        0.20        0.25         0.30         0.35        0.40
                                frequency
figjumps.svg shows it
]]
