-- Sheet 7: the friction damper: two bodies, the slip torque with the least peak over all frequencies.

--- The machine with its damper; Rd is the slip torque between them.
local function rig(given, Rd)
  return system{
    bodies = { machine = { I = 1, k = 1, C = given.C }, damper = { I = given.mu } },
    links = { joint = { "machine", "damper", Rd = Rd } },
  }
end

local function amplitude(given, Rd, omega)
  local M = excitation.harmonic{ amplitude = given.M0, omega = omega }
  return rig(given, Rd):steady{ M = { machine = M } }.machine.amplitude
end

--- Where the machine alone and the machine with the damper glued to it swing equally far, without C.
local function crossing(given) return math.sqrt(2/(2 + given.mu)) end

local function glued_from(given)
  local omega = crossing(given)
  return given.mu*omega^2*amplitude(given, 100*given.M0, omega)
end

--- The place of the least value of f between low and high, and that value: by the golden section.
local function lowest(f, low, high, steps)
  local part = (math.sqrt(5) - 1)/2
  local a, b = high - part*(high - low), low + part*(high - low)
  local at_a, at_b = f(a), f(b)
  for _ = 1, steps do
    if at_a < at_b then
      high, b, at_b = b, a, at_a
      a = high - part*(high - low)
      at_a = f(a)
    else
      low, a, at_a = a, b, at_b
      b = low + part*(high - low)
      at_b = f(b)
    end
  end
  return (low + high)/2, math.min(at_a, at_b)
end

--- The greatest amplitude over all frequencies: the best of some, and its surroundings.
local function peak(given, Rd)
  local low, step = 1/math.sqrt(1 + given.mu) - 0.02, 0.02
  local best, at = 0, low
  for omega = low, 1.03, step do
    local swing = amplitude(given, Rd, omega)
    if swing > best then best, at = swing, omega end
  end
  return -select(2, lowest(function(omega) return -amplitude(given, Rd, omega) end, at - step, at + step, 6))
end

--- The slip torque with the least peak, and that peak.
local function best(given)
  return lowest(function(Rd) return peak(given, Rd) end, 0.5*given.M0, 1.3*given.M0, 8)
end

