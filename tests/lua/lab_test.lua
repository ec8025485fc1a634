-- lab and check: student numbers, refused input, and that the answers cannot be read instead of worked out.
dofile "tests/lua/support.lua"

test("before a number is given, the lab gives and judges nothing", function()
  equal(lab.number(), nil)
  refused {
      { 'check("1a", 3)', "check: first set your own student number, for example lab.number(4711)" },
      { "lab.given(1)", "lab.given: first set your own student number" },
      { "lab.experiment(1)", "lab.experiment: first set your own student number" },
      { "lab.marks()", "lab.marks: first set your own student number" },
  }
end)

test("a sweep judges no answers, as each of its workers would begin with all tries", function()
  for call, code in pairs {
    ["lab.number"] = "lab.number(4711)", ["check"] = "check('1a', p.n)", ["lab.given"] = "lab.given(1)",
    ["lab.experiment"] = "lab.experiment(1)", ["lab.marks"] = "lab.marks()",
  } do
    local said = output("lab.number(4711) sweep{ over = { n = { 1, 2 } }, run = function(p) " .. code .. " return { n2 = p.n } end }")
    assert(said:find(call .. " is not possible within the function of a sweep", 1, true), said)
  end
end)

test("an invalid number is refused with one sentence", function()
  for _, wrong in ipairs { 0, -3, 1.5, 1e9, math.huge, 0/0 } do
    refused { { "lab.number(wrong)", "lab.number: a student number is a whole number from 1 to 999999999, got " } }
  end
  refused {
      { 'lab.number("4711")', 'got the string "4711"; write it without quotes' },
      { "lab.number(nil)", "got nil" },
      { "lab.number({})", "got a table" },
  }
  equal(lab.number(), nil)
  equal(lab.number(4711), 4711)
  equal(lab.number(4711.0), 4711)
  equal(math.type(lab.number()), "integer")
end)

test("the given values depend only on the number", function()
  local first, again = lab.given(1), lab.given(1.0)
  assert(first ~= again)
  equal(first.viscous.k, again.viscous.k)
  local differ = 0
  for number = 1, 20 do
    lab.number(number)
    if lab.given(1).viscous.k ~= first.viscous.k then differ = differ + 1 end
  end
  assert(differ > 12, differ)
  lab.number(4711)
  again.viscous.k = 1
  equal(lab.given(1).viscous.k, first.viscous.k)
  assert(lab.experiment(1).t == lab.experiment(1).t)
end)

test("an unknown question, sheet or value is refused with a reason", function()
  for _, case in ipairs {
    { check, "check: there is no question '1z'; sheet 1 asks 1a to 1h", "1z", 3 },
    { check, "check: there is no question 'a1'; did you mean '1a'?", "a1", 3 },
    { check, "check: there is no question '9a'; a name is the number of a sheet and a letter", "9a", 3 },
    { check, "check: there is no question ''", "", 3 },
    { check, "check: there is no question '1ä'", "1ä", 3 },
    { check, "the name of a question, got 1; for example check(\"1a\", 3.2)", 1, 3 },
    { check, "check: the answer is a number, got nil; for example", "1a" },
    { check, 'got the string "3.2"; write it without quotes', "1a", "3.2" },
    { check, 'got the string "three"; for example check("1a", 3.2)', "1a", "three" },
    { check, "check: the answer is a number, got a table", "1a", {} },
    { check, "got nan; is that a root or a logarithm of a negative number, or 0/0", "1a", 0/0 },
    { check, "check: the answer must be a finite number", "1a", math.huge },
    { check, "check: expects a question and one value; after that comes 43", "1a", 1,43 },
    { check, "after that comes", "1a", 3, "s" },
    { lab.given, "lab.given: there is no sheet 17; the sheets are 1, 2, 3, 4, 5, 6", 17 },
    { lab.given, "lab.given: the first argument is the number of a sheet, got the string", "1" },
    { lab.given, "got nil; for example lab.given(1)" },
    { lab.experiment, "lab.experiment(2, x): x", 2, "fast" },
  } do
    raises_here(function() case[1](table.unpack(case, 3)) end, case[2])
  end
  equal(#lab.marks(), 0)
end)

test("twelve wrong values are judged, and no more; a right one stays right", function()
  local said = output [[
    lab.number(1)
    for i = 1, 20 do check("0", i) end
    lab.number(2)
    check("0", 42)
    check("1A", 2*math.pi*math.sqrt(lab.given(1).dry.I/lab.given(1).dry.k))
    check(" 1a", 3)
    for _, m in ipairs(lab.marks()) do print(m.question, m.verdict, m.tries) end
    print(lab.marks().said[2])
    print(lab.marks())]]
  assert(said:find("\n1a: not right[^\n]*%(an earlier answer was right, and counts%)\n"), said)
  equal(select(2, said:gsub("0: not judged, because 12 different values were wrong for number 1", "")), 8)
  assert(said:find("\n0\tright\t1.0?\n1a\tright\t1.0?\n1a: right\nnumber 2: 2 of 2 right\n", 1), said)
end)

test("no script can read the course, or change its answers", function()
  local spies = [[
    local seen, find = {}, string.find
    local function spy(name, f) return function(...) seen[#seen + 1] = name return f(...) end end
    for name, f in pairs(math) do if type(f) == "function" then math[name] = spy("math." .. name, f) end end
    for name, f in pairs(string) do string[name] = spy("string." .. name, f) end
    for _, name in ipairs { "tonumber", "ipairs", "pairs", "error", "system", "nondimensional", "load" } do _G[name] = spy(name, _G[name]) end
    course = { judge = function() return true, "stolen" end }
    if debug.sethook then debug.sethook(function() seen[#seen + 1] = debug.getinfo(2, "S").source end, "c") end
    check("1a", 3)
    if debug.sethook then debug.sethook() end
    for i = 1, #seen do assert(not find(seen[i], "course") and not find(seen[i], "^math"), seen[i]) end]]
  for _, options in ipairs { "", "--safe" } do
    local said = output("lab.number(4711) " .. spies, options)
    equal(said, "1a: not right, and not one of the usual mistakes: read task 1.2 again\n")
  end
end)

test("neither the program nor the students' files show the course", function()
  local pipe <close> = io.popen("cat src/lab/judge.lua sheets/[1-9]*.lua")
  local text = pipe:read "a"
  local program = read(program())
  local looked_for = 0
  for line in text:gmatch "[^\n]+" do
    if #line > 40 then
      looked_for = looked_for + 1
      assert(not program:find(line, 1, true), line)
    end
  end
  assert(looked_for > 100)
end)

test("a course that runs too long is stopped like any other script", function()
  local said = output("lab.number(1) while true do lab.experiment(1) end", "--max-time 0.3")
  has(said, "stopped", "--max-time allows")
end)

finish()
