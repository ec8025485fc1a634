-- One problem written in two ways has one answer: mirrored, later in time, with a link to a fixed body instead of the
-- ground, with the torque of a base instead of the base, with a doubled law instead of a doubled load.
dofile "tests/lua/support.lua"

-- All systems here are of size 1; two ways differ by the rounding of the panels.
local tolerance = 1e-9

local function close(found, wanted, what)
    if type(found) == "number" then found, wanted = vector { found }, vector { wanted } end
    local far = #found ~= #wanted and math.huge or #found > 0 and (found - wanted):abs():max() or 0
    if far > 0 and not (far <= tolerance * math.max(1, wanted:abs():max())) then error(("%s differ by %g"):format(what, far), 2) end
end

local omega = 1.3
local sine = excitation.harmonic { amplitude = 2, omega = omega }
local dry = { Rd = 0.3, Re = 0.4 }
local function angle(theta) return type(theta) == "table" and theta.a or theta end
local function walls(way, more)
    return merged({ lower = way > 0 and -0.5 or -0.4, upper = way > 0 and 0.4 or 0.5 }, more)
end

-- What a body has, and what acts on it beside `sine`; all of it is mirrored if `way` is -1.
local kinds = {
    ["Coulomb friction"] = function() return dry end,
    ["other friction each way"] = function(way)
        local one, other = { Rd = 0.3, Re = 0.4 }, { Rd = 0.2 }
        return { friction = friction.asymmetric { forward = way > 0 and one or other, backward = way > 0 and other or one } }
    end,
    ["Stribeck's law on a belt"] = function(way) return { friction = friction.stribeck { Rd = 0.2, Re = 0.4, speed = 0.3 } }, { belt = way * 0.3 } end,
    ["bristles on a belt"] = function(way)
        return { friction = friction.lugre { Rd = 0.3, Re = 0.4, speed = 0.2, stiffness = 20, damping = 1 } }, { belt = way * 0.3 }
    end,
    ["two sliders"] = function()
        return { friction = { friction.jenkins { stiffness = 6, Rd = 0.4 }, friction.jenkins { stiffness = 3, Rd = 0.5 } } }
    end,
    ["walls"] = function(way) return { Rd = 0.1, walls = walls(way, { restitution = 0.7 }) } end,
    ["elastic walls"] = function(way) return { Rd = 0.1, walls = walls(way, { stiffness = 60, damping = 1 }) } end,
    ["a bent spring"] = function(way) return merged(dry, { spring = spring.polynomial { [2] = way * 0.8, [3] = 0.5 } }) end,
    ["a load that opens"] = function() return merged(dry, { normal = function(t) return 0.6 + math.sin(0.65 * t) end }) end,
    ["a relay"] = function(way)
        local function of(t, theta) return angle(theta) end
        return dry, { M = excitation.relay { on = way * -0.1, off = way * 0.15, amplitude = { way, way * -0.5 }, of = way > 0 and of or "theta" } }
    end,
    ["an act that throws it out"] = function(way)
        local function act(t, theta, velocity)
            if type(theta) == "number" then return way * 1.1, way * -0.1 end
            theta.a, velocity.a = way * 1.1, way * -0.1
        end
        local function when(t, theta) return angle(theta) - way * 0.2 end
        return merged(dry, { spring = spring.polynomial { [3] = 0.5 } }),
            { events = { { name = "thrown", when = when, direction = way > 0 and "up" or "down", act = act } } }
    end,
}

local body, start = { I = 1, k = 4, C = 0.1 }, { theta0 = 0.3, velocity0 = 0.2 }
local function drive_of(more, M, options) return merged(merged(more, { M = more.M and M + more.M or M, t_end = 12, dt = 0.1 }), options) end

-- The same events but turns, which a link does not have; `late`: so much later.
local function same_order(found, wanted, late)
    local function of(events, name) return events:filter(function(event) return event.kind ~= "turn" end):column(name) end
    equal(table.concat(of(found, "kind"), " "), table.concat(of(wanted, "kind"), " "))
    close(of(found, "t") - (late or 0), of(wanted, "t"), "times of events")
    return of(found, "velocity"), of(wanted, "velocity")
end

local function same_totals(found, wanted, names)
    for name, value in pairs(found) do
        if not names or names:find(name) then close(value, wanted[name], name) end
    end
end

