-- Sheet 2: sticking, dead zone, breakaway.

--- The block that is drawn by its spring: how long it slips, how far it jumps, from slip to slip.
local function stick_slip(given, Re)
  local a, v, omega0 = (Re - given.Rd)/given.k, given.speed, math.sqrt(given.k/given.I)
  local lasts = 2*(math.pi - math.atan(omega0*a/v))/omega0
  local jump = 2*a + v*lasts
  return { lasts = lasts, jump = jump, period = jump/v }
end

sheet(2, {
  title = "sticking, dead zone, breakaway",

  -- The script to begin with: the tasks, and what they have in it besides the questions.
  tasks = {
    { "2.2", "Breakaway: the torque at which the angle is first seen to change", [[
local function breakaway(slope)
  local record = lab.experiment(2, slope)
  return record:filter(function(row) return row.theta > 0 end).M[1]
end
print("one reading:", breakaway(5))]] },
    { "2.3", "Dead zone" },
    { "2.4", "Where it ends" },
    { "2.5", "Stick-slip: add its picture with page:plot(drawn(Re):plot{ show = false })" },
  },

  given = function(pick)
    local I, k, Rd = pick(1, 3, 0.2), pick(200, 400, 10), pick(12, 20, 0.5)
    return { I = I, k = k, Rd = Rd }
  end,

  -- Re of the bench; the start of task 2.4 stops where Re decides; the drive of task 2.5.
  secret = function(given, pick)
    local ratio = pick(1.45, 1.6, 0.05)
    local x_f, a = given.Rd/given.k, (ratio - 1)*given.Rd/given.k
    given.theta0 = rounded((2*pick(3, 5, 1) + pick(1.1, 1.25, 0.05))*x_f, 4)
    -- A period of nearly 1 would be as right upside down.
    repeat
      given.speed = rounded(math.sqrt(given.k/given.I)*a*pick(0.5, 0.7, 0.05), 3)
    until math.abs(stick_slip(given, given.Rd*ratio).period - 1) > 0.1
    return { Re = rounded(given.Rd*ratio, 6), seed = math.floor(pick(1, 1e6, 1)) }
  end,

  -- The torque rises by x a time unit until 4 Rd; a sensor of torque with 0.4 % of noise, one of angle that sees 0.0002.
  try_with = 1,
  experiment = function(given, secret, slope)
    if not slope then error("give it a slope: by how much the torque rises in a time unit, lab.experiment(2, 5)", 0) end
    if slope < 0.1 or slope > 2000 then
      error("the drive of the bench pulls with slopes from 0.1 to 2000", 0)
    end
    local bench = system{ I = given.I, k = given.k, Rd = given.Rd, Re = secret.Re }
    local t_end = 4*given.Rd/slope
    local run = bench:simulate{ M = excitation.ramp{ slope = slope }, t_end = t_end, dt = t_end/2000 }
    local seed = secret.seed + math.floor(1000*slope)
    local torque = run.M + vector.normal{ n = #run, seed = seed, std = 0.004*secret.Re }
    local angle = {}
    for i = 1, #run do angle[i] = rounded(2e-4*math.floor(run.theta[i]/2e-4), 6) end
    return data{ { "t", run.t }, { "M", torque }, { "theta", vector(angle) } }
  end,

  discussion = function(given, secret)
    local difference = secret.Re - given.Rd
    return {
      string.format("The error of Re itself stays, but Re - Rd is smaller than Re: 1 %% of %.4g is %.2g %% of %.4g. So is the error of 2 (Re - Rd)/k, the jump.",
        secret.Re, secret.Re/difference, difference),
      "Between breaking loose and being seen to move some time passes (the angle must grow to what the sensor sees), and the torque goes on rising " ..
        "meanwhile: slope times that time is the error. The true Re of this bench is the same; with real materials it may depend on the pull and on how " ..
        "long they have rested, which is another story.",
      string.format("Within |theta| <= Re/k = %.3g rad of its true value nothing moves it. Tapping is a torque that comes and goes: whenever it helps the " ..
        "spring, the pointer slips a little towards the true value; against the spring it must do more, so it goes the other way less often.", secret.Re/given.k),
      string.format("It is 0 in the limit: the block does not wait any more. At the speed v of the drive it starts from rest and moves with v (1 - cos omega0 t): up to 2 v, " ..
        "and once in each T0 = %.3g its velocity touches 0 without a stop. Any damping makes that an even slide.",
        2*math.pi*math.sqrt(given.I/given.k)),
      "There is none any more. At velocity 0 such a friction is 0, so nothing holds the mass: under any load it creeps, where it should rest, with the " ..
        "velocity at which tanh makes up for the load. And breakaway, Re > Rd, cannot be said with it at all.",
    }
  end,

  questions = function(given, secret)
    local Re, Rd, k, v = secret.Re, given.Rd, given.k, given.speed
    local full = system{ I = given.I, k = k, Rd = Rd, Re = Re }
    local simple = system{ I = given.I, k = k, Rd = Rd }
    local rest = theory.rest_position{ system = full, theta0 = given.theta0 }
    local a = (Re - Rd)/k
    local drawn = stick_slip(given, Re)
    local lasts, jump = drawn.lasts, drawn.jump
    return {
      { name = "a", asks = "Re of the bench", unit = "torque", answer = Re, tolerance = 0.02, task = "2.2",
        how = "M where theta first moves, pulled slowly; the mean of several pulls",
        mistakes = {
          { Rd, "that is Rd, which you were given; it takes more to get it going" },
          { Re/k, "that is an angle, Re/k; the torque is asked for" },
          { 4*Rd, "that is where the pull ended; look where theta moved first" },
          { function(x) return x > 1.02*Re and x < 4*Rd end,
            "too much: pulled fast, the torque has gone on rising when the angle is seen to move; pull more slowly" },
          { function(x) return x > Rd and x < 0.98*Re end,
            "too little: that is before it moved; one noisy reading is not enough, take several pulls" },
        } },
      { name = "b", asks = "half width of the dead zone", unit = "rad", answer = Re/k, tolerance = 0.02, task = "2.3",
        how = "Re/k",
        mistakes = {
          { 2*Re/k, "that is its whole width; the dead zone reaches as far to the other side" },
          { Rd/k, "that is Rd/k: what holds a resting mass is Re" },
          { Re, "that is the torque; divide by the stiffness" },
        } },
      { name = "c", asks = "where it rests, let go at theta0", unit = "rad", answer = rest, tolerance = 0.01, task = "2.4",
        how = "the first extreme within Re/k: Re decides whether there is one more half swing",
        praise = "with Re = Rd it would have gone on",
        mistakes = {
          { theory.rest_position{ system = simple, theta0 = given.theta0 },
            "that is with Re = Rd: once it stops there, Re holds it. Give your system the Re that you have measured" },
          { -rest, "the distance is right, the side is not" },
          { 0, "nothing brings it back to the middle" },
        } },
      { name = "d", asks = "first slip of the drawn block", unit = "time units", answer = Re/(k*v), tolerance = 0.025, task = "2.5",
        how = "Re/(k v)",
        mistakes = {
          { Rd/(k*v), "that is where M passes Rd: at rest it is held by Re" },
          { Re/v, "the stiffness is missing: the torque of the spring is k v t" },
        } },
      { name = "e", asks = "how far it jumps", unit = "rad", answer = jump, tolerance = 0.08, task = "2.5",
        how = "theta of stick less theta of slip; 2 (Re - Rd)/k + v times how long it lasts",
        mistakes = {
          { 2*a, "that is the limit of pulling slowly, 2 (Re - Rd)/k; meanwhile the drive goes on" },
          { a, "that is (Re - Rd)/k; it swings as far beyond the middle again, and the drive goes on" },
          { Re/k, "that is where the spring was when it slipped" },
        } },
      { name = "f", asks = "from slip to slip", unit = "time units", answer = drawn.period, tolerance = 0.08, task = "2.5",
        how = "jump/v: in the mean it keeps up with the drive",
        mistakes = {
          { lasts, "that is how long it slips; the time that it sticks belongs to it, too" },
          { 2*a/v, "that is how long it sticks; the time that it slips belongs to it, too" },
          { Re/(k*v), "that is the first slip, from a relaxed spring; from then on the spring is never relaxed again" },
        } },
    }
  end,

  words = {
    es = {
      ["sticking, dead zone, breakaway"] = "adherencia, zona muerta, despegue",
      ["Breakaway: the torque at which the angle is first seen to change"] =
        "Despegue: el momento con que se ve cambiar el ángulo por primera vez",
      ["Dead zone"] = "Zona muerta",
      ["Where it ends"] = "Dónde termina",
      ["Stick-slip: add its picture with page:plot(drawn(Re):plot{ show = false })"] =
        "Stick-slip: agregue su figura con page:plot(drawn(Re):plot{ show = false })",
      ["give it a slope: by how much the torque rises in a time unit, lab.experiment(2, 5)"] =
        "dele una pendiente: cuánto crece el momento por unidad de tiempo, lab.experiment(2, 5)",
      ["the drive of the bench pulls with slopes from 0.1 to 2000"] = "el banco tira con pendientes de 0.1 a 2000",
      ["that is Rd, which you were given; it takes more to get it going"] =
        "eso es Rd, que está entre los datos; para que arranque hace falta más",
      ["that is an angle, Re/k; the torque is asked for"] = "eso es un ángulo, Re/k; se pide el momento",
      ["that is where the pull ended; look where theta moved first"] = "ahí terminó el tirón; mire dónde se movió theta por primera vez",
      ["too much: pulled fast, the torque has gone on rising when the angle is seen to move; pull more slowly"] =
        "demasiado: si se tira rápido, el momento sigue creciendo hasta que se ve mover el ángulo; tire más despacio",
      ["too little: that is before it moved; one noisy reading is not enough, take several pulls"] =
        "muy poco: eso es antes de que se moviera; una lectura con ruido no alcanza, tire varias veces",
      ["that is its whole width; the dead zone reaches as far to the other side"] =
        "ese es el ancho entero; la zona muerta llega igual de lejos al otro lado",
      ["that is Rd/k: what holds a resting mass is Re"] = "eso es Rd/k: lo que sostiene una masa en reposo es Re",
      ["that is the torque; divide by the stiffness"] = "ese es el momento; divida por la rigidez",
      ["with Re = Rd it would have gone on"] = "con Re = Rd habría seguido",
      ["that is with Re = Rd: once it stops there, Re holds it. Give your system the Re that you have measured"] =
        "eso es con Re = Rd: una vez detenida, la sostiene Re. Dé a su sistema el Re que midió",
      ["the distance is right, the side is not"] = "la distancia es correcta, el lado no",
      ["nothing brings it back to the middle"] = "nada la devuelve al centro",
      ["that is where M passes Rd: at rest it is held by Re"] = "ahí M pasa por Rd: en reposo la sostiene Re",
      ["the stiffness is missing: the torque of the spring is k v t"] = "falta la rigidez: el momento del resorte es k v t",
      ["that is the limit of pulling slowly, 2 (Re - Rd)/k; meanwhile the drive goes on"] =
        "ese es el límite de tirar despacio, 2 (Re - Rd)/k; mientras tanto el arrastre sigue",
      ["that is (Re - Rd)/k; it swings as far beyond the middle again, and the drive goes on"] =
        "eso es (Re - Rd)/k; del otro lado del centro recorre otro tanto, y el arrastre sigue",
      ["that is where the spring was when it slipped"] = "ahí estaba el resorte cuando deslizó",
      ["that is how long it slips; the time that it sticks belongs to it, too"] =
        "eso dura el deslizamiento; también cuenta el tiempo en que está adherido",
      ["that is how long it sticks; the time that it slips belongs to it, too"] =
        "eso dura la adherencia; también cuenta el tiempo en que desliza",
      ["that is the first slip, from a relaxed spring; from then on the spring is never relaxed again"] =
        "ese es el primer deslizamiento, con el resorte flojo; después el resorte nunca vuelve a estar flojo",
    },
  },
})
