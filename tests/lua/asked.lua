-- A system that turns, sticks and slips, and its runs by each integrator that watches what M does.
local asked = {}

asked.sys = nondimensional { zeta = 0.05, friction_ratio = 0.1 }
asked.methods = { integrator.spectral {}, integrator.rk4 { h = 0.002 }, integrator.dopri5 { tolerance = 1e-9 } }

--- Simulates with what `make` makes, by each integrator, and as a run with a state.
function asked.runs(make, more)
    local list = {}
    for _, method in ipairs(asked.methods) do
        for _, states in ipairs { false, { way = { rate = function(_, _, velocity) return math.abs(velocity) end } } } do
            local options = { M = make(), theta0 = 1, t_end = 10, dt = 0.1, integrator = method, states = states or nil }
            list[#list + 1] = asked.sys:simulate(merged(options, more))
        end
    end
    return ipairs(list)
end

return asked
