-- The lab course: the systems of a student number, and the verdict on an answer.
-- This file and the sheets (sheets/*.lua) run in a Lua state that no script of a student can reach (src/lab/lab_course.cpp).
course = { sheets = {} }

--- Adds a sheet; sheets/template.lua explains its fields.
function course.sheet(number, sheet)
  if math.type(number) ~= "integer" or number < 1 then error("sheet(number, { ... }): the number must be a whole number from 1", 2) end
  if course.added and course.added[number] then error(string.format("sheet %d exists twice: give one of them another number", number), 2) end
  for _, field in ipairs { "given", "questions" } do
    if type(sheet[field]) ~= "function" then error(string.format("sheet %d needs %s = function(...)", number, field), 2) end
  end
  sheet.number = number
  course.sheets[number], course.last = sheet, number
  if course.added then course.added[number] = true end -- not one of the built-in sheets, which may be replaced
end

-- ---- languages

-- The sentences of this file in other languages; a sheet has those of its own in words = { es = { ... } }.
course.words = {
  es = {
    ["sheet"] = "hoja", ["right"] = "correcto", ["not right"] = "no es correcto", [". Or: "] = ". O bien: ",
    ["not right, and not one of the usual mistakes: read task %s again"] = "no es correcto, ni uno de los errores conocidos: relea la tarea %s",
    ["near, but outside the tolerance of this method (%s)"] = "cerca, pero fuera de la tolerancia de este método (%s)",
    ["%s (an earlier answer was right, and counts)"] = "%s (una respuesta anterior era correcta, y cuenta)",
    ["%s: not judged, because %d different values were wrong for number %d. Do the task again, or ask your instructor"] =
      "%s: no se juzga, porque %d valores distintos eran incorrectos para el número %d. Haga la tarea otra vez, o pregunte a su docente",
    ["the size is right, the sign is not"] = "el tamaño es correcto, el signo no",
    ["that is twice as much: a whole cycle for half of one, both sides for one, peak to peak for an amplitude?"] =
      "es el doble: ¿un ciclo entero por medio, los dos lados por uno, de pico a pico por una amplitud?",
    ["that is twice as much: where does the factor 2 come in?"] = "es el doble: ¿de dónde viene el factor 2?",
    ["that is half of it: half a cycle for a whole one, one side for both, an amplitude for peak to peak?"] =
      "es la mitad: ¿medio ciclo por uno entero, un lado por los dos, una amplitud por de pico a pico?",
    ["that is half of it: where does the factor 2 come in?"] = "es la mitad: ¿de dónde viene el factor 2?",
    ["that is in degrees; radians are asked for"] = "está en grados; se piden radianes",
    ["that is in radians; degrees are asked for"] = "está en radianes; se piden grados",
    ["a factor of 2 pi is missing: whole turns for radians, or radians for turns?"] = "falta un factor 2 pi: ¿vueltas por radianes, o radianes por vueltas?",
    ["there is a factor of 2 pi too much: whole turns for radians, or radians for turns?"] = "sobra un factor 2 pi: ¿vueltas por radianes, o radianes por vueltas?",
    ["that is its reciprocal: a frequency, where a time is asked for?"] = "es el recíproco: ¿una frecuencia, donde se pide un tiempo?",
    ["that is a hundred times too small: a fraction where percent are asked for?"] = "es cien veces demasiado chico: ¿una fracción, donde se pide por ciento?",
    ["that is a hundred times too much: percent where the plain number is asked for?"] = "es cien veces demasiado: ¿por ciento, donde se pide el número solo?",
    ["that is a thousand times too much: a prefix of the unit?"] = "es mil veces demasiado: ¿un prefijo de la unidad?",
    ["that is a thousand times too small: a prefix of the unit?"] = "es mil veces demasiado chico: ¿un prefijo de la unidad?",
    ["a whole number is asked for: count"] = "se pide un número entero: cuente",
    ["%s is yours to fill in; dinal --report %s makes the page to hand in"] = "%s es suyo para completar; dinal --report %s hace la página para entregar",
    ["dinal --report %s makes the page to hand in."] = "dinal --report %s hace la página para entregar.",
    ["your name"] = "su nombre", ["Questions"] = "Preguntas",
    ["Questions: write your answers here; an empty line begins a paragraph"] = "Preguntas: escriba aquí sus respuestas; una línea vacía comienza un párrafo",
  },
}

--- The language that was chosen with lab.number(4711, "es"), else that of the sheet.
local function language_of(sheet) return course.speaks or sheet and sheet.language or "en" end

--- The text in the language of the sheet, with its arguments.
local function say(sheet, text, ...)
  local language = language_of(sheet)
  local own, common = sheet and sheet.words and sheet.words[language], course.words[language]
  local said = own and own[text] or common and common[text] or text
  return select("#", ...) > 0 and said:format(...) or said
end

--- What the program says of a question, in the language of the student.
function course.say(n, text, ...) return say(course.sheets[n], text, ...) end

--- The languages of all sheets, in order.
function course.languages()
  local known, names = { en = true }, {}
  for language in pairs(course.words) do known[language] = true end
  for _, sheet in pairs(course.sheets) do
    known[sheet.language or "en"] = true
    for language in pairs(sheet.words or {}) do known[language] = true end
  end
  for language in pairs(known) do names[#names + 1] = language end
  table.sort(names)
  return names, known
end

--- From now on all sheets speak that language; nil: each its own.
function course.speak(language)
  local names, known = course.languages()
  if language and not known[language] then error("the languages of the sheets are " .. table.concat(names, ", "), 0) end
  course.speaks = language
end

-- ---- what belongs to a number

--- A number with at most ten digits, so that what a student sees is what he types.
function course.rounded(x, digits) return tonumber(string.format("%." .. (digits or 10) .. "g", x)) end

--- pick(from, to, step): the same for the same student number, whatever the machine (splitmix64).
local function picker(number, sheet)
  local state = number * 0x9E3779B97F4A7C15 + sheet * 0x2545F4914F6CDD1D
  return function(from, to, step)
    state = state + 0x9E3779B97F4A7C15
    local z = state
    z = (z ~ (z >> 30)) * 0xBF58476D1CE4E5B9
    z = (z ~ (z >> 27)) * 0x94D049BB133111EB
    local u = ((z ~ (z >> 31)) >> 11) * 2.0^-53
    local places = math.floor((to - from)/step + 0.5) + 1
    return course.rounded(from + step*math.floor(u*places))
  end
end

--- The numbers of the sheets, in order.
function course.numbers()
  local numbers = {}
  for number in pairs(course.sheets) do numbers[#numbers + 1] = number end
  table.sort(numbers)
  return numbers
end

local function sheet_of(n)
  local sheet = course.sheets[n]
  if not sheet then error(string.format("there is no sheet %s; the sheets are %s", n, table.concat(course.numbers(), ", ")), 0) end
  return sheet
end

--- What the draws of `pick` make of the sheet: what is given, and what is not shown.
function course.world(sheet, pick)
  local given = sheet.given(pick)
  return { sheet = sheet, given = given, secret = sheet.secret and sheet.secret(given, pick) or {} }
end

local known = {} -- "4711/1" -> what belongs to that number and sheet

local function world_of(number, n)
  local key = number .. "/" .. n
  known[key] = known[key] or course.world(sheet_of(n), picker(number, n))
  return known[key]
end

local function questions_of(world)
  if not world.questions then
    world.questions = world.sheet.questions(world.given, world.secret)
    for _, question in ipairs(world.questions) do question.sheet = world.sheet end
  end
  return world.questions
end

function course.given(number, n) return world_of(number, n).given end

function course.experiment(number, n, x)
  local world = world_of(number, n)
  if not world.sheet.experiment then error(string.format("sheet %d has no experiment: simulate its system", n), 0) end
  local good, result = pcall(world.sheet.experiment, world.given, world.secret, x)
  if not good then error(type(result) == "string" and say(world.sheet, result) or result, 0) end
  return result
end

-- ---- judging

--- Whether x is y as well as the method can tell; y may be the answer or what a mistake makes of it, some times as great.
local function near(x, y, question)
  if question.whole then return x == y end
  local within = question.within and question.within*math.max(1, math.abs(y/question.answer))
  return math.abs(x - y) <= (within or question.tolerance*math.abs(y))
end

--- The same for a part or a multiple of the answer: an absolute tolerance shrinks with it.
local function near_in_proportion(x, y, question)
  if question.whole then return x == y end
  return math.abs(x - y) <= (question.within and question.within/math.abs(question.answer) or question.tolerance)*math.abs(y)
end

-- What goes wrong everywhere: what such a mistake makes of the answer, what is said, and the units of the answers that it can
-- happen to ("" is a plain number): a torque is never in degrees.
local angles = { ["rad"] = true, ["rad per time unit"] = true }
local swings = { ["rad"] = true, ["time units"] = true, ["speed"] = true, ["Mc/k"] = true }
local turns = { ["rad"] = true, ["rad per time unit"] = true, ["time units"] = true, ["T0"] = true, [""] = true }
local plain, percent, degrees, times = { [""] = true }, { ["percent"] = true }, { ["degrees"] = true }, { ["time units"] = true }
local usual = {
  { function(x) return -x end, "the size is right, the sign is not" },
  { function(x) return 2*x end,
    "that is twice as much: a whole cycle for half of one, both sides for one, peak to peak for an amplitude?", swings },
  { function(x) return 2*x end, "that is twice as much: where does the factor 2 come in?" },
  { function(x) return x/2 end, "that is half of it: half a cycle for a whole one, one side for both, an amplitude for peak to peak?", swings },
  { function(x) return x/2 end, "that is half of it: where does the factor 2 come in?" },
  { math.deg, "that is in degrees; radians are asked for", angles },
  { math.rad, "that is in radians; degrees are asked for", degrees },
  { function(x) return x/(2*math.pi) end, "a factor of 2 pi is missing: whole turns for radians, or radians for turns?", turns },
  { function(x) return 2*math.pi*x end, "there is a factor of 2 pi too much: whole turns for radians, or radians for turns?", turns },
  { function(x) return 1/x end, "that is its reciprocal: a frequency, where a time is asked for?", times },
  { function(x) return x/100 end, "that is a hundred times too small: a fraction where percent are asked for?", percent },
  { function(x) return 100*x end, "that is a hundred times too much: percent where the plain number is asked for?", plain },
  { function(x) return 1000*x end, "that is a thousand times too much: a prefix of the unit?" },
  { function(x) return x/1000 end, "that is a thousand times too small: a prefix of the unit?" },
}

local function whole_hint(question, value)
  if value ~= math.floor(value) then return "a whole number is asked for: count" end
  if value == -question.answer then return usual[1][2] end
  return nil
end

--- What is said about the known mistakes that make this value of the answer, the likeliest first: what two of them may
--- have made is told of both.
local function known_mistakes(question, value)
  local made = {}
  for _, mistake in ipairs(question.mistakes or {}) do
    local wrong, said = mistake[1], mistake[2]
    if type(wrong) == "number" and near(value, wrong, question) and not made[said] then
      made[said] = math.abs(value - wrong)
      made[#made + 1] = said
    end
  end
  table.sort(made, function(a, b) return made[a] < made[b] end)
  if #made > 0 then
    for i, said in ipairs(made) do made[i] = say(question.sheet, said) end
    return table.concat(made, say(question.sheet, ". Or: "))
  end
  for _, mistake in ipairs(question.mistakes or {}) do
    if type(mistake[1]) == "function" and mistake[1](value) then return say(question.sheet, mistake[2]) end
  end
  return nil
end

local function hint_for(question, value)
  local mistakes = known_mistakes(question, value)
  if mistakes then return mistakes end
  if question.whole then
    local said = whole_hint(question, value)
    if said then return say(question.sheet, said) end
  end
  for _, case in ipairs(usual) do
    local fits = not case[3] or case[3][question.unit or ""]
    if fits and near_in_proportion(value, case[1](question.answer), question) then return say(question.sheet, case[2]) end
  end
  local tolerance = question.within or not question.whole and question.tolerance*math.abs(question.answer)
  if tolerance and math.abs(value - question.answer) <= 4*tolerance then
    return say(question.sheet, "near, but outside the tolerance of this method (%s)", question.within and
      string.format("%.2g", question.within) or string.format("%.2g %%", 100*question.tolerance))
  end
  return nil
end

local function names_of(n, world)
  local names = {}
  for _, question in ipairs(questions_of(world)) do names[#names + 1] = n .. question.name end
  return names
end

local function unknown(name, number)
  local n = tonumber(name:match("^%a?(%d+)"))
  if n and course.sheets[n] then
    local names = names_of(n, world_of(number, n))
    local letter = name:match("^(%a)%d+$")
    local meant = letter and table.concat(names, " "):find(n .. letter, 1, true)
    local ending = meant and string.format("; did you mean '%d%s'?", n, letter) or
                   string.format("; sheet %d asks %s to %s", n, names[1], names[#names])
    error(string.format("there is no question '%s'%s", name, ending), 0)
  end
  error(string.format("there is no question '%s'; a name is the number of a sheet and a letter, such as '1a'", name), 0)
end

--- The question of that name, "1a"; "0" is for trying check out.
local function question_of(number, name)
  name = name:lower():gsub("%s+", "")
  if name == "0" then return { name = "", asks = "six times seven", answer = 42, tolerance = 1e-9 }, "0" end
  local n, letter = name:match("^(%d+)(%a)$")
  n = tonumber(n)
  for _, question in ipairs(n and course.sheets[n] and questions_of(world_of(number, n)) or {}) do
    if question.name == letter then return question, name end
  end
  unknown(name, number)
end

--- Only its name, as it is kept: raises when there is none.
function course.name(number, name) return (select(2, question_of(number, name))) end

--- Whether the value is right, and what is said about it.
function course.verdict(question, value)
  local sheet = question.sheet
  if near(value, question.answer, question) then
    return true, say(sheet, "right") .. (question.praise and "; " .. say(sheet, question.praise) or "")
  end
  local task = question.task
  return false, hint_for(question, value) or
    (task and say(sheet, "not right, and not one of the usual mistakes: read task %s again", task) or say(sheet, "not right"))
end

--- The same of the question of that name of a student. The answer is never in it.
function course.judge(number, name, value)
  local question
  question, name = question_of(number, name)
  local right, said = course.verdict(question, value)
  return right, string.format("%s: %s", name, said)
end

-- ---- the script to begin with

--- The sheet and language of a name: "3" is sheet 3 in its own language, "hoja-3" the Spanish one.
local function named_sheet(name)
  local word, digits = name:match("^(%a*)[-_ ]?(%d+)$")
  local sheet = sheet_of(tonumber(digits) or name)
  if word == "" then return sheet, sheet.language end
  for _, language in ipairs((course.languages())) do
    local own, common = sheet.words and sheet.words[language] or {}, course.words[language] or {}
    if word:lower() == (own.sheet or common.sheet or "sheet") then return sheet, language end
  end
  error(string.format("'%s' is no name of a sheet; for example %d, or hoja-%d in Spanish", name, sheet.number, sheet.number), 0)
end

--- The name of the file, the script to begin with, and what is said about it.
function course.start(name, number)
  local sheet, language = named_sheet(name)
  course.speaks = language
  local lines = {}
  local function add(line, ...) lines[#lines + 1] = say(sheet, line, ...) end
  local function add_code(code) lines[#lines + 1] = code and code:gsub("%-%- (%C+)", function(words) return "-- " .. say(sheet, words) end) end
  local file = string.format("%d-%d.lua", sheet.number, number)
  add(string.format("-- %d: %s", sheet.number, say(sheet, sheet.title)))
  add("-- " .. say(sheet, "dinal --report %s makes the page to hand in.", file))
  add(language and language ~= "en" and string.format("lab.number(%d, %q)", number, language) or string.format("lab.number(%d)", number))
  add(string.format("local page = report{ title = %q, author = %q }", say(sheet, sheet.title), say(sheet, "your name")))
  add(string.format("\nlocal given = lab.given(%d)", sheet.number))
  add_code(sheet.setup)
  local questions, placed = questions_of(world_of(number, sheet.number)), {}
  local function add_checks(task)
    for _, question in ipairs(questions) do
      if not placed[question] and (task == nil or question.task == task) then
        placed[question] = true
        lines[#lines + 1] = string.format('-- check("%d%s", )', sheet.number, question.name)
      end
    end
  end
  for _, task in ipairs(sheet.tasks or {}) do
    lines[#lines + 1] = string.format("\n-- %s %s", task[1], say(sheet, task[2]))
    add_code(task[3])
    add_checks(task[1])
  end
  add_checks()
  local world = world_of(number, sheet.number)
  local open = sheet.discussion and #sheet.discussion(world.given, world.secret) or 0
  if open > 0 then
    lines[#lines + 1] = "\n-- " .. say(sheet, "Questions: write your answers here; an empty line begins a paragraph")
    lines[#lines + 1] = string.format("page:heading %q\npage:text [[", say(sheet, "Questions"))
    for i = 1, open do lines[#lines + 1] = i .. "." .. (i < open and "\n" or "") end
    lines[#lines + 1] = "]]"
  end
  lines[#lines + 1] = 'page:save "answers.html"\nprint(lab.marks())\n'
  return file, table.concat(lines, "\n"), say(sheet, "%s is yours to fill in; dinal --report %s makes the page to hand in", file, file)
end

-- ---- for the instructor

local function tolerance_text(question)
  if question.whole then return "exactly" end
  return question.within and string.format("+- %.2g", question.within) or string.format("+- %.2g %%", 100*question.tolerance)
end

--- The words in lines of at most 100 characters, the first of which begins with `head`.
local function wrapped(head, words)
  local lines, line = {}, head
  for word in words:gmatch("%S+") do
    if #line + #word >= 100 then
      lines[#lines + 1] = line
      line = (" "):rep(#head - 1)
    end
    line = line .. " " .. word
  end
  lines[#lines + 1] = line
  return table.concat(lines, "\n")
end

--- All answers of a number, as text.
function course.solutions(number)
  local lines = { string.format("The lab of number %d", number) }
  for _, n in ipairs(course.numbers()) do
    local world = world_of(number, n)
    lines[#lines + 1] = string.format("\nSheet %d: %s", n, world.sheet.title)
    for _, question in ipairs(questions_of(world)) do
      local answer = string.format(question.whole and "%.0f" or "%.7g", question.answer)
      lines[#lines + 1] = string.format("  %d%s  %-52s %12s %-12s %s", n, question.name, question.asks, answer,
        question.unit or "", tolerance_text(question))
      lines[#lines + 1] = "      " .. question.how
    end
    local discussion = world.sheet.discussion and world.sheet.discussion(world.given, world.secret) or {}
    if #discussion > 0 then lines[#lines + 1] = "  The questions at the end:" end
    for i, words in ipairs(discussion) do
      lines[#lines + 1] = wrapped(string.format("  %d.", i), words)
    end
  end
  return table.concat(lines, "\n") .. "\n"
end

--- The names of all questions: { "1a", "1b", ... }.
function course.question_names()
  local names = {}
  for _, n in ipairs(course.numbers()) do
    for _, question in ipairs(questions_of(world_of(1, n))) do names[#names + 1] = n .. question.name end
  end
  return table.concat(names, " ")
end

-- ---- testing a sheet

--- Raises unless the question is complete, its answer is right, and each known mistake is wrong and named.
local function test_question(question, where)
  local function must(good, ...) if not good then error(where .. ": " .. string.format(...), 0) end end
  must(type(question.name) == "string" and question.name:match "^%l$", "its name must be one small letter")
  must(type(question.asks) == "string", "needs asks = \"what is asked for\"")
  must(type(question.how) == "string", "needs how = \"the way to the answer\", for --lab-solutions")
  must(type(question.answer) == "number" and math.abs(question.answer) < math.huge, "its answer must be a finite number, got %s", question.answer)
  must(question.whole or question.within or question.tolerance, "needs tolerance = (relative), within = (absolute) or whole = true")
  must(question.whole or question.within or question.answer ~= 0, "its answer is 0, so it needs within = (absolute), not a relative tolerance")
  must(course.verdict(question, question.answer), "its own answer %.9g is not right", question.answer)
  for _, mistake in ipairs(question.mistakes or {}) do
    if type(mistake[1]) == "number" then
      local right, said = course.verdict(question, mistake[1])
      must(not right, "the mistake %.9g ('%s') is within the tolerance of the answer %.9g", mistake[1], mistake[2], question.answer)
      must(said:find(say(question.sheet, mistake[2]), 1, true), "the mistake %.9g gets the hint '%s', not '%s'", mistake[1], said, mistake[2])
    end
  end
end

local function shown(value)
  if type(value) ~= "table" then return type(value) == "string" and string.format("%q", value) or tostring(value) end
  local parts = {}
  for name, part in pairs(value) do parts[#parts + 1] = name .. " = " .. shown(part) end
  table.sort(parts)
  return "{ " .. table.concat(parts, ", ") .. " }"
end

--- Raises unless each language that the sheet has words of has all of its hints.
local function test_words(sheet, question, where)
  for language, words in pairs(sheet.words or {}) do
    local hints = { question.praise }
    for _, mistake in ipairs(question.mistakes or {}) do hints[#hints + 1] = mistake[2] end
    for _, hint in ipairs(language ~= sheet.language and hints or {}) do
      if not words[hint] then error(string.format("%s: words.%s lacks the hint '%s'", where, language, hint), 0) end
    end
  end
end

--- The sentences of this file that the sheet has no words for in its own language, a line each.
local function untranslated(sheet)
  local language, missing = sheet.language or "en", {}
  if language == "en" or course.words[language] then return "" end
  local own = sheet.words and sheet.words[language] or {}
  for sentence in pairs(course.words.es) do
    if not own[sentence] then missing[#missing + 1] = string.format("\n    %q", sentence) end
  end
  table.sort(missing)
  return #missing == 0 and "" or string.format("\nwords.%s has no translation of these sentences, which all sheets share:%s", language, table.concat(missing))
end

--- Works the sheet with student numbers 1 to 20 and returns what the first of them sees.
function course.test(n)
  for number = 1, 20 do
    local world = world_of(number, n)
    if world.sheet.experiment then course.experiment(number, n, world.sheet.try_with) end
    if world.sheet.discussion then world.sheet.discussion(world.given, world.secret) end
    local names = {}
    for i, question in ipairs(questions_of(world)) do
      local where = string.format("sheet %d, student number %d, question %s", n, number, question.name or "number " .. i)
      test_question(question, where)
      test_words(world.sheet, question, where)
      if names[question.name] then error(where .. ": the name is used twice", 0) end
      names[question.name] = true
    end
  end
  local world = world_of(1, n)
  local lines = { string.format("Sheet %d: %s, as student number 1 sees it", n, world.sheet.title or "without a title"),
    string.format("lab.given(%d) --> %s", n, shown(world.given)) }
  for _, question in ipairs(questions_of(world)) do
    lines[#lines + 1] = string.format('check("%d%s", ...)  %s%s; task %s', n, question.name, question.asks,
      question.unit and ", in " .. question.unit or "", question.task or "not given")
    for _, mistake in ipairs(question.mistakes or {}) do
      if type(mistake[1]) == "number" then lines[#lines + 1] = string.format("    %-12.6g %s", mistake[1], mistake[2]) end
    end
  end
  lines[#lines + 1] = "All answers are right for student numbers 1 to 20, and no known mistake is."
  return table.concat(lines, "\n") .. untranslated(world.sheet) .. "\n"
end

function course.test_last() return course.test(course.last) end

sheet, rounded = course.sheet, course.rounded -- for the sheets
