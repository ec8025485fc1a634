-- Sheet 1: free decay, viscous against dry.
sheet(1, {
  title = "free decay, viscous against dry",

  setup = [[local viscous, dry = system(given.viscous), system(given.dry)]],

  -- The script to begin with: the tasks, and what they have in it besides the questions.
  tasks = {
    { "1.2", "The period" },
    { "1.3", "Viscous damping", [[
local run = viscous:simulate{ theta0 = given.theta0, t_end = 10*viscous.T0, dt = viscous.T0/100 }
page:plot(run:plot{ show = false })]] },
    { "1.4", "Dry friction", [[
run = dry:simulate{ theta0 = given.theta0, t_end = 10*dry.T0, dt = dry.T0/100 }
page:plot(run:plot{ show = false })
page:plot(run:phase_plot{ show = false })]] },
    { "1.5", "A record with both", [[
local record = lab.experiment(1)
print(record)]] },
  },

  given = function(pick)
    local I, k, theta0 = pick(0.5, 2, 0.1), pick(20, 60, 1), pick(0.8, 1.2, 0.05)
    local zeta = pick(0.04, 0.085, 0.005) -- with 0.09 X2/X0 is as great as its own logarithm
    -- n half swings, and where in the dead zone the last one ends: never near its edge, nor in the middle
    local n, s = pick(5, 8, 1), pick(0.35, 0.7, 0.05) * (pick(0, 1, 1) == 0 and 1 or -1)
    return {
      theta0 = theta0,
      viscous = { I = I, k = k, C = rounded(2*zeta*math.sqrt(I*k), 4) },
      dry = { I = I, k = k, Rd = rounded(k*theta0/(2*n + s), 4) },
    }
  end,

  secret = function(given, pick)
    local mixed = nondimensional{ zeta = pick(0.02, 0.05, 0.002), friction_ratio = pick(0.01, 0.03, 0.001) }
    return { mixed = mixed }
  end,

  -- The turns of a motion with both frictions, as a colleague has noted them: five digits.
  experiment = function(given, secret)
    local t, X = theory.extremes{ system = secret.mixed, theta0 = 1, count = 5 }
    local turns = { t = {}, theta = {} }
    for i = 1, #t do
      turns.t[i], turns.theta[i] = rounded(t[i], 5), tonumber(string.format("%.5f", X[i]))
    end
    return data{ { "t", turns.t }, { "theta", turns.theta } }
  end,

  discussion = function(given)
    local viscous, dry = system(given.viscous), system(given.dry)
    local x_f, slower = dry.Rd/dry.k, 100*(1/math.sqrt(1 - viscous.zeta^2) - 1)
    return {
      "By its extremes. Viscous: they lie on a curve that flattens, each a fixed part of the one before, and the motion never quite ends. Dry: " ..
        "they lie on a straight line, and the motion ends at once, as a rule not in the middle.",
      "The dry one rests first: it goes on losing as much in each half cycle, while the viscous one loses less and less. In the model the viscous " ..
        "one is never at rest.",
      string.format("It can stop only where its velocity is 0, at an extreme, and these are theta0 less multiples of 2 x_f. The first of them within " ..
        "the dead zone is the last. It stops in the middle when theta0 is a multiple of 2 x_f = %.4g, for example theta0 = %.4g.", 2*x_f,
        2*x_f*math.floor(given.theta0/(2*x_f))),
      string.format("It does: T1 = T0/sqrt(1 - zeta^2), here %.2g %% longer. Dry friction only shifts the middle of each half swing; between two turns " ..
        "it is a constant torque, and the period does not know of it.", slower),
      "The amount that is lost stays the same while the amplitude falls, so the ratio X0/X1 = X0/(X0 - 2 x_f) grows from swing to swing. A decrement " ..
        "that grows towards the end is how one sees dry friction in a record.",
    }
  end,

  questions = function(given, secret)
    local viscous, dry, mixed = system(given.viscous), system(given.dry), secret.mixed
    local decrement = theory.logarithmic_decrement{ zeta = viscous.zeta }
    local x_f, T0 = dry.Rd/dry.k, dry.T0
    local rest = theory.rest_position{ system = dry, theta0 = given.theta0 }
    local time = theory.time_to_rest{ system = dry, theta0 = given.theta0 }
    local _, X = theory.extremes{ system = mixed, theta0 = 1, count = 3 }
    local X0, X1, X2 = X[1], -X[2], X[3]
    local q = (X1 - X2)/(X0 - X1)
    return {
      { name = "a", asks = "natural period", unit = "time units", answer = T0, tolerance = 0.002, task = "1.2",
        how = "2 pi sqrt(I/k)",
        mistakes = {
          { dry.omega0, "that is omega0, in rad per time unit; the period is asked for" },
          { 1/T0, "that is the frequency; the period is its reciprocal" },
          { math.sqrt(dry.I/dry.k), "a factor of 2 pi is missing: 1/omega0 is no period" },
          { 2*math.pi*math.sqrt(dry.k/dry.I), "I and k have changed places under the root" },
          { T0/2, "that is half of it: from turn to turn it is half a period" },
        } },
      { name = "b", asks = "logarithmic decrement of the viscous system", answer = decrement, tolerance = 0.01, task = "1.3",
        how = "ln(X0/X2) of two extremes on the same side",
        mistakes = {
          { decrement/2, "that is the decrement of half a cycle: two turns that follow each other are half a cycle apart" },
          { decrement/math.log(10), "that is with the logarithm to base 10; math.log(x) is the natural one" },
          { math.exp(decrement), "that is the ratio of the extremes; its logarithm is asked for" },
          { math.exp(-decrement), "that is the ratio of the extremes, the smaller one above; the logarithm of X0/X2 is asked for" },
          { viscous.zeta, "that is zeta, which is asked for in 1c" },
        } },
      { name = "c", asks = "zeta of the viscous system", answer = viscous.zeta, tolerance = 0.01, task = "1.3",
        how = "zeta = d/sqrt(4 pi^2 + d^2), or C/(2 sqrt(I k))",
        mistakes = {
          { viscous.zeta/2, "half of it: is your decrement that of half a cycle, or did the 2 in 2 pi come twice?" },
          { 2*viscous.zeta, "twice as much: the decrement of a whole cycle belongs to 2 pi, not to pi" },
          { viscous.zeta/(2*math.pi), "too small by 2 pi: divide the decrement by it once" },
          { decrement, "that is the decrement; zeta is about d/(2 pi)" },
        } },
      { name = "d", asks = "amplitude lost in each half cycle, dry", unit = "rad", answer = 2*x_f, tolerance = 0.005, task = "1.4",
        how = "2 Rd/k",
        mistakes = {
          { 4*x_f, "that is lost in a whole cycle; half a cycle is asked for" },
          { x_f, "that is Rd/k; the centre of the swing jumps from one side to the other, so it counts twice" },
          { -2*x_f, "the size is right; a loss is a positive number here" },
        } },
      { name = "e", asks = "where it rests, dry (with its sign)", unit = "rad", answer = rest, within = 0.02*x_f, task = "1.4",
        how = "the first extreme within Rd/k; alternate signs",
        praise = "off the middle, as dry friction may leave it",
        mistakes = {
          { -rest, "the distance is right, the side is not: count the half swings, or look at run.events" },
          { 0, "nothing brings it back to the middle: within Rd/k friction holds it" },
          { x_f, "that is the edge of the dead zone; it rests at an extreme somewhere within" },
          { -x_f, "that is an edge of the dead zone; it rests at an extreme somewhere within" },
        } },
      { name = "f", asks = "when it comes to rest, dry", unit = "time units", answer = time, tolerance = 0.005, task = "1.4",
        how = "n T0/2, n half swings",
        mistakes = {
          { 2*time, "twice as long: from turn to turn it is half a period" },
          { time/2, "half as long: you have counted whole cycles as halves" },
          { 2*time/T0, "that is the number of half swings; how long do they take?" },
          { time - T0/2, "one half swing too early: at that turn it still moved on" },
          { time + T0/2, "one half swing too late: it was at rest before" },
        } },
      { name = "g", asks = "zeta of the colleague's record", answer = mixed.zeta, tolerance = 0.03, task = "1.5",
        how = "q = (X1 - X2)/(X0 - X1); zeta/sqrt(1 - zeta^2) = -ln(q)/pi",
        mistakes = {
          { math.log(X0/X1)/math.pi, "that takes all damping for viscous; the dry part must go out first: take differences" },
          { math.log(X0/X2)/(2*math.pi), "that takes all damping for viscous; the dry part must go out first: take differences" },
          { -math.log(q)/(2*math.pi), "half of it: X0, X1, X2 are half a cycle apart, so -ln(q) belongs to pi" },
          { -math.log(q), "that is -ln(q); divide by pi" },
          { function(x) return x < 0 end, "zeta is positive: q is less than 1, and its logarithm negative" },
        } },
      { name = "h", asks = "x_f = Rd/k of the colleague's record", unit = "rad", answer = mixed.Rd/mixed.k, tolerance = 0.03,
        task = "1.5", how = "x_f = (q X0 - X1)/(1 + q), without sign",
        mistakes = {
          { 2*mixed.Rd/mixed.k, "that is 2 x_f, what dry friction alone would take in half a cycle" },
          { (X0 - X1)/2, "that takes all damping for dry; use q" },
          { -mixed.Rd/mixed.k, "the sign is wrong: take the extremes without theirs" },
        } },
    }
  end,

  words = {
    es = {
      ["free decay, viscous against dry"] = "decaimiento libre, viscoso y seco",
      ["The period"] = "El período",
      ["Viscous damping"] = "Amortiguamiento viscoso",
      ["Dry friction"] = "Rozamiento seco",
      ["A record with both"] = "Un registro con los dos",
      ["that is omega0, in rad per time unit; the period is asked for"] = "eso es omega0, en rad por unidad de tiempo; se pide el período",
      ["that is the frequency; the period is its reciprocal"] = "esa es la frecuencia; el período es su recíproco",
      ["a factor of 2 pi is missing: 1/omega0 is no period"] = "falta un factor 2 pi: 1/omega0 no es un período",
      ["I and k have changed places under the root"] = "I y k cambiaron de lugar bajo la raíz",
      ["that is half of it: from turn to turn it is half a period"] = "es la mitad: de un giro al siguiente hay medio período",
      ["that is the decrement of half a cycle: two turns that follow each other are half a cycle apart"] =
        "ese es el decremento de medio ciclo: dos giros seguidos están a medio ciclo uno del otro",
      ["that is with the logarithm to base 10; math.log(x) is the natural one"] =
        "eso es con el logaritmo decimal; math.log(x) es el natural",
      ["that is the ratio of the extremes; its logarithm is asked for"] = "ese es el cociente de los extremos; se pide su logaritmo",
      ["that is the ratio of the extremes, the smaller one above; the logarithm of X0/X2 is asked for"] =
        "ese es el cociente de los extremos, con el menor arriba; se pide el logaritmo de X0/X2",
      ["that is zeta, which is asked for in 1c"] = "eso es zeta, que se pide en 1c",
      ["half of it: is your decrement that of half a cycle, or did the 2 in 2 pi come twice?"] =
        "es la mitad: ¿su decremento es el de medio ciclo, o entró dos veces el 2 de 2 pi?",
      ["twice as much: the decrement of a whole cycle belongs to 2 pi, not to pi"] =
        "es el doble: al decremento de un ciclo entero le corresponde 2 pi, no pi",
      ["too small by 2 pi: divide the decrement by it once"] = "demasiado chico por 2 pi: divida el decremento por 2 pi una sola vez",
      ["that is the decrement; zeta is about d/(2 pi)"] = "ese es el decremento; zeta es cerca de d/(2 pi)",
      ["that is lost in a whole cycle; half a cycle is asked for"] = "eso se pierde en un ciclo entero; se pide medio ciclo",
      ["that is Rd/k; the centre of the swing jumps from one side to the other, so it counts twice"] =
        "eso es Rd/k; el centro de la oscilación salta de un lado al otro, y entonces cuenta dos veces",
      ["the size is right; a loss is a positive number here"] = "el tamaño es correcto; una pérdida es aquí un número positivo",
      ["off the middle, as dry friction may leave it"] = "fuera del centro, como lo puede dejar el rozamiento seco",
      ["the distance is right, the side is not: count the half swings, or look at run.events"] =
        "la distancia es correcta, el lado no: cuente los medios ciclos, o mire run.events",
      ["nothing brings it back to the middle: within Rd/k friction holds it"] =
        "nada lo devuelve al centro: dentro de Rd/k el rozamiento lo sostiene",
      ["that is the edge of the dead zone; it rests at an extreme somewhere within"] =
        "ese es el borde de la zona muerta; se queda en un extremo, en algún lugar adentro",
      ["that is an edge of the dead zone; it rests at an extreme somewhere within"] =
        "ese es un borde de la zona muerta; se queda en un extremo, en algún lugar adentro",
      ["twice as long: from turn to turn it is half a period"] = "es el doble: de un giro al siguiente hay medio período",
      ["half as long: you have counted whole cycles as halves"] = "es la mitad: contó ciclos enteros como medios",
      ["that is the number of half swings; how long do they take?"] = "ese es el número de medios ciclos; ¿cuánto duran?",
      ["one half swing too early: at that turn it still moved on"] = "medio ciclo antes de tiempo: en ese giro todavía siguió",
      ["one half swing too late: it was at rest before"] = "medio ciclo tarde: ya estaba en reposo",
      ["that takes all damping for viscous; the dry part must go out first: take differences"] =
        "eso toma todo el amortiguamiento por viscoso; la parte seca tiene que salir antes: tome diferencias",
      ["half of it: X0, X1, X2 are half a cycle apart, so -ln(q) belongs to pi"] =
        "es la mitad: X0, X1, X2 están a medio ciclo, así que a -ln(q) le corresponde pi",
      ["that is -ln(q); divide by pi"] = "eso es -ln(q); divida por pi",
      ["zeta is positive: q is less than 1, and its logarithm negative"] = "zeta es positivo: q es menor que 1, y su logaritmo negativo",
      ["that is 2 x_f, what dry friction alone would take in half a cycle"] =
        "eso es 2 x_f, lo que el rozamiento seco solo quitaría en medio ciclo",
      ["that takes all damping for dry; use q"] = "eso toma todo el amortiguamiento por seco; use q",
      ["the sign is wrong: take the extremes without theirs"] = "el signo está mal: tome los extremos sin el suyo",
    },
  },
})
