-- One function writes a variable that another one reads. Functions are called out of order, ahead of time and again, so
-- the run is as if they were called in order of time, or reports that one depends on more than its arguments.
dofile "tests/lua/support.lua"

local change = 5.3
local shared
local function at_time(t) return t > change and 3 or 1 end

local function one(t) return 1 end
-- Each takes a run and the function that stands in this place, of which it is a part: 1 if nothing else is asked.
local places = {
    M = function(o, of) o.M.a = o.M.a + function(t) return of(t) * math.sin(t) end end,
    feedback = function(o, of) o.M.a = o.M.a + function(t, theta, v) return of(t) * (1 + theta.a) end end,
    link = function(o, of) o.M.s = function(t) return of(t) * math.cos(t) end end,
    belt = function(o, of)
        o.bodies.b.Rd = o.bodies.b.Rd or 0.1
        o.belt = { b = function(t) return 0.5 * of(t) end }
    end,
    base = function(o, of) o.base = function(t) return 0.3 * of(t) * math.sin(t) end end,
    normal = function(o, of)
        o.bodies.b.Rd = 0.1
        o.bodies.b.normal = function(t) return of(t) end
    end,
    Rd = function(o, of)
        o.bodies.a.Rd = function(t) return 0.1 * of(t) end
        o.bodies.a.Re = o.bodies.a.Re or function(t) return 0.8 end
    end,
    Re = function(o, of)
        o.bodies.a.Rd = o.bodies.a.Rd or function(t) return 0.1 end
        o.bodies.a.Re = function(t) return 0.3 * of(t) end
    end,
    law = function(o, of) o.links.s.friction = function(speed, t) return 0.1 * of(t) / (1 + speed) end end,
    rate = function(o, of)
        o.states = { q = { start = 0, rate = function(t, theta, v, z) return of(t) - z.q end } }
        o.M.a = o.M.a + function(t, theta, v, z) return z.q end
    end,
    when = function(o, of)
        table.insert(o.events, { name = "w", when = function(t, theta) return theta.a - 0.2 * of(t) end })
    end,
    moved = function(o, of)
        o.bodies.m = { theta = function(t) return 0.2 * of(t) * math.sin(t) end }
        o.links.u = { "m", "b", k = 1 }
    end,
    delayed = function(o, of)
        o.M.a = o.M.a + excitation.delayed(function(t, theta) return of(t) * (1 + theta.a) end, { by = 0.1 })
    end,
    relay = function(o, of)
        local function seen(t, theta) return of(t) * theta.a end
        o.M.a = o.M.a + excitation.relay { on = -0.1, off = 0.1, amplitude = 0.5, of = seen }
    end,
    -- These two are called only once for each time, in order.
    sampled = function(o, of)
        o.M.a = o.M.a + excitation.sampled(function(t, theta) return of(t) * (1 + theta.a) end, { every = 0.1 })
    end,
    act = function(o, of)
        local function act(t, theta, v) v.a = v.a + 0.1 * of(t) end
        table.insert(o.events, { name = "even", when = function(t) return (t - 1) % 2 - 1 end, act = act })
    end,
}
local names = {}
for name in pairs(places) do names[#names + 1] = name end
table.sort(names)

local function run(writer, reader, writes, reads)
    local o = { M = { a = excitation.harmonic { omega = 1 } }, events = {},
        bodies = { a = { I = 1, k = 4, C = 0.2 }, b = { I = 1, k = 1, C = 0.1 } }, links = { s = { "a", "b", k = 1, C = 0.1 } } }
    places[reader](o, reads)
    places[writer](o, writes)
    local result = system { bodies = o.bodies, links = o.links }:simulate { M = o.M, belt = o.belt, base = o.base, states = o.states,
        events = o.events, theta0 = { a = 0.5 }, velocity0 = { b = 0.3 }, t_end = 10, dt = 0.5 }
    return result
end

test("a variable that one function writes and another reads has its present value, or the run reports the contradiction", function()
    local told, right = 0, 0
    for _, writer in ipairs(names) do
        for _, reader in ipairs(names) do
            shared = 1
            local function write(t) shared = at_time(t) return 1 end
            local found = writer ~= reader and run(writer, reader, write, function(t) return shared end)
            if found and found.outcome:find("more than its arguments", 1, true) then
                told = told + 1
            elseif found then
                right = right + 1
                equal(found.outcome, "reached the end", writer .. " > " .. reader)
                -- act writes at even times
                local function timed(t) return writer == "act" and (t > 6.05 and 3 or 1) or at_time(t) end
                local wanted = run(writer, reader, one, timed)
                for _, body in ipairs { "a", "b" } do
                    local far = (found[body].theta - wanted[body].theta):abs():max()
                    assert(far < 1e-6, ("%s > %s: off by %g"):format(writer, reader, far))
                end
            end
        end
    end
    assert(right >= 28 and right + told == #names * (#names - 1), right)
end)

test("a variable that had one value in all evaluations of its reader, on a run of a few stretches, is detected", function()
    local p
    local function write(t) p = t < 1 and 1 or 2 return 0 end
    local function end_of(o, options)
        p = 1
        o.theta0, o.t_end, o.dt = -1, 3, 1
        return system(options):simulate(o)
    end
    local spring = { I = 1, k = 4, C = .2 }
    local runs = {
        end_of({ M = function(t) return p * math.sin(t) end, base = write }, spring),
        end_of({ states = { w = { start = 0, rate = write } } },
            { I = 1, k = 4, friction = friction.law(function(speed) return .02 * p + .01 * speed end) }),
        end_of({ base = write, M = function(t, theta, v, z) return z.q end,
            states = { q = { start = 0, rate = function() return p * .3 end } } }, spring),
        end_of({ states = { w = { start = 0, rate = write } },
            events = { { when = function(t, theta) return theta - .2 * p end, act = function(t, theta, v) return theta, .9 * v end } } },
            { I = 1, k = 4 }),
    }
    for i, run in ipairs(runs) do assert(run.outcome:find("depends on more than its arguments", 1, true), i .. ": " .. run.outcome) end
end)

finish()