local function shares(run) return table.concat({ run:explain():match "stuck for [^(]*%(([^)]*)" }) end

-- Motions whose search takes long, or that have no period.
local slow = { ["a relay"] = true, ["a load that opens"] = true, ["bristles on a belt"] = true }
local period = 2 * math.pi / omega

for kind, make in pairs(kinds) do
    local own, more = make(1)
    more = more or {}
    local sys = system(merged(body, own))
    local run = sys:simulate(drive_of(more, sine, start))
    local s = not slow[kind] and sys:steady(merged(more, { M = sine, period = period }))
    local columns = { "theta", "velocity", "M", "friction", "acceleration" }

    test("the mirrored problem has the mirrored answer: " .. kind, function()
        local own, more = make(-1)
        more = more or {}
        local other = system(merged(body, own))
        local mirrored = other:simulate(drive_of(more, -sine, { theta0 = -0.3, velocity0 = -0.2 }))
        for _, name in ipairs(columns) do close(-mirrored[name], run[name], name) end
        local found, wanted = same_order(mirrored.events, run.events)
        close(-found, wanted, "velocities of events")
        same_totals(mirrored:energy().total, run:energy().total)
        if not s then return end
        local t = other:steady(merged(more, { M = -sine, period = period }))
        for _, name in ipairs { "amplitude", "peak", "lag", "stuck", "stops" } do near(t[name], s[name], 1e-7) end
        near(t.mean, -s.mean, 1e-7)
    end)

    test("a problem that begins later has the same answer: " .. kind, function()
        local late = 64 -- no digit of a time is lost
        local function later(f) return function(t, ...) return f(t - late, ...) end end
        local system_options = merged(own, { normal = own.normal and later(own.normal) })
        local then_on = sine:delay(late)
        local other = system(merged(body, system_options))
        local shifted = other:simulate(drive_of(more, then_on, merged(start, { t_start = late, t_end = late + 12 })))
        for _, name in ipairs(columns) do close(shifted[name], run[name], name) end
        same_order(shifted.events, run.events, late)
        same_totals(shifted:energy().total, run:energy().total)
        equal(shares(shifted), shares(run))
        if not s then return end
        local t = other:steady(merged(more, { M = then_on:window(late, math.huge), period = period }))
        for _, name in ipairs { "amplitude", "peak", "lag", "peak_lag", "stuck", "stops", "mean" } do near(t[name], s[name], 1e-7) end
    end)

    test("a link to a body that stands still acts as on the ground: " .. kind, function()
        local link = merged(merged(own, { k = 4, C = 0.1 }), { "a", "b" })
        local rig = system { bodies = { a = { I = 1 }, b = { theta = 0 } }, links = { link = link } }
        local drive = drive_of(more, sine)
        drive.M, drive.belt = { link = drive.M }, { link = drive.belt }
        local linked = rig:simulate(merged(drive, { theta0 = { a = 0.3 }, velocity0 = { a = 0.2 } }))
        for _, name in ipairs { "theta", "velocity", "acceleration" } do close(linked.a[name], run[name], name) end
        close(linked.link.friction, run.friction, "friction")
        local found, wanted = same_order(linked.link.events, run.events)
        close(found, wanted, "velocities of events")
        local own_energy, energy = run:energy(), linked:energy()
        for _, name in ipairs { "input", "spring", "viscous", "dry", "belt", "acts", "impacts" } do
            close(energy[name], own_energy[name], name)
            close(energy.total[name], own_energy.total[name], name)
        end
    end)

    test("a base acts as M = -I a does: " .. kind, function()
        local by_base = sys:simulate(merged(merged(more, start), { base = sine, t_end = 12, dt = 0.1 }))
        local by_M = sys:simulate(drive_of(more, -sine, start))
        for _, name in ipairs { "theta", "velocity", "friction", "acceleration" } do close(by_base[name], by_M[name], name) end
        same_order(by_base.events, by_M.events)
        local total, wanted = by_base:energy().total, by_M:energy().total
        close(total.input + total.base, wanted.input, "work")
        if not more.M then close(total.flow, wanted.flow, "flow") end
    end)

    if s then
        test("amplitude and peak of a motion are those of theta in its run: " .. kind, function()
            local low, high = s.run.theta:min(), s.run.theta:max()
            near(s.amplitude, (high - low) / 2, 1e-2)
            near(s.peak, math.max(high, -low), 1e-2)
        end)
    end
