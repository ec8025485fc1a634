"""The progress line and Ctrl-C in long runs, as a terminal shows them. Usage: progress_test.py PROGRAM"""

import re
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True  # no folder __pycache__ in the source tree

from home import PROGRAM, AtHome
from screen import Screen
from session import AT_ONCE, CTRL_C, PATIENCE, processor_time

import pexpect

# Longer than any test waits; a native excitation, so that nothing but the stepping loop runs.
LONG = "nondimensional{ zeta = 0.1 }:simulate{ M = excitation.harmonic{ frequency = 0.7 }, t_end = 1e9, times = {} }"
LINE = re.compile(r" *\d+% ")


class Program(Screen):
    """It may end before anything is seen."""

    def read(self, seconds):
        try:
            self.stream.feed(self.child.read_nonblocking(65536, seconds))
            return True
        except pexpect.TIMEOUT:
            return True
        except pexpect.EOF:
            return False

    def lines(self):
        return [line.rstrip() for line in self.screen.display if line.strip()]

    def until(self, condition):
        """Waits until the lines on the screen are as wanted."""
        end = time.monotonic() + PATIENCE
        while not (self.lines() and condition(self.lines())) and time.monotonic() < end:
            if not self.read(0.05):
                break
        assert self.lines() and condition(self.lines()), self.lines()
        return self.lines()

    def until_the_end(self):
        end = time.monotonic() + PATIENCE
        while self.read(0.5):
            assert time.monotonic() < end, self.lines()
        return self.lines()


def progress_lines(lines):
    return [line for line in lines if "% " in line]


class TerminalTest(AtHome):
    def start(self, *arguments, **options):
        terminal = Program(PROGRAM, self.home, *arguments, **{"height": 12, **options})
        self.addCleanup(terminal.close)
        return terminal


class TheLine(TerminalTest):
    def test_a_long_run_shows_fraction_rate_and_time_left(self):
        shown = self.start("-e", LONG).until(progress_lines)
        self.assertEqual(len(shown), 1)
        self.assertRegex(shown[0], r"^  0% ▕ +▏ t = [\d.e+]+ of 1e\+09, [\d.e+]+/s, .* left$")

    def test_it_moves_on_in_one_line_and_is_gone_at_the_end(self):
        terminal = self.start("-e", "for i in progress(9, 'sweep') do os.execute 'sleep 0.3' end "
                              "print 'done'")
        first = terminal.until(progress_lines)
        later = terminal.until(lambda lines: progress_lines(lines) and re.search(" [6-8] of 9", lines[-1]))
        self.assertEqual((len(first), len(later)), (1, 1))
        done, rate, left = re.fullmatch(r"sweep +\d+% ▕█+.*▏ (\d) of 9, ([\d.]+)/s, (\d) s left", later[0]).groups()
        self.assertLessEqual(abs(int(left) - (9 - int(done)) / float(rate)), 1)
        self.assertEqual(terminal.until_the_end(), ["done"])

    def test_it_fits_every_window_also_one_that_changes(self):
        terminal = self.start("-e", LONG, width=132)
        terminal.until(progress_lines)
        for columns, pattern in [(80, "left$"), (40, "left$"), (20, "left$"), (10, "0%$"), (60, "left$")]:
            with self.subTest(columns):
                terminal.child.setwinsize(12, columns)
                terminal.until(lambda lines: len(lines) == 1 and columns / 4 < len(lines[0]) < columns)
                self.assertRegex(terminal.lines()[0], pattern)

    def test_ascii_where_the_locale_or_the_terminal_know_no_more(self):
        for variables in ({"LC_ALL": "C"}, {"TERM": "dumb"}):
            with self.subTest(variables):
                shown = self.start("-e", LONG, **variables).until(progress_lines)
                self.assertRegex(shown[0], r"^  0% \[\.+\] t = ")

    def test_a_dumb_terminal_gets_no_escape_codes(self):
        terminal = self.start("-e", LONG, TERM="dumb")
        seen = b""
        while b"%" not in seen:
            seen += terminal.child.read_nonblocking(65536, PATIENCE)
        terminal.child.send(CTRL_C)
        seen += terminal.child.read()
        self.assertNotIn(b"\x1b", seen)

    def test_what_is_printed_stands_in_lines_of_its_own(self):
        # The line is there from the fifth step on.
        code = ("for i in progress(9, 'loop') do os.execute 'sleep 0.12' "
                "local ways = { print, function(i) io.write(i, '\\n') end, function(i) io.stdout:write(i, '\\n') end, "
                "function(i) io.stderr:write(i, '\\n') end } ways[i % 4 + 1](i) end")
        terminal = self.start("-e", code)
        terminal.until(progress_lines)
        self.assertEqual(terminal.until_the_end(), [str(i) for i in range(1, 10)])

    def test_a_line_that_is_not_yet_ended_is_left_alone(self):
        code = "for i in progress(8) do os.execute 'sleep 0.12' io.write(i, ' ') io.flush() end"
        self.assertEqual(self.start("-e", code).until_the_end(), ["1 2 3 4 5 6 7 8"])

    def test_loops_within_loops_are_one_line(self):
        code = ("for i in progress(2, 'outer') do for j in progress({ 'a', 'b', 'c', 'd' }, 'inner') do "
                "os.execute 'sleep 0.14' end end print 'done'")
        terminal = self.start("-e", code)
        shown = terminal.until(lambda lines: "62%" in lines[-1])
        self.assertRegex(shown[0], r"^outer +62% .* 1 of 2, ")
        self.assertEqual(terminal.until_the_end(), ["done"])

    def test_a_loop_that_is_left_takes_its_line_along(self):
        code = ("local function loop(leave) for i in progress(10) do os.execute 'sleep 0.12' "
                "if i == 6 then if leave == 'break' then break elseif leave == 'error' then error() else return end end end end "
                "for _, leave in ipairs{ 'break', 'error', 'return' } do pcall(loop, leave) print(leave) end io.read()")
        terminal = self.start("-e", code)
        terminal.until(progress_lines)
        self.assertEqual(terminal.until(lambda lines: lines[-1] == "return"), ["break", "error", "return"])

    def test_a_loop_in_a_coroutine_that_is_forgotten_leaves_no_line(self):
        code = ("coroutine.wrap(function() for i in progress(10) do os.execute 'sleep 0.12' "
                "if i == 6 then coroutine.yield() end end end)()")
        terminal = self.start("-i", "-e", code)
        terminal.until(progress_lines)
        shown = terminal.until(lambda lines: lines[-1] == ">")
        self.assertEqual(progress_lines(shown), [])

    def test_short_work_shows_nothing(self):
        terminal = self.start("-e", "for i in progress(3) do nondimensional{}:simulate{ theta0 = 1, t_end = 1, dt = 1 } end")
        seen = b""
        while True:
            try:
                seen += terminal.child.read_nonblocking(65536, PATIENCE)
            except (pexpect.EOF, pexpect.TIMEOUT):
                break
        self.assertEqual(seen, b"")

    def test_nothing_where_standard_error_is_no_terminal(self):
        code = "for i in progress(8) do os.execute 'sleep 0.12' end"
        done = subprocess.run([PROGRAM, "-e", code], capture_output=True, timeout=PATIENCE)
        self.assertEqual((done.stdout, done.stderr, done.returncode), (b"", b"", 0))


