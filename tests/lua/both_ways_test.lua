-- A body is a system of one: each question about each kind of system is asked both ways, of system{ ... } and of the
-- same body as the only one of system{ bodies = { a = ... } }. The answers must be equal, except for the name. The
-- table `different` lists what is not yet equal; it can only become shorter.
dofile "tests/lua/support.lua"

-- All systems here are of size 1, and a panel is integrated to 1e-12. Two paths to the same motion differ by the
-- rounding of some hundred panels and events: by 1e-9 of a number at most, or of 1 if the number is smaller.
local tolerance = 1e-9

-- ---- the two ways

local function one_value(x) return x ~= nil and { a = x } or nil end

-- A function is written once, as text: for one body `theta` and `velocity` are numbers, for several they are tables.
local function named(text)
    local head, body = text:match "^(function%b())(.*)$"
    return head .. body:gsub("%f[%w_]theta%f[^%w_]", "theta.a"):gsub("%f[%w_]velocity%f[^%w_]", "velocity.a")
end

local function compiled(text) return assert(load("return " .. text))() end

local alone = {
    f = function(text) return compiled(text) end,
    times = function(factor)
        return compiled("function(t, theta, velocity) return theta, " .. factor .. " * velocity end")
    end,
    theta = "theta",
    system = function(body) return system(body) end,
    options = function(drive) return drive end,
    part = function(whole) return whole end,
    told = function(story)
        return (story:gsub("%s+", " "):gsub("The system ", "a "):gsub("The mass ", "a "))
    end,
}
local only_one = {
    f = function(text) return compiled(named(text)) end,
    times = function(factor)
        return compiled("function(t, theta, velocity) velocity.a = " .. factor .. " * velocity.a end")
    end,
    theta = "theta.a",
    system = function(body) return system { bodies = { a = body } } end,
    options = function(drive)
        local options = merged(drive)
        for _, name in ipairs { "M", "theta0", "velocity0", "belt" } do options[name] = one_value(drive[name]) end
        return options
    end,
    part = function(whole) return whole.a end,
    told = function(story) return (story:gsub("%s+", " ")) end,
}

-- ---- the kinds of systems: what a body has beside I, k and C, and what acts on it

local omega = 1.3
local period = 2 * math.pi / omega
local dry = { Rd = 0.3, Re = 0.4 }
local sine = excitation.harmonic { amplitude = 2, omega = omega }

local function stops(restitution)
    return function() return merged(dry, { walls = { lower = -0.4, upper = 0.5, restitution = restitution } }) end
end
local function rubs(law) return function() return { friction = law } end end
local function acts(drive) return function(own) return dry, drive(own) end end
local function located(event)
    return acts(function(own)
        local passes = { when = own.f "function(t, theta, velocity) return theta - 0.3 end", direction = "up" }
        return { events = { merged(passes, event(own)) } }
    end)
end

