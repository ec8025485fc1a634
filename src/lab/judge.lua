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
  if not sheet then error("the sheets are " .. table.concat(course.numbers(), ", "), 0) end
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
  world.questions = world.questions or world.sheet.questions(world.given, world.secret)
  return world.questions
end

function course.given(number, n) return world_of(number, n).given end

function course.experiment(number, n, x)
  local world = world_of(number, n)
  if not world.sheet.experiment then error(string.format("sheet %d has no experiment: simulate its system", n), 0) end
  return world.sheet.experiment(world.given, world.secret, x)
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
local swings = { ["rad"] = true, ["time units"] = true, ["speed"] = true, ["M0/k"] = true }
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
  { function(x) return x/(2*math.pi) end, "there is a 2 pi missing in it: whole turns for radians, or radians for turns?", turns },
  { function(x) return 2*math.pi*x end, "there is a 2 pi too much in it: whole turns for radians, or radians for turns?", turns },
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
  if #made > 0 then return table.concat(made, ". Or: ") end
  for _, mistake in ipairs(question.mistakes or {}) do
    if type(mistake[1]) == "function" and mistake[1](value) then return mistake[2] end
  end
  return nil
end

local function hint_for(question, value)
  local mistakes = known_mistakes(question, value)
  if mistakes then return mistakes end
  if question.whole then
    local said = whole_hint(question, value)
    if said then return said end
  end
  for _, case in ipairs(usual) do
    local fits = not case[3] or case[3][question.unit or ""]
    if fits and near_in_proportion(value, case[1](question.answer), question) then return case[2] end
  end
  local tolerance = question.within or not question.whole and question.tolerance*math.abs(question.answer)
  if tolerance and math.abs(value - question.answer) <= 4*tolerance then
    return string.format("near, but outside the tolerance of this method (%s)", question.within and
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
  if near(value, question.answer, question) then
    return true, "right" .. (question.praise and "; " .. question.praise or "")
  end
  local task = question.task and string.format(", and not one of the usual mistakes: read task %s again", question.task)
  return false, hint_for(question, value) or "not right" .. (task or "")
end

--- The same of the question of that name of a student. The answer is never in it.
function course.judge(number, name, value)
  local question
  question, name = question_of(number, name)
  local right, said = course.verdict(question, value)
  return right, string.format("%s: %s", name, said)
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
      must(said:find(mistake[2], 1, true), "the mistake %.9g gets the hint '%s', not '%s'", mistake[1], said, mistake[2])
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
  return table.concat(lines, "\n") .. "\n"
end

function course.test_last() return course.test(course.last) end

sheet, rounded = course.sheet, course.rounded -- for the sheets
