-- 200: plots. A response, its phase plane and a family of curves, in the terminal and as figures for a report.
--
-- Here all pictures are 64 columns of plain ASCII, so that the comment below can show them. Without width, height and
-- ascii they are as wide as your terminal, and finer: run:plot().

local sys = nondimensional{ zeta = 0.02, friction_ratio = 0.1, breakaway_ratio = 0.15 }
local M = excitation.harmonic{ amplitude = 0.3, frequency = 0.31 }
local run = sys:simulate{ M = M, theta0 = 1, t_end = 12, dt = 0.01 }

local function small(options)
  options.width, options.height, options.ascii = 64, 16, true
  return options
end

-- theta and M/k over time; the bars below are the times when the mass sticks
run:plot(small{})

-- 1:1, with the dead zone: without an excitation the mass can rest anywhere on it
local free = sys:simulate{ theta0 = 1, t_end = 12, dt = 0.01 }
free:phase_plot(small{ title = "free motion" })

-- any vectors: magnification for some ratios of damping
local r = vector.linspace(0, 2.5, 251)
local family = { xlabel = "frequency ratio", ylabel = "magnification", ylim = { 0, 4 } }
for i, zeta in ipairs{ 0.15, 0.3, 0.7 } do
  family[i] = { r, 1 / ((1 - r^2)^2 + (2 * zeta * r)^2):sqrt(), label = "zeta = " .. zeta }
end
plot(small(family))

-- The same calls write figures as wide as the column of a paper, when they have a file: .svg, .png, .pdf or .txt.
run:plot{ file = "response.pdf" }
family.file, family.width, family.height, family.ascii = "resonance.svg", nil, nil, nil
plot(family)
-- side by side, in the width of a page
plot{ run:plot{ show = false }, run:phase_plot{ show = false }, file = "both.svg", size = { 17, 7 } }
print "written: response.pdf, resonance.svg, both.svg"

--[[ prints
  Mc/k   a theta   b M/k
    1 +a
      |a   aa
      |aa  aa
      | a  aa
      | a aaa
      | ababaa         aaaaaaa       aaaaaaa       aaaaaaa
      |ba a  ab      baa   bba      aa   bba      ba   bbaa
    0 +ba-a- abaaa -bba- - -baa- -bba- - -baa- - baa - - ba-
      | aaa  aaabaaaaa       baaaaaaa       aaaaaaa       aaaa
      |  aa      bb            bb             bb            bb
      |  a
      ++---------------------+---------------------+---------
stuck          ==  ==   =====  ====   =====  =====  =====  ==
       0                     5                    10
                                t, T0
              free motion
theta'/omega0, Mc/k   o start   @ end   = dead zone
     | .    *******        .
 0.5 +    ***    .****
     |  **       .   ***     .
     | **     ****     *
 0.0 +.*. . .**==*@ . .*. . . o .
     | **    **  .     *     **
     |  *     ***.   ***     *
-0.5 +   *      *****       **
     | .  **     .        ***
     |   .  **** .    ****
     |       . ********
     +-----------+------------+--
                 0            1
              theta, Mc/k
magnification   a zeta = 0.15   b zeta = 0.3   c zeta = 0.7
4 +
  |
  |                     aaaa
3 +                    aa  aa
  |                  aa     aa
  |                 aa       a
2 +               aaabbbbbb   aa
  |           aaaaabbb    bbbb aa
1 +aaaaaaaaaaaabb            bbbaaaa
  |             cccccccccccccc   bbaaaaa
  |                          cccccccccbbaaaaaaaaaaaaaa
0 +                                            cccccbaaaaaaaaabc
  ++----------+-----------+----------+-----------+----------+
  0.0        0.5         1.0        1.5         2.0        2.5
                         frequency ratio
written: response.pdf, resonance.svg, both.svg
]]
