-- One script from end to end for valgrind: native and scripted loads, feedback, both integrators, files, an error.

local sys = system{ I = 1, k = 4 * math.pi ^ 2, C = 1.5, Rd = 16.5, Re = 18 }
local load = excitation.harmonic{ amplitude = 40, frequency = 1 } + 0.5 * excitation.pulse{ at = 1.5, width = 0.2 }

local native = sys:simulate{ M = load, theta0 = 1, t_end = 3, dt = 0.05 }
assert(#native == 61 and #native.events > 2, tostring(native))
assert(native.theta:max() > 0.5 and #native.t:table() == 61)

local scripted = sys:simulate{ M = function(t) return load(t) end, theta0 = 1, t_end = 3, dt = 0.05 }
assert(math.abs(scripted.theta[#scripted] - native.theta[#native]) < 1e-3) -- the pulse's corners are not announced here

local braked = sys:simulate{ M = function(_, _, velocity) return -3 * velocity end, theta0 = 1, t_end = 1, dt = 0.05 }
assert(braked.outcome)

local museum = sys:simulate{ M = load, theta0 = 1, t_end = 1, dt = 0.05, integrator = integrator.dinal1989{ h = 0.01 } }
for _, ending in ipairs{ ".csv", ".dat" } do
  local name = os.tmpname()
  os.remove(name)
  museum:save(name .. ending)
  local again = dinal.load(name .. ending)
  os.remove(name .. ending)
  assert(again.theta[#again] == museum.theta[#museum])
end

local ok, message = pcall(sys.simulate, sys, { M = function() error "out of load" end, t_end = 1, dt = 0.1 })
assert(not ok and tostring(message):find "out of load")
ok, message = pcall(sys.simulate, sys, { tend = 1 })
assert(not ok and tostring(message):find "t_end", message)
print "done"