class AtThePrompt(TerminalTest):
    def interrupted_run(self, **options):
        terminal = self.start(**options)
        terminal.until(lambda lines: lines[-1] == ">")
        terminal.child.send(LONG.replace("times = {}", "dt = 1e6, integrator = integrator.rk4{ h = 0.01 }") + "\r")
        terminal.until(progress_lines)
        before = processor_time(terminal.child.pid)
        terminal.child.send(CTRL_C)
        shown = terminal.until(lambda lines: lines[-1] == ">")
        self.assertLess(processor_time(terminal.child.pid) - before, AT_ONCE)
        return terminal, shown

    def test_ctrl_c_stops_the_run_and_keeps_what_was_done(self):
        terminal, shown = self.interrupted_run()
        self.assertEqual([line for line in shown if "▕" in line], [])
        self.assertTrue(any("interrupted at input:1" in line for line in shown), shown)
        terminal.child.send("print(ans.outcome, #ans > 0, #ans.events > 0, ans == dinal.partial)\r")
        terminal.until(lambda lines: re.fullmatch("interrupted +true +true +true", lines[-2]))

    def test_the_session_goes_on(self):
        terminal, _ = self.interrupted_run(width=40, LC_ALL="C")
        terminal.child.send("6*7\r")
        terminal.until(lambda lines: lines[-2:] == ["42", ">"])

    def test_each_input_of_a_limited_session_has_its_own_time(self):
        terminal = self.start("--safe", "--max-time", "0.5")
        terminal.until(lambda lines: lines[-1] == ">")
        time.sleep(0.6)  # typing takes its time
        terminal.child.send("6*7\r")
        terminal.until(lambda lines: lines[-2:] == ["42", ">"])
        terminal.child.send("while true do end\r")
        shown = terminal.until(lambda lines: lines[-1] == ">" and "max-time" in lines[-2])
        self.assertIn("stopped at input:1: it ran longer than the 0.5 s", shown[-2])
        terminal.child.send("7*7\r")
        terminal.until(lambda lines: lines[-2:] == ["49", ">"])


if __name__ == "__main__":
    unittest.main()
