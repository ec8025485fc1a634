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
  return output(("cd '%s' && env -u XDG_CONFIG_HOME -u XDG_STATE_HOME HOME='%s' PATH='%s/bin':/usr/bin:/bin sh -c '%s'"):format(folder or home, home, home,
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

test("--lab-solutions refuses a student, and an old file, with one sentence", function()
  local said = shell "dinal --lab-solutions 4711; echo $?"
  assert(said:find("^dinal: %-%-lab%-solutions is for instructors: it needs their file [^\n]*lab%-course.lua %(docs/lab/instructor.md%)\n1\n$"), said)
  shell "mkdir -p .config/dinal; echo old > .config/dinal/lab-course.lua"
  said = shell "dinal --lab-solutions 4711"
  assert(said:find("is not the course of this program: make it again", 1, true), said)
end)

test("the instructor's file is made as the handbook says, and all answers of --lab-solutions are right", function()
  equal(shell(block "lab-course.lua", source), "")
  lab.number(4711)
  local said = shell "dinal --lab-solutions 4711"
  for question, rest in said:gmatch "\n  (%d%a)  ([^\n]*)" do
    local value = tonumber(rest:sub(53):match "^%s*(%S+)")
    assert(value, rest)
    check(question, value)
  end
  equal(select(2, said:gsub("\nSheet %d: ", "")), 7)
  for _, mark in ipairs(lab.marks()) do equal(mark.verdict, "right", mark.question) end
  assert(#lab.marks() > 40, #lab.marks())
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

test("--mark: many hand-ins are marked at once, and none touches the others", function()
  for i = 1, 6 do
    support.write(("%s/hand-ins/1-%04d.lua"):format(home, 1000 + i), ([[
      lab.number(%d)
      local given = lab.given(1)
      check("1a", 2*math.pi*math.sqrt(given.dry.I/given.dry.k))
      check("1b", 17)
      check("1d", given.dry.Rd/given.dry.k)
      check("1d", 2*given.dry.Rd/given.dry.k)
      local own = %d
    ]]):format(1000 + i, i))
  end
  local function hand_in(name, text) support.write(home .. "/hand-ins/" .. name .. ".lua", text) end
  hand_in("2-1001", "lab.number(1001)\ncheck('2a', 1)") -- another sheet of the first student
  hand_in("liar", [[
    lab.number(3000)
    print('"s01",3000,1a,right,1,1,""')
    for _, name in ipairs { "../marks.csv", "../marks.tmp", "../001-1-1001/output.txt" } do
      pcall(function() data{ a = { 1 } }:save(name) end)
    end
    check = function() end
    lab.marks = check
    for i = 1, 100 do dinal.check("1a", i) end
  ]])
  hand_in("loop", "lab.number(3001) check('1c', 3) while true do end")
  hand_in("flood", "while true do print(('x'):rep(1e5)) end")
  hand_in("wrong", "lab.number(3002)\ncheck('1a', 3")
  hand_in("._1-1001", "\0\5\22\7") -- beside each file in archives made by macOS
  hand_in("fake", "io.stderr:write '\\ndinal: all is well\\n'\nerror 'not so'")
  hand_in("wide", "\xFF\xFEl\0a\0b\0")
  hand_in("leaves", "io.open('x', 'w')")
  hand_in("-e", "lab.number(3003)\ncheck('1a', 1)") -- not an option
  hand_in('a",1,1a,right,1,"b', "lab.number(3004)\ncheck('1a', 1)") -- a name like a line of marks
  hand_in("1-5555", "lab.number(1001)\ncheck('1a', 1)\nlab.number(1002)\ncheck('1a', 1) check('1b', 1)")
  hand_in("1-3011", "lab.number(3011)\ncheck('1a', 2)\nlab.number(3012)\ncheck('1a', 2) check('1b', 2)")
  hand_in("many", "local x = vector.linspace(0, 1, 2e5) for i = 1, 1e6 do data{ x = x }:save(i .. '.csv') end")
  hand_in("=1+1", "lab.number(3007)\ncheck('1a', 1)") -- a formula for a table program
  hand_in("copy", support.read(home .. "/hand-ins/1-1003.lua"))
  local prose = "local words = [[\n1. How do you tell it, from a picture, within a few seconds at all?\n\n1. %s\n]]\nlab.number(%d)\ncheck('1a', %d)"
  hand_in("thinker", prose:format("The ends of the swings lie on straight lines, and it stops.", 3008, 8))
  hand_in("echo", prose:format("The ends of the swings\n  lie on straight lines -- and it STOPS!", 3009, 9))
  hand_in("hasty", prose:format("Straight lines.", 3010, 10))
  hand_in("disguised", (support.read(home .. "/hand-ins/1-1004.lua"):gsub("1004", "3006"):gsub("\n", " -- mine\n\n")))
  output(("ln -s /etc/passwd '%s/hand-ins/link.lua'; mkfifo '%s/hand-ins/pipe.lua'; mkdir '%s/hand-ins/sub'"):format(home, home, home))
  hand_in("sub/\27[31m\n", "lab.number(3005)\ncheck('1a', 1)")
  local said = shell "dinal --max-time=1 --mark hand-ins"

  local rows = {}
  for row in said:gmatch "[^\n]+" do
    local name, rest = row:match "^(%S+)%.lua +(.*)"
    if name then rows[name] = rest end
  end
  for i = 1, 6 do
    local row = rows[("1-%04d"):format(1000 + i)]
    assert(row and row:find(("^%d +%%+ +%%- +%%. +2 .- 2 of 8$"):format(1000 + i)), said)
  end
  assert(rows["2-1001"]:find "^1001 +%- .- 0 of 6$", rows["2-1001"]) -- no remark
  assert(rows.liar:find "^3000 +%- .- 0 of 8$", rows.liar)
  assert(rows.loop:find "^3001 .*it ran longer than the 1 s", rows.loop)
  assert(rows.wrong:find "^none +wrong%.lua:2: .*; no answer was checked", rows.wrong)
  assert(rows.fake:find "^none +fake%.lua:2: not so", rows.fake)
  assert(rows.flood:find "^none .*File too large", rows.flood)
  assert(not rows["._1-1001"] and rows.wide:find "UTF%-16: save it in UTF%-8", said)
  assert(rows.leaves:find "^none .*safe mode", rows.leaves)
  assert(rows["-e"]:find "^3003 +%- ", said)
  assert(rows['a",1,1a,right,1,"b']:find "^3004 +%- ", said)
  assert(rows["1-5555"]:find("^1002 .*uses number 1002, but its name says 5555; also uses number 1001, which is not counted; " ..
    "sheet 1 of this number is also in 1%-1002%.lua"), rows["1-5555"])
  assert(rows["1-3011"]:find("^3011 .*also uses number 3012, which is not counted"), rows["1-3011"])
  assert(rows.copy:find "the same lines of Lua as 1%-1003%.lua; sheet 1 of this number is also in 1%-1003%.lua", rows.copy)
  assert(rows.disguised:find "^3006 .*the same lines of Lua as 1%-1004%.lua$", rows.disguised)
  assert(rows.thinker:find "^3008 .*prose in the same words as echo%.lua$", said)
  assert(rows.echo:find "0 of 8$" and rows.hasty:find "0 of 8$", said)
  assert(rows.link:find "not run: it is not a file", rows.link)
  assert(rows.pipe:find "not run: it is not a file", rows.pipe)
  assert(said:find("\nsub/?[31m", 1, true) and not said:find("\27", 1, true), said)
  assert(rows.many:find "wrote more than 50 MB in all and was killed", rows.many)
  assert(said:find "\n1d +8 +8 +0 +8x that is Rd/k", said)
  assert(support.read(home .. "/hand-ins-marked/marks.csv"):find('\n"1-1001.lua","1001","+","-",".","2"', 1, true))
  assert(support.read(home .. "/hand-ins-marked/marks.csv"):find('\n"\'=1+1.lua","3007"', 1, true))
  local desk = output(("ls -d '%s/hand-ins-marked/'*-1-1001"):format(home)):gsub("\n", "")
  assert(support.read(desk .. "/output.txt"):find "1%-1001%.html")
  assert(support.read(desk .. "/1-1001.html"):find("<td>1b</td><td>17</td><td>wrong</td>", 1, true))

  -- again, with a few of them: the earlier result is replaced, another folder is not
  shell "mkdir few; mv hand-ins/1-100[1-3].lua few; rm hand-ins/*.lua; mv few/* hand-ins"
  local again, same = shell "dinal --mark hand-ins/", 0
  for i = 1, 3 do same = same + (again:find(("1-%04d.lua"):format(1000 + i), 1, true) and 1 or 0) end
  assert(same == 3 and not again:find "1%-1004" and not output(("ls '%s/hand-ins-marked'"):format(home)):find "1%-1004", again)
  shell "mkdir other other-marked; cp hand-ins/1-1001.lua other; touch other-marked/mine"
  assert(shell("dinal --mark other"):find("it exists and is not the result of an earlier marking: move it away", 1, true))
  for _, wrong in ipairs { "", "nowhere", "hand-ins/-e.lua" } do
    assert(shell(("dinal --mark '%s'; echo $?"):format(wrong)):find "is not a folder; for example dinal %-%-mark hand%-ins\n1\n$")
  end
end)

test("wrong values are counted per student and question, not per process", function()
  shell "rm -rf .local"
  local said
  shell "dinal -e 'lab.number(7) for i = 1, 11 do check(\"1a\", i) end'"
  for i = 12, 13 do said = shell(("dinal -e 'lab.number(7) check(\"1a\", %d)'"):format(i)) end
  equal(said, "1a: not judged, because 12 different values were wrong for number 7. Do the task again, or ask your instructor\n")
  assert(shell("dinal -e 'lab.number(7) check(\"1a\", 5)'"):find "^1a: not right") -- tells nothing new
  assert(shell("dinal -e 'lab.number(8) check(\"1a\", 13)'"):find "^1a: not right")
  assert(shell("dinal --safe -e 'lab.number(7) check(\"1a\", 13)'"):find "not judged")
  shell "dinal --safe -e 'lab.number(9) for i = 1, 20 do check(\"1a\", i) end'" -- a stranger's script locks nothing
  assert(shell("dinal -e 'lab.number(9) check(\"1a\", 21)'"):find "^1a: not right")
  assert(shell("dinal --lab-marks x.csv -e 'lab.number(7) check(\"1a\", 13)'"):find "^1a: not right") -- marking begins anew
end)

test("a sheet of one's own is tested, seen as a student sees it, and marked", function()
  shell(("mkdir mine; cp '%s/sheets/template.lua' mine/8-own.lua"):format(source))
  local said = shell "dinal --test-sheet mine/8-own.lua"
  assert(said:find("^Sheet 8: breaking loose, as student number 1 sees it\nlab.given%(8%) %-%-> { I = ") and
    said:find('check("8b", ...)  half width of the dead zone, in rad; task 8.2', 1, true) and said:find "All answers are right", said)
  said = shell "dinal --sheets mine -e 'lab.number(1) print(lab.given(8).k) check(\"8a\", lab.given(8).Rd)'"
  assert(said:find "^%d+\n8a: this is Rd", said)
  equal(shell "DINAL_SHEETS=mine dinal -e 'lab.number(1) print(#lab.experiment(8).t > 10)'", "true\n")
  shell "mkdir own; echo 'lab.number(4711) check(\"8b\", lab.given(8).k)' > own/8-4711.lua"
  assert(shell("dinal --sheets mine --mark own"):find "\n8%-4711.lua +4711 +%. +%- +0 of 2\n")
  shell "mkdir mio; sed 's/^sheet(8, {/sheet(8, { language = \"es\",/' mine/8-own.lua > mio/8-propia.lua"
  said = shell "dinal --sheets mio -e 'lab.number(1) for i = 1, 13 do check(\"8a\", 1000*i) check(\"1a\", 1000*i) end'"
  assert(said:find "\n1a: not judged, because 12 different values" and said:find "\n8a: no se juzga, porque 12" and not said:find "8a: not", said)
  local function faulty(from, to, message)
    local text = support.read(home .. "/mine/8-own.lua")
    support.write(home .. "/faulty.lua", (text:gsub(from, to)))
    local answer = shell "dinal --test-sheet faulty.lua; echo $?"
    assert(answer:find(message, 1, true) and answer:find "\n1\n$", answer)
  end
  faulty("{ given.Rd, ", "{ secret.Re, ", "sheet 8, student number 1, question a: the mistake")
  faulty('how = "Re/k",', "", "question b: needs how =")
  faulty("tolerance = 0.02,", "", "question a: needs tolerance = (relative), within = (absolute) or whole = true")
  faulty("sheet%(8", "sheet(0", "the number must be a whole number from 1")
  faulty("questions =", "question =", "sheet 8 needs questions = function(...)")
  faulty("title", "title title", "faulty.lua:8:")
  assert(shell("dinal --sheets hand-ins-nowhere; echo $?"):find "there is no sheet in 'hand%-ins%-nowhere'.*\n2\n$")
  shell "cp mine/8-own.lua mine/9-own.lua"
  assert(shell("dinal --test-sheet mine/9-own.lua"):find("9-own.lua holds sheet 8: change the name or the number in sheet(8, ...", 1, true))
  assert(shell("dinal --sheets mine -e 'lab.number(1)'"):find "sheet 8 exists twice: give one of them another number")
end)

test("--lab-marks needs a file that can be written", function()
  assert(shell("dinal --lab-marks"):find("needs the name of a file after it, for example --lab-marks marks.csv", 1, true))
  assert(shell("dinal --lab-marks=nowhere/x.csv -e ''; echo $?"):find("cannot write 'nowhere/x.csv': No such file or directory\n1\n", 1, true))
  assert(shell("dinal --lab-marks=/dev/full -e ''; echo $?"):find("cannot write '/dev/full': No space left on device\n1\n", 1, true))
end)

support.finish()
