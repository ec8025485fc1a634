-- minimise{ over, run }: minima that are known, and refused input. Run by dinal.
dofile "tests/lua/support.lua"

test("the least value over one parameter is found, inside and at the ends", function()
    local best = minimise{ over = { x = { -1, 3 } }, run = function(p) return (p.x - 0.7) ^ 2 + 2 end }
    near(best.x, 0.7, 1e-7)
    near(best.value, 2, 1e-14)
    assert(best.calls < 60, best.calls)
    near(minimise{ over = { x = { 1, 3 } }, run = function(p) return -p.x end }.x, 3, 1e-7)
    near(minimise{ over = { x = { 0, 1e-6 } }, run = function(p) return (p.x * 1e6 - 0.2) ^ 4 end }.x, 0.2e-6, 1e-9)
    -- The lower one of two valleys, and a wall of infinities.
    near(minimise{ over = { x = { 0, 10 } }, run = function(p) return math.cos(p.x) + 0.1 * p.x end }.x, math.pi - math.asin(0.1), 1e-6)
    near(minimise{ over = { x = { 0, 1 } }, run = function(p) return p.x < 0.4 and math.huge or p.x end }.x, 0.4, 1e-6)
end)

test("the least value over two parameters is found, also in a curved valley", function()
    local best = minimise{ over = { x = { -2, 2 }, y = { -1, 3 } }, run = function(p) return (1 - p.x) ^ 2 + 100 * (p.y - p.x ^ 2) ^ 2 end }
    near(best.x, 1, 1e-5)
    near(best.y, 1, 1e-5)
    best = minimise{ over = { a = { 0, 1 }, b = { 0, 5 } }, run = function(p) return p.a + (p.b - 2) ^ 2 end }
    near(best.a, 0, 1e-7)
    near(best.b, 2, 1e-6)
end)

test("mistakes in the call are errors with a reason", function()
    local function run() return 1 end
    refuses(minimise, {
        { { run = run }, "minimise needs over" },
        { { over = { x = { 1, 2 } } }, "minimise needs run" },
        { { over = { x = { 1 } }, run = run }, "over.x must be the two limits of x" },
        { { over = { x = { 2, 1 } }, run = run }, "over.x must be the two limits of x" },
        { { over = { a = { 1, 2 }, b = { 1, 2 }, c = { 1, 2 } }, run = run }, "more than two parameters" },
        { { over = { value = { 1, 2 } }, run = run }, "'value' is a field of the result" },
        { { over = { x = { 1, 2 } }, run = function() end }, "run returned nil at x = 1" },
        { { over = { x = { 1, 2 } }, run = function() return 0 / 0 end }, "run returned" },
    })
    equal(pcall(minimise, { over = { x = { 1, 2 } }, run = function() error("mine") end }), false)
end)

finish()
