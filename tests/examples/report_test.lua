-- docs/report.md against the scripts of examples/report: each number in the text is computed again, and each picture.
--
--     dinal report_test.lua PROGRAM EXAMPLES
--
-- In a section on a figure the numbers of the text, read from the top, must be those that the script of the figure lists
-- (figure:quote), rounded to the digits given. What is no number of this kind: code, formulas such as 2pi or 1/2, the
-- numbers of figures, chapters and years. Sections on no figure may only repeat numbers of those that are.

local program, examples = arg[1], arg[2]
local drawn_lines = dofile(debug.getinfo(1, "S").source:match("^@(.*/)") .. "drawn_lines.lua")
local failed = 0

local function complain(...)
  failed = failed + 1
  print(string.format(...))
end
local function read(name)
  local file <close> = assert(io.open(name, "rb"))
  return file:read("a")
end
local function quoted(text) return "'" .. text:gsub("'", "'\\''") .. "'" end
local function new_folder()
  local name = os.tmpname()
  os.remove(name)
  assert(os.execute("mkdir " .. quoted(name)))
  return name
end

-- Text without what is no number of its own; powers of ten as Lua writes them.
local raised = { ["⁰"] = "0", ["¹"] = "1", ["²"] = "2", ["³"] = "3", ["⁴"] = "4", ["⁵"] = "5", ["⁶"] = "6",
  ["⁷"] = "7", ["⁸"] = "8", ["⁹"] = "9", ["⁻"] = "-" }
local function prose(text)
  text = text:gsub("```.-```", ""):gsub("`[^`]*`", ""):gsub("!%b[]%b()", ""):gsub("(%b[])%b()", "%1")
  text = text:gsub(utf8.charpattern, function(letter) return raised[letter] and "^" .. raised[letter] end)
  text = text:gsub("·10(%^[%d^-]*)", function(power) return "e" .. power:gsub("%^", "") end)
  text = text:gsub("−", "-"):gsub("°", " ")
  for _, word in ipairs{ "[Ff]igures?", "[Cc]hapter", "[Ss]tage" } do
    text = text:gsub("(" .. word .. ")%s+%d+%a?", "%1")
    for _ = 1, 5 do -- figures 4, 22 and 26; 10 to 13
      for _, joint in ipairs{ "%s*,%s*", "%s+and%s+", "%s+to%s+" } do
        text = text:gsub("(" .. word .. ")" .. joint .. "%d+%a?%f[^%w.]", "%1")
      end
    end
  end
  return text
end

