-- A sheet of your own: copy this file, change it, and test it with
--     dinal --test-sheet 8-pendulum.lua
-- It shows what a student sees, and works the sheet with twenty student numbers: each answer must be right, and no known
-- mistake may be. Then put it into a folder; students and marking use it with
--     dinal --sheets FOLDER        (or the environment variable DINAL_SHEETS=FOLDER)
-- All of dinal but files and plots is available here: system, theory, vector, data, identify, nondimensional.
sheet(8, {
  title = "breaking loose",

  -- In which language the hints are, and those of all sheets in it; only needed for a sheet that is not in English.
  -- language = "de", words = { de = { ["right"] = "richtig" } },

  -- What the script of dinal --lab 8 4711 has in it besides the checks: Lua behind lab.given, and in each task. Optional.
  setup = "local mass = system(given)",
  tasks = { { "8.1", "Breakaway", "local record = lab.experiment(8)" }, { "8.2", "Dead zone" } },

  -- What lab.given(8) returns. pick(from, to, step) draws a value for the student number.
  given = function(pick)
    return { I = pick(0.5, 2, 0.1), k = pick(20, 60, 1), Rd = pick(1, 3, 0.1) }
  end,

  -- What a student cannot see, but an experiment and the answers depend on. Optional.
  secret = function(given, pick)
    return { Re = rounded(given.Rd*pick(1.2, 1.8, 0.1), 4) }
  end,

  -- What lab.experiment(8, x) returns: here the record of a slow pull. Optional.
  experiment = function(given, secret)
    local run = system{ I = given.I, k = given.k, Rd = given.Rd, Re = secret.Re }:simulate{
      M = excitation.ramp{ slope = 1 }, t_end = 1.2*secret.Re, dt = 0.01 }
    return data{ { "t", run.t }, { "theta", run.theta } }
  end,

  -- try_with = 1, -- the x with which --test-sheet calls the experiment, if it needs one

  -- The questions "8a", "8b", ... in order of their names.
  questions = function(given, secret)
    return {
      { name = "a", asks = "breakaway torque Re", answer = secret.Re, tolerance = 0.02, task = "8.1",
        how = "slope times the time at which theta leaves 0", -- for you: --lab-solutions prints it
        mistakes = { -- values that a known mistake gives, and what check says about them
          { given.Rd, "this is Rd, the torque of a sliding mass" },
          { secret.Re/given.k, "this is an angle; a torque is asked for" },
        } },
      { name = "b", asks = "half width of the dead zone", unit = "rad", answer = secret.Re/given.k, tolerance = 0.02, task = "8.2",
        how = "Re/k", praise = "with dry friction a mass rests anywhere in it",
        mistakes = { { 2*secret.Re/given.k, "this is its whole width" } } },
    }
  end,

  -- For you: what a good page says to the open questions at the end of the handout, one string for each. Optional.
  discussion = function(given, secret)
    return { string.format("Breakaway takes %.3g, sliding %.3g: a mass that moves is held less.", secret.Re, given.Rd) }
  end,
})