sheet(7, {
  title = "the friction damper: two bodies, the best slip torque",

  setup = [[

local function steady(Rd, omega)
  local rig = system{
    bodies = { machine = { I = 1, k = 1, C = given.C }, damper = { I = given.mu } },
    links = { joint = { "machine", "damper", Rd = Rd } },
  }
  return rig:steady{ M = { machine = excitation.harmonic{ amplitude = given.M0, omega = omega } } }
end]],

  -- The script to begin with: the tasks, and what they have in it besides the questions.
  tasks = {
    { "7.2", "The two ends", "print(steady(0, 1))" },
    { "7.3", "Where they cross" },
    { "7.4", "The best slip torque", [[
local omega = vector.linspace(0.85, 1.05, 21)
local function peak(Rd)
  local highest = 0
  for _, w in ipairs(omega) do highest = math.max(highest, steady(Rd, w).machine.amplitude) end
  return highest
end

local torque, peaks = vector.linspace(0.4, 1.6, 21)*given.M0, {}
for i = 1, #torque do peaks[i] = peak(torque[i]) end
page:plot{ { torque, peaks }, xlabel = "Rd", ylabel = "peak, rad" }]] },
  },

  given = function(pick)
    return { mu = pick(0.1, 0.3, 0.02), C = pick(0.01, 0.02, 0.002), M0 = pick(0.05, 0.2, 0.01) }
  end,

  discussion = function(given)
    local _, least = best(given)
    return {
      "Without torque no energy is taken, and without slip none either: power is torque times slip speed. Between the two ends the contact takes energy, but it also drags the damper along, " ..
        "which moves the resonance towards that of both together. The peak is least where neither the resonance of the machine nor that of both can build up.",
      string.format("At the best slip torque the peak is %.4g, %.3g times less than without a damper. All curves of a viscous contact pass the point M0 (2 + mu)/mu = %.4g at the crossing, and the " ..
        "best viscous one has its peak there. Dry friction comes near this, at one load.", least, given.M0/given.C/least, given.M0*(2 + given.mu)/given.mu),
      "All slip torques scale with M0: at twice the M0 the best one is twice as great. A damper that is set for one load glues at a smaller one, and slips freely at a greater one.",
      "Where it slips it wears, and heats: the power is what the energy of 7.5 shows. The slip torque falls with the wear, and the peak rises slowly at first, as the curve of 7.4 is flat at its best.",
      string.format("At omega = 1 gluing is best: M0/mu = %.4g there; but then the resonance of both together has its full height, M0/(C omega) = %.4g. A setting for one frequency is of no use when " ..
        "the machine meets another one.", given.M0/given.mu, given.M0/given.C*math.sqrt(1 + given.mu)),
    }
  end,

  questions = function(given)
    local omega = crossing(given)
    local Rd, least = best(given)
    local alone = given.M0/given.C
    local glued = 1/math.sqrt(1 + given.mu)
    local limit = glued_from(given)
    return {
      { name = "a", asks = "amplitude of the machine alone at omega = 1", unit = "rad", answer = alone, tolerance = 0.01, task = "7.2",
        how = "at resonance only damping is left: M0/(C omega)",
        mistakes = {
          { given.M0, "that is M0/k, at rest" },
          { given.C/given.M0, "upside down" },
          { alone/2, "half of it: the amplitude, and C, not 2 zeta, stands in the formula" },
        } },
      { name = "b", asks = "natural omega of both, glued together", unit = "rad per time unit", answer = glued, tolerance = 0.005, task = "7.2",
        how = "omega = sqrt(k/(I + mu))",
        mistakes = {
          { 1/(1 + given.mu), "the root is missing" },
          { math.sqrt(1 + given.mu), "upside down: more inertia is slower" },
          { 1, "that is the machine alone" },
        } },
      { name = "c", asks = "omega at which alone and glued swing equally far", unit = "rad per time unit", answer = omega, tolerance = 0.0005, task = "7.3",
        how = "1 - omega^2 = (1 + mu) omega^2 - 1",
        mistakes = {
          { omega^2, "that is omega^2" },
          { (1 + glued)/2, "not half way: solve 1 - omega^2 = (1 + mu) omega^2 - 1" },
        } },
      { name = "d", asks = "slip torque above which they are glued there", unit = "torque", answer = limit, tolerance = 0.01, task = "7.3",
        how = "the torque that takes the damper along: mu omega^2 times the amplitude, nearly 2 M0",
        mistakes = {
          { limit/given.mu, "that takes the machine along; the damper has the inertia mu" },
          { limit/2, "half of it: look at the amplitude once more" },
          { limit/omega^2, "the amplitude of the acceleration is omega^2 times that of the angle" },
          { function(x) return math.abs(x - 2*given.M0) < 0.001*given.M0 end, "that is without C, which makes the amplitude smaller: take it from steady(100, omega)" },
        } },
      { name = "e", asks = "slip torque with the least peak over all omega", unit = "torque", answer = Rd, tolerance = 0.1, task = "7.4",
        how = "the lowest place of the greatest amplitude over omega, as a curve over Rd",
        mistakes = {
          { limit, "that glues them at the crossing; the best slip torque lets them slip" },
          { function(x) return x > 1.1*Rd and x < 3*Rd end, "too tight: the peak near the resonance of both together is higher; was omega scanned down to there?" },
          { function(x) return x > 0.2*Rd and x < 0.9*Rd end, "too loose: the peak near omega = 1 is higher" },
        } },
      { name = "f", asks = "this least peak of the machine", unit = "rad", answer = least, tolerance = 0.03, task = "7.4",
        how = "the greatest s.machine.amplitude over omega at the best slip torque",
        mistakes = {
          { alone, "that is without the damper" },
          { alone/glued, "that is the resonance of both, glued together" },
          { 2*least, "twice as much: half of the way from the least to the greatest theta is asked for" },
        } },
    }
  end,

  words = {
    es = {
      ["the friction damper: two bodies, the best slip torque"] = "el amortiguador de rozamiento: dos cuerpos, el mejor momento",
      ["The two ends"] = "Los dos extremos",
      ["Where they cross"] = "Dónde se cruzan",
      ["The best slip torque"] = "El mejor momento de deslizamiento",
      ["that is M0/k, at rest"] = "eso es M0/k, en reposo",
      ["upside down"] = "al revés",
      ["half of it: the amplitude, and C, not 2 zeta, stands in the formula"] =
        "es la mitad: se pide la amplitud, y en la fórmula está C, no 2 zeta",
      ["the root is missing"] = "falta la raíz",
      ["upside down: more inertia is slower"] = "al revés: con más inercia va más despacio",
      ["that is the machine alone"] = "esa es la máquina sola",
      ["that is omega^2"] = "eso es omega^2",
      ["not half way: solve 1 - omega^2 = (1 + mu) omega^2 - 1"] =
        "no está a mitad de camino: resuelva 1 - omega^2 = (1 + mu) omega^2 - 1",
      ["that takes the machine along; the damper has the inertia mu"] = "eso arrastra la máquina; el amortiguador tiene la inercia mu",
      ["half of it: look at the amplitude once more"] = "es la mitad: mire la amplitud otra vez",
      ["the amplitude of the acceleration is omega^2 times that of the angle"] =
        "la amplitud de la aceleración es omega^2 veces la del ángulo",
      ["that is without C, which makes the amplitude smaller: take it from steady(100, omega)"] =
        "eso es sin C, que achica la amplitud: tómela de steady(100, omega)",
      ["that glues them at the crossing; the best slip torque lets them slip"] =
        "eso los pega en el cruce; el mejor momento los deja deslizar",
      ["too tight: the peak near the resonance of both together is higher; was omega scanned down to there?"] =
        "demasiado apretado: el pico cerca de la resonancia de los dos juntos es más alto; ¿recorrió omega hasta ahí?",
      ["too loose: the peak near omega = 1 is higher"] = "demasiado flojo: el pico cerca de omega = 1 es más alto",
      ["that is without the damper"] = "eso es sin el amortiguador",
      ["that is the resonance of both, glued together"] = "esa es la resonancia de los dos pegados",
      ["twice as much: half of the way from the least to the greatest theta is asked for"] =
        "es el doble: se pide la mitad de la distancia entre el mínimo y el máximo de theta",
    },
  },
})