-- The numbers of a text, as they are written: { value, unit of the last digit }.
local function numbers_of(text)
  text = prose(text)
  local list = {}
  for before, sign, number, after in text:gmatch "()(-?)%f[%w.](%d+%.?%d*e?-?%d*)()" do
    local left, right = text:sub(before - 1, before - 1), text:sub(after, after)
    number = number:gsub("%.$", "")
    local part_of_a_formula = left:find "[%w/\128-\255^]" or right:find "[%a/\128-\255^]"
    local year = #number == 4 and number:find "^[12][09]%d%d$"
    if not part_of_a_formula and not year then
      local decimals = #(number:match "%.(%d*)" or "")
      local exponent = tonumber(number:match "e(.*)" or 0)
      list[#list + 1] = { value = tonumber(sign .. number), unit = 10.0 ^ (exponent - decimals), text = sign .. number }
    end
  end
  return list
end

-- The sections of the chapter, each with the names of its figures ("03bis").
local function sections_of(chapter)
  local list = {}
  local parted = ("\n" .. chapter):gsub("\n##* ", "\0%0")
  for heading, body in parted:gmatch "\0\n#+ ([^\n]*)\n([^\0]*)" do
    local names = {}
    local first, last = heading:match "^Figures (%d+) to (%d+)"
    if first then
      for n = first, last do names[#names + 1] = ("%02d"):format(n) end
    elseif heading:find "^Figure " then
      local number, letter = heading:match "^Figure (%d+) ?(%a*)"
      names[1] = ("%02d%s"):format(number, letter)
    end
    list[#list + 1] = { heading = heading, body = body, figures = names }
  end
  return list
end

-- The sentences of complaint about a chapter. quotes: name of a figure -> its numbers.
local function complaints_about(chapter, quotes)
  local list, known, told = {}, {}, {}
  local function say(...) list[#list + 1] = string.format(...) end
  local sections = sections_of(chapter)
  for _, section in ipairs(sections) do
    if #section.figures > 0 then
      local expected = {}
      for _, name in ipairs(section.figures) do
        told[name] = true
        if not section.body:find("](report/fig" .. name .. ".svg)", 1, true) then
          say("%s: fig%s.svg is not shown", section.heading, name)
        end
        table.move(quotes[name] or {}, 1, #(quotes[name] or {}), #expected + 1, expected)
      end
      local found = numbers_of(section.body)
      for i = 1, math.max(#found, #expected) do
        local number, value = found[i], expected[i]
        if not number or not value then
          say("%s: %d numbers in the text, %d computed", section.heading, #found, #expected)
          break
        elseif not (math.abs(number.value - value) <= 0.5001 * number.unit) then
          say("%s: number %d is %s in the text, %.10g computed", section.heading, i, number.text, value)
          break -- all that follow may be shifted
        end
        known[number.text] = true
      end
    end
  end
  for _, section in ipairs(sections) do
    for _, number in ipairs(#section.figures == 0 and section.heading ~= "Errata" and numbers_of(section.body) or {}) do
      if not known[number.text] then say("%s: %s is in no section on a figure", section.heading, number.text) end
    end
  end
  for name in pairs(quotes) do
    if not told[name] then say("figure %s is not in the chapter", name) end
  end
  return list
end

local folder = new_folder()
local figures = assert(loadfile(examples .. "/report/all.lua"))(folder)
local quotes = {}
for _, figure in ipairs(figures) do quotes[figure.name] = figure.quoted end
assert(#figures == 28, "figures 3, 3 bis, 4, 5a, 5b, 6 to 24, 24 bis and 25 to 27")

local chapter = read(examples .. "/../docs/report.md")
for _, sentence in ipairs(complaints_about(chapter, quotes)) do complain("docs/report.md: %s", sentence) end

-- The check itself: a changed, a missing and an added number are found.
for from, to in pairs{ ["at 0.155151 from"] = "at 0.155152 from", ["0.012 from the edge"] = "from the edge",
  ["are 0.846849, "] = "are 0.846849, 0.5, ", ["| 2.09205 | 2.69 |"] = "| 2.09206 | 2.69 |" } do
  local changed, count = chapter:gsub(from:gsub("%p", "%%%0"), (to:gsub("%%", "%%%%")))
  assert(count == 1, from .. " is not in the text any more: choose another one")
  if #complaints_about(changed, quotes) == 0 then complain("%q for %q was not noticed", to, from) end
end

for _, figure in ipairs(figures) do
  local shown = examples .. "/../docs/report/fig" .. figure.name .. ".svg"
  local now, kept = drawn_lines.read(read(figure.file)), drawn_lines.read(read(shown))
  local difference = drawn_lines.difference(now, kept)
  if difference then
    complain("docs/report/fig%s.svg is not what its script draws now: %s\n  make it again with examples/report/all.lua, "
      .. "and look at it", figure.name, difference)
  end
  assert(#now.words > 5 and next(now.ink), "nothing found in " .. figure.file)
  -- These draw dry friction beside the angle, and no excitation.
  local words = table.concat(now.words, " ")
  if figure.name == "22" or figure.name == "26" then
    if not words:find("friction*", 1, true) or words:find("M*", 1, true) then
      complain("docs/report/fig%s.svg does not call friction by its name: %s", figure.name, words)
    end
  end
end
-- A curve two pixels off, and another word.
local svg = read(folder .. "/fig22.svg")
local one = drawn_lines.read(svg)
local shifted, count = svg:gsub("<path[^>]*rgb%(0%%,%s*44[^>]*", function(path)
  return path:gsub("([ML]) ([%d.]+) ([%d.]+)", function(letter, x, y) return ("%s %s %f"):format(letter, x, y + 2.5) end)
end)
assert(count > 0)
if not drawn_lines.difference(one, drawn_lines.read(shifted)) then complain "a shifted curve was not noticed" end
if not drawn_lines.difference(one, drawn_lines.read((svg:gsub("stuck", "stick")))) then complain "a word was not noticed" end

os.execute("rm -r " .. quoted(folder))
os.exit(failed == 0)
