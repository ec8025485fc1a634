-- 264: three blocks on a belt, coupled by springs (Burridge and Knopoff's model of a fault): they stick and slip, alone
-- and together. The last events of a long run.

local rig = system{
  bodies = { a = { I = 1, k = 1, Rd = 1, Re = 1.4 }, b = { I = 1, k = 1, Rd = 1, Re = 1.4 }, c = { I = 1, k = 1, Rd = 1, Re = 1.5 } },
  links = { ab = { "a", "b", k = 4 }, bc = { "b", "c", k = 4 } } }
local run = rig:simulate{ belt = { a = 0.1, b = 0.1, c = 0.1 }, theta0 = { a = 0.3, b = -0.2 }, t_end = 200 }
print(run)
for i = #run.events - 5, #run.events do
  local e = run.events[i]
  print(string.format("%9.4f  %-5s %s  %.5f", e.t, e.kind, e.where, e.theta))
end

--[[ prints
3 bodies, 3821 rows, t 0 … 200; 143 events (1 turn, 71 sticks, 71 slips); moving at the end
 196.9210  slip  c  1.19361
 197.3060  stick b  1.13259
 197.8735  slip  b  1.18934
 198.0171  slip  a  1.23928
 198.6026  stick c  1.08569
 199.1898  slip  c  1.14441
]]
