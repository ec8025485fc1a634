-- Sheet 4: which number can you believe: schemes, steps, and the bug of 1989.

--- One step of the free motion, as the report's chapter 6 may have made it. slip: nil, 3 or 4.
local function step_of_1989(u, v, h, zeta, slip)
  local function rate(x, y) return -4*math.pi^2*x - 4*math.pi*zeta*y end
  local q11, q21 = h*v, h*rate(u, v) -- Q1 of the angle, Q2 of the velocity, as the listing numbers them
  local q12, q22 = h*(v + q21/2), h*rate(u + q11/2, v + q21/2)
  local y3 = v + (slip == 3 and q21 or q22)/2
  local q13, q23 = h*y3, h*rate(u + q12/2, y3)
  local x4 = u + (slip == 4 and q11 or q13)
  local q14, q24 = h*(v + q23), h*rate(x4, v + q23)
  return u + (q11 + 2*q12 + 2*q13 + q14)/6, v + (q21 + 2*q22 + 2*q23 + q24)/6
end

--- What the amplitude is multiplied by in a step: the root of the determinant, while the motion swings.
local function factor(h, zeta, slip)
  local a, b = step_of_1989(1, 0, h, zeta, slip)
  local c, d = step_of_1989(0, 1, h, zeta, slip)
  local trace, determinant = a + d, a*d - b*c
  local inner = trace^2/4 - determinant
  return inner <= 0 and math.sqrt(determinant) or math.abs(trace/2) + math.sqrt(inner)
end

--- The step from which on the scheme diverges.
local function limit(zeta, slip)
  local low, high = 0.01, 1
  while factor(high, zeta, slip) < 1 do high = high*2 end
  for h = 0.01, 1, 0.001 do
    if factor(h, zeta, slip) > 1 then
      high = h
      break
    end
    low = h
  end
  for _ = 1, 50 do
    local middle = (low + high)/2
    if factor(middle, zeta, slip) > 1 then high = middle else low = middle end
  end
  return high
end

