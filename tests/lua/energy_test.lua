dofile "tests/lua/support.lua"

-- Figure 27 of the report: steady after a while, both frictions, no stops.
local sys = nondimensional { zeta = 0.119, friction_ratio = 0.418 }
local M = excitation.harmonic { frequency = 1 }
local run = sys:simulate { M = M, theta0 = 1, t_end = 40, dt = 0.01 }
local energy = run:energy()

test("the energies add up, and the balance states how well", function()
    local total = energy.total
    near(total.input - total.kinetic - total.spring - total.viscous - total.dry, total.error, 1e-12 * total.flow)
    assert(total.closure <= 1e-12 and total.flow > total.input)
    near(energy.finish.kinetic - energy.start.kinetic, total.kinetic, 1e-15 * total.flow)
    near(energy.finish.spring - energy.start.spring, total.spring, 1e-15 * total.flow)
    equal(energy.start.spring, 0.5)
end)

--- What the half cycles add up to, in these columns and one more.
local function sums_of(half_cycles, more)
    local sums = { input = 0, kinetic = 0, spring = 0, viscous = 0, dry = 0, [more] = 0 }
    for _, half in ipairs(half_cycles) do
        for name, sum in pairs(sums) do sums[name] = sum + half[name] end
    end
    return sums
end

