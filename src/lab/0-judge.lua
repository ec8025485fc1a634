-- The lab course: what belongs to a student number, and what is said about an answer.
-- The files of this folder are put together in the order of their names and run in a Lua state that no script of a
-- student can reach (src/api/lab_course.cpp). So all here may speak plainly. Each further file is a sheet.
course = { sheets = {} }

--- A sheet: title, given(pick), secret(given, pick), experiment(given, secret, x) and questions(given, secret), a list of
--- { name, asks, answer =, unit =, tolerance = (relative) | within = (absolute) | whole = true, task =, how =,
---   mistakes = { { wrong value or function(value), what is said }, ... } }; and, for the instructor alone,
--- discussion(given, secret): what a good page says to each of the questions at the end of the handout.
function course.sheet(number, sheet)
  sheet.number = number
  course.sheets[number] = sheet
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

local function sheet_of(n)
  local sheet = course.sheets[n]
  if not sheet then error(string.format("there are sheets 1 to %d", #course.sheets), 0) end
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
  if not world.sheet.experiment then error(string.format("sheet %d has no experiment: simulate what it asks for", n), 0) end
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
    return string.format("near, but further off than this method need be (%s)", question.within and
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
  error(string.format("there is no question '%s'; they are named after their sheet, '1a' to '%da' and on", name,
                      #course.sheets), 0)
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
  local task = question.task and string.format(", and no mistake that is known here; look at task %s again", question.task)
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
  for n = 1, #course.sheets do
    local world = world_of(number, n)
    lines[#lines + 1] = string.format("\nSheet %d: %s", n, world.sheet.title)
    for _, question in ipairs(questions_of(world)) do
      local answer = string.format(question.whole and "%.0f" or "%.7g", question.answer)
      lines[#lines + 1] = string.format("  %d%s  %-52s %12s %-12s %s", n, question.name, question.asks, answer,
        question.unit or "", tolerance_text(question))
      lines[#lines + 1] = "      " .. question.how
    end
    lines[#lines + 1] = "  The questions at the end:"
    for i, words in ipairs(world.sheet.discussion(world.given, world.secret)) do
      lines[#lines + 1] = wrapped(string.format("  %d.", i), words)
    end
  end
  return table.concat(lines, "\n") .. "\n"
end

local sheet, rounded = course.sheet, course.rounded -- for the sheets
