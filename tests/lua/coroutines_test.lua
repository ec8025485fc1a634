-- The functions of coroutines, which the program replaces so that Ctrl-C and limits stop what runs in them.
dofile "tests/lua/support.lua"

test("coroutine functions behave as in standard Lua", function()
    equal(select("#", coroutine.resume(coroutine.create(function(...) return ... end), 1, nil, nil)), 4)
    local wrapped = coroutine.wrap(function(a) local b = coroutine.yield(a + 1) error("bad " .. b) end)
    equal(wrapped(1), 2)
    local ok, message = pcall(wrapped, "x")
    assert(not ok and message:find("coroutines_test.lua:%d+: bad x"), message)
    ok, message = pcall(wrapped)
    assert(not ok, message)
    has(message, "cannot resume dead coroutine")
    refused {
        { "coroutine.resume(1)", "bad argument #1 to 'resume'", "thread expected" },
        { "coroutine.wrap(1)", "bad argument #1 to 'wrap'" },
        { "coroutine.close(coroutine.running())", "cannot close a running coroutine" },
    }
    local co = coroutine.create(function() coroutine.yield() end)
    coroutine.resume(co)
    equal(coroutine.close(co), true)
    equal(coroutine.status(co), "dead")
    local value = {}
    ok, message = coroutine.resume(coroutine.create(function() error(value) end))
    assert(not ok and message == value)
    equal(debug.gethook(), nil)
end)

finish()
