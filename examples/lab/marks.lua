-- What became of thirty hand-ins: a table of the file that dinal --lab-marks has written (docs/lab/instructor.md).
local name = arg[1] or "marks.csv"
local file = assert(io.open(name))

local scripts, answers, numbers, questions = {}, {}, {}, {}
for line in file:lines() do
  -- The name of a script may hold quotes (written twice) and commas, so what stands behind it is read from the end.
  local script, number, question, verdict, tries = line:match '^"(.*)",(%d+),(%w*),(%a+),(%d+),[^,"]*$'
  script = script and script:gsub('""', '"')
  if not script or verdict ~= "begun" and not answers[script] then
    print("no line of --lab-marks: " .. line)
  elseif verdict == "begun" then
    if not answers[script] then scripts[#scripts + 1] = script end
    answers[script], numbers[script] = {}, nil -- a later run counts
  else
    answers[script][question] = { right = verdict == "right", tries = tonumber(tries) }
    local before = numbers[script]
    numbers[script] = not before and number or before:find(number, 1, true) and before or before .. " and " .. number
    questions[question] = true
  end
end
file:close()

local names = {}
for question in pairs(questions) do names[#names + 1] = question end
table.sort(names)
table.sort(scripts)

--- "+" right at once, a digit right after so many tries, "-" wrong, "." not tried.
local function sign(answer)
  if not answer then return "." end
  if not answer.right then return "-" end
  return answer.tries == 1 and "+" or tostring(answer.tries)
end

local owner = {} -- number -> the script that has it
print(string.format("%-24s %-10s %s  right", "script", "number", table.concat(names, " ")))
for _, script in ipairs(scripts) do
  local row, right = {}, 0
  for _, question in ipairs(names) do
    local answer = answers[script][question]
    row[#row + 1] = string.format("%" .. #question .. "s", sign(answer))
    if answer and answer.right then right = right + 1 end
  end
  local number = numbers[script] or "none"
  local twin = owner[number]
  owner[number] = twin or number ~= "none" and script or nil
  local remark = twin and "  has the number of " .. twin or number == "none" and "  nothing was checked" or ""
  print(string.format("%-24s %-10s %s  %d of %d%s", script, number, table.concat(row, " "), right, #names, remark))
end
