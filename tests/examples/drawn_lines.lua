-- What is drawn in an SVG file of plot: its words in their order, and where there is ink of each colour. Two such
-- drawings are the same when an eye could not tell them apart: the same words, and no ink further than a pixel (a quarter
-- of a millimetre) from ink of the same colour. So another version of cairo, or a rounding that lets the thinning of
-- a curve choose a neighbouring point, is no difference; another motion is.

local drawn_lines = {}

local stride = 100000 -- cells are pixels, numbered x * stride + y

local function paint(cells, x0, y0, x1, y1)
  local steps = math.ceil(2 * math.max(math.abs(x1 - x0), math.abs(y1 - y0))) + 1
  for i = 0, steps do
    local x, y = x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps
    cells[math.floor(x) * stride + math.floor(y)] = true
  end
end

-- "M 1 2 L 3 4 C 1 2 3 4 5 6 Z": of a curve, the line to its end.
local function paint_path(cells, path)
  local x0, y0
  for letter, numbers in path:gmatch "([MLC])([^MLCZ]*)" do
    local x, y = numbers:match "(%-?[%d.]+)[%s,]+(%-?[%d.]+)%s*$"
    x, y = tonumber(x), tonumber(y)
    if letter ~= "M" and x0 then paint(cells, x0, y0, x, y) end
    x0, y0 = x, y
  end
end

--- { words = { ... }, ink = { ["stroke rgb(0%,45%,70%)"] = cells, ... } } of the text of an SVG file.
function drawn_lines.read(svg)
  local words, ink = {}, setmetatable({}, { __index = function(all, key)
    all[key] = {}
    return all[key]
  end })
  for word in svg:gmatch "<text[^>]*>(.-)</text>" do words[#words + 1] = word end
  for path in svg:gmatch "<path[^>]*>" do
    for _, kind in ipairs{ "stroke", "fill" } do -- one of them; as style, or as attributes in newer versions of cairo
      local colour = path:match("%f[%a]" .. kind .. "[:=]\"?(rgb%b())")
      if colour then paint_path(ink[kind .. " " .. colour:gsub("%s", ""):gsub("%.%d+", "")], path:match " d=\"([^\"]*)\"") end
    end
  end
  return { words = words, ink = setmetatable(ink, nil) }
end

-- The first cell of ink that has nobody near in the other drawing.
local function lonely(ink, other)
  for cell in pairs(ink) do
    if not other[cell] then
      local found = false
      for dx = -1, 1 do
        for dy = -1, 1 do found = found or other[cell + dx * stride + dy] end
      end
      if not found then return cell end
    end
  end
end

--- nil when they look the same, else a sentence.
function drawn_lines.difference(a, b)
  local words_a, words_b = table.concat(a.words, " | "), table.concat(b.words, " | ")
  if words_a ~= words_b then return "the words are other ones:\n  " .. words_a .. "\n  " .. words_b end
  for _, pair in ipairs{ { a.ink, b.ink }, { b.ink, a.ink } } do
    for key, cells in pairs(pair[1]) do
      local cell = lonely(cells, pair[2][key] or {})
      if cell then
        return ("%s is at x = %d, y = %d in one of them only"):format(key, cell // stride, cell % stride)
      end
    end
  end
end

return drawn_lines
