-- Lab 3: resonance with friction, Den Hartog against linearisation (docs/lab/3-resonance.md). Copy it to 3-NUMBER.lua (NUMBER is yours) and fill it in.
-- dinal --report 3-NUMBER.lua makes the page to hand in.
lab.number(4711) -- your own number
local page = report{ title = "Resonance with friction", author = "your name" }

local given = lab.given(3)
local sys = nondimensional{ friction_ratio = given.friction_ratio }

-- 3.2 The true amplitude
local s = sys:steady{ M = excitation.harmonic{ frequency = given.r } }
print(s.status)
-- check("3a", )

page:plot(s.run:plot{ show = false })

-- 3.3 Linearised
-- check("3b", )
-- check("3c", )

-- 3.4 Phase
-- check("3d", )

-- 3.5 At resonance
-- check("3e", )

-- 3.6 Stops
-- check("3f", )
-- check("3g", )

-- 3.7 With a damper
-- check("3h", )

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
