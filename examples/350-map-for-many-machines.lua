-- 350 A map for many machines: kept in a file while it is made, resumed after any death, made by whatever processes there are.
--
--     dinal 350-map-for-many-machines.lua                       all cores of this machine
--     python3 -m dinal.sweep 350-map-for-many-machines.lua      the same on processes; --mpi, --dask ADDRESS: docs/many-machines.md

-- How long friction takes to stop a mass that was let go, for every start: 1200 runs, in chunks of five.
local map = {
    over = { theta0 = vector.linspace(0.1, 4, 40), velocity0 = vector.linspace(0, 6, 30) },
    file = "rest.csv",
    run = function(p)
        local run = nondimensional{ friction_ratio = 0.05 }:simulate{
            theta0 = p.theta0, velocity0 = 2*math.pi*p.velocity0, t_end = 100, times = {} }
        local last = run.events[#run.events]
        return { time = last and last.t or 0, turns = #run.events }
    end,
}
if not arg then return map end -- to python3 -m dinal.sweep; a script that dinal runs has arguments

local rest = sweep(map)
print(#rest .. " points")
print(string.format("the longest motion takes %.3f periods", rest.time:max()))
rest:plot{ x = "theta0", y = "velocity0", z = "turns", title = "half swings until rest", file = "figrest.svg" }
print("figrest.svg shows them all")

--[[ prints
1200 points
the longest motion takes 36.156 periods
figrest.svg shows them all
]]
