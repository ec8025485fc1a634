-- The Spanish tutorial and sheets show the very sessions of the English ones, which are tested: block by block.
package.path = "tests/lua/?.lua;" .. package.path
local support = require "support"

local function blocks(name)
  local list = {}
  for block in support.read(name):gmatch "```console\n(.-)```" do list[#list + 1] = block end
  return list
end

for spanish, english in pairs {
  ["tutorial"] = "docs/tutorial.md", ["hoja-1"] = "docs/lab/1-free-decay.md", ["hoja-2"] = "docs/lab/2-sticking.md",
} do
  support.test(spanish .. " has the blocks and the questions of " .. english, function()
    local there, here = blocks(english), blocks("docs/es/" .. spanish .. ".md")
    support.equal(#here, #there)
    for i = 1, #there do support.equal(here[i], there[i]) end
    local function questions(name)
      local found = {}
      for question in support.read(name):gmatch "%*%*(%d%l)%*%*" do found[#found + 1] = question end
      return table.concat(found, " ")
    end
    support.equal(questions("docs/es/" .. spanish .. ".md"), questions(english))
  end)
end

support.finish()
