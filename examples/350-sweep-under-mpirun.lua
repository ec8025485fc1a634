-- 350 A sweep under mpirun: processes share the points of a map through a file, and go on after whatever has killed them.
--
--     mpirun -n 4 dinal 350-sweep-under-mpirun.lua        srun, a job array, GNU parallel: docs/many-machines.md

-- How long friction takes to stop a mass that was let go, for every start: 1200 runs, in chunks of five.
local map = sweep{ over = { theta0 = vector.linspace(0.1, 4, 40), velocity0 = vector.linspace(0, 6, 30) }, file = "rest.csv", run = function(p)
        local run = nondimensional{ friction_ratio = 0.05 }:simulate{
            theta0 = p.theta0, velocity0 = 2*math.pi*p.velocity0, t_end = 100, times = {} }
        local last = run.events[#run.events]
        return { time = last and last.t or 0, turns = #run.events }
    end }

-- Only one process comes here, and it has all of the map: whoever has done the last share.
print(#map .. " points")
print(string.format("the longest motion takes %.3f periods", map.time:max()))
map:plot{ x = "theta0", y = "velocity0", z = "turns", title = "half swings until rest", file = "figrest.svg" }
print("figrest.svg shows them all")

--[[ prints
1200 points
the longest motion takes 36.156 periods
figrest.svg shows them all
]]