sheet(4, {
  title = "which number can you believe",

  -- The script to begin with: the tasks, and what they have in it besides the questions.
  tasks = {
    { "4.2", "Half a swing" },
    { "4.3", "Two suspects. The scheme as it is printed; build the slips in where slip is 3 or 4", [[
local function step(u, v, h, zeta, slip)
  local function f(x, y) return -4*math.pi^2*x - 4*math.pi*zeta*y end
  local Q11, Q21 = h*v, h*f(u, v)
  local Q12, Q22 = h*(v + Q21/2), h*f(u + Q11/2, v + Q21/2)
  local Q13, Q23 = h*(v + Q22/2), h*f(u + Q12/2, v + Q22/2)
  local Q14, Q24 = h*(v + Q23), h*f(u + Q13, v + Q23)
  return u + (Q11 + 2*Q12 + 2*Q13 + Q14)/6, v + (Q21 + 2*Q22 + 2*Q23 + Q24)/6
end

local function factor(h, zeta, slip)
  local a, b = step(1, 0, h, zeta, slip)
  local c, d = step(0, 1, h, zeta, slip)
  return math.sqrt(a*d - b*c)
end

local u, v = 1, 0
for _ = 1, 5 do u, v = step(u, v, 0.1, 0) end
page:add("theta(T0/2)", u)
page:add("factor", factor(0.1, 0))]] },
    { "4.4", "When does it diverge?" },
    { "4.5", "Where does it stop?" },
    { "4.6", "6.28" },
  },

  given = function(pick)
    return { theta0 = pick(0.5, 1.5, 0.05), h = ({ 0.125, 0.0625, 0.05 })[pick(1, 3, 1)], zeta = pick(0.02, 0.03, 0.0005),
             friction_ratio = pick(0.13, 0.19, 0.002), periods = pick(40, 90, 1) }
  end,

  discussion = function()
    return {
      "A true observation of the program that was run, not of the scheme: with either slip a step multiplies by more than 1 when there is no damping. The scheme as it is printed " ..
        "multiplies by about 1 - (2 pi h)^6/144, less than 1 up to h = 0.45 T0. What was concluded about the method was true of a misprint in the program.",
      "Without damping both slips give the same angles (only the velocities differ, by a factor), and all numbers that the report gives to many digits are without damping; its damped figures are pictures. The source of " ..
        "that day, or one damped number to five digits (0.98720 or 0.98769 for zeta = 0.02387, h = 0.1), would decide it.",
      "He knows that the smooth part of the error is small, if the step is small enough for the order to show at all. He does not know the error of the stops: it goes with h itself, may jump " ..
        "when a stop comes one step earlier, and may be small by chance for both steps. Nor does he know that the program does what he means: a wrong program converges, too.",
      "For example: a free motion without damping keeps its amplitude (a factor of 1 but for h^6). Half a period from theta0 ends at -theta0. Half the step makes the error 16 times " ..
        "smaller, with a load that depends on the time. The energy balance closes. The motion run backwards comes home.",
      "There is no right answer, but an honest one names the check that was not made.",
    }
  end,

  questions = function(given)
    local h, zeta, n = given.h, given.zeta, given.periods
    local free = nondimensional{}
    local function half(how)
      local run = free:simulate{ theta0 = given.theta0, t_end = 0.5, dt = 0.5, integrator = how }
      return run.theta[2]
    end
    local listing, slipped = half(integrator.dinal1989{ h = h }), half(integrator.dinal1989{ h = h, slip = true })
    local dry = nondimensional{ friction_ratio = given.friction_ratio }
    local function rest(how)
      local run = dry:simulate{ theta0 = 0, velocity0 = 2*math.pi, t_end = 5, dt = 5, integrator = how }
      return run.theta[2]
    end
    local true_rest = rest()
    local error = rest(integrator.dinal1989{ h = 0.01 }) - true_rest
    local behind = math.deg(n*(2*math.pi - 6.28))
    return {
      { name = "a", asks = "theta after half a swing, the listing", answer = listing, tolerance = 4e-6, task = "4.2",
        how = "integrator.dinal1989{ h = given.h }",
        mistakes = {
          { -given.theta0, "that is the truth; what does the listing get with your h?" },
          { slipped, "that is with the slip, which 4b asks for" },
          { function(x) return math.abs(x - listing) < 1e-4*math.abs(listing) end, "give it with six digits" },
        } },
      { name = "b", asks = "the same with the slip", answer = slipped, tolerance = 4e-6, task = "4.2",
        how = "slip = true; your own scheme with either slip gives the same",
        mistakes = {
          { listing, "that is the listing as it is printed: four stages, no slip" },
          { -given.theta0, "that is the truth" },
          { function(x) return math.abs(x - slipped) < 1e-4*math.abs(slipped) end, "give it with six digits" },
        } },
      { name = "c", asks = "factor a step with zeta, slip in stage 3", answer = factor(h, zeta, 3), within = 2e-6, task = "4.3",
        how = "the root of the determinant of the step",
        mistakes = {
          { factor(h, zeta, 4), "that is the slip in stage 4" },
          { factor(h, zeta), "that is the scheme as it is printed, without a slip" },
          { math.exp(-2*math.pi*zeta*h), "that is the truth, e^(-2 pi zeta h)" },
          { factor(h, 0, 3), "that is without damping" },
          { factor(h, zeta, 3)^2, "that is the determinant; a factor is its root" },
          { function(x) return math.abs(x - factor(h, zeta, 3)) < 5e-6 end, "give it with six decimals" },
        } },
      { name = "d", asks = "factor a step with zeta, slip in stage 4", answer = factor(h, zeta, 4), within = 2e-6, task = "4.3",
        how = "the same with U + Q11 in stage 4",
        praise = "without damping the two slips cannot be told apart, with damping they can",
        mistakes = {
          { factor(h, zeta, 3), "that is the slip in stage 3" },
          { factor(h, zeta), "that is the scheme as it is printed, without a slip" },
          { math.exp(-2*math.pi*zeta*h), "that is the truth, e^(-2 pi zeta h)" },
          { factor(h, 0, 4), "that is without damping" },
          { factor(h, zeta, 4)^2, "that is the determinant; a factor is its root" },
          { function(x) return math.abs(x - factor(h, zeta, 4)) < 5e-6 end, "give it with six decimals" },
        } },
      { name = "e", asks = "step from which the slip in stage 3 diverges", unit = "T0", answer = limit(zeta, 3), tolerance = 0.005,
        task = "4.4", how = "where the factor of 4c passes 1",
        mistakes = {
          { limit(zeta), "that is where the scheme as it is printed diverges" },
          { limit(zeta, 4), "that is the slip in stage 4" },
          { zeta, "that is the bound of the report, h < zeta: it is not even nearly true" },
          { zeta/math.pi, "that is the bound of Euler's scheme" },
        } },
      { name = "f", asks = "where it rests, truly", answer = true_rest, tolerance = 1e-4, task = "4.5",
        how = "the default integrator, or theory.rest_position",
        mistakes = {
          { true_rest + error, "that is what the listing gets with h = 0.01" },
          { -true_rest, "the distance is right, the side is not" },
        } },
      { name = "g", asks = "error of the listing there, h = 0.01", answer = error, within = math.abs(error)*0.01 + 1e-6, task = "4.5",
        how = "what dinal1989{ h = 0.01 } gets, less the truth",
        mistakes = {
          { -error, "the size is right; an error is what was got less what is true" },
          { true_rest + error, "that is where it rests; its error is asked for" },
          { error/true_rest, "that is the relative error" },
          { 100*error/true_rest, "that is in percent of the truth" },
        } },
      { name = "h", asks = "how far sin(6.28 t) is behind after n periods", unit = "degrees", answer = behind, tolerance = 0.01,
        task = "4.6", how = "n (2 pi - 6.28), in degrees",
        mistakes = {
          { math.rad(behind), "that is in radians; degrees are asked for" },
          { behind/360, "that is in periods; degrees are asked for" },
          { behind/n, "that is in each period" },
          { -behind, "6.28 is less than 2 pi: it comes later; behind is positive" },
        } },
    }
  end,

  words = {
    es = {
      ["which number can you believe"] = "en qué número se puede creer",
      ["Half a swing"] = "Media oscilación",
      ["Two suspects. The scheme as it is printed; build the slips in where slip is 3 or 4"] =
        "Dos sospechosos. El esquema como está impreso; ponga los errores donde slip es 3 o 4",
      ["When does it diverge?"] = "¿Cuándo diverge?",
      ["Where does it stop?"] = "¿Dónde se detiene?",
      ["that is the truth; what does the listing get with your h?"] = "esa es la verdad; ¿qué da el listado con su h?",
      ["that is with the slip, which 4b asks for"] = "eso es con el error, que se pide en 4b",
      ["give it with six digits"] = "délo con seis cifras",
      ["that is the listing as it is printed: four stages, no slip"] = "ese es el listado como está impreso: cuatro etapas, sin error",
      ["that is the truth"] = "esa es la verdad",
      ["that is the slip in stage 4"] = "ese es el error en la etapa 4",
      ["that is the slip in stage 3"] = "ese es el error en la etapa 3",
      ["that is the scheme as it is printed, without a slip"] = "ese es el esquema como está impreso, sin error",
      ["that is the truth, e^(-2 pi zeta h)"] = "esa es la verdad, e^(-2 pi zeta h)",
      ["that is without damping"] = "eso es sin amortiguamiento",
      ["that is the determinant; a factor is its root"] = "ese es el determinante; el factor es su raíz",
      ["give it with six decimals"] = "délo con seis decimales",
      ["without damping the two slips cannot be told apart, with damping they can"] =
        "sin amortiguamiento los dos errores no se distinguen, con amortiguamiento sí",
      ["that is where the scheme as it is printed diverges"] = "ahí diverge el esquema como está impreso",
      ["that is the bound of the report, h < zeta: it is not even nearly true"] =
        "ese es el límite del informe, h < zeta: no es cierto ni de cerca",
      ["that is the bound of Euler's scheme"] = "ese es el límite del esquema de Euler",
      ["that is what the listing gets with h = 0.01"] = "eso da el listado con h = 0.01",
      ["the distance is right, the side is not"] = "la distancia es correcta, el lado no",
      ["the size is right; an error is what was got less what is true"] =
        "el tamaño es correcto; un error es lo obtenido menos lo verdadero",
      ["that is where it rests; its error is asked for"] = "ahí se queda; se pide el error",
      ["that is the relative error"] = "ese es el error relativo",
      ["that is in percent of the truth"] = "eso es en por ciento de la verdad",
      ["that is in radians; degrees are asked for"] = "está en radianes; se piden grados",
      ["that is in periods; degrees are asked for"] = "eso es en períodos; se piden grados",
      ["that is in each period"] = "eso es en cada período",
      ["6.28 is less than 2 pi: it comes later; behind is positive"] = "6.28 es menor que 2 pi: viene después; el atraso es positivo",
    },
  },
})
