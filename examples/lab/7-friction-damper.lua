-- Lab 7: the friction damper, two bodies, the best slip torque (docs/lab/7-friction-damper.md). Take a copy and fill it in.
lab.number(4711) -- your own number

local given = lab.given(7)

local function steady(Rd, omega)
  local rig = system{
    bodies = { machine = { I = 1, k = 1, C = given.C }, damper = { I = given.mu } },
    links = { joint = { "machine", "damper", Rd = Rd } },
  }
  return rig:steady{ M = { machine = excitation.harmonic{ amplitude = given.M0, omega = omega } } }
end

-- 7.2 The two ends
print(steady(0, 1))
-- check("7a", )
-- check("7b", )

-- 7.3 Where they cross
-- check("7c", )
-- check("7d", )

-- 7.4 The best slip torque
-- check("7e", )
-- check("7f", )

print(lab.marks())
