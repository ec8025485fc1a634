-- What docs/lab/instructor.md promises: solutions for those who have the file, and thirty hand-ins marked at once.
package.path = "tests/lua/?.lua;" .. package.path
local support = require "support"
local test, equal = support.test, support.equal

local function output(command)
  local pipe <close> = io.popen(command .. " 2>&1")
  return (pipe:read "a")
end

local program = output(("realpath '%s'"):format(support.program())):gsub("\n", "")
local source = output("pwd"):gsub("\n", "")
local home = os.tmpname()
os.remove(home)
assert(os.execute(("mkdir -p '%s/bin' '%s/hand-ins' && ln -s '%s' '%s/bin/dinal' && cp -r examples '%s'"):format(home, home, program, home,
  home)))
local removed <close> = setmetatable({}, { __close = function() os.execute("rm -rf '" .. home .. "'") end })

--- Runs a command in the folder of the instructor, or in that of the repository.
local function shell(command, folder)
  return output(("cd '%s' && env -u XDG_CONFIG_HOME HOME='%s' PATH='%s/bin':/usr/bin:/bin sh -c '%s'"):format(folder or home, home, home,
    command:gsub("'", "'\\''")))
end

local handbook = support.read "docs/lab/instructor.md"

--- The block of commands that has these words in it.
local function block(words)
  for text in handbook:gmatch "```sh\n(.-)```" do
    if text:find(words, 1, true) then return text end
  end
  error("no block with " .. words)
end

test("a student gets one sentence for --lab-solutions, and so does an old file", function()
  local said = shell "dinal --lab-solutions 4711; echo $?"
  assert(said:find("^dinal: %-%-lab%-solutions is for instructors: it needs their file [^\n]*lab%-course.lua, which docs/lab/instructor.md " ..
    "tells of\n1\n$"), said)
  shell "mkdir -p .config/dinal; echo old > .config/dinal/lab-course.lua"
  said = shell "dinal --lab-solutions 4711"
  assert(said:find("is not the course of this program; make it again", 1, true), said)
end)

test("the instructor's file is made as the handbook says, and all that --lab-solutions tells is right", function()
  equal(shell(block "lab-course.lua", source), "")
  local sheets = 0
  for _, number in ipairs { 4711, 20260017 } do
    lab.number(number)
    local said = shell("dinal --lab-solutions " .. number)
    for question, rest in said:gmatch "\n  (%d%a)  ([^\n]*)" do
      local value = tonumber(rest:sub(53):match "^%s*(%S+)")
      assert(value, rest)
      check(question, value)
    end
    for _ in said:gmatch "\nSheet %d: " do sheets = sheets + 1 end
    for _, mark in ipairs(lab.marks()) do equal(mark.verdict, "right", mark.question) end
    assert(#lab.marks() > 10)
  end
  assert(sheets >= 4, sheets)
  local said = shell "dinal --lab-solutions 4711"
  local sheet = 0
  for talk in (said .. "\n\n"):gmatch "\n  The questions at the end:\n(.-)\n\n" do
    sheet = sheet + 1
    local handout = support.read(output(("ls docs/lab/%d-*.md"):format(sheet)):match "[^\n]*")
    local asked = handout:match "\n## Questions\n(.-)\n## "
    local _, questions = asked:gsub("\n%d%. ", "")
    local _, answers = ("\n" .. talk):gsub("\n  %d%. ", "")
    equal(answers, questions, "answers to the open questions of sheet " .. sheet)
  end
  equal(sheet, 7)
  for _, wrong in ipairs { "", "x", "0", "-1", "1.5", "1000000000" } do
    local refused = shell(("dinal --lab-solutions '%s'; echo $?"):format(wrong))
    assert(refused:find("needs a student number after it", 1, true), refused)
  end
end)

test("thirty hand-ins are marked at once, and none touches the others", function()
  for i = 1, 26 do
    support.write(("%s/hand-ins/s%02d.lua"):format(home, i), ([[
      lab.number(%d)
      local given = lab.given(1)
      check("1a", 2*math.pi*math.sqrt(given.dry.I/given.dry.k))
      check("1b", 17)
      check("1d", given.dry.Rd/given.dry.k)
      check("1d", 2*given.dry.Rd/given.dry.k)
    ]]):format(1000 + i))
  end
  local function hand_in(name, text) support.write(home .. "/hand-ins/" .. name .. ".lua", text) end
  hand_in("liar", [[
    lab.number(3000)
    print('"s01",3000,1a,right,1,1')
    for _, name in ipairs { "../../marks.csv", "../s01/s01.lua", "../s01/output.txt" } do
      pcall(function() data{ a = { 1 } }:save(name) end)
      pcall(function() io.open(name, "w"):write("x") end)
    end
    check = function() end
    lab.marks = check
    for i = 1, 100 do dinal.check("1a", i) end
  ]])
  hand_in("loop", "lab.number(3001) check('1c', 3) while true do end")
  hand_in("flood", "while true do print(('x'):rep(1e5)) end")
  hand_in("wrong", "lab.number(3002)\ncheck('1a', 3")
  hand_in("-e", "lab.number(3003)\ncheck('1a', 1)") -- not an option
  hand_in('a",1,1a,right,1,"b', "lab.number(3004)\ncheck('1a', 1)") -- a name like a line of marks
  hand_in("twin", "lab.number(1001)\ncheck('1a', 1)")
  local loop = block "--lab-marks"
  local began = os.time()
  local said = shell(loop)
  assert(os.time() - began < 60, "it took " .. os.time() - began .. " s")

  local rows = {}
  for name, row in said:gmatch "\n(%w+)%.lua +([^\n]*)" do rows[name] = row end
  for i = 1, 26 do
    local row = rows[("s%02d"):format(i)]
    assert(row and row:find(("^%d +%%+  %%-  %%.  2  2 of 4"):format(1000 + i)), said)
  end
  assert(rows.liar:find "^3000 +%-  %.  %.  %.  0 of 4", rows.liar)
  assert(rows.loop:find "^3001 +%.  %.  %-  %.  0 of 4", rows.loop)
  assert(rows.wrong:find "none +.*nothing was checked", rows.wrong)
  assert(said:find "%-e%.lua +3003 +%-", said)
  assert(said:find('\na",1,1a,right,1,"b.lua +3004 +%-  %.  %.  %.  0 of 4'), said)
  assert(rows.twin:find "has the number of s01.lua", rows.twin)
  assert(said:find("loop ended with an error", 1, true) and said:find("wrong ended with an error", 1, true), said)
  assert(not said:find("s01 ended", 1, true), said)
  assert(said:find("flood ended with an error", 1, true), said)
  assert(#support.read(home .. "/desks/flood/output.txt") < 30e6)
  equal(support.read(home .. "/desks/s01/s01.lua"), support.read(home .. "/hand-ins/s01.lua"))
  assert(support.read(home .. "/desks/s01/output.txt"):find("1a: right", 1, true))

  -- no more lines than there can be tries
  local lines = select(2, support.read(home .. "/marks.csv"):gsub('"liar.lua"', ""))
  equal(lines, 13)
end)

test("--lab-marks needs a file that can be written", function()
  assert(shell("dinal --lab-marks"):find("needs the name of a file after it, for example --lab-marks marks.csv", 1, true))
  assert(shell("dinal --lab-marks=nowhere/x.csv -e ''; echo $?"):find("cannot write 'nowhere/x.csv': No such file or directory\n1\n", 1, true))
  assert(shell("dinal --lab-marks=/dev/full -e ''; echo $?"):find("cannot write '/dev/full': No space left on device\n1\n", 1, true))
end)

support.finish()
