"""Ctrl-C in a script: it ends at once, with exit code 130 and a word about where. Usage: interrupt_test.py PROGRAM"""

import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True  # no folder __pycache__ in the source tree

from home import PROGRAM
from session import AT_ONCE, PATIENCE, processor_time, time_until_end


SIMULATE = "nondimensional{{ zeta = 0.01, friction_ratio = 0.1 }}:simulate{{ M = {}, t_end = 1e7, dt = 1e4 }}"
LONG = {
    "a loop in Lua": "while true do end",
    "a loop in a coroutine that was resumed":
        "print(coroutine.resume(coroutine.create(function() while true do end end))) while true do end",
    "a loop in a wrapped coroutine": "coroutine.wrap(function() while true do end end)()",
    "a loop in a coroutine within a coroutine":
        "coroutine.wrap(function() coroutine.wrap(function() while true do end end)() end)()",
    "a pcall, and more code after it": "pcall(function() while true do end end) while true do end",
    "a loop of pcalls": "while true do pcall(function() while true do end end) end",
    "a loop of xpcalls": "while true do xpcall(function() while true do end end, function() return 1 end) end",
    "a pcall that is the last thing": "pcall(function() while true do end end)",
    "a reader of load": "load(function() while true do end end) while true do end",
    "a comparison in table.sort": "table.sort({3, 2, 1}, function(a, b) while true do end end)",
    "io.read": "io.read()",
    "a run with a native M": SIMULATE.format("excitation.harmonic{ amplitude = 1, frequency = 0.3 }"),
    "a run with M in Lua": SIMULATE.format("function(t) return math.sin(t) end"),
    "a run with feedback": SIMULATE.format("function(t, theta, velocity) return -0.1*velocity end"),
    "runs within pcall": "while true do pcall(function() " + SIMULATE.format(1) + " end) end",
    "a run in a coroutine": "coroutine.wrap(function() " + SIMULATE.format("math.sin") + " end)()",
    "M that never returns": SIMULATE.format("function(t) while true do end end"),
    "__close of a coroutine that is stopped":
        "coroutine.wrap(function() local x <close> = setmetatable({}, { __close = function() while true do end end }) "
        "while true do end end)()",
    "coroutine.close of a coroutine that was stopped":
        "local co = coroutine.create(function() local x <close> = setmetatable({}, { __close = function() while true "
        "do end end }) while true do end end) while true do pcall(coroutine.resume, co) pcall(coroutine.close, co) end",
    "coroutine.close that Lua calls on its way out":
        "local co = coroutine.create(function() local x <close> = setmetatable({}, { __close = function() while true "
        "do end end }) while true do end end) debug.setmetatable(co, { __close = coroutine.close }) "
        "local guard <close> = co coroutine.resume(co)",
    "a file being written": "local run = nondimensional{}:simulate{ theta0 = 1, t_end = 1000, dt = 1e-3 } go() while true do "
                            "pcall(run.save, run, TEMPORARY .. '.csv') end",
    "a record of 1989 being written": "local run = nondimensional{}:simulate{ theta0 = 1, t_end = 100, dt = 1e-3, integrator = "
                                      "integrator.rk4{ h = 1e-3 } } go() while true do pcall(run.save, run, TEMPORARY .. '.dat') end",
    "vectors": "local v = vector.linspace(0, 1, 3e6) go() while true do pcall(v.sin, v) pcall(function() return v^0.3 end) end",
    "values of an excitation": "local v, e = vector.linspace(0, 1, 3e6), excitation.harmonic{ frequency = 1 } go() while true do pcall(e.values, e, v) end",
    "the energy of a long run": "local run = nondimensional{ zeta = 0.01 }:simulate{ M = excitation.harmonic{ frequency = 0.7 }, t_end = 2e4, "
                                "times = {} } go() while true do run:energy() end",
    "points of a sweep that never end": "sweep{ over = { x = { 1, 2, 3 } }, run = function(p) while true do pcall(function() while true do end "
                                        "end) end end }",
    "runs within a sweep": "sweep{ over = { x = { 1, 2, 3 } }, workers = 2, run = function(p) " + SIMULATE.format("math.sin") + " end }",
    "a sweep within a sweep": "sweep{ over = { x = { 1, 2 } }, workers = 2, run = function() return { n = #sweep{ over = { y = { 1, 2 } }, run = "
                              "function() while true do end end } } end }",
    "plots": "local run = nondimensional{}:simulate{ theta0 = 1, t_end = 1000, dt = 1e-3 } go() while true do run:plot{ show = false } end",
    "a loop of pcalls of error": "while true do pcall(error) end",
    "coroutines that yield for ever":
        "local inner = coroutine.wrap(function() while true do coroutine.yield(1) end end) "
        "local outer = coroutine.wrap(function() while true do inner() coroutine.yield(2) end end) while true do outer() end",
    # At rest under loads that never reach the limit together, which nobody knows before.
    "a run that computes long between two events":
        "nondimensional{ friction_ratio = 0.5, breakaway_ratio = 0.9 }:simulate{ M = 0.5*excitation.harmonic{ frequency = 1 } + "
        "0.3*excitation.harmonic{ frequency = 1.1 } + 0.2*excitation.pulse{ width = 1, at = -3 }, t_end = 1e12, times = {} }",
    "a load that turns a million times a period":
        "nondimensional{}:simulate{ M = 0.1*excitation.harmonic{ frequency = 1e6 }, theta0 = 1, t_end = 1e9, times = {} }",
    "many rows between two events": "nondimensional{}:simulate{ theta0 = 1, t_end = 10, dt = 1e-6 }",
    "a search for a steady motion":
        "nondimensional{ friction_ratio = 0.01 }:steady{ M = excitation.harmonic{ frequency = 1e-9 } }",
    "__close": "local x <close> = setmetatable({}, { __close = function() while true do end end })",
}


