-- What is drawn in an SVG file of gnuplot: its words in their order, and where there is ink of each colour. Two such
-- drawings are the same when an eye could not tell them apart: the same words, and no ink further than a pixel (a quarter
-- of a millimetre) from ink of the same colour. So another version of gnuplot, or a rounding that lets the thinning of
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

-- "M1,2 L3,4 M5,6 ..." or "1,2 3,4 ...": without a letter the pen stays down.
local function paint_path(cells, path)
  local x0, y0
  for letter, x, y in path:gmatch "(%a?)%s*(-?[%d.]+),(-?[%d.]+)" do
    x, y = tonumber(x), tonumber(y)
    if letter ~= "M" and x0 then paint(cells, x0, y0, x, y) end
    x0, y0 = x, y
  end
end

local function colour(kind, text) return kind .. text:gsub("%s", "") end

--- { words = { ... }, ink = { ["line rgb(0,114,178)"] = cells, ... } } of the text of an SVG file.
function drawn_lines.read(svg)
  local words, ink = {}, setmetatable({}, { __index = function(all, key)
    all[key] = {}
    return all[key]
  end })
  for word in svg:gmatch "<text>(.-)</text>" do words[#words + 1] = word end
  for stroke, path in svg:gmatch "<path%s+stroke%s*=%s*'([^']*)'[^>]-%sd%s*=%s*'([^']*)'" do
    paint_path(ink[colour("line ", stroke)], path)
  end
  for fill, points in svg:gmatch "<polygon%s+fill%s*=%s*'([^']*)'[^>]-points%s*=%s*'([^']*)'" do
    paint_path(ink[colour("fill ", fill)], points)
  end
  local point = "<use xlink:href='#(%w+)' transform='translate%(([%d.]+),([%d.]+)%)[^']*' color='([^']*)'"
  for shape, x, y, own in svg:gmatch(point) do
    paint(ink[colour(shape .. " ", own)], x, y, x, y)
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
