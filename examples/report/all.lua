-- All figures of the report, in its order: each by its own script, into the folder named after this one. Without a name
-- that is docs/report of the project, whose pictures are written over, or the current folder where the examples are
-- installed.
local here = debug.getinfo(1, "S").source:match("^@(.*/)") or ""

local function default_folder()
  local chapter = io.open(here .. "../../docs/report.md")
  if not chapter then return "." end
  chapter:close()
  return here .. "../../docs/report"
end

local folder = ... or default_folder()
local figures = {}
for name in ([[03 03bis 04 05a 05b 06 07 08 09 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 24bis 25 26 27]]):gmatch "%S+" do
  local figure = assert(loadfile(here .. "fig" .. name .. ".lua"))(folder, true) -- true: no numbers
  print(string.format("%-14s %s", figure.file:match "[^/]*$", figure.title))
  figures[#figures + 1] = figure
end
return figures