local kinds = {
    ["no dry friction"] = function() return {} end,
    ["Coulomb with Re = Rd"] = function() return { Rd = 0.3 } end,
    ["Coulomb with Re above Rd"] = function() return dry end,
    Stribeck = rubs(friction.stribeck { Rd = 0.3, Re = 0.4, speed = 0.2 }),
    LuGre = rubs(friction.lugre { Rd = 0.3, Re = 0.4, speed = 0.2, stiffness = 10, damping = 0.5 }),
    Dahl = rubs(friction.dahl { Rd = 0.3, stiffness = 10 }),
    ["friction.table"] = rubs(friction.table { speed = { 0, 0.5, 2 }, torque = { 0.4, 0.25, 0.3 } }),
    uneven = rubs(friction.asymmetric { forward = { Rd = 0.3, Re = 0.4 }, backward = { Rd = 0.2 } }),
    ["a law in Lua"] = rubs(friction.law(function(speed) return 0.3 + 0.1 / (1 + speed) end)),
    ["a function of the speed"] = rubs(function(speed) return 0.3 + 0.1 / (1 + speed) end),
    ["Rd of t"] = function() return { Rd = function(t) return 0.3 + 0.1 * math.sin(1.3 * t) end } end,
    ["normal constant"] = function() return merged(dry, { normal = 1.5 }) end,
    ["normal of t and theta"] = function(own)
        return merged(dry, { normal = own.f "function(t, theta) return 1 + 0.2 * math.sin(1.3 * t) + 0.1 * theta end" })
    end,
    ["spring.polynomial"] = function() return merged(dry, { spring = spring.polynomial { [3] = 0.5 } }) end,
    ["a spring in Lua"] = function() return merged(dry, { spring = function(x) return 0.5 * x ^ 3 end }) end,
    ["walls of restitution 0"] = stops(0),
    ["walls of restitution 0.7"] = stops(0.7),
    ["elastic walls"] = function() return merged(dry, { walls = { lower = -0.6, upper = 0.7, stiffness = 300, damping = 2 } }) end,
    Jenkins = function() return { friction = friction.jenkins { stiffness = 6, Rd = 0.4 } } end,
    freewheel = function() return { friction = friction.freewheel { Rd = 0.2 } } end,
    ["belt constant"] = acts(function() return { belt = 0.2 } end),
    ["belt of t"] = acts(function() return { belt = function(t) return 0.2 * math.sin(1.3 * t) end } end),
    ["held on a belt"] = function() return { Rd = 30 }, { belt = 0.2 } end,
    base = acts(function() return { base = 0.3 * sine } end),
    ["state idle"] = acts(function()
        return { states = { z = { start = 1, rate = function(t, theta, velocity, z) return -z.z end } } }
    end),
    ["state acting"] = acts(function(own)
        local rate = own.f "function(t, theta, velocity, z) return 0.2 * theta - z.z end"
        return { states = { z = { start = 0.5, rate = rate } },
            M = sine + excitation.scripted(own.f "function(t, theta, velocity, z) return 0.3 * z.z end") }
    end),
    ["event"] = located(function() return { name = "there" } end),
    ["event that acts"] = located(function(own) return { act = own.times "1.3" } end),
    ["event that bounces endlessly"] = located(function(own) return { act = own.times "-0.5" } end),
    ["event that stops"] = located(function() return { stop = true } end),
    feedback = acts(function(own)
        local pull = own.f "function(t, theta, velocity) return 0.1 * theta - 0.2 * velocity end"
        return { M = sine + excitation.scripted(pull) }
    end),
    ["M that is read"] = acts(function()
        local function pull(t) return 2 * math.sin(1.3 * t) / (1 + 0.1 * math.sin(1.3 * t) ^ 2) end
        return { M = excitation.scripted(pull) }
    end),
    ["M that is not read"] = acts(function()
        return { M = excitation.scripted(unread(function(t) return 2 * math.sin(1.3 * t) end)) }
    end),
    resonance = function() return { C = 0, k = omega ^ 2 } end,
    block = function() return { k = 0, Rd = 0.3, Re = 0.4 } end,
    overdamped = function() return { C = 9, Rd = 0.3, Re = 0.4 } end,
    ["held for ever"] = function() return { Rd = 1.9, Re = 2.5 } end,
    ["two harmonics"] = function() return { C = 0.4 }, { M = sine + excitation.harmonic { omega = 2 * omega, phase = 1 } } end,
    ["normal that opens"] = function() return merged(dry, { normal = function(t) return math.sin(1.3 * t) + 0.5 end }) end,
    preload = function() return { spring = function(x) return x > 0 and 0.3 or -0.3 end } end,
    ["a load that slides"] = acts(function(own)
        return { M = sine + excitation.scripted(own.f "function(t, theta, velocity) return velocity > 0 and -0.5 or 0.5 end") }
    end),
    ["sampled with memory"] = acts(function(own)
        return { M = sine + excitation.sampled(own.f [[function(t, theta, velocity, z, memory)
            memory.sum = 0.9 * memory.sum + theta
            return -0.1 * memory.sum
        end]], { every = period / 16, start = function() return { sum = 0 } end }) }
    end),
    delayed = acts(function(own)
        local brake = own.f "function(t, theta, velocity) return -0.3 * velocity end"
        return { M = sine + excitation.delayed(brake, { by = period / 16 }) }
    end),
    relay = acts(function(own)
        return { M = excitation.relay { on = -0.1, off = 0.1, amplitude = 1, of = own.theta } }
    end),
}
local autonomous = { relay = true }

