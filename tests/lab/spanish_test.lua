-- The Spanish tutorial and sheets show the very sessions of the English ones, which are tested: block by block.
package.path = "tests/lua/?.lua;" .. package.path
local support = require "support"

local function blocks(name)
  local list = {}
  for block in support.read(name):gmatch "```console\n(.-)```" do list[#list + 1] = block end
  return list
end

local pages = { ["tutorial"] = "docs/tutorial.md" }
for n, name in ipairs { "free-decay", "sticking", "resonance", "belief", "identification", "governor", "friction-damper" } do
  pages["hoja-" .. n] = ("docs/lab/%d-%s.md"):format(n, name)
end

--- The block as the English page has it: the Spanish one asks for answers in Spanish.
local function in_english(block)
  return (block:gsub('lab%.number%(4711, "es"%)', "lab.number(4711)"):gsub("\n0: correcto", "\n0: right"))
end

for spanish, english in pairs(pages) do
  support.test(spanish .. " has the blocks and the questions of " .. english, function()
    local there, here = blocks(english), blocks("docs/es/" .. spanish .. ".md")
    support.equal(#here, #there)
    for i = 1, #there do support.equal(in_english(here[i]), there[i]) end
    local function found(name, pattern)
      local list = {}
      for question in support.read(name):gmatch(pattern) do list[#list + 1] = question end
      return table.concat(list, " ")
    end
    for _, pattern in ipairs { "%*%*(%d%l)%*%*", "\n### (%d%.%d)", "\n(%d%.) " } do
      support.equal(found("docs/es/" .. spanish .. ".md", pattern), found(english, pattern))
    end
  end)
end

--- The questions of a handout, each with the task that asks it: "a 1.2, b 1.3".
local function tasks_of_page(name)
  local list, task = {}, nil
  for line in support.read(name):gmatch "[^\n]+" do
    task = line:match "^### (%d%.%d)" or task
    for _, pattern in ipairs { "%*%*%d(%l)%*%*", 'check%("%d(%l)", %.%.%.%)' } do
      for question in line:gmatch(pattern) do list[#list + 1] = question .. " " .. task end
    end
  end
  table.sort(list)
  return table.concat(list, ", ")
end

for _, english in pairs(pages) do
  local sheet = english:match "lab/(.*)%.md"
  if sheet then
    support.test("sheet " .. sheet .. " sends a student to the task that asks the question", function()
      local list = {}
      for question, task in support.read("sheets/" .. sheet .. ".lua"):gmatch 'name = "(%l)".-task = "(%d%.%d)"' do
        list[#list + 1] = question .. " " .. task
      end
      table.sort(list)
      support.equal(table.concat(list, ", "), tasks_of_page(english))
    end)
  end
end

support.test("the program speaks the language of the sheet, or the one that is set for all sheets", function()
  local pipe <close> = io.popen "cat src/lab/judge.lua sheets/[1-9]*.lua"
  local judge = setmetatable({}, { __index = _G })
  assert(load(pipe:read "a", "=course", "t", judge))()
  local course = judge.course
  judge.sheet(8, { title = "Pendel", language = "de", words = { de = { ["right"] = "richtig" } }, given = function() return {} end,
    questions = function() return { { name = "a", asks = "x", how = "x", answer = 3, tolerance = 0.01, mistakes = { { 1, "zu klein" } } } } end })
  local function said(number, question, value) return select(2, course.judge(number, question, value)) end
  support.equal(said(1, "8a", 3), "8a: richtig")
  support.equal(said(1, "8a", 1), "8a: zu klein")
  support.equal(said(1, "0", -42), "0: the size is right, the sign is not")
  local shown = course.test(8)
  assert(shown:find 'All answers are right.*words.de has no translation of these.*"not right"', shown)
  assert(not shown:find '\n    "right"' and not course.test(1):find "no translation")
  course.speak "es"
  support.equal(said(1, "8a", 3), "8a: correcto")
  support.equal(said(1, "0", -42), "0: el tamaño es correcto, el signo no")
  support.equal(table.concat(course.languages(), " "), "de en es")
  support.equal(select(2, pcall(course.speak, "fr")), "the languages of the sheets are de, en, es")
end)

support.finish()
