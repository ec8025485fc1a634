-- 338: a valve between elastic stops: a pulse throws it open, a spring and the pressure close it again; it bounces at both ends.

print "damping of the stops   bounces open   open from    bounces closed   closed from   deepest behind a stop, mm"
for _, damping in ipairs{ 5, 40, 300 } do
  local valve = system{ I = 0.1, k = 40, C = 0.5, Rd = 0.2,
    walls = { lower = 0, upper = 0.01, stiffness = 2e5, damping = damping }, units = { theta = "m", t = "s", M = "N" } }
  local run = valve:simulate{ M = excitation.pulse{ amplitude = 7, at = 0.02, width = 0.1 } - 2, t_end = 0.4, dt = 1e-4 }
  local open, closed = {}, {}
  for _, e in ipairs(run.events) do
    if e.kind == "impact" and e.t > 0.02 then table.insert(e.theta > 0.005 and open or closed, e.t) end
  end
  print(string.format("%20d %14d %11.5f %17d %13.5f %27.3f", damping, #open, open[1], #closed, closed[1],
    1000 * math.max(run.theta:max() - 0.01, -run.theta:min())))
end

--[[ prints
damping of the stops   bounces open   open from    bounces closed   closed from   deepest behind a stop, mm
                   5              3     0.04080                15       0.13794                       0.657
                  40              6     0.04084                 6       0.15063                       0.550
                 300              2     0.04091                 2       0.15117                       0.237
]]
