-- Ctrl-C stops whatever runs, in coroutines and behind pcall, too; the program then ends with 130.
dofile "tests/lua/support.lua"

--- Runs a script and sends SIGINT when it has said that it is up and has then computed for 0.1 s. No clock decides: the
--- time is that of the processor, and so is the limit. Returns the exit code and the output.
local runner = [[
    out=$3
    (ulimit -t 20; exec env --default-signal=INT "$1" "$2") >"$out" 2>&1 &
    pid=$!
    runs() { read -r _ _ state _ </proc/$pid/stat && [ "$state" != Z ]; }
    used() { cut -d " " -f 14,15 /proc/$pid/stat | { read -r user system; echo $((user + system)); }; }
    until grep -q "^up$" "$out" || ! runs; do sleep 0.01; done
    began=$(used)
    while runs && [ $(($(used) - began)) -lt 10 ]; do sleep 0.01; done
    kill -INT $pid
    wait $pid
    echo "exit $?" >>"$out"]]
local function interrupted(code)
    local name, output, shell = temporary ".lua", temporary(), temporary ".sh"
    write(name, 'print "up" io.stdout:flush() ' .. code)
    write(shell, runner)
    os.execute(("sh %s '%s' %s %s"):format(shell, program(), name, output))
    local text = read(output)
    return tonumber(text:match "exit (%d+)\n$"), text
end

local function check(code, output)
    local exit, text = interrupted(code)
    equal(exit, 130, text)
    assert(text:find "^up\n", text)
    has(text, "dinal: interrupted") -- by its own word, not by the signal
    if output then
        assert(text:find(output, 1, true), text)
    end
end

test("a loop in Lua", function() check "while true do end" end)

test("a loop that swallows errors with pcall or xpcall", function()
    check "while true do pcall(function() while true do end end) end"
    check "while true do xpcall(function() while true do end end, function(e) return e end) end"
    check "while true do pcall(error) end"
end)

test("a loop inside of coroutines", function()
    check "coroutine.wrap(function() while true do end end)()"
    check "while true do coroutine.resume(coroutine.create(function() while true do end end)) end"
    check [[
        local inner = coroutine.wrap(function() while true do coroutine.yield(1) end end)
        local outer = coroutine.wrap(function() while true do inner() coroutine.yield(2) end end)
        while true do outer() end]]
    check [[
        local co = coroutine.create(function() local x <close> = setmetatable({}, { __close = function() while true do end end }) coroutine.yield() end)
        coroutine.resume(co)
        coroutine.close(co)]]
end)

test("a long run with a native excitation", function()
    check "nondimensional{ zeta = 0.1 }:simulate{ M = excitation.harmonic{ frequency = 0.7 }, t_end = 1e9, times = {} }"
end)

test("a run that computes long between two events, or has many rows there", function()
    local sys = "nondimensional{ friction_ratio = 0.5, breakaway_ratio = 0.9 }:simulate"
    -- At rest under loads that never reach the limit together, which nobody knows before.
    check(sys .. "{ M = 0.5*excitation.harmonic{ frequency = 1 } + 0.3*excitation.harmonic{ frequency = 1.1 } + 0.2*"
        .. "excitation.pulse{ width = 1, at = -3 }, t_end = 1e12, times = {} }")
    check "nondimensional{}:simulate{ M = 0.1*excitation.harmonic{ frequency = 1e6 }, theta0 = 1, t_end = 1e9, times = {} }"
    check "nondimensional{}:simulate{ theta0 = 1, t_end = 10, dt = 1e-7 }"
end)

test("a long run with a scripted excitation, also in a coroutine", function()
    check "nondimensional{ zeta = 0.1 }:simulate{ M = function(t) return math.sin(t) end, t_end = 1e9, times = {} }"
    check [[coroutine.wrap(function()
        nondimensional{ zeta = 0.1 }:simulate{ M = function(t) return math.sin(t) end, t_end = 1e9, times = {} }
    end)()]]
end)

test("a search for a steady motion", function()
    check "nondimensional{ friction_ratio = 0.01 }:steady{ M = excitation.harmonic{ frequency = 1e-9 } }"
end)

test("M that does not return", function()
    check "nondimensional{}:simulate{ M = function(t) while t > 0.5 do end return 1 end, t_end = 1, dt = 0.1 }"
end)

test("coroutine functions behave as those of Lua", function()
    equal(select("#", coroutine.resume(coroutine.create(function(...) return ... end), 1, nil, nil)), 4)
    local wrapped = coroutine.wrap(function(a) local b = coroutine.yield(a + 1) error("bad " .. b) end)
    equal(wrapped(1), 2)
    local ok, message = pcall(wrapped, "x")
    assert(not ok and message:find("interrupt_test.lua:%d+: bad x"), message)
    ok, message = pcall(wrapped)
    assert(not ok, message)
    has(message, "cannot resume dead coroutine")
    raises(function() coroutine.resume(1) end, "bad argument #1 to 'resume'", "thread expected")
    raises(function() coroutine.wrap(1) end, "bad argument #1 to 'wrap'")
    raises(function() coroutine.close(coroutine.running()) end, "cannot close a running coroutine")
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
