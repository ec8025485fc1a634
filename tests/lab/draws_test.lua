-- For every student number each sheet can be worked out: its answers are right, and each known mistake is recognised.
-- `dinal tests/lab/draws_test.lua all` tries all combinations, for minutes; without that word a part of large sets.
package.path = "tests/lua/?.lua;" .. package.path
local support = require "support"

local pipe <close> = io.popen "cat src/lab/judge.lua sheets/[1-9]*.lua"
assert(load(pipe:read "a", "=course"))()

--- What a question depends on: the places of its draws in the order in which the sheet draws them, and how many of their
--- combinations are tried in every run. The other draws are taken from their middle.
local sets = {
  { sheet = 1, draws = { 1, 2, 4 }, questions = "abc", some = 120 },       -- I, k, zeta
  { sheet = 1, draws = { 2, 3, 5, 6, 7 }, questions = "de", some = 120 },  -- k, theta0, n, s and its sign
  { sheet = 1, draws = { 1, 2, 5 }, questions = "f", some = 120 },         -- I, k, n
  { sheet = 1, draws = { 8, 9 }, questions = "gh" },                       -- zeta and x_f of the colleague
  { sheet = 2, draws = { 2, 3, 4 }, questions = "ab", some = 120 },        -- k, Rd, Re/Rd
  { sheet = 2, draws = { 2, 3, 4, 5, 6 }, questions = "c", some = 120 },   -- and theta0
  { sheet = 2, draws = { 1, 2, 3, 4, 7 }, questions = "def", some = 200 }, -- and I, the speed
  { sheet = 3, draws = { 1, 2 }, questions = "abcdf" },                    -- r, friction_ratio
  { sheet = 3, draws = { 2, 4 }, questions = "g" },                        -- friction_ratio, low_r
  { sheet = 3, draws = { 3, 5 }, questions = "eh" },                       -- small_ratio, zeta
  { sheet = 4, draws = { 1, 2 }, questions = "ab" },                       -- theta0, h
  { sheet = 4, draws = { 2, 3 }, questions = "cde" },                      -- h, zeta
  { sheet = 4, draws = { 4 }, questions = "fg" },                          -- friction_ratio
  { sheet = 4, draws = { 5 }, questions = "h" },                           -- periods
  { sheet = 5, draws = { 1, 2, 3, 4, 5, 6, 7 }, questions = "abcdefg", some = 4, all = 500 },
  { sheet = 6, draws = { 1, 2, 3, 4, 5 }, questions = "abcdef", some = 4, all = 500 },
  { sheet = 7, draws = { 1, 2, 3 }, questions = "abcdef", some = 2, all = 100 },
}

--- How many values each draw of the sheet has, from a world of middles; these are, counted from 0, in `middles`.
local function draws_of(sheet)
  local counts, middles = {}, {}
  course.world(sheet, function(from, to, step)
    local n = #counts + 1
    counts[n] = math.floor((to - from)/step + 0.5) + 1
    middles[n] = counts[n]//2
    return course.rounded(from + step*middles[n])
  end)
  return counts, middles
end

local drawn_again = {}

--- The world of the sheet with these draws; nil when it does not take them and draws again.
local function world_with(sheet, places)
  local n = 0
  local good, world = pcall(course.world, sheet, function(from, _, step)
    n = n + 1
    return course.rounded(from + step*(places[n] or error(drawn_again)))
  end)
  if not good and world ~= drawn_again then error(world, 0) end
  return good and world or nil
end

--- The answer is a right one; each mistake is none, and is told.
local function try(question, where)
  local answer = question.answer
  local function must(good, what) return good or error(("%s: %s is %.9g: %s"):format(where, question.name, answer, what), 0) end
  must(math.abs(answer) < math.huge, "no number")
  must(course.verdict(question, answer), "not right")
  for _, mistake in ipairs(question.mistakes or {}) do
    local wrong, words = mistake[1], mistake[2]
    if type(wrong) == "number" then
      local right, said = course.verdict(question, wrong)
      must(not right, ("%.9g is right, too: %s"):format(wrong, words))
      must((said .. ". Or: "):find(words .. ". Or: ", 1, true), ("of %.9g is said '%s', not '%s'"):format(wrong, said, words))
    end
  end
  if not question.whole then
    for _, factor in ipairs { -1, 2, 0.5, 2*math.pi, 1/(2*math.pi), 180/math.pi, math.pi/180, 100, 0.01, 1000, 0.001 } do
      must(not course.verdict(question, factor*answer), ("%g times as much is right, too"):format(factor))
    end
    if question.unit == "time units" then must(not course.verdict(question, 1/answer), "its reciprocal is right, too") end
  end
