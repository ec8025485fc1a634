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

--- What is said about this value.
function walk.said(question, value)
  check(question, value)
  local marks = lab.marks()
  for i = 1, #marks do
    if marks.question[i] == question then return marks.said[i] end
  end
  error(question .. " was not judged")
end

function walk.right(question, value)
  local said = walk.said(question, value)
  assert(said:find("^" .. question .. ": right"), ("number %d: %s (%.9g)"):format(lab.number(), said, value))
end

--- Each typical mistake has its hint: list of { question, value, piece of the hint }. After the right answers, so that tries
--- do not run out. No hint contains a digit beyond its question's name that could be the answer.
function walk.mistakes(list)
  for _, case in ipairs(list) do
    local question, value, piece = table.unpack(case)
    local said = walk.said(question, value)
    assert(said:find(piece, 1, true), ("number %d: %.9g gave '%s', not '%s'"):format(lab.number(), value, said, piece))
  end
end

--- The sheet for each of the numbers: follow the handout, then do the work of the student.
function walk.sheet(name, work)
  for _, number in ipairs(walk.numbers) do
    support.test(("sheet %s is done by number %d with honest work, and typical mistakes get their hints"):format(name, number),
      function() work(walk.follow(name, number), number) end)
  end
  support.test("the script of sheet " .. name .. " runs as it is given", function()
    -- It writes its page into the folder in which it runs: one that goes away.
    local script = ('folder=$(mktemp -d) && cp examples/lab/%s.lua "$folder" && program=$(realpath "%s") && cd "$folder" && '
      .. '"$program" %s.lua 2>&1; code=$?; rm -r "$folder"; exit $code'):format(name, support.program(), name)
    local pipe = io.popen(script)
    local text = pipe:read "a"
    assert(pipe:close(), text)
  end)
  support.finish()
end

return walk
