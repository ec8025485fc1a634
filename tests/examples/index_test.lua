-- The index of the examples is complete, each example says its idea first, and the data are what their script makes.
--
--     dinal index_test.lua PROGRAM EXAMPLES

local program, examples = arg[1], arg[2]

local function read(name)
  local file = assert(io.open(name, "rb"))
  local text = file:read("a")
  file:close()
  return text
end
local function quoted(text) return "'" .. text:gsub("'", "'\\''") .. "'" end
local function listing(folder)
  local names, pipe = {}, assert(io.popen("ls " .. quoted(folder)))
  for name in pipe:lines() do
    if name:find("%.lua$") then names[#names + 1] = name end
  end
  pipe:close()
  return names
end

local index = read(examples .. "/README.md")
local count = 0
for _, folder in ipairs{ "", "report/", "data/" } do
  for _, name in ipairs(listing(examples .. "/" .. folder)) do
    count = count + 1
    local path = folder .. name
    assert(index:find("](" .. path .. ")", 1, true), path .. " is not in examples/README.md")
    local first = read(examples .. "/" .. path):match("^[^\n]*")
    assert(first:find("^%-%- .+%S"), path .. " does not begin with a comment that says its idea")
    local number = name:match("^(%d%d%d)%-") or name:match("^fig0?(%d+)%.")
    assert(not number or first:find(number, 1, true), path .. " does not say its number first")
  end
end
for path in index:gmatch("%]%(([%w/.-]+)%)") do
  assert(io.open(examples .. "/" .. path), "examples/README.md names " .. path .. ", which is not there"):close()
end
assert(count >= 33, "only " .. count .. " scripts found in " .. examples)

-- data/record.csv against data/make-record.lua: another libm may turn a last digit
local folder = os.tmpname()
os.remove(folder)
assert(os.execute(("mkdir %s && cd %s && %s %s >.out"):format(quoted(folder), quoted(folder), quoted(program),
  quoted(examples .. "/data/make-record.lua"))))
local made, shipped = load(folder .. "/record.csv"), load(examples .. "/data/record.csv")
os.execute("rm -r " .. quoted(folder))
assert(#made == 801 and #shipped == 801)
assert((made.t - shipped.t):abs():max() == 0)
assert((made.acceleration - shipped.acceleration):abs():max() < 1.5e-4)
assert(math.abs(shipped.acceleration:abs():max() - 3) < 1e-9)