-- ---- the questions: each returns its answers by name

local function drive_of(way, kind, more)
    local body, drive = kinds[kind](way)
    drive = merged({ M = sine, theta0 = 0.4, velocity0 = 0.1 }, drive)
    return way.system(merged({ I = 1, k = 4, C = 0.1 }, body)), merged(drive, more)
end

-- Most questions are about the same run, which no question changes.
local runs = { [alone] = {}, [only_one] = {} }
local function simulated(way, kind, more)
    if not more and runs[way][kind] then return runs[way][kind] end
    local sys, drive = drive_of(way, kind, merged({ t_end = 9, dt = 0.1 }, more))
    local run = sys:simulate(way.options(drive))
    if not more then runs[way][kind] = run end
    return run
end

local function period_of(kind) return { period = not autonomous[kind] and period or nil } end

local function fields(of, names)
    local answer = {}
    for name in names:gmatch "%S+" do answer[name] = of[name] end
    return answer
end

local function copy(of)
    local answer = {}
    for name, value in pairs(of) do answer[name] = value end
    return answer
end

local function rows(run)
    return merged(fields(run, "t theta velocity M friction damping acceleration"), { states = copy(run.states) })
end

local function columns(data)
    local answer = {}
    for _, name in ipairs(data.names) do answer[(name:gsub("^a%.", ""))] = data:column(name) end
    return answer
end

-- With several bodies an event also says where it was: at `a`, or nowhere for an event of the user.
local function events(run)
    local answer = columns(run.events)
    for _, where in ipairs(answer.where or {}) do assert(where == "a" or where == "", where) end
    answer.where = nil
    return answer
end

local run_fields = "outcome status t_start t_end gap names units excitation integrator system"

-- One field of each of these members, as each may be refused by itself.
local function each(of, names, ask)
    local answer = {}
    for name in names:gmatch "%S+" do
        local ok, value = pcall(ask or function(x, member) return x[member] end, of, name)
        if ok then answer[name] = value else answer[name] = "refused: " .. tostring(value) end
    end
    return answer
end

local function balance(run)
    local energy = run:energy()
    local answer = each(energy, "half_cycles start finish t input kinetic spring viscous dry error")
    answer = merged(answer, each(energy, "belt base acts impacts others"))
    for name, value in pairs(energy.total) do answer["total." .. name] = value end
    return answer
end

local function pictures(run)
    return each(run, "plot phase_plot", function(_, name) return picture(run, {}, name) end)
end

