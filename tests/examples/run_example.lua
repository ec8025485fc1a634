-- Runs one example in an empty temporary folder and compares what it prints with the comment at its end.
--
--     dinal run_example.lua PROGRAM SCRIPT             compare
--     dinal run_example.lua PROGRAM SCRIPT --update    rewrite the comment from what is printed now (then read it!)
--
-- The comment is "--[[ prints" ... "]]". Text must be the same but for the width of blanks; a whole number must be the
-- same; a number with decimals may differ by two units of its last printed digit, for other compilers round otherwise.
-- PROGRAM and SCRIPT must be absolute paths, since the folder changes.

local program, script, update = arg[1], arg[2], arg[3] == "--update"
local opening = "\n--[[ prints\n"

local function read(name)
  local file = assert(io.open(name, "rb"))
  local text = file:read("a")
  file:close()
  return text
end
local function quoted(text) return "'" .. text:gsub("'", "'\\''") .. "'" end

local function run_in_empty_folder()
  local folder = os.tmpname()
  os.remove(folder)
  assert(os.execute("mkdir " .. quoted(folder)))
  local ok, _, code = os.execute(("cd %s && %s %s >.out 2>.err </dev/null"):format(
    quoted(folder), quoted(program), quoted(script)))
  local out, err = read(folder .. "/.out"), read(folder .. "/.err")
  -- what an example says that it wrote must be there
  for name in out:gmatch("%f[%w]fig%w+%.svg") do
    assert(io.open(folder .. "/" .. name), name .. " was not written"):close()
  end
  os.execute("rm -r " .. quoted(folder))
  assert(ok, ("exit code %s\n%s%s"):format(code, out, err))
  assert(err == "", "something on stderr:\n" .. err)
  return out
end

-- A line as text with a sign for each number, and the numbers as they are written. The 4 of rk4 is no number.
local function split(line)
  local numbers, text = {}, line
  for kind, pattern in ipairs{ "%f[%w]%d+%.?%d*e[-+]%d+", "%f[%w]%d+%.%d+", "%f[%w]%d+" } do
    text = text:gsub(pattern, function(number)
      numbers[#numbers + 1] = number
      return ("#"):rep(kind)
    end)
  end
  return text:gsub("%s+", " "):gsub("%s$", ""), numbers
end

-- How far a number may be from the one written here.
local function tolerance(number)
  local decimals, exponent = number:match("%.(%d*)") or "", number:match("e(.*)")
  if decimals == "" and not exponent then return 0 end
  return 2.001 * 10.0 ^ (tonumber(exponent) or 0) / 10.0 ^ #decimals
end

local function same(expected, printed)
  local a, x = split(expected)
  local b, y = split(printed)
  if a ~= b or #x ~= #y then return false end
  for i = 1, #x do
    if math.abs(tonumber(x[i]) - tonumber(y[i])) > tolerance(x[i]) then return false end
  end
  return true
end

local function lines(text)
  local list = {}
  for line in text:gmatch("([^\n]*)\n") do list[#list + 1] = (line:gsub("%s+$", "")) end
  return list
end

local source = read(script)
local start = source:find(opening, 1, true)
local out = run_in_empty_folder()

if update then
  local file = assert(io.open(script, "wb"))
  local code = (start and source:sub(1, start - 1) or source):gsub("%s+$", "")
  file:write(code, "\n", opening, table.concat(lines(out), "\n"), "\n]]\n")
  file:close()
  os.exit(0)
end

assert(start, script .. " has no comment '--[[ prints' at its end")
local expected, printed = lines(source:sub(start + #opening):match("^(.-)%]%]%s*$")), lines(out)
local failed = #expected ~= #printed
if failed then print(("%d lines printed, %d in the comment"):format(#printed, #expected)) end
for i = 1, math.max(#expected, #printed) do
  if not same(expected[i] or "", printed[i] or "") then
    failed = true
    print(("line %d\n  comment: %s\n  printed: %s"):format(i, expected[i] or "(nothing)", printed[i] or "(nothing)"))
  end
end
os.exit(not failed)
