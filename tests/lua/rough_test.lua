-- Functions with noise in runs with states, belts and several bodies: the message names the rough function.
dofile "tests/lua/support.lua"

-- A number within 1 that depends on t alone, and not smoothly anywhere.
local function noise(t)
    local s = math.sin(12345.678 * t + 1) * 43758545.3
    return 2 * (s - math.floor(s)) - 1
end

local sys = system { I = 1, k = 1, C = 0.1, Rd = 0.3, Re = 0.5 }

-- The options of a run with this much noise in one of its functions, by its name.
local noisy = {
    ["the belt"] = function(size)
        return { M = 0.2, belt = function(t) return 0.5 + 0.3 * math.sin(t) + size * noise(t) end }
    end,
    ["the base"] = function(size)
        return { M = 0.2, velocity0 = 1, base = function(t) return 0.9 * math.sin(0.7 * t) + size * noise(t) end }
    end,
    ["the rate of u"] = function(size)
        return {
            M = function(t, _, _, z) return math.sin(0.7 * t) - 0.1 * z.u end, velocity0 = 1,
            states = { u = { start = 1, rate = function(t, theta, _, z) return theta - z.u + size * noise(t) end } },
        }
    end,
}

for who, options in pairs(noisy) do
    test("noise ends a run with an explanation about " .. who .. ", and the tolerance that it names goes on", function()
        local function run(size, tolerance)
            local task = options(size)
            task.t_end, task.dt, task.integrator = 12, 0.5, tolerance and integrator.spectral { tolerance = tolerance }
            return sys:simulate(task)
        end
        local clean, sentences = run(0), 0
        for _, size in ipairs { 1e-11, 1e-9, 1e-8 } do -- greater ones take longer to get nowhere
            local found = run(size)
            local tolerance = found.outcome:match("tolerance = (%S+)")
            if tolerance then
                sentences = sentences + 1
                assert(found.outcome:find(who .. " is noisy on every scale", 1, true) == 1, found.outcome)
                assert(found:explain():gsub("%s+", " "):find(who .. " is noisy", 1, true) and tostring(found):find(who .. " is noisy", 1, true))
                found = run(size, tonumber(tolerance))
            end
            assert(#found == #clean, ("%g: %s"):format(size, found.outcome))
            -- what the noise, or the tolerance that takes it for nothing, does to a motion of size 1
            near(found.theta, clean.theta, 100 * size)
        end
        assert(sentences >= 1, sentences)
    end)
end

test("noise in M is followed as accurately as possible, also with two bodies", function()
    local function run(size)
        local rig = pair({ I = 1, k = 1, C = 0.1, Rd = 0.3, Re = 0.5 }, { I = 1, k = 2, Rd = 0.1 }, { k = 0.5 })
        local M = { a = function(t) return math.sin(0.7 * t) + size * noise(t) end }
        return rig:simulate { M = M, velocity0 = { a = 1 }, t_end = 12, dt = 0.5 }
    end
    local clean = run(0)
    equal(clean.outcome, "reached the end")
    for _, size in ipairs { 1e-11, 1e-9, 1e-8 } do
        local found = run(size)
        local said = tonumber(found.outcome:match("within the noise of the torques, (%S+)"))
        assert(said and said > size / 30 and said < 10 * size, found.outcome)
        -- A constant error of that size would move the mass by its own size over k.
        near(found.a.theta, clean.a.theta, size)
    end
end)

test("noise found in a steep pulse does not count for the motion after it", function()
    local c, w, A = 10.968540029560247, 5.0162678889507557e-07, 2847704.8565944256
    local function load(_, theta) return -0.1 * theta^3 end
    local sys = system { I = 1, k = 2, C = 0.2 }
    local function at(breaks)
        local M = excitation.scripted(function(t, theta) return load(t, theta) + A * math.max(0, 1 - ((t - c) / w)^2) end, { breaks = breaks })
        return sys:simulate { M = M, theta0 = 1, velocity0 = -1, t_end = 20 }:at(20)
    end
    -- The pulse is an impulse of 4/3 A w.
    local before = sys:simulate { M = load, theta0 = 1, velocity0 = -1, t_end = c }
    local theta, velocity = before:at(c)
    local after = sys:simulate { M = load, theta0 = theta, velocity0 = velocity + 4 / 3 * A * w, t_start = c, t_end = 20 }:at(20)
    for _, breaks in ipairs { {}, { c }, { c - w, c + w } } do near(at(breaks), after, 1e-6) end
end)

finish()
