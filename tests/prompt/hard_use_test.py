"""Hard use: signals, full pipes and disks, strangers' control sequences, Ctrl-C in a script. Usage: hard_use_test.py PROGRAM"""

import os
import resource
import signal
import subprocess
import sys
import time
import unittest

sys.dont_write_bytecode = True  # no folder __pycache__ in the source tree

from home import PROGRAM, AtHome
from session import PATIENCE, PROMPT

check = unittest.TestCase()
equal, contained = check.assertEqual, check.assertIn

LONG_FILE = ("local run = nondimensional{}:simulate{ theta0 = 1, t_end = 1000, dt = 1e-3 } print('running') "
             "io.stdout:flush() while true do run:save 'run.csv' end")
SMALL_RUN = "nondimensional{}:simulate{ theta0 = 1, t_end = 1000, dt = 1e-2 }"


class HardUse(AtHome):
    def start(self, *arguments, **options):
        process = subprocess.Popen([PROGRAM, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   cwd=self.home, **options)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def files(self):
        return sorted(entry.name for entry in self.home.iterdir())


class Signals(HardUse):
    def test_a_signal_that_ends_the_program_leaves_no_half_file(self):
        for number in (signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                process = self.start("-e", LONG_FILE)
                equal(process.stdout.readline(), "running\n")
                until = time.monotonic() + PATIENCE
                while not any(name.endswith(".tmp") for name in self.files()) and time.monotonic() < until:
                    pass
                process.send_signal(number)
                equal(process.wait(PATIENCE), -number)
                equal([name for name in self.files() if name != "run.csv"], [])

    def test_a_signal_that_is_ignored_stays_so(self):
        process = self.start("-e", "print('running') io.stdout:flush() io.read()", stdin=subprocess.PIPE,
                             preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        equal(process.stdout.readline(), "running\n")
        process.send_signal(signal.SIGHUP)
        equal(process.communicate("\n", PATIENCE)[1], "")
        equal(process.returncode, 0)

    def test_a_file_that_is_larger_than_allowed_is_an_error(self):
        process = self.start("-e", SMALL_RUN + ":save 'run.csv'",
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000)))
        errors = process.communicate(timeout=PATIENCE)[1]
        contained("cannot write 'run.csv': File too large", errors)
        equal((process.returncode, self.files()), (1, []))

    def test_a_reader_that_goes_away_does_not_end_a_session(self):
        session = self.session()
        session.enter("p = io.popen('true', 'w')")
        session.enter("for i = 1, 100 do p:write(('x'):rep(10000)) end p:close()")
        equal(session.enter("6 * 7"), "42")

    def test_after_a_stop_the_prompt_and_the_line_are_drawn_again(self):
        session = self.session()
        session.press("6 * ")
        session.child.expect_exact("*")
        session.child.kill(signal.SIGSTOP)
        session.child.kill(signal.SIGCONT)
        session.child.expect_exact("> ")
        session.press("7\r")
        contained("\n42\n", session.until_prompt())


class Limits(HardUse):
    def test_the_time_ends_though_nobody_reads(self):
        for stream in ("stderr", "stdout"):
            with self.subTest(stream):
                process = self.start("--max-time", "0.1", "-e", f"while true do io.{stream}:write(('x'):rep(65536)) end")
                contained(process.wait(5), (1, -signal.SIGPIPE))

    @unittest.skipUnless(os.path.exists("/dev/full"), "there is no /dev/full")
    def test_a_history_that_cannot_be_written_is_told_once(self):
        folder = self.home / ".local" / "state" / "dinal"
        folder.mkdir(parents=True)
        (folder / "history").symlink_to("/dev/full")
        session = self.session()
        contained("(this input is not in", session.enter("1 + 1").replace("\n", " "))
        equal(session.enter("2 + 2"), "4")

    def test_safe_mode_writes_scripts_only_where_scripts_are(self):
        session = self.session("--safe")
        session.enter("1 + 1")
        for command in (":save notes.txt", ":save .bashrc"):
            contained("does not end in .lua", session.enter(command))
        contained("are in lab.lua", session.enter(":save lab.lua"))
        equal([name for name in self.files() if not name.startswith(".")], ["lab.lua"])


class Strangers(HardUse):
    EVIL = "\x1b]0;owned\x07\x1b[2J\x1b[8m\x9b2J"

    def raw(self, session, line):
        session.press(line + "\r")
        session.child.expect_exact(PROMPT)
        shown = session.child.before
        return shown[shown.find("\n"):]

    def test_names_in_a_file_and_error_values_do_not_steer_the_terminal(self):
        (self.home / "evil.csv").write_text(f"t,\"{self.EVIL}\"\n0,1\n1,2\n", encoding="utf-8")
        session = self.session()
        escaped = self.EVIL.encode("unicode_escape").decode()
        for line in ("load 'evil.csv'", "print(load 'evil.csv')", "load('evil.csv').nothing",
                     "load('evil.csv').names", f"error('{escaped}')", f"error('{escaped}', 0)",
                     f"error(setmetatable({{}}, {{ __tostring = function() return '{escaped}' end }}))"):
            shown = self.raw(session, line)
            for sequence in ("\x1b]", "\x07", "\x1b[2J", "\x1b[8m", "\x9b"):
                self.assertNotIn(sequence, shown, line)

    def test_what_a_safe_script_prints_does_not_steer_the_terminal(self):
        session = self.session("--safe")
        escaped = self.EVIL.encode("unicode_escape").decode()
        for line in (f"print('{escaped}')", f"io.write('{escaped}')", f"io.stdout:write('{escaped}')",
                     f"io.stderr:write('{escaped}')", f"warn('@on') warn('{escaped}')", "io.write('\27') io.write(']0;owned\7')",
                     f"print(setmetatable({{}}, {{ __tostring = function() return '{escaped}' end }}))"):
            shown = self.raw(session, line)
            for sequence in ("\x1b]", "\x07", "\x1b[2J", "\x1b[8m", "\x9b"):
                self.assertNotIn(sequence, shown, line)
            contained("owned", shown, line)
        contained("\x1b[31mred\x1b[0m\tnil", self.raw(session, "print('\\27[31mred\\27[0m', nil)"))
        piped = subprocess.run([PROGRAM, "--safe", "-e", "print('\\27[2J', 1)"], capture_output=True, check=True)
        equal(piped.stdout, b"\x1b[2J\t1\n")


class Interrupted(HardUse):
    RUN = ("nondimensional{ zeta = 0.01 }:simulate{ M = function(t) if t > 500 and not told then told = true print('running') "
           "io.stdout:flush() end return math.sin(t) end, t_end = 1e7, dt = 1 }")

    def interrupted(self, code):
        process = self.start("-e", code)
        equal(process.stdout.readline(), "running\n")
        process.send_signal(signal.SIGINT)
        out, errors = process.communicate(timeout=PATIENCE)
        return process.returncode, out, errors

    def test_a_script_gets_what_was_done_and_can_save_it(self):
        code, out, errors = self.interrupted(
            "dinal.on_interrupt = function(run) run:save 'part.csv' print(run.outcome, #run > 5) end " + self.RUN)
        equal((code, out), (130, "interrupted\ttrue\n"))
        self.assertRegex(errors, "^dinal: interrupted")
        equal(self.files(), ["part.csv"])

    def test_an_error_in_it_is_told_and_a_second_ctrl_c_stops_it(self):
        code, _, errors = self.interrupted("dinal.on_interrupt = function() error 'oh' end " + self.RUN)
        equal(code, 130)
        contained("oh", errors)
        process = self.start("-e", "dinal.on_interrupt = function(run) print(run) io.stdout:flush() while true do end end "
                                   "print 'running' io.stdout:flush() while true do end")
        equal(process.stdout.readline(), "running\n")
        process.send_signal(signal.SIGINT)
        equal(process.stdout.readline(), "nil\n")  # there was no run
        process.send_signal(signal.SIGINT)
        equal(process.wait(PATIENCE), 130)


if __name__ == "__main__":
    unittest.main()