test("half cycles are a list of tables, the same list each time, that sum to the total", function()
    local half_cycles = energy.half_cycles
    equal(energy.half_cycles, half_cycles)
    for i, half in ipairs(half_cycles) do
        assert(half.t_end > half.t_start)
        if i > 1 then
            assert(half.t_start >= half_cycles[i - 1].t_end) -- later when it stuck in between
            equal(half.theta_start, half_cycles[i - 1].theta_end)
        end
    end
    for name, value in pairs(sums_of(half_cycles, "error")) do near(value, energy.total[name], 1e-13 * energy.total.flow) end
    local X = 1.9611201772 -- the amplitude of figure 27, exact
    near(half_cycles[#half_cycles - 1].dry, 2 * sys.Rd * X, 1e-9)
end)

test("energy prints as a small table", function()
    local text = tostring(energy)
    has(text, "t 0 … 40", "input", "kinetic", "spring", "from 0.5 to", "viscous", "dry", "half cycles")
    for line in text:gmatch("[^\n]+") do
        assert(utf8.len(line) <= 80, line)
    end
end)

test("each row of the printed table shows the value of that name in total", function()
    local shaken = system { I = 1, k = 4, C = 0.2, Rd = 0.1, walls = { upper = 0.05, restitution = 0.5 } }
        :simulate { M = M, base = excitation.harmonic { omega = 1 }, belt = 0.3, t_end = 10 }:energy()
    local rows = 0
    for name, number in tostring(shaken):gmatch "\n  (%l+) +(%S+)" do
        rows = rows + 1
        near(tonumber(number), shaken.total[name], 1e-5 * shaken.total.flow)
    end
    equal(rows, 9)
end)

test("the energy of a run without its motion is refused with a remedy", function()
    local rk4 = sys:simulate { M = M, t_end = 1, dt = 0.1, integrator = integrator.rk4 { h = 0.01 } }
    refused { { "rk4:energy()", "run:energy(): ", "integrator.exact and integrator.spectral" } }
    local sparse = sys:simulate { M = M, t_end = 1, dt = 0.1, dense = false }
    refused {
        { "sparse:energy()", "without dense = false" },
        { "reloaded(run):energy()", "read from a file", "simulate the system again" },
        { "run.energy()", "use a colon: run:energy()" },
    }
end)

test("misspelt names are errors with a suggestion", function()
    refused {
        { "energy.imput", "did you mean 'input'?" },
        { "energy.halfcycles", "did you mean 'half_cycles'?" },
        { "energy.input = 1", "cannot be changed" },
    }
end)

test("the complete part of a failed run has its energy", function()
    local ok = pcall(function()
        sys:simulate { M = function(t) assert(t < 5) return math.sin(6 * t) end, theta0 = 1, t_end = 10, dt = 0.1 }
    end)
    assert(not ok)
    local part = dinal.partial:energy()
    assert(part.total.dry > 1 and part.total.closure <= 1e-12)
end)

test("half cycles on a belt run from one extreme of theta to the next and sum to the total", function()
    local block = system { I = 1, k = 8, C = 0.6, Rd = 0.15, Re = 0.3 }
    for _, belt in ipairs { 0.1, 0.35, 2, excitation.harmonic { amplitude = 0.3, omega = 1.7 } } do
        local driven = block:simulate { M = excitation.harmonic { amplitude = 1.2, omega = 4 }, belt = belt, t_end = 30, dt = 0.5 }
        local found = driven:energy()
        for name, sum in pairs(sums_of(found.half_cycles, "belt")) do near(sum, found.total[name], 1e-12 * found.total.flow) end
        for i, half in ipairs(found.half_cycles) do
            if i > 1 then
                equal(half.t_start, found.half_cycles[i - 1].t_end)
                local theta, velocity = driven:at(half.t_start)
                near(theta, half.theta_start, 1e-12)
                near(velocity, 0, 1e-9)
            end
            near(half.error, 0, 1e-10)
        end
    end
end)

test("dry friction takes Rd (X0 + X1) of each half cycle of a free decay, exactly", function()
    local Rd = 0.167
    local decay = nondimensional { friction_ratio = Rd }:simulate { velocity0 = 2 * math.pi, t_end = 5, integrator = integrator.spectral {} }:energy()
    -- Thrown from the middle with the energy of amplitude 1: X = 0.846..., and 2 Rd less at each turn.
    local X, lost, gave = math.sqrt(1 + Rd ^ 2) - Rd, 0, 0.5
    equal(#decay.half_cycles, 4)
    for i, half in ipairs(decay.half_cycles) do
        local next = i == 1 and X or X - 2 * Rd
        local way = i == 1 and X or X + next
        near(half.dry, Rd * way, 1e-12)
        near(math.abs(half.theta_end), math.abs(next), 1e-12)
        if i > 1 then
            near(half.t_end - half.t_start, 0.5, 1e-12)
            near(half.spring, (next ^ 2 - X ^ 2) / 2, 1e-12)
            equal(half.kinetic, 0.0)
            gave = gave + (X ^ 2 - (half.theta_start * half.theta_end > 0 and next ^ 2 or 0)) / 2
        end
        X, lost = next, lost + Rd * way
    end
    local total = decay.total
    near(total.dry, lost, 1e-12)
    equal(total.input + total.viscous + decay.finish.kinetic, 0.0)
    near(decay.start.kinetic, 0.5, 1e-12)
    near(decay.finish.spring, 0.155151392 ^ 2 / 2, 1e-10) -- the report's nine digits
    near(total.flow, gave, 1e-12) -- what was there at the start, and what the spring gave back after each turn
end)

test("the columns are the balance of a run up to each row, whatever M and friction do, and jumps cost no energy", function()
    local function jumps(t) return t % 0.73 < 0.365 and 1 or -1 end
    for i, case in ipairs {
        { nondimensional { friction_ratio = 0.836 }, M, 5 }, { sys, M, 5 }, { nondimensional {}, M, 8 }, { system { I = 1, k = 1e4, C = 4000 }, M, 0.5 },
        { nondimensional { zeta = 0.05, friction_ratio = 0.2 }, excitation.square { period = 0.73 }, 12 },
        { nondimensional { zeta = 0.05, friction_ratio = 0.2 }, unread(jumps), 12 },
    } do
        local own, load, t_end = table.unpack(case)
        local function energy(till) return closes(own:simulate { M = load, theta0 = 1, t_end = till, dt = t_end / 37, integrator = integrator.spectral {} }, i, 1e-12) end
        local whole = energy(t_end)
        local off = 1e-12 * whole.total.flow
        equal(whole.input[1] + whole.dry[1], 0.0)
        near(whole.error:abs():max(), 0, off)
        for _, row in ipairs { 6, 22, 38 } do
            local part = energy(whole.t[row])
            for _, name in ipairs { "input", "viscous", "dry" } do near(whole[name][row], part.total[name], off) end
            for _, name in ipairs { "kinetic", "spring" } do near(whole[name][row], part.finish[name], off) end
        end
    end
end)

long_test("the sum over a hundred thousand half cycles has no more rounding than one half cycle", function()
    -- The parts of a panel add up to 1e-15 of what flows in it; sums that rounded at each half cycle are off by 2e-13 here.
    local many = sys:simulate { M = M, theta0 = 1, t_end = 5e4, dt = 5e4, integrator = integrator.spectral {} }:energy()
    assert(#many.half_cycles > 99990 and many.total.closure <= 1e-14, many.total.closure)
end)

test("a mass that never moves keeps the energy of its spring, and no energy flows", function()
    local still = nondimensional { zeta = 0.1, friction_ratio = 0.3 }:simulate { M = excitation.harmonic { amplitude = 0.1, omega = 3 }, theta0 = 0.1, t_end = 9 }:energy()
    equal(#still.half_cycles, 0)
    equal(still.total.flow + still.total.error + still.total.closure, 0.0)
    near(still.finish.spring, 0.005, 1e-17)
end)

finish()
