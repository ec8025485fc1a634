-- Lab 1: free decay, viscous against dry (docs/lab/1-free-decay.md). Copy it to 1-NUMBER.lua (NUMBER is yours) and fill it in.
-- dinal --report 1-NUMBER.lua makes the page to hand in.
lab.number(4711) -- your own number
local page = report{ title = "Free decay, viscous against dry", author = "your name" }

local given = lab.given(1)
local viscous, dry = system(given.viscous), system(given.dry)

-- 1.2 The period
-- check("1a", )

-- 1.3 Viscous damping
local run = viscous:simulate{ theta0 = given.theta0, t_end = 10*viscous.T0, dt = viscous.T0/100 }
page:plot(run:plot{ show = false })
-- check("1b", )
-- check("1c", )

-- 1.4 Dry friction
run = dry:simulate{ theta0 = given.theta0, t_end = 10*dry.T0, dt = dry.T0/100 }
page:plot(run:plot{ show = false })
page:plot(run:phase_plot{ show = false })
-- check("1d", )
-- check("1e", )
-- check("1f", )

-- 1.5 A record with both
local record = lab.experiment(1)
print(record)
-- check("1g", )
-- check("1h", )

-- Questions: write your answers here; an empty line begins a paragraph
page:heading "Questions"
page:text [[
1.

2.

3.

4.

5.
]]
page:save "answers.html"
print(lab.marks())
