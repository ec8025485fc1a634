-- Questions that people ask help(), and a part of the page that must come first.
dofile "tests/lua/support.lua"

local questions = {
  { "fourier", "run:spectrum()" },
  { "export csv", 'run:save "run.csv"' },
  { "how do I export to excel", 'run:save "run.csv"' },
  { "compare two runs", "plot{ { a.t, a.theta" },
  { "plot two curves in one picture", "plot{ { a.t, a.theta" },
  { "save a plot as png", 'file = "a.svg"' },
  { "phase portrait", "run:phase_plot()" },
  { "resonance curve", "sys:response{" },
  { "frequency response", "sys:response{" },
  { "steady state", "sys:steady{" },
  { "limit cycle", "sys:steady{ belt" },
  { "natural frequency", "sys.omega0" },
  { "damping ratio", "sys.zeta" },
  { "viscous damping", "C of system{}" },
  { "static friction", "Re (>= Rd)" },
  { "coefficient of friction", "Rd is the torque" },
  { "stiction", "Re (>= Rd)" },
  { "step size", "dt only sets the rows" },
  { "accuracy", "accurate to rounding" },
  { "parameter study", "sweep{" },
  { "how do I vary two parameters", "sweep{" },
  { "optimise a parameter", "minimise{" },
  { "animation", "run:animate{" },
  { "pid controller", "excitation.sampled has a memory" },
  { "feedback", "M may depend on the motion" },
  { "impulse", "excitation.pulse" },
  { "wall impact", "walls = {" },
  { "two masses", "bodies = {" },
  { "clutch", "bodies = {" },
  { "force from a csv file", "excitation.samples" },
  { "measured data", "excitation.samples" },
  { "import data", 'load "file.csv"' },
  { "read a csv file", "load" },
  { "si units", "units of a system" },
  { "stop a run", "Ctrl-C stops" },
  { "why is it so slow", "run:explain() says" },
  { "chaos", "bifurcation{" },
  { "poincare section", "run:poincare" },
  { "energy loss", "run:energy()" },
  { "what happened in my run", "run:explain()" },
  { "same random numbers", "seed = 1" },
  { "fit a model to data", "identify" },
  { "degrees", "math.rad(90)" },
  { "python", "indices" },
  { "append to a list", "table.insert" },
  { "hand in my report", "dinal --report" },
  { "for loop", "for i = 1, 10 do" },
  { "rounding", "math.floor(x + 0.5)" },
  { "undo", ":history lists" },
  { "quit", "Ctrl-D" },
  { "dead zone", "sys.dead_zone" },
  { "ode45", "sys:simulate{ M" },
  { "bode plot", "sys:response{" },
  { "read an excel file", 'load "file.csv"' },
  { "decimal comma", "1,5 is a number" },
  { "initial conditions", "theta0 and velocity0" },
  { "moving belt", "belt = .2" },
  { "square wave", "excitation.square" },
  { "step response", "excitation.step" },
  { "zoom in", "xlim" },
  { "mean value", ":mean()" },
  { "last event", "run.events[#run.events]" },
  { "list of events", "run.events lists" },
  { "jupyter", "--jupyter-install" },
}

local code = {}
for _, case in ipairs(questions) do code[#code + 1] = ("print('\\0') help %q"):format(case[1]) end
local i = 0
for page in output(table.concat(code, "\n")):gmatch "%z\n([^\0]*)" do
  i = i + 1
  test(("help %q"):format(questions[i][1]), function() has(page:match("^" .. ("[^\n]*\n?"):rep(6)), questions[i][2]) end)
end
test("there are many questions, and each one is tested", function() assert(#questions >= 50 and i == #questions, i) end)
finish()
