-- report{}: all items appear in HTML and in Markdown, no text is taken for markup, and wrong items are refused.
dofile "tests/lua/support.lua"


local function saved(r, ending)
    local name = temporary(ending)
    r:save(name)
    return read(name), name
end

local sys = system{ I = 1, k = 40, Rd = 1, Re = 1.5 }
local run = sys:simulate{ theta0 = 1, t_end = 6, dt = 0.01 }

test("a report has all kinds of items, in their order, on one page", function()
    local r = report{ title = "Decay <1>", author = "A & B" }
    r:heading "Results"
    r:text "First & foremost.\n\nSecond paragraph."
    r:add("omega0", sys.omega0)
    r:add("T0", sys.T0)
    r:add(run)
    r:table(data{ n = { 1, 2 }, ["a|b"] = { 0.5, 0.25 } })
    r:plot{ { run.t, run.theta, label = "theta" }, xlabel = "t" }
    r:plot(run:plot{ show = false })
    local page = saved(r, ".html")
    local place = 1
    for _, part in ipairs{ "<!DOCTYPE html>", "<title>Decay &lt;1&gt;</title>", "<h1>Decay &lt;1&gt;</h1>", "A &amp; B",
        "<h2>Results</h2>", "<p>First &amp; foremost.</p>", "<p>Second paragraph.</p>", "omega0 = 6.32", "\nT0 = 0.99",
        "601 rows", "It made", "How to repeat this run", "simulate", "<th>a|b</th>", "<td>0.25</td>", "</html>" } do
        local found = page:find(part, place, true)
        assert(found, part .. " is not there, or not in its place")
        place = found
    end
    equal(select(2, page:gsub("<svg", "")), 2)
    local ids = {}
    for id in page:gmatch ' id="([^"]+)"' do
        assert(not ids[id], id)
        ids[id] = true
    end
    assert(next(ids))
    assert(not page:find "<%?xml")
    has_not(page, "<1>")
end)

test("names of columns are not markup, invalid bytes are not letters, and a table is shown with its content", function()
    local r = report{ title = "x" }
    r:table(data{ { "<b>a</b>", { 1 } }, { "`c` [d](e)", { 2 } } })
    r:text "\xff and \xc3\xa4"
    r:add{ 1, "two", { three = 3 } }
    r:add("list", { 1, 2 })
    local page = saved(r, ".html")
    assert(not page:find "<b>" and utf8.len(page), page)
    has(page, "\u{FFFD} and \u{E4}")
    r = report{ title = "a\nb\27]0;c\7", author = "\127\194\155x" }
    r:text "\226\128\174turned"
    r:add "\27[2J\tkept\255"
    local text = saved(r, ".html")
    assert(utf8.len(text) and not text:find "[%z\1-\8\11-\31\127]", text)
    assert(not text:find "\194\155" and not text:find "\226\128\174" and text:find "\tkept", text)
    has(page, '{ 1, &quot;two&quot;, { three = 3 } }\nlist = { 1, 2 }')
    refused { { "r:add{ io.stdout }", "r:add: this table contains values that cannot be shown" } }
end)

test("wide items do not widen the page, and long ones may continue on the next sheet", function()
    local r = report{ title = "x" }
    r:table(data{ n = vector.linspace(1, 40, 40) })
    r:add(("line\n"):rep(40))
    r:add "short"
    local page = saved(r, ".html")
    has(page, '<div class="table" style="overflow-x: auto"><table>\n<thead>')
    has(page, '<pre class="long">line')
    has(page, "overflow-wrap: anywhere", "only light")
    has(page, "padding: .15em .5em; overflow-wrap: anywhere") -- on paper no column is beyond the edge
end)

test("an animation is on the page", function()
    local r = report{ title = "x" }
    r:animate(run, { speed = 2, from = 1, to = 3 })
    r:animate(run)
    local page = saved(r, ".html")
    equal(select(2, page:gsub("<title>A run in motion, t = 1 to 3</title>", "")), 1)
    local first, second = page:match 'id="(%S+)%-floor0".*id="(%S+)%-floor0"'
    assert(first ~= second)
    has(page, "url(#" .. first .. "-floor0)", "url(#" .. second .. "-floor0)", 'dur="1.000s"')
    has(page, "A run in motion, t = 0 to 6", "animateTransform")
    refused {
        { "r:animate(3)", "r:animate takes a run, got 3" },
        { 'r:animate(run, { file = "x.svg" })', "file" },
    }
end)

test("an animation of several bodies is on the page with all of them", function()
    local rig = system{ bodies = { motor = { I = 1 }, load = { I = 3 } }, links = { clutch = { "motor", "load", Rd = 2 } } }
    local r = report{ title = "x" }
    r:animate(rig:simulate{ velocity0 = { motor = 3 }, t_end = 1 })
    has(saved(r, ".html"), "2 bodies as discs on one axis")
end)

test("the end of CDATA in a label leaves the picture well formed", function()
    local r = report{ title = "x" }
    r:plot{ { run.t, run.theta, label = "]]><!--" }, title = "]]>", xlabel = "a]]]>" }
    local picture = saved(r, ".html"):match "<svg.-</svg>"
    has_not(picture, "]]>")
    has(picture, "a]]]&gt;")
end)

test("an item that cannot be reported is refused with a reason", function()
    refuses(report, {
        { {}, "report needs title" },
        { { title = 3 }, "title must be" },
        { { title = " " }, "report: the title is empty" },
    })
    local r = report{ title = "x" }
    refused {
        { "r:text()", "what is added must be text, got nil" },
        { "r:table(3)", "r:table takes data" },
        { "r:plot(3)", "r:plot takes what plot{ ... } takes" },
        { "r:plot{ { run.t } }", "plot" },
        { "r:add(nil)", "r:add takes" },
        { 'r:save "x.doc"', "must end in .html" },
        { 'r:save "/nowhere/x.html"', "/nowhere/x.html" },
    }
    equal(tostring(r), 'report "x" with 0 parts')
end)

finish()
