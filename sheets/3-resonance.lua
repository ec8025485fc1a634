-- Sheet 3: resonance with friction, Den Hartog against linearisation.
sheet(3, {
  title = "resonance with friction, Den Hartog against linearisation",

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
      string.format("It limits the motion only if Rd >= pi/4 = 0.785 of the load's amplitude M0. Below that each period adds pi - 4 gamma (in M0/k), for ever, " ..
        "here %.3g. Friction in joints is small and not to be relied upon; a damper takes more the faster it goes.", math.pi - 4*g),
      string.format("At the turns. Between them friction is a constant and drops out of the difference of two motions, which then swings freely. At a turn it jumps: the " ..
        "torque behind it is less than the one before it, and the difference of the two velocities shrinks by the ratio of these torques. Here %.2g of a disturbance is left after a " ..
        "period. Without friction nothing jumps, and nothing fades.", s.multipliers and s.multipliers[1].abs or 0),
      "Into the swing: M0 does pi M0 A of work in a period, friction takes 4 Rd A, and what is left is added to k A^2/2. Were it a machine, it would go on until " ..
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
      { name = "a", asks = "amplitude at r with friction", unit = "M0/k", answer = A, tolerance = 0.002, task = "3.2",
        how = "sys:steady, or theory.den_hartog",
        mistakes = {
          { 2*A, "that is from peak to peak; an amplitude is half of it" },
          { V, "that is without friction" },
          { linear, "that is the linearised one, which 3b asks for" },
        } },
      { name = "b", asks = "the same, friction linearised", unit = "M0/k", answer = linear, tolerance = 0.002, task = "3.3",
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
      { name = "e", asks = "growth in each period at resonance", unit = "M0/k", answer = growth, tolerance = 0.005, task = "3.5",
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
      { name = "h", asks = "amplitude at resonance with a damper, too", unit = "M0/k", answer = damped, tolerance = 0.002,
        task = "3.7", how = "sys:steady with zeta and gamma, or theory.den_hartog with both",
        mistakes = {
          { 1/(2*given.zeta), "that is without dry friction" },
          { 2*damped, "that is from peak to peak" },
        } },
    }
  end,
})