end

test("samples outside a window have no effect", function()
    local t = vector.range(0, 240) / 20
    for _, method in ipairs { integrator.exact {}, integrator.spectral {}, integrator.rk4 { h = 0.01 } } do
        local function moved(outside)
            local M = (3 * t):sin():map(function(x, i) return (i <= 60 or i > 162) and outside or x end)
            local cut = excitation.samples { t = t, M = M }:window(3, 8)
            return system { I = 1, k = 4, Rd = 0.1 }:simulate(merged(start, { M = cut, t_end = 12, dt = 0.1, integrator = method })).theta
        end
        close(moved(5), moved(0), tostring(method))
    end
end)

test("a mass that its base will move later does not rest for good", function()
    local sys = system { I = 1, k = 4, Rd = 1.5 }
    equal(sys:simulate { base = sine, t_end = 0.1 }.status, "stuck")
    equal(sys:simulate { M = -sine, t_end = 0.1 }.status, "stuck")
end)

test("under the normal load 2 friction is the same law with all torques doubled", function()
    local laws = {
        ["Rd and Re"] = function(by) return { Rd = 0.2 * by, Re = 0.3 * by } end,
        Stribeck = function(by) return { friction = friction.stribeck { Rd = 0.2 * by, Re = 0.4 * by, speed = 0.3 } } end,
        table = function(by) return { friction = friction.table { speed = { 0, 0.2, 1 }, torque = { 0.3 * by, 0.2 * by, 0.25 * by } } } end,
        ["each way"] = function(by) return { friction = friction.asymmetric { forward = { Rd = 0.2 * by }, backward = { Rd = 0.1 * by, Re = 0.2 * by } } } end,
        ["alike each way"] = function(by)
            local one = { Rd = 0.2 * by, Re = 0.3 * by }
            return by == 2 and one or { friction = friction.asymmetric { forward = one, backward = one } }
        end,
        law = function(by) return { friction = friction.law(function(v) return by * (0.2 + 0.1 / (1 + v)) end, { Re = 0.4 * by }) } end,
        ["a function"] = function(by) return { friction = function(v) return by * (0.2 + 0.1 / (1 + v)) end } end,
        LuGre = function(by) return { friction = friction.lugre { Rd = 0.3 * by, Re = 0.4 * by, speed = 0.2, stiffness = 20 * by, damping = by } } end,
        ["a slider"] = function(by) return { friction = friction.jenkins { stiffness = 6, Rd = 0.2 * by } } end,
        ["two sliders"] = function(by) return { friction = { friction.jenkins { stiffness = 6, Rd = 0.2 * by }, friction.jenkins { stiffness = 3, Rd = 0.3 * by } } } end,
    }
    for name, law in pairs(laws) do
        local loads = { 2 }
        if not name:find "slider" then loads[2], loads[3] = function(t) return 2 end, excitation.constant(2) end
        local drive = merged(start, { M = sine, t_end = 9, dt = 0.1 })
        local own = system(merged(body, law(2)))
        local strong = own:simulate(drive)
        for _, load in ipairs(loads) do
            local sys = system(merged(merged(body, law(1)), { normal = load }))
            local loaded = sys:simulate(drive)
            if name == "Rd and Re" then
                local found, wanted = sys:steady { M = sine, period = period }, own:steady { M = sine, period = period }
                for _, field in ipairs { "amplitude", "lag", "stops" } do near(found[field], wanted[field], 1e-8) end
                near(found.multipliers[1].abs, wanted.multipliers[1].abs, 1e-7)
            end
            for _, column in ipairs { "theta", "velocity", "friction", "acceleration" } do close(loaded[column], strong[column], name .. ": " .. column) end
            same_order(loaded.events, strong.events)
            close(loaded:energy().total.dry, strong:energy().total.dry, name .. ": dry")
            local told = loaded:explain():gsub(" These are[^:]-load 2%.", "")
            if load == 2 then equal(told:gsub("%s+", " "), (strong:explain():gsub("%s+", " "))) end
        end
    end
    local function moved(more) return system(merged({ I = 1, k = 4, C = 0.1 }, more)):simulate(merged(start, { M = sine, t_end = 9, dt = 0.1 })).theta end
    close(moved(merged(laws.LuGre(1), { normal = function() return -1 end })), moved {}, "bristles under a load below 0")
end)

finish()
