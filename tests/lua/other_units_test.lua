-- The same problem in other units of time, angle and torque, each a power of two greater or smaller, is the same motion to
-- the last bit. A difference shows that a result depends on an absolute size.
dofile "tests/lua/support.lua"

-- Each gives the options of a system and of a run; u has the units: t, angle, torque, k, and speed = angle/t.
local cases = {
    ["terms with breaks"] = function(u, _, run)
        run.M = run.M + excitation.pulse { amplitude = 0.4*u.torque, at = 3*u.t, width = u.t } +
            excitation.square { amplitude = 0.2*u.torque, frequency = 1/(7*u.t) } + excitation.ramp { slope = 0.05*u.torque/u.t, at = 9*u.t, duration = 4*u.t }
    end,
    ["a narrow bump and a chirp"] = function(u, _, run)
        run.M = excitation.gaussian { amplitude = 2*u.torque, at = 5*u.t, sigma = 0.1*u.t } +
            excitation.chirp { amplitude = 0.8*u.torque, from = 0.05/u.t, to = 0.4/u.t, duration = 20*u.t }
    end,
    ["a feedback"] = function(u, _, run) run.M = function(t, theta, v) return u.torque*math.cos(t/u.t) - u.k*(0.2*theta + 0.1*v*u.t) end end,
    ["a sampled controller"] = function(u, _, run)
        local sum = 0
        run.M = run.M + excitation.sampled(function(_, theta, v)
            sum = sum + theta
            return -0.3*u.k*(theta + 0.05*sum + 0.5*v*u.t)
        end, { every = 0.375*u.t, delay = 0.0625*u.t })
    end,
    ["a relay"] = function(u, _, run) run.M = run.M + excitation.relay { on = -0.11*u.angle, off = 0.13*u.angle, amplitude = { 0.4*u.torque, -0.3*u.torque } } end,
    ["a delayed feedback"] = function(u, _, run) run.M = run.M + excitation.delayed(function(_, theta, v) return -0.4*u.k*theta - 0.3*u.k*u.t*v end, { by = 1.3*u.t }) end,
    ["events that act"] = function(u, _, run)
        run.events = { { when = function(_, theta) return theta - 0.2*u.angle end, direction = "up", act = function(_, theta, v) return theta, v/2 end },
            { when = function(_, _, v) return v - 0.3*u.speed end } }
    end,
    ["a table of friction"] = function(u, system)
        system.friction = friction.table { speed = { 0, 0.1*u.speed, 0.4*u.speed, 3*u.speed }, torque = { 0.2*u.torque, 0.1*u.torque, 0.13*u.torque, 0.2*u.torque } }
    end,
    ["a law of friction"] = function(u, system) system.friction = friction.law(function(v) return u.torque*(0.1 + 0.1/(1 + (v/u.speed)^2)) end) end,
    ["other friction each way"] = function(u, system)
        system.friction = friction.asymmetric { forward = { Rd = 0.1*u.torque, Re = 0.15*u.torque }, backward = { Rd = 0.17*u.torque } }
    end,
    ["Stribeck's friction on a belt"] = function(u, system, run)
        system.friction = friction.stribeck { Rd = 0.1*u.torque, Re = 0.2*u.torque, speed = 0.3*u.speed }
        run.belt = 0.25*u.speed
    end,
    ["a belt that turns"] = function(u, _, run) run.belt = function(t) return 0.5*u.speed*math.sin(0.7*t/u.t) end end,
    ["a base"] = function(u, _, run) run.base = excitation.harmonic { amplitude = 0.5*u.angle/u.t^2, omega = 1.7/u.t } end,
    ["walls"] = function(u, system, run)
        system.walls = { lower = -2*u.angle, upper = 0.3*u.angle, restitution = 0.6 }
        run.M = run.M + 0.6*u.torque
        run.theta0 = 0
    end,
    ["springs"] = function(u, system)
        system.spring = function(theta) return 0.5*u.torque*math.sin(theta/u.angle) + 0.1*u.torque*(theta/u.angle)^3 end
    end,
    ["a block"] = function(u, system, run) system.k, run.base = 0, function(t) return 0.5*u.angle/u.t^2*math.sin(1.1*t/u.t) end end,
}

local function run_of(change, method, t, angle, torque)
    local u = { t = t, angle = angle, torque = torque, k = torque/angle, speed = angle/t }
    local system_options = { I = 1.3*u.k*t^2, k = u.k, C = 0.07*u.k*t, Rd = 0.11*torque, Re = 0.14*torque }
    local options = { M = excitation.harmonic { amplitude = 0.9*torque, omega = 0.8/t, phase = 0.3 }, theta0 = 0.7*angle, velocity0 = -0.4*u.speed,
        t_end = 40*t, dt = t/2, integrator = method(t) }
    change(u, system_options, options)
    if system_options.friction then system_options.Rd, system_options.Re = nil, nil end
    return system(system_options):simulate(options)
end

local methods = { usual = function() end, spectral = function() return integrator.spectral {} end, rk4 = function(t) return integrator.rk4 { h = t/64 } end,
    dopri5 = function() return integrator.dopri5 { tolerance = 1e-6 } end }

for name, change in pairs(cases) do
    test("other units change no bit: " .. name, function()
        for method, make in pairs(methods) do
            local here = run_of(change, make, 1, 1, 1)
            assert(#here == 81, method .. ": " .. here.outcome)
            for _, units in ipairs { { 2^20, 1, 1 }, { 2^-33, 1, 1 }, { 1, 2^30, 1 }, { 1, 2^-40, 1 }, { 1, 1, 2^37 }, { 1, 1, 2^-39 }, { 2^-11, 2^13, 2^-17 } } do
                local t, angle = units[1], units[2]
                local there = run_of(change, make, table.unpack(units))
                local what = ("%s, t * %a, theta * %a, M * %a: "):format(method, table.unpack(units))
                assert(here.outcome == there.outcome, what .. there.outcome)
                assert(here.theta*angle == there.theta and here.velocity*(angle/t) == there.velocity, what .. "another motion")
                assert(#here.events == #there.events, what .. #there.events .. " events")
                for i, event in ipairs(here.events) do
                    assert(event.kind == there.events[i].kind and event.t*t == there.events[i].t, what .. event.kind .. " at " .. there.events[i].t)
                end
            end
        end
    end)
end

finish()
