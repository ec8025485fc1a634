-- The pictures of docs/ are those that docs/pictures.lua draws.
local program, examples = ...
local docs = examples .. "/../docs/"
local here = debug.getinfo(1, "S").source:match "^@(.*/)"
local drawn_lines = dofile(here .. "drawn_lines.lua")

local function read(path)
  local file = assert(io.open(path, "rb"))
  local text = file:read "a"
  file:close()
  return text
end

local folder = os.tmpname()
os.remove(folder)
assert(os.execute("mkdir '" .. folder .. "'"))
local drawn = assert(loadfile(docs .. "pictures.lua"))(folder)
assert(#drawn == 15)
for _, path in ipairs(drawn) do
  local name = path:match "[^/]*$"
  local now, kept = read(path), read(docs .. "pictures/" .. name)
  local difference = drawn_lines.difference(drawn_lines.read(now), drawn_lines.read(kept))
  assert(not difference, name .. " is not what docs/pictures.lua draws: " .. tostring(difference))
  assert(now:match "<desc>(.-)</desc>" == kept:match "<desc>(.-)</desc>", name .. " has another description")
end
for name, word in pairs{ ["stick-slip"] = "Stuck 5 times", hunting = "half swings", clutch = "motor θ&#39;: falls from 3 to 0.75" } do
  assert(read(docs .. "pictures/" .. name .. ".svg"):match("<desc>(.-)</desc>"):find(word, 1, true), name .. ": " .. word)
end
os.execute("rm -r '" .. folder .. "'")
