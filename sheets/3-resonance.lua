-- Sheet 3: resonance with friction, Den Hartog against linearisation.
sheet(3, {
  title = "resonance with friction, Den Hartog against linearisation",

  setup = [[local sys = nondimensional{ friction_ratio = given.friction_ratio }]],

  -- The script to begin with: the tasks, and what they have in it besides the questions.
  tasks = {
    { "3.2", "The true amplitude", [[
local s = sys:steady{ M = excitation.harmonic{ frequency = given.r } }
print(s.status)
page:plot(s.run:plot{ show = false })]] },
    { "3.3", "Linearised" },
    { "3.4", "Phase" },
    { "3.5", "At resonance" },
    { "3.6", "Stops" },
    { "3.7", "With a damper" },
  },

  -- With much of both the motion of 3.7 would stop, and linearisation not do well: such numbers are drawn again.
  given = function(pick)
    local given
    repeat
      given = { r = pick(1.25, 1.6, 0.05), friction_ratio = pick(0.3, 0.5, 0.02), small_ratio = pick(0.1, 0.6, 0.02),
                low_r = pick(0.14, 0.4, 0.02), zeta = pick(0.1, 0.2, 0.01) }
      local damped = theory.den_hartog{ r = 1, friction_ratio = given.small_ratio, zeta = given.zeta }
    until damped
    return given
  end,

  discussion = function(given)
    local g = given.small_ratio
    local damped = theory.den_hartog{ r = 1, friction_ratio = g, zeta = given.zeta }
    local linear = theory.linearised{ r = 1, friction_ratio = g, zeta = given.zeta }
    local s = nondimensional{ friction_ratio = given.friction_ratio }:steady{ M = excitation.harmonic{ frequency = given.r } }
    return {
      string.format("Linearisation keeps the energy of a sine. With a damper at resonance the motion is nearly one, and large beside Rd/k: there it is off by %.2g %%. " ..
        "Away from resonance the square wave of friction is no small part of the torque, and the motion is no sine.", 100*(linear/damped - 1)),
      string.format("It limits the motion only if Rd >= pi/4 = 0.785 of the load's amplitude Mc. Below that each period adds pi - 4 gamma (in Mc/k), for ever, " ..
        "here %.3g. Friction in joints is small and not to be relied upon; a damper takes more the faster it goes.", math.pi - 4*g),
      string.format("At the turns. Between them friction is a constant and drops out of the difference of two motions, which then swings freely. At a turn it jumps: the " ..
        "torque behind it is less than the one before it, and the difference of the two velocities shrinks by the ratio of these torques. Here %.2g of a disturbance is left after a " ..
        "period. Without friction nothing jumps, and nothing fades.", s.multipliers and s.multipliers[1].abs or 0),
      "Into the swing: Mc does pi Mc A of work in a period, friction takes 4 Rd A, and what is left is added to k A^2/2. Were it a machine, it would go on until " ..
        "something breaks, or something else than friction limits it.",
      "By the flat parts of theta: where it sticks the angle is constant, and it leaves them with a kink in the velocity.",
    }
  end,

  questions = function(given)
    local r, g = given.r, given.friction_ratio
    local V = 1/math.abs(1 - r^2)
    local A, peak_lag = theory.den_hartog{ r = r, friction_ratio = g }
    local linear, linear_lag = theory.linearised{ r = r, friction_ratio = g }
    local s = nondimensional{ friction_ratio = g }:steady{ M = excitation.harmonic{ frequency = r } }
    local low = nondimensional{ friction_ratio = g }:steady{ M = excitation.harmonic{ frequency = given.low_r } }
    local growth = math.pi - 4*given.small_ratio
    local boundary = theory.stop_boundary{ r = r }
    local damped = theory.den_hartog{ r = 1, friction_ratio = given.small_ratio, zeta = given.zeta }
    local error = 100*(linear/A - 1)
    return {
      { name = "a", asks = "amplitude at r with friction", unit = "Mc/k", answer = A, tolerance = 0.002, task = "3.2",
        how = "sys:steady, or theory.den_hartog",
        mistakes = {
          { 2*A, "that is from peak to peak; an amplitude is half of it" },
          { V, "that is without friction" },
          { linear, "that is the linearised one, which 3b asks for" },
        } },
      { name = "b", asks = "the same, friction linearised", unit = "Mc/k", answer = linear, tolerance = 0.002, task = "3.3",
        how = "sqrt(1 - (4 gamma/pi)^2)/|1 - r^2|",
        mistakes = {
          { A, "that is the true one of 3a" },
          { -linear, "an amplitude is positive: |1 - r^2|" },
          { (1 - (4*g/math.pi)^2)*V, "the root is missing" },
          { math.sqrt(math.max(0, 1 - (math.pi*g/4)^2))*V, "4/pi has become pi/4" },
          { V, "that is without friction" },
        } },
      { name = "c", asks = "how much too great that is", unit = "percent", answer = error, tolerance = 0.005, task = "3.3",
        how = "100 (linearised/true - 1)",
        mistakes = {
          { 100*(1 - A/linear), "the error belongs to the true value: divide by that of 3a" },
          { -error, "too great is a positive error" },
          { 100*(V/A - 1), "that compares with no friction at all" },
        } },
      { name = "d", asks = "lag of the fundamental", unit = "degrees", answer = math.deg(s.lag), within = 0.005, task = "3.4", how = "math.deg(s.lag)",
        mistakes = {
          { math.deg(s.peak_lag), "that is how much the greatest angle lags; the fundamental is asked for" },
          { 180 - math.deg(s.lag), "180 degrees less this: above resonance the lag is more than 90" },
          { math.deg(linear_lag), "that is the linearised one: near, but not the same" },
          { -math.deg(s.lag), "theta comes after M: a lag is positive here" },
          { s.lag, "that is in radians; degrees are asked for" },
          { function(x) return math.abs(x - math.deg(s.lag)) < 0.1 end, "give it with three decimals: the linearised one is as near" },
        } },
      { name = "e", asks = "growth in each period at resonance", unit = "Mc/k", answer = growth, tolerance = 0.005, task = "3.5",
        how = "pi - 4 gamma",
        mistakes = {
          { growth/2, "that is in each half cycle; a period has two" },
          { math.pi, "that is without friction" },
          { math.pi - 2*given.small_ratio, "friction takes 2 Rd/k in each half cycle, and a period has two of them" },
          { math.pi - given.small_ratio, "friction takes 4 Rd/k in each period" },
        } },
      { name = "f", asks = "gamma from which on it stops at r", answer = boundary, tolerance = 0.02, task = "3.6",
        how = "theory.stop_boundary{ r = r }, or trying gammas with steady until s.stops is not 0",
        mistakes = {
          { math.pi/4, "that is the boundary at resonance, pi/4; here r is another" },
        } },
      { name = "g", asks = "stops in a period at low_r", answer = low.stops, whole = true, task = "3.6", how = "s.stops",
        mistakes = {
          { low.stops/2, "that is in half a period" },
          { 2*low.stops, "that is in two periods" },
          { 0, "it does stop: so slow a load is followed in steps" },
        } },
      { name = "h", asks = "amplitude at resonance with a damper, too", unit = "Mc/k", answer = damped, tolerance = 0.002,
        task = "3.7", how = "sys:steady with zeta and gamma, or theory.den_hartog with both",
        mistakes = {
          { 1/(2*given.zeta), "that is without dry friction" },
          { 2*damped, "that is from peak to peak" },
        } },
    }
  end,

  words = {
    es = {
      ["resonance with friction, Den Hartog against linearisation"] = "resonancia con rozamiento, Den Hartog y linealización",
      ["The true amplitude"] = "La amplitud verdadera",
      ["Linearised"] = "Linealizado",
      ["Phase"] = "Fase",
      ["At resonance"] = "En resonancia",
      ["Stops"] = "Paradas",
      ["With a damper"] = "Con un amortiguador",
      ["that is from peak to peak; an amplitude is half of it"] = "eso es de pico a pico; la amplitud es la mitad",
      ["that is without friction"] = "eso es sin rozamiento",
      ["that is the linearised one, which 3b asks for"] = "esa es la linealizada, que se pide en 3b",
      ["that is the true one of 3a"] = "esa es la verdadera, de 3a",
      ["an amplitude is positive: |1 - r^2|"] = "una amplitud es positiva: |1 - r^2|",
      ["the root is missing"] = "falta la raíz",
      ["4/pi has become pi/4"] = "4/pi quedó como pi/4",
      ["the error belongs to the true value: divide by that of 3a"] = "el error se refiere al valor verdadero: divida por el de 3a",
      ["too great is a positive error"] = "demasiado grande es un error positivo",
      ["that compares with no friction at all"] = "eso compara con nada de rozamiento",
      ["that is how much the greatest angle lags; the fundamental is asked for"] =
        "eso se atrasa el ángulo máximo; se pide la fundamental",
      ["180 degrees less this: above resonance the lag is more than 90"] =
        "180 grados menos esto: por encima de la resonancia el atraso es mayor que 90",
      ["that is the linearised one: near, but not the same"] = "ese es el linealizado: cerca, pero no igual",
      ["theta comes after M: a lag is positive here"] = "theta viene después de M: un atraso es aquí positivo",
      ["that is in radians; degrees are asked for"] = "está en radianes; se piden grados",
      ["give it with three decimals: the linearised one is as near"] = "délo con tres decimales: el linealizado está igual de cerca",
      ["that is in each half cycle; a period has two"] = "eso es en cada medio ciclo; un período tiene dos",
      ["friction takes 2 Rd/k in each half cycle, and a period has two of them"] =
        "el rozamiento quita 2 Rd/k en cada medio ciclo, y un período tiene dos",
      ["friction takes 4 Rd/k in each period"] = "el rozamiento quita 4 Rd/k en cada período",
      ["that is the boundary at resonance, pi/4; here r is another"] = "ese es el límite en resonancia, pi/4; aquí r es otro",
      ["that is in half a period"] = "eso es en medio período",
      ["that is in two periods"] = "eso es en dos períodos",
      ["it does stop: so slow a load is followed in steps"] = "sí se detiene: una carga tan lenta se sigue de a saltos",
      ["that is without dry friction"] = "eso es sin rozamiento seco",
      ["that is from peak to peak"] = "eso es de pico a pico",
    },
  },
})
