-- Lab 5: what made this record (docs/lab/5-identification.md). Copy it to 5-NUMBER.lua (NUMBER is yours) and fill it in.
-- dinal --report 5-NUMBER.lua makes the page to hand in.
lab.number(4711) -- your own number
local page = report{ title = "What made this record?", author = "your name" }

local given = lab.given(5)
local record = lab.experiment(5, 1)

-- 5.3 By least squares
local fit = identify{ data = record, velocity0 = 0 }
print(#fit.residual .. " samples fitted")
-- check("5a", )
-- check("5b", )
-- check("5c", )
-- check("5d", )

page:plot(fit:plot{ show = false })

-- 5.4 The stiffness
-- check("5e", )

-- 5.5 One damping too few
-- check("5f", )

-- 5.6 The pull
local pull = lab.experiment(5, 2)
print(#pull .. " rows of the pull")
-- check("5g", )

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
