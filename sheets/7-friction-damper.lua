-- Sheet 7: the friction damper: two bodies, the best slip torque.

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

--- The slip torque with the least amplitude, and that: by the golden section.
local function best(given)
  local omega, part = crossing(given), (math.sqrt(5) - 1)/2
  local low, high = 0.05*given.M0, 1.5*given.M0
  local a, b = high - part*(high - low), low + part*(high - low)
  local at_a, at_b = amplitude(given, a, omega), amplitude(given, b, omega)
  for _ = 1, 24 do
    if at_a < at_b then
      high, b, at_b = b, a, at_a
      a = high - part*(high - low)
      at_a = amplitude(given, a, omega)
    else
      low, a, at_a = a, b, at_b
      b = low + part*(high - low)
      at_b = amplitude(given, b, omega)
    end
  end
  return (low + high)/2, math.min(at_a, at_b)
end

sheet(7, {
  title = "the friction damper: two bodies, the best slip torque",

  given = function(pick)
    return { mu = pick(0.1, 0.3, 0.02), C = pick(0.01, 0.02, 0.002), M0 = pick(0.05, 0.2, 0.01) }
  end,

  discussion = function(given)
    local Rd, least = best(given)
    return {
      "Without torque no energy is taken, and without slip none either: work is torque times way. Between the two ends the contact takes energy, but it also drags the damper along, which moves " ..
        "the resonance: below the best slip torque there is too little of the one, far above it the machine swings more than at either end.",
      string.format("A viscous contact would leave M0 (2 + mu)/mu = %.4g at this frequency, whatever its C: all its curves pass this point. The force of dry friction changes its sign where the slip does, not " ..
        "where the fundamental of the slip does, so it is no pure damping for it; at its best it leaves %.4g.", given.M0*(2 + given.mu)/given.mu, least),
      "All slip torques scale with M0: at twice the M0 the best one is twice as great. A damper that is set for one load glues at a smaller one, and slips freely at a greater one.",
      "Where it slips it wears, and heats: the power is what the energy of 7.5 shows. The slip torque falls with the wear, and the amplitude rises slowly, as the curve of 7.4 is flat at its best.",
      string.format("At the resonance of the machine alone, omega = 1, gluing is best: M0/mu = %.4g. One has to choose for the worst frequency that will be met, not for one of them.", given.M0/given.mu),
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
      { name = "c", asks = "omega at which alone and glued swing equally far", unit = "rad per time unit", answer = omega, tolerance = 0.003, task = "7.3",
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
        } },
      { name = "e", asks = "best slip torque there", unit = "torque", answer = Rd, tolerance = 0.1, task = "7.4",
        how = "minimise, or the lowest place of the curve",
        mistakes = {
          { limit, "that glues them; less than that slips" },
          { function(x) return x > 1.1*Rd and x < 2.5*Rd end, "too tight: they slip too little" },
          { function(x) return x > 0.2*Rd and x < 0.9*Rd end, "too loose: it slips far, but its torque is small" },
        } },
      { name = "f", asks = "amplitude of the machine with it", unit = "rad", answer = least, tolerance = 0.01, task = "7.4",
        how = "s.machine.amplitude at the best slip torque",
        mistakes = {
          { given.M0*(2 + given.mu)/given.mu, "that is without any damping: at Rd = 0, or glued" },
          { 2*least, "twice as much: half of the way from the least to the greatest theta is asked for" },
        } },
    }
  end,
})
