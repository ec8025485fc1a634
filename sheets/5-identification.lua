-- Sheet 5: what made this record: identification with error bars.

local function decay_without_noise(system)
  return system:simulate{ theta0 = 1, t_end = 12*system.T0, dt = system.T0/25 }
end

--- The two records: a decay with noise and an unknown zero; stick-slip under a pull that grows evenly.
local function decay_of(given, secret)
  local run = decay_without_noise(secret.system)
  local noise = vector.normal{ n = #run, seed = secret.seed, std = given.noise }
  return data{ { "t", run.t }, { "theta", run.theta + noise + secret.offset } }
end

local function pull_of(given, secret)
  local run = secret.system:simulate{ M = excitation.ramp{ slope = given.slope }, t_end = given.pull_time, dt = given.pull_time/400 }
  local noise = vector.normal{ n = #run, seed = secret.seed + 1, std = given.noise/10 }
  return data{ { "t", run.t }, { "theta", run.theta + noise } }
end

sheet(5, {
  title = "what made this record",

  setup = [[local record = lab.experiment(5, 1)]],

  -- The script to begin with: the tasks, and what they have in it besides the questions.
  tasks = {
    { "5.2", "By eye" },
    { "5.3", "By least squares", [[
local fit = identify{ data = record, velocity0 = 0 }
print(fit)
page:plot(fit:plot{ show = false })]] },
    { "5.4", "The stiffness" },
    { "5.5", "One damping too few" },
    { "5.6", "The pull", [[
local pull = lab.experiment(5, 2)
page:plot(pull:plot{ x = "t", y = "theta", show = false })]] },
  },

  given = function(pick)
    local I
    repeat I = pick(0.5, 2, 0.1) until I ~= 1 -- else k/I would be k
    return { I = I, noise = 0.01 }
  end,

  secret = function(given, pick)
    -- Drawn again when the record ends before it is at rest, or it rests so near the middle that that is no mistake.
    local k, x_f, ratio, oscillator, rest
    repeat
      k = pick(20, 60, 1)
      local zeta = pick(0.012, 0.03, 0.001)
      x_f, ratio = pick(0.01, 0.018, 0.001), pick(1.3, 1.6, 0.05)
      oscillator = system{ I = given.I, k = k, C = 2*zeta*math.sqrt(given.I*k), Rd = x_f*k, Re = ratio*x_f*k }
      local run = decay_without_noise(oscillator)
      rest = run.theta[#run]
    until run.outcome == "at rest" and math.abs(rest) > 0.006
    local a = (ratio - 1)*x_f
    given.slope = rounded(k*a*oscillator.omega0*0.4, 3)
    given.pull_time = rounded(6*oscillator.Re/given.slope, 3)
    return { system = oscillator, rest = rest, offset = pick(0.1, 0.4, 0.05)*(pick(0, 1, 1) == 0 and 1 or -1),
             seed = math.floor(pick(1, 1e6, 1)) }
  end,

  try_with = 1,
  experiment = function(given, secret, which)
    if which ~= nil and which ~= 1 and which ~= 2 then
      error("there are two records: lab.experiment(5, 1), the decay, and lab.experiment(5, 2), the pull", 0)
    end
    return which == 2 and pull_of(given, secret) or decay_of(given, secret)
  end,

  discussion = function(given, secret)
    return {
      string.format("Dry friction holds the mass anywhere within Re/k of the zero: up to %.2g rad here, much more than the error of the fit. Where in it depends on the start.",
        secret.system.dead_zone),
      "A larger start: viscous damping takes a part and rules the large swings, dry friction takes an amount and rules the last ones, so the more amplitudes the record has, the less can one " ..
        "stand for the other. It must go on until the rest; what comes behind that tells of the offset and the noise only.",
      "Only how much the noise would move the result of that fit if its model were true, not how far off the model is. That shows in the residual, which follows the velocity; so dinal leaves the error out.",
      "Re acts only where the mass is at rest, and in a decay it comes there once. That it stays says Re >= k |theta - offset|, no more.",
      "Neighbouring samples then have errors in common, and the fit takes them for independent: the error bars come out too small. The extremes are cut, so the amplitudes, and with them the " ..
        "dampings, are off by something that no error bar shows. Least squares does the smoothing itself, by the model.",
    }
  end,

  questions = function(given, secret)
    local true_system = secret.system
    local decay = decay_of(given, secret)
    local fit = identify{ data = decay, velocity0 = 0 }
    local x_f = true_system.Rd/true_system.k
    -- Honest work has the error of the fit; four of them are missed by one record in ten thousand.
    local function bars(name) return 4*fit.error_if_right[name] end
    local viscous -- takes half a second, so only when it is asked for
    local function is_viscous(zeta)
      viscous = viscous or identify{ data = decay, velocity0 = 0, I = given.I, Rd = 0 }
      return math.abs(zeta - viscous.zeta) <= bars "zeta" -- that fit has no errors: its model is wrong
    end
    return {
      { name = "a", asks = "omega0", unit = "rad per time unit", answer = true_system.omega0, within = bars "omega0", task = "5.3",
        how = "identify{ data = record, velocity0 = 0 }.omega0",
        mistakes = {
          { 2*math.pi/true_system.omega0, "that is the period" },
        } },
      { name = "b", asks = "zeta", answer = true_system.zeta, within = bars "zeta", task = "5.3", how = "fit.zeta",
        mistakes = {
          { is_viscous, "that takes all damping for viscous: leave Rd free" },
        } },
      { name = "c", asks = "Rd/k", unit = "rad", answer = x_f, within = bars "Rd_over_k", task = "5.3", how = "fit.Rd_over_k",
        mistakes = {
          { 2*x_f, "that is lost in each half cycle, 2 Rd/k" },
          { true_system.Rd, "that is Rd; the record of a decay tells Rd/k only" },
        } },
      { name = "d", asks = "zero of the sensor", unit = "rad", answer = secret.offset, within = bars "offset", task = "5.3", how = "fit.offset",
        mistakes = {
          { -secret.offset, "the size is right: the offset is what the record shows where the spring is relaxed" },
          { secret.offset + secret.rest, "that is where it came to rest: with dry friction that is not the middle" },
          { function(x) return math.abs(x - secret.offset) < true_system.dead_zone + 3*given.noise end,
            "that is where it came to rest: with dry friction that is not the middle" },
        } },
      { name = "e", asks = "k, from I", unit = "torque per rad", answer = true_system.k, tolerance = 0.01, task = "5.4", how = "I omega0^2, or identify with I",
        mistakes = {
          { true_system.omega0^2, "that is k/I" },
          { true_system.omega0*given.I, "omega0 is to be squared" },
        } },
      { name = "f", asks = "standard error of zeta", answer = fit.error_if_right.zeta, tolerance = 0.2, task = "5.5", how = "fit.error_if_right.zeta",
        mistakes = {
          { fit.std_error.zeta, "that allows for any law of friction; if the model is right, please: fit.error_if_right" },
          { 2*fit.error_if_right.zeta, "that is two of them; one is asked for" },
          { fit.error_if_right.zeta/fit.zeta, "that is relative to zeta; as it stands in fit.error_if_right, please" },
        } },
      { name = "g", asks = "Re, from the pull", unit = "torque", answer = true_system.Re, tolerance = 0.03, task = "5.6",
        how = "identify{ data = pull, M = ramp, I, k, C, Rd of the decay, start and offset 0, free = { Re } }",
        mistakes = {
          { function(x) return math.abs(x/true_system.Rd - 1) < 0.08 end, "that is Rd, which brakes it once it moves" },
          { function(x) return x > 1.03*true_system.Re and x < 1.5*true_system.Re end,
            "too much: it leaves so slowly that the eye sees it late; fit it" },
          { true_system.Re/true_system.k, "that is an angle, Re/k" },
        } },
    }
  end,

  words = {
    es = {
      ["what made this record"] = "qué sistema hizo este registro",
      ["By eye"] = "A ojo",
      ["By least squares"] = "Por cuadrados mínimos",
      ["The stiffness"] = "La rigidez",
      ["One damping too few"] = "Un amortiguamiento de menos",
      ["The pull"] = "El tirón",
      ["there are two records: lab.experiment(5, 1), the decay, and lab.experiment(5, 2), the pull"] =
        "hay dos registros: lab.experiment(5, 1), el decaimiento, y lab.experiment(5, 2), el tirón",
      ["that is the period"] = "ese es el período",
      ["that takes all damping for viscous: leave Rd free"] = "eso toma todo el amortiguamiento por viscoso: deje libre Rd",
      ["that is lost in each half cycle, 2 Rd/k"] = "eso se pierde en cada medio ciclo, 2 Rd/k",
      ["that is Rd; the record of a decay tells Rd/k only"] = "eso es Rd; el registro de un decaimiento solo dice Rd/k",
      ["the size is right: the offset is what the record shows where the spring is relaxed"] =
        "el tamaño es correcto: el cero es lo que muestra el registro cuando el resorte está flojo",
      ["that is where it came to rest: with dry friction that is not the middle"] =
        "ahí quedó en reposo: con rozamiento seco ese no es el centro",
      ["that is k/I"] = "eso es k/I",
      ["omega0 is to be squared"] = "falta elevar omega0 al cuadrado",
      ["that is two of them; one is asked for"] = "esos son dos; se pide uno",
      ["that allows for any law of friction; if the model is right, please: fit.error_if_right"] =
        "ese admite otras leyes de rozamiento; se pide el del modelo correcto: fit.error_if_right",
      ["that is relative to zeta; as it stands in fit.error_if_right, please"] =
        "ese es relativo a zeta; délo como está en fit.error_if_right",
      ["that is Rd, which brakes it once it moves"] = "eso es Rd, que frena cuando ya se mueve",
      ["too much: it leaves so slowly that the eye sees it late; fit it"] =
        "demasiado: arranca tan despacio que el ojo lo ve tarde; haga el ajuste",
      ["that is an angle, Re/k"] = "eso es un ángulo, Re/k",
    },
  },
})