end

local function without_common_factor(a, b)
  while b > 0 do a, b = b, a % b end
  return a == 1
end

for _, set in ipairs(sets) do
  support.test(("sheet %d, questions %s, whatever is drawn"):format(set.sheet, set.questions), function()
    local sheet = course.sheets[set.sheet]
    local counts, places = draws_of(sheet)
    local total = 1
    for _, draw in ipairs(set.draws) do total = total*counts[draw] end
    local most = arg[1] == "all" and set.all or arg[1] ~= "all" and set.some or total
    local stride = math.max(1, total//most)
    while not without_common_factor(total, stride) do stride = stride + 1 end
    local tried = 0
    for code = 0, total - 1, stride do
      local rest = code
      for _, draw in ipairs(set.draws) do places[draw], rest = rest % counts[draw], rest//counts[draw] end
      local world = world_with(sheet, places)
      if world then
        tried = tried + 1
        for _, question in ipairs(sheet.questions(world.given, world.secret)) do
          if set.questions:find(question.name, 1, true) then try(question, "draws " .. table.concat(places, " ")) end
        end
        if tried % 50 == 1 then assert(#sheet.discussion(world.given, world.secret) >= 3) end
      end
    end
    assert(tried > 0.4*(total//stride), ("only %d of %d are taken"):format(tried, total//stride))
  end)
end

support.test("a value that two mistakes explain is reported with both, the nearer one first", function()
  local question = { sheet = {}, answer = 1, tolerance = 0.01, mistakes = { { 2.02, "the farther" }, { 2, "the nearer" } } }
  support.equal(select(2, course.verdict(question, 2.001)), "the nearer. Or: the farther")
end)

support.test("a usual mistake gets the hint that fits the unit of the answer, and no other", function()
  local turn, half, double = 2*math.pi, "half of it: where", "twice as much: where"
  local missing, much, prefix = "2 pi is missing", "2 pi too much", "a prefix"
  local swing, swings = "half of it: half a cycle", "twice as much: a whole cycle"
  local hints = {
    rad = { [0.5] = swing, [2] = swings, [180/math.pi] = "in degrees", [1/turn] = missing, [turn] = much },
    degrees = { [0.5] = half, [2] = double, [math.pi/180] = "in radians" },
    ["time units"] = { [0.5] = swing, [2] = swings, [1/turn] = missing, [turn] = much },
    percent = { [0.5] = half, [2] = double, [0.01] = "a fraction where percent are" },
    [""] = { [0.5] = half, [2] = double, [100] = "percent where the plain number is", [1/turn] = missing, [turn] = much },
    torque = { [0.5] = half, [2] = double },
  }
  for unit, known in pairs(hints) do
    local question = { sheet = {}, answer = 0.37, tolerance = 1e-3, unit = unit }
    known[-1], known[1000], known[0.001] = "the sign is not", prefix, prefix
    for _, factor in ipairs { -1, 0.5, 2, 180/math.pi, math.pi/180, 1/turn, turn, 0.01, 100, 1000, 0.001, 3 } do
      support.has(select(2, course.verdict(question, factor*0.37)), known[factor] or "not right")
    end
    support.has(select(2, course.verdict(question, 1/0.37)), unit == "time units" and "its reciprocal" or "not right")
  end
end)

support.test("an absolute tolerance is that of the answer, and of a mistake ten times as great ten times as much", function()
  local question = { sheet = {}, answer = 1, within = 0.1, mistakes = { { 10, "ten times" } } }
  support.equal((course.verdict(question, 1.05)), true)
  support.equal((course.verdict(question, 1.5)), false)
  support.equal(select(2, course.verdict(question, 10.5)), "ten times")
end)

support.finish()