class Interrupts(unittest.TestCase):
    def start(self, *command):
        process = subprocess.Popen([PROGRAM, *command], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        return process

    def interrupt(self, process):
        """Once it says that it runs; returns the exit code and standard error."""
        self.assertEqual(process.stdout.readline(), "running\n")
        time.sleep(0.1)
        before = processor_time(process.pid)
        process.send_signal(signal.SIGINT)
        self.assertLess(time_until_end(process) - before, 2 * AT_ONCE)  # the sanitizers look for leaks at the end
        return process.returncode, process.communicate()[1]

    def test_whatever_runs_stops(self):
        for what, code in LONG.items():
            with self.subTest(what), tempfile.NamedTemporaryFile("w", suffix=".lua") as script:
                start = "" if "go()" in code else "go()"  # a script with preparations says itself when it begins
                script.write("function go() print('running') io.stdout:flush() end "
                             f"TEMPORARY = {script.name!r} {start}\n{code}\nprint('never')\n")
                script.flush()
                code, errors = self.interrupt(self.start(script.name))
                self.assertEqual(code, 130)
                self.assertRegex(errors, r"^dinal: interrupted( at \S+:\d+)?\n$")

    def test_a_script_on_standard_input_stops(self):
        process = self.start("-")
        process.stdin.write("print('running') io.stdout:flush() while true do end")
        process.stdin.close()
        process.stdin = None
        self.assertEqual(self.interrupt(process), (130, "dinal: interrupted at stdin:1\n"))

    def test_code_that_is_waited_for_stops(self):
        process = self.start("-e", "print('running') io.stdout:flush()", "-")  # standard input stays open and silent
        self.assertEqual(self.interrupt(process), (130, "dinal: interrupted\n"))

    def test_lua_init_stops(self):
        os.environ["LUA_INIT"] = "print('running') io.stdout:flush() while true do end"
        self.addCleanup(os.environ.pop, "LUA_INIT")
        self.assertEqual(self.interrupt(self.start("-e", "print(1)"))[0], 130)

    def test_a_second_one_ends_code_that_never_returns(self):
        process = self.start("-e", "print('running') io.stdout:flush(); (('a'):rep(40)):find(('.-'):rep(40)..'b')")
        self.assertEqual(process.stdout.readline(), "running\n")
        time.sleep(0.2)
        process.send_signal(signal.SIGINT)
        time.sleep(1.5)  # not only a quick one
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=PATIENCE), 130)

    def test_a_key_that_is_held_down_is_one(self):
        code = "print('running') io.stdout:flush() local ok, e = pcall(function() while true do end end) error(e, 0)"
        process = self.start("-i", "-e", code)
        self.assertEqual([process.stdout.readline() for _ in range(2)][1], "running\n")
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=PATIENCE), 130)
        self.assertRegex(process.communicate()[1], "dinal: interrupted at")  # _exit(130) would say nothing

    def test_an_endless_finalizer_at_the_end_stops(self):
        loop = "setmetatable({}, { __gc = function() print('running') io.stdout:flush() while true do end end })"
        code, _ = self.interrupt(self.start("-e", loop))
        self.assertEqual(code, -signal.SIGINT)  # Lua cannot be stopped there, so the signal ends the process


if __name__ == "__main__":
    unittest.main()