local questions = {
    rows = function(way, kind) return rows(way.part(simulated(way, kind))) end,
    ["events of the run"] = function(way, kind) return events(simulated(way, kind)) end,
    ["events of the body"] = function(way, kind) return events(way.part(simulated(way, kind))) end,
    at = function(way, kind)
        local answer, run = {}, way.part(simulated(way, kind))
        for i = 0, 4 do answer["quarter" .. i] = { run:at(i / 4 * run.t_end) } end
        return answer
    end,
    ["fields of the run"] = function(way, kind) return each(simulated(way, kind), run_fields) end,
    ["fields of the body"] = function(way, kind) return each(way.part(simulated(way, kind)), run_fields) end,
    ["words of the run"] = function(way, kind)
        local run = simulated(way, kind)
        return { line = tostring(run), story = way.told(run:explain()), energy = tostring(run:energy()) }
    end,
    ["words of the body"] = function(way, kind)
        local run = way.part(simulated(way, kind))
        return { line = tostring(run), story = way.told(run:explain()), energy = tostring(run:energy()) }
    end,
    ["energy of the run"] = function(way, kind) return balance(simulated(way, kind)) end,
    ["energy of the body"] = function(way, kind) return balance(way.part(simulated(way, kind))) end,
    integrators = function(way, kind)
        return each(integrator, "spectral exact rk4 dopri5 dinal1989", function(all, name)
            local steps = name == "rk4" or name == "dinal1989"
            local chosen = all[name] { h = steps and 0.01 or nil, tolerance = name == "dopri5" and 1e-9 or nil }
            local run = way.part(simulated(way, kind, { integrator = chosen }))
            return merged(rows(run), { between = { run:at(run.t_end / 2.7) } })
        end)
    end,
    continue = function(way, kind)
        local run = simulated(way, kind, { t_end = 4.03 }):continue { t_end = 9 }
        local part = way.part(run)
        return merged(rows(part), { events = part.events.t, outcome = run.outcome, line = tostring(part) })
    end,
    ["continue of the body"] = function(way, kind)
        return rows(way.part(simulated(way, kind, { t_end = 4.03 })):continue { t_end = 9 })
    end,
    save = function(way, kind)
        local run = simulated(way, kind)
        local back, file = reloaded(run)
        return merged(columns(back), { header = read(file):match "^(.-)\n[^#]" })
    end,
    ["save of the body"] = function(way, kind)
        local back, file = reloaded(way.part(simulated(way, kind)))
        return merged(columns(back), { header = read(file):match "^(.-)\n[^#]" })
    end,
    repeated = function(way, kind)
        local run = simulated(way, kind)
        local again = repeated(run)
        same_events(again, run, 0)
        for _, name in ipairs(run.names) do equal(again:column(name), run:column(name)) end
        return rows(way.part(again))
    end,
    cycle = function(way, kind) return way.part(simulated(way, kind, { t_end = 40, dt = 40 })):cycle() or {} end,
    spectrum = function(way, kind) return columns(way.part(simulated(way, kind)):spectrum {}) end,
    poincare = function(way, kind) return columns(way.part(simulated(way, kind)):poincare { period = period }) end,
    ["pictures of the run"] = function(way, kind)
        return pictures(simulated(way, kind))
    end,
    ["pictures of the body"] = function(way, kind)
        return pictures(way.part(simulated(way, kind)))
    end,
    steady = function(way, kind)
        local sys, drive = drive_of(way, kind, period_of(kind))
        local s = sys:steady(way.options(drive))
        local answer = each(s, "status period periods multipliers stable unique symmetric growth")
        answer.explain, answer.line = s:explain(), tostring(s)
        answer.others = s.others and #s.others
        answer.run = s.run and rows(way.part(s.run))
        return merged(answer, each(way.part(s), "amplitude peak mean lag peak_lag stops stuck rest"))
    end,
    ["steady of the run"] = function(way, kind)
        local s = simulated(way, kind):steady(period_of(kind))
        return fields(way.part(s), "status period amplitude")
    end,
    response = function(way, kind)
        local sys, drive = drive_of(way, kind, period_of(kind))
        return columns(sys:response { over = { x = { 0.9, 1 } }, at = function(p)
            return way.options(merged(drive, { M = p.x * drive.M }))
        end })
    end,
    ["response with folds"] = function(way)
        local response = way.system { I = 1, k = 1, C = 0.2, spring = spring.polynomial { [3] = 1 } }:response {
            over = { omega = { 1.2, 1.5 } }, at = function(p)
                return way.options { M = excitation.harmonic { amplitude = 0.4, omega = p.omega } }
            end }
        return merged(columns(response), each(response, "points jumps"))
    end,
    bifurcation = function(way, kind)
        local sys, drive = drive_of(way, kind)
        local options = merged(way.options(drive), { system = sys, of = way == only_one and "a" or nil })
        return columns(bifurcation { over = { x = { 1, 2 } }, period = period, skip = 1, keep = 2, workers = 1,
            at = function() return options end })
    end,
    identify = function(way, kind)
        local sys, drive = drive_of(way, kind)
        local record = way.part(simulated(way, kind))
        local o = way.options(drive)
        local before = way == only_one and "a." or ""
        local fit = identify { data = { t = record.t, theta = record.theta }, system = sys, free = { before .. "k" },
            measured = { [before .. "theta"] = "theta" }, M = o.M, belt = o.belt, base = o.base, states = o.states }
        return { k = fit[before .. "k"], error = fit.std_error[before .. "k"], noise = fit.noise, text = tostring(fit) }
    end,
    sweep = function(way, kind)
        local sys, drive = drive_of(way, kind, { t_end = 3, dt = 3 })
        local options, part = way.options(drive), way == only_one
        return columns(sweep { over = { x = { 1, 2 } }, workers = 1, run = function()
            local run = sys:simulate(options)
            if part then run = run.a end
            return { theta = run:at(run.t_end), events = #run.events }
        end })
    end,
}

-- ---- the differences that are left

-- Questions that take long, or for which a kind means nothing, are asked of these only.
local only = {
    identify = { ["Coulomb with Re above Rd"] = 1, Stribeck = 1, ["normal constant"] = 1, relay = 1,
        ["normal of t and theta"] = 1, ["belt constant"] = 1, base = 1, ["walls of restitution 0.7"] = 1 },
    ["response with folds"] = { ["spring.polynomial"] = 1 },
}
only.steady, only.response = merged(kinds), merged(kinds)
-- "steady of the run" has the slow ones; a block without a spring has a family of motions, of which each finds another one.
for _, kind in ipairs { "LuGre", "Dahl", "block" } do only.steady[kind], only.response[kind] = nil, nil end
only.response["elastic walls"] = nil
local function asked(question) return only[question] or kinds end

local written_by_body = "an act returns the angle and velocity of one body, and assigns to those of several"
local no_spring = "one body needs k = 0, several do not"
-- What differs today, and why: "QUESTION: FIELDS, KINDS", for all kinds where none is named.
local different = {
    ["save: header, event that acts, event that bounces endlessly"] = written_by_body,
    ["save of the body: header, event that acts, event that bounces endlessly"] = written_by_body,
    ["fields of the run: system, block"] = no_spring,
    ["save: header, block"] = no_spring,
    ["save of the body: header, block"] = no_spring,
    ["integrators: rk4, a load that slides"] = "the steps of rk4 cross a jump of M at other times",
    ["response: peak, held for ever"] = "the response of one body has 0 for a mass that adheres elsewhere",
}

-- What has no answer either way, as the sentence of both is the same.
local unanswered = {
    ["bifurcation: answer, event that stops"] = "the run ends before its samples",
    ["bifurcation: answer, event that bounces endlessly"] = "the run ends before its samples",
    ["steady: answer, event that bounces endlessly"] = "the motion cannot be followed",
}

-- The keys of such a list, each for one field and one kind.
local function spread(list)
    local all = {}
    for key, reason in pairs(list) do
        local question, names, where = key:match "^(.-): ([^,]+)(.*)$"
        assert(questions[question] and #reason > 10, key)
        local wanted = {}
        for name in where:gmatch ", ([^,]+)" do
            assert(kinds[name], key)
            wanted[name] = asked(question)[name]
        end
        for name in names:gmatch "%S+" do
            for kind in pairs(where == "" and asked(question) or wanted) do
                all[question .. ": " .. name .. ", " .. kind] = key
            end
        end
    end
    return all
end
local listed, silent = spread(different), spread(unanswered)

-- ---- the comparison

-- { a = x } is x.
local function unwrapped(text)
    return (text:gsub("%b{}", function(braces)
        local value = braces:match "^{ a = (.*) }$"
        return value and unwrapped(value) or "{" .. unwrapped(braces:sub(2, -2)) .. "}"
    end))
end

-- A text without the name of the body, the ends of lines and what is only rounding.
local function plain(text)
    text = text:gsub("[%w_/]+%.lua:%d+: ", ""):gsub("%s+#? *", " "):gsub("%-?[%d.]+e%-1%d", "0")
    text = unwrapped(text):gsub("{ bodies = (%b{}) }", "%1"):gsub("%f[%w]rig:", "sys:")
    return (text:gsub("%f[%w]a%.%f[%w]", ""):gsub("(%w)%.a%f[%W]", "%1"))
end

local function same(a, b)
    if type(a) == "string" and type(b) == "string" then return plain(a) == plain(b) end
    if type(a) == "number" and type(b) == "number" then
        return a == b or a ~= a and b ~= b or math.abs(a - b) <= tolerance * math.max(1, math.abs(a), math.abs(b))
    end
    if type(a) ~= type(b) then return false end
    if type(a) == "table" then
        for name, value in pairs(a) do
            if not same(value, b[name]) then return false end
        end
        for name in pairs(b) do
            if a[name] == nil then return false end
        end
        return true
    end
    if type(a) == "userdata" and tostring(a):find "^vector" and tostring(b):find "^vector" then
        if #a ~= #b then return false end
        for i = 1, #a do
            if not same(a[i], b[i]) then return false end
        end
        return true
    end
    return a == b or type(a) == "userdata" and plain(tostring(a)) == plain(tostring(b))
end

local function told(x)
    if type(x) ~= "table" then return (tostring(x):gsub("%s+", " ")) end
    local all = {}
    for name, value in pairs(x) do all[#all + 1] = tostring(name) .. " = " .. told(value) end
    table.sort(all)
    return "{ " .. table.concat(all, ", ") .. " }"
end

local function answer(question, way, kind)
    local ok, found = pcall(questions[question], way, kind)
    return ok and found or { refused = tostring(found) }
end

local function in_order(all)
    local names = {}
    for name in pairs(all) do names[#names + 1] = name end
    table.sort(names)
    return names
end

for _, question in ipairs(in_order(questions)) do
    test(question .. ": a body is answered as a system of one, but for what is listed", function()
        local wrong, seen = {}, {}
        for _, kind in ipairs(in_order(asked(question))) do
            local one, other = answer(question, alone, kind), answer(question, only_one, kind)
            local nothing = question .. ": answer, " .. kind
            local mute = one.refused and other.refused and same(one.refused, other.refused)
            if not silent[nothing] ~= not mute then
                wrong[#wrong + 1] = nothing .. (mute and ": nothing is answered, " .. one.refused
                    or " is answered now: take it off the list of what is not")
            end
            local refused = (one.refused or other.refused) and { refused = true }
            for _, name in ipairs(in_order(refused or merged(one, other))) do
                local what = question .. ": " .. name .. ", " .. kind
                local x, y = one[name], other[name]
                if not same(x, y) then
                    seen[what] = true
                    if not listed[what] then
                        wrong[#wrong + 1] = ("%s differs:\n    system{...}: %s\n    bodies = { a = {...} }: %s")
                            :format(what, told(x):sub(1, 300), told(y):sub(1, 300))
                    end
                end
            end
        end
        for _, what in ipairs(in_order(listed)) do
            if what:find(question .. ": ", 1, true) == 1 and not seen[what] then
                wrong[#wrong + 1] = ("%s is equal both ways now: take it off the list (%q)"):format(what, listed[what])
            end
        end
        if #wrong > 0 then error(table.concat(wrong, "\n"), 0) end
    end)
end

finish()
