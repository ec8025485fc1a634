-- Whether a steady motion is the only one: proofs, searches from other starts, other motions. Run by dinal.
dofile "tests/lua/support.lua"

local function harmonic(r) return excitation.harmonic{ frequency = r } end

test("without losses, at a fraction of the natural period, other motions exist that repeat after some periods", function()
    local free = nondimensional{}
    for _, r in ipairs{ 2, 1.5, 0.75, 5 } do
        local s = free:steady{ M = excitation.harmonic{ frequency = r } }
        near(s.amplitude, 1 / math.abs(1 - r * r), 1e-12)
        assert(s.unique == false, r)
        assert(s:explain():find("one%s+of%s+a%s+family"))
    end
    equal(free:steady{ M = excitation.harmonic{ frequency = 2^0.5 } }.unique, "proven")
    equal(nondimensional{ zeta = 0.01 }:steady{ M = excitation.harmonic{ frequency = 2 } }.unique, "proven")
end)

test("a bounded motion does not grow, and one of a family is not called the only one", function()
    local wells = system{ I = 1, k = 0, C = 0.25, spring = spring.polynomial{ [1] = -1, [3] = 1 } }
    local s = wells:steady{ M = excitation.harmonic{ amplitude = 0.34, omega = 1 }, theta0 = 1 }
    assert(s.status ~= "grows", s.status)
    -- A relay makes another motion beat for hundreds of periods; M has bounds and the system damping.
    local beats = system{ I = 1.43473, k = 6.25771, C = 0.103388 }:steady{ M = excitation.square{ amplitude = 1.018888, period = 6.222563 }
        + excitation.relay{ on = 0.0953254, off = -0.0330133, amplitude = -0.458701 } }
    assert(beats.status ~= "grows", beats.status)
    local sys = system{ I = 1 / (4 * math.pi ^ 2), k = 1, Rd = 0.5854, Re = 0.5854 }
    local M = excitation.square{ period = 1 / 0.1334, duty = 0.333 }
    local at = {} -- two starts that end apart
    for i, theta0 in ipairs{ -1.2, 0.9 } do
        local run = sys:simulate{ M = M, theta0 = theta0, t_end = 40 / 0.1334, dt = 1 / 0.1334 }
        near(run.theta[#run], run.theta[#run - 1], 1e-12)
        at[i] = run.theta[#run]
    end
    assert(math.abs(at[1] - at[2]) > 0.1)
    assert(sys:steady{ M = M }.unique ~= "proven")
end)

test("a motion is not called the only one if acts maintain another one, for several bodies as for one", function()
    local sine = excitation.harmonic{ amplitude = 0.25, omega = 1.93 }
    local body = { I = 1, k = 4, C = 0.1, Rd = 0.1 }
    local function kick(_, theta, velocity) return theta, velocity + 0.6 end
    local kicked = { { when = function(t, theta) return theta - 0.8 end, direction = "up", act = kick } }
    for velocity0, amplitude in pairs{ [0] = 0.46243670, [6] = 1.54833071 } do
        local s = system(body):steady{ M = sine, events = kicked, velocity0 = velocity0 }
        near(s.amplitude, amplitude, 1e-7)
        assert(s.unique ~= "proven")
    end
    local rig = system{ bodies = { a = body } }
    kicked[1].when = function(t, theta) return theta.a - 0.8 end
    kicked[1].act = function(_, _, velocity) velocity.a = velocity.a + 0.6 end
    assert(rig:steady{ M = { a = sine }, events = kicked }.unique ~= "proven")
end)

test("unique is true only where it is proven", function()
    local load = harmonic(0.7)
    local uneven = system{ I = 1, k = 4, friction = friction.asymmetric{ forward = { Rd = 0.3 }, backward = { Rd = 0.2 } } }
    for _, sys in ipairs{ nondimensional{ friction_ratio = 0.3 }, uneven } do
        equal(sys:steady{ M = load }.unique, "proven")
    end
    local linear = { I = 1, k = 4, C = 0.4 }
    local unproven = { { walls = { upper = 50 } }, { spring = spring.polynomial{ [3] = 1e-3 } },
        { friction = friction.stribeck{ Rd = 0.1, Re = 0.2, speed = 0.1 } }, { Rd = 0.1, Re = 0.12 } }
    for i, more in ipairs(unproven) do
        local s = system(merged(linear, more)):steady{ M = 2 * load }
        equal(s.unique, "not seen", i)
        says(s, "which is no proof.")
    end
    local fed = system(linear):steady{ M = function(t, theta) return math.sin(t) - 0.1 * theta end, period = 2 * math.pi }
    equal(fed.unique, "not seen")
    -- A mass without a spring may rest anywhere.
    assert(system{ I = 1, k = 0, Rd = 1 }:steady{ M = 0.5 * load }.unique ~= "proven")
end)

test("other starts find motions far larger than the one found, and adhesion", function()
    -- Both motions of each are found from starts given by hand.
    for i, case in ipairs{ { 0.03, 0.5, 0.25, 1.8, 5 }, { 0.05, 0.1, 0.4, 1.3, 5 }, { 0.03, 2, 0.2, 1.7, 3 } } do
        local C, cubic, amplitude, omega, far = table.unpack(case)
        local sys, M = system{ I = 1, k = 1, C = C, spring = spring.polynomial{ [3] = cubic } }, excitation.harmonic{ amplitude = amplitude, omega = omega }
        local small, large = sys:steady{ M = M }
        for theta0 = 1, far do
            local s = sys:steady{ M = M, theta0 = theta0 }
            if s.amplitude > 4 * small.amplitude then large = s end
        end
        assert(large, i)
        equal(small.unique, false, i)
        equal(large.unique, false, i)
        assert(#small.others >= 1 and #large.others >= 1, i)
        near(small.others[1].amplitude, large.amplitude, 1e-6 * large.amplitude)
        near(large.others[1].amplitude, small.amplitude, 1e-6 * large.amplitude)
    end
    -- Two wells: the motion in the other one has the same amplitude about the opposite mean.
    local wells = system{ I = 1, k = 0, C = 0.3, spring = spring.polynomial{ [1] = -1, [3] = 1 } }
    local right = wells:steady{ M = excitation.harmonic{ amplitude = 0.05, omega = 1 }, theta0 = 1 }
    equal(#right.others, 1)
    near(right.others[1].mean, -right.mean, 1e-6)
    local held = system{ I = 1, k = 1, C = 0.02, Rd = 0.3, Re = 1.1 }
    local s = held:steady{ M = excitation.harmonic{ omega = 1 }, theta0 = 5 }
    equal(s.status, "steady")
    equal(s.unique, false)
    says(s, "From another start the mass comes to rest at theta = 0.")
end)

finish()
