-- The axes of pictures of a run: one for each unit, with the unit that the user says.
dofile "tests/lua/support.lua"

local metres = { theta = "m", t = "s" }
local sys = system{ I = 1, k = 4, Rd = 0.1 }
local run = sys:simulate{ M = excitation.harmonic{ amplitude = 2, omega = 1 }, theta0 = 1, t_end = 5, dt = 0.1 }

test("columns of different quantities have separate axes, one below the other", function()
    local text = picture(run, { y = { "theta", "velocity", "M", "friction" }, units = metres })
    has(text, "theta, m", "theta', m/s", "torque", "a M", "b friction")
    local first, second, third = text:find("theta, m", 1, true), text:find("theta', m/s", 1, true), text:find("torque", 1, true)
    assert(first < second and second < third)
    has(picture(run, { y = { "theta", "velocity" }, ylabel = "both" }), "both", "a theta", "b theta'")
    has(picture(run, { y = { "theta", "M/k" }, labels = { "angle", "load" } }), "a angle", "b load")
    refused {
        { 'run:plot{ y = { "theta", "velocity" }, ylim = { 0, 1 }, show = false }', "ylim is for one unit", "give ylabel" },
        { "run:plot{ labels = 3, show = false }", "labels must be a list of words" },
    }
end)

test("a spectrum is drawn over decades, and a response near a pole with limits that show most of it", function()
    local function drawn(d, options) return picture(d, options) end
    local sys = nondimensional { zeta = 0.05 }
    local spectrum = sys:simulate { M = excitation.harmonic { frequency = 0.4 }, theta0 = 1, t_end = 64, dt = 0.05 }:spectrum {}
    local picture = drawn(spectrum)
    assert(picture:find "\n1e%-5 %+" and not picture:find "1e%-6 %+", picture)
    assert(not drawn(spectrum, { ylog = false }):find "1e%-", "a user's word counts")
    -- Beyond the frequencies at which a spectrum is that high there is nothing to see.
    local smooth = sys:simulate { M = excitation.harmonic { frequency = 0.4 }, theta0 = 1, t_end = 64, dt = 0.005 }:spectrum {}
    assert(smooth.frequency:max() > 99)
    picture = drawn(smooth)
    assert(not picture:find "%f[%d]50%f[^%d]" and not picture:find "%f[%d]100%f[^%d]", picture)
    assert(drawn(smooth, { xlim = { 0, 100 } }):find "%f[%d]100%f[^%d]", "a user's word counts")
    local pole = nondimensional {}:response { over = { frequency = vector.linspace(0.05, 3, 200) } }
    assert(pole.amplitude:max() > 50)
    picture = drawn(pole)
    assert(picture:find "\n10 %+" and not picture:find "20 %+", picture)
    assert(drawn(pole, { ylog = true }):find "\n100 %+", "all of it")
    has(drawn(data { theta = { 1, 2 }, velocity = { 1, 2 } }), "theta'")
end)

finish()
