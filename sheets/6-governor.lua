-- Sheet 6: the governor: friction in a loop, hunting.

--- The turbine of example 270 with the numbers of a student; options: Rd, Re, dither.
local function turbine(given, options)
  local governor = system{ I = 1, k = 1, C = given.C, Rd = options.Rd or 0, Re = options.Re or options.Rd or 0 }
  local dither = options.dither or 0
  return governor:simulate{
    M = function(t, theta, velocity, z) return given.gain*z.w + dither*math.sin(20*t) end,
    states = { w = { start = 0, rate = function(t, theta) return (-theta - (t < 5 and 0 or given.load))/given.J end } },
    events = { { when = function(t) return t - 5 end, name = "load step" } },
    t_end = options.t_end or 400, dt = 0.1,
  }
end

--- How far the speed swings at last, from its greatest to its least.
local function swing(run)
  local late = run.states.w[run.t:find(function(t) return t > 300 end)]
  return late:max() - late:min()
end

--- How long from one slip up to the next one, in the mean over the last ones, and how many these are.
local function hunting_period(run)
  local slips = run.events:filter(function(e) return e.kind == "slip" and e.t > 200 and e.M > e.theta end)
  if #slips < 2 then return 0, #slips end
  return (slips.t[#slips] - slips.t[1])/(#slips - 1), #slips
end

sheet(6, {
  title = "the governor: friction in a loop, hunting",

  setup = [[
local function turbine(o)
  local sleeve = system{ I = 1, k = 1, C = given.C, Rd = o.Rd or 0, Re = o.Re or o.Rd or 0 }
  local J, dither = o.J or given.J, o.dither or 0
  local function M(t, theta, velocity, z) return given.gain*z.w + dither*math.sin(20*t) end
  local function rate(t, theta) return (-theta - (t < 5 and 0 or given.load))/J end
  return sleeve:simulate{ M = M, states = { w = { start = 0, rate = rate } },
    events = { { when = function(t) return t - 5 end, name = "load step" } },
    t_end = o.t_end or 400, dt = 0.1 }
end]],

  -- The script to begin with: the tasks, and what they have in it besides the questions.
  tasks = {
    { "6.2", "No friction", "page:plot(turbine{ t_end = 60 }:plot{ show = false })" },
    { "6.3", "Stability" },
    { "6.4", "Friction" },
    { "6.5", "What makes it hunt" },
  },

  -- Where a sleeve happens to stop almost where the load wants it, the drift to the next slip takes too long to be seen,
  -- or with Re = Rd nothing moves any more: such numbers are drawn again.
  given = function(pick)
    local given
    repeat
      given = { J = pick(4, 6, 0.2), C = pick(1.1, 1.4, 0.05), gain = pick(1.6, 2.2, 0.1), load = pick(0.08, 0.14, 0.01),
                Rd = 0.02, Re = pick(0.045, 0.07, 0.005) }
      local _, slips = hunting_period(turbine(given, given))
    until slips >= 6 and swing(turbine(given, { Rd = given.Rd })) > 1e-4
    return given
  end,

  discussion = function(given)
    local hunting = turbine(given, { Rd = given.Rd, Re = given.Re })
    local stops = hunting.events:filter(function(e) return e.kind == "stick" and e.t > 200 end)
    local off = #stops > 0 and math.abs(stops.M[#stops] - stops.theta[#stops]) or 0
    local half = swing(turbine(given, { Rd = given.Rd, Re = (given.Rd + given.Re)/2 }))
    return {
      "An integral goes on until the error is 0: at rest no other speed is possible. For the same reason there is no rest with a sleeve that sticks: as long as the speed is off by anything, " ..
        "the integral grows until it breaks the sleeve loose, and that goes too far again.",
      string.format("It slides until the pull has fallen below Rd, so it stops well inside of its dead zone: %.2g from the middle, where %.2g would be an edge. The speed needs to drift from " ..
        "there to the other edge only, not from edge to edge, which is 6c.", off, given.Re),
      "With a shaking that is fast beside the motion the sleeve never rests; friction then acts a little longer against the mean motion than with it, in proportion to its velocity. On the " ..
        "average it is a damper, and nothing is left to break loose.",
      "For example: a valve positioner whose stem sticks, the drive of a telescope, the slide of a machine tool, a ship on its autopilot. Those hunt whose controller has an integral, or whose " ..
        "load does one, as the rotor here.",
      string.format("The swing of 6d becomes %.3g instead of %.3g: less, but it hunts still. A little dither does more, and costs less.", half, swing(hunting)),
    }
  end,

  questions = function(given)
    local hunting = turbine(given, { Rd = given.Rd, Re = given.Re })
    local amount, period = swing(hunting), (hunting_period(hunting))
    local even = swing(turbine(given, { Rd = given.Rd }))
    local droop = -given.load/given.gain
    local least_J = given.gain/given.C
    return {
      { name = "a", asks = "speed it settles at, no friction", unit = "speed", answer = droop, tolerance = 0.01, task = "6.2",
        how = "theta = -load, and k theta = gain w, so w = -load/gain",
        mistakes = {
          { -droop, "more load makes it slower: the sign" },
          { 0, "it would need an integral for that; look at run.states.w[#run]" },
          { -given.load, "that is where the valve settles; the speed is asked for" },
        } },
      { name = "b", asks = "least J that is stable, no friction", unit = "inertia", answer = least_J, tolerance = 0.02, task = "6.3",
        how = "J I s^3 + J C s^2 + J k s + gain = 0; Routh: J C k > I gain",
        mistakes = {
          { 1/least_J, "upside down: a heavier rotor is steadier" },
          { given.gain*given.C, "divide by C: more damping, less J" },
          { given.gain, "where is C?" },
        } },
      { name = "c", asks = "speeds between which it does nothing (whole width)", unit = "speed", answer = 2*given.Re/given.gain,
        tolerance = 0.01, task = "6.4", how = "2 Re/gain",
        mistakes = {
          { given.Re/given.gain, "that is to one side; the whole width is asked for" },
          { 2*given.Rd/given.gain, "that is with Rd: a resting sleeve is held by Re" },
          { 2*given.Re, "that is the torque; divide by the gain" },
        } },
      { name = "d", asks = "how far the speed hunts, greatest less least", unit = "speed", answer = amount, tolerance = 0.05, task = "6.4",
        how = "late:max() - late:min()",
        mistakes = {
          { amount/2, "that is the amplitude; greatest less least is asked for" },
          { even, "that is with Re = Rd" },
          { 2*given.Re/given.gain, "that is the band of 6c; a sleeve that has just jumped does not stand in the middle of its own" },
          { function(x) return x > 1.05*amount and x < 4*amount end, "more than that: the load step is in it; take the end only, t > 300" },
        } },
      { name = "e", asks = "period of the hunting", unit = "time units", answer = period, tolerance = 0.05, task = "6.4",
        how = "from a slip to the next but one",
        mistakes = {
          { period/2, "that is half of it: from a slip up to a slip down" },
          { 2*math.pi, "that is the period of the governor by itself; the hunting is much slower" },
        } },
      { name = "f", asks = "the same as 6d with Re = Rd", unit = "speed", answer = even, tolerance = 0.08, task = "6.5",
        how = "Re = Rd: what makes it hunt is Re - Rd",
        mistakes = {
          { amount, "that is with Re > Rd" },
          { even/2, "that is the amplitude; greatest less least is asked for" },
        } },
    }
  end,

  words = {
    es = {
      ["the governor: friction in a loop, hunting"] = "el regulador: rozamiento en un lazo, oscilación sostenida",
      ["No friction"] = "Sin rozamiento",
      ["Stability"] = "Estabilidad",
      ["Friction"] = "Con rozamiento",
      ["What makes it hunt"] = "Por qué no se queda quieto",
      ["more load makes it slower: the sign"] = "con más carga va más despacio: el signo",
      ["it would need an integral for that; look at run.states.w[#run]"] = "para eso haría falta una integral; mire run.states.w[#run]",
      ["that is where the valve settles; the speed is asked for"] = "ahí se queda la válvula; se pide la velocidad",
      ["upside down: a heavier rotor is steadier"] = "al revés: un rotor más pesado es más estable",
      ["divide by C: more damping, less J"] = "divida por C: más amortiguamiento, menos J",
      ["where is C?"] = "¿dónde está C?",
      ["that is to one side; the whole width is asked for"] = "eso es hacia un lado; se pide el ancho entero",
      ["that is with Rd: a resting sleeve is held by Re"] = "eso es con Rd: un manguito en reposo lo sostiene Re",
      ["that is the torque; divide by the gain"] = "ese es el momento; divida por la ganancia",
      ["that is the amplitude; greatest less least is asked for"] = "esa es la amplitud; se pide el máximo menos el mínimo",
      ["that is with Re = Rd"] = "eso es con Re = Rd",
      ["that is the band of 6c; a sleeve that has just jumped does not stand in the middle of its own"] =
        "esa es la banda de 6c; un manguito que acaba de saltar no está en el centro de la suya",
      ["more than that: the load step is in it; take the end only, t > 300"] =
        "es más que eso: incluye el salto de la carga; tome solo el final, t > 300",
      ["that is half of it: from a slip up to a slip down"] = "es la mitad: de un deslizamiento hacia arriba a uno hacia abajo",
      ["that is the period of the governor by itself; the hunting is much slower"] =
        "ese es el período del regulador solo; la oscilación sostenida es mucho más lenta",
      ["that is with Re > Rd"] = "eso es con Re > Rd",
    },
  },
})
