-- Does a lab sheet as a student would: what the handout shows is typed word for word, with another student number.
package.path = "tests/lua/?.lua;" .. package.path
local support = require "support"
local walk = { test = support.test, finish = support.finish, equal = support.equal, near = support.near }

walk.numbers = { 4711, 1, 20260017, 999999999 }

--- Types the lines behind "> " of the console blocks into a session of its own, and returns its variables.
function walk.follow(sheet, number)
  local session = setmetatable({}, { __index = _G })
  local pending = ""
  for block in support.read("docs/lab/" .. sheet .. ".md"):gmatch "```console\n(.-)```" do
    for line in block:gmatch "[^\n]+" do
      local typed = line:match "^>>? ?(.*)"
      if typed then
        pending = pending .. typed:gsub("4711", tostring(number)) .. "\n"
        local chunk = load("return " .. pending, "=handout", "t", session) or load(pending, "=handout", "t", session)
        if chunk then
          chunk()
          pending = ""
        end
      end
    end
    support.equal(pending, "", "left unfinished")
  end
  return session
end

local pipe <close> = io.popen "cat src/lab/judge.lua sheets/[1-9]*.lua"
local judge = setmetatable({}, { __index = _G })
assert(load(pipe:read "a", "=course", "t", judge))()

--- What is said about this value, in a language.
function walk.said(question, value, language)
  judge.course.speak(language)
  return (select(2, judge.course.judge(lab.number(), question, value)))
end

--- The program itself finds the value right.
function walk.right(question, value)
  check(question, value)
  local marks = lab.marks()
  local right = marks:filter(function(row) return row.question == question and row.verdict == "right" end)
  assert(#right == 1, ("number %d: %s (%.9g)"):format(lab.number(), walk.said(question, value), value))
end

--- Each typical mistake has its hint: list of { question, value, piece of the hint }, and the hint has a Spanish one.
function walk.mistakes(list)
  for _, case in ipairs(list) do
    local question, value, piece = table.unpack(case)
    local said = walk.said(question, value)
    assert(said:find(piece, 1, true), ("number %d: %.9g gave '%s', not '%s'"):format(lab.number(), value, said, piece))
    assert(walk.said(question, value, "es") ~= said, said .. " has no Spanish words")
  end
end

--- The sheet for each of the numbers: follow the handout, then do the work of the student.
function walk.sheet(name, work, numbers)
  for _, number in ipairs(numbers or walk.numbers) do
    support.test(("sheet %s is done by number %d with honest work, and typical mistakes get their hints"):format(name, number),
      function() work(walk.follow(name, number), number) end)
  end
  local program = io.popen(('realpath "%s"'):format(support.program())):read "l"
  for _, sheet in ipairs { name:match "^%d", "hoja-" .. name:match "^%d" } do
    support.test("the script to begin sheet " .. sheet .. " with makes a page as it is given", function()
      local pipe = io.popen(([[folder=$(mktemp -d) && cd "$folder" && '%s' --lab %s 4711 && '%s' --report %s-4711.lua && cat %s-4711.html 2>&1
        code=$?; rm -r "$folder"; exit $code]]):format(program, sheet, program, name:match "^%d", name:match "^%d"))
      local text = pipe:read "a"
      assert(pipe:close(), text)
      assert(text:find("<h2>" .. (sheet:find "hoja" and "Preguntas" or "Questions"), 1, true), text)
    end)
  end
  support.finish()
end

return walk
