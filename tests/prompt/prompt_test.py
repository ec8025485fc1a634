"""What a user sees at the prompt. Usage: prompt_test.py PROGRAM [unittest arguments]"""

import stat
import sys
import time
import unittest

sys.dont_write_bytecode = True  # no folder __pycache__ in the source tree

from home import HAS_READLINE, AtHome
from session import AT_ONCE, CONTINUATION, CTRL_C, CTRL_D, ENTER, UP, end, processor_time

check = unittest.TestCase()
equal, contained = check.assertEqual, check.assertIn



class SessionTest(AtHome):
    def run_on(self, session, code):
        """Types code that runs for long, and waits until it does: until it has called busy()."""
        session.enter("function busy() io.write('run', 'ning', '\\n') io.flush() busy = os.time end")
        session.press(code + ENTER)
        session.child.expect_exact("running\r\n")

    def interrupted(self, session, code):
        """What is shown when Ctrl-C stops the code, which it does at once."""
        self.run_on(session, code)
        before = processor_time(session.child.pid)
        session.press(CTRL_C)
        shown = session.until_prompt()
        self.assertLess(processor_time(session.child.pid) - before, AT_ONCE)
        return shown.replace("^C", "")


class PromptTest(SessionTest):
    """With readline: its escape sequences show where the prompt is."""

    @classmethod
    def setUpClass(cls):
        if not HAS_READLINE:
            raise unittest.SkipTest("built without readline")


class Values(PromptTest):
    def test_the_first_line_names_the_version_and_the_way_out(self):
        self.assertRegex(self.session().greeting, r"dinal \d+\.\d+\.\d+ \(Lua 5\.4\.\d+\): help\(\) for help, Ctrl-D to")

    def test_expressions_are_shown_without_print_and_kept_in_ans(self):
        session = self.session()
        equal(session.enter("1 + 1"), "2")
        equal(session.enter("ans * 1.5"), "3.0")
        equal(session.enter("'a\"b'"), r'"a\"b"')
        equal(session.enter("{ 1, x = { 2 } }"), "{ 1, x = { 2 } }")
        equal(session.enter("= ans.x[1]"), "2")
        equal(session.enter("y = 5"), "")
        equal(session.enter("y, nil"), "5\tnil")
        equal(session.enter("y = 6; y"), "6")
        equal(session.enter("y = 7; z = y; y + z;"), "")
        equal(session.enter("ans"), "14")
        equal(session.enter("s = 'a;b'; s"), '"a;b"')
        equal(session.enter("for i = 1, 2 do y = i; z = i end; z"), "2")
        equal(session.enter("y = 1; print(y)"), "1")

    def test_an_error_is_told_and_the_session_goes_on(self):
        session = self.session()
        equal(session.enter("error('oh')"), "input:1: oh")
        contained("syntax error near 'b'", session.enter("a b"))
        equal(session.enter("1"), "1")

    def test_os_exit_at_the_prompt_gives_its_code(self):
        session = self.session()
        session.press("os.exit(3)" + ENTER)
        equal(session.exit_code(), 3)

    def test_lua_code_reads_the_next_line_that_is_typed(self):
        session = self.session()
        self.run_on(session, "busy() name = io.read()")
        session.enter("Coulomb")
        equal(session.enter("name"), '"Coulomb"')

    def test_a_script_with_i_is_followed_by_the_prompt(self):
        (self.home / "lab.lua").write_text("w = 42 print(...)\n")
        session = self.session("-i", "lab.lua", "here")
        contained("here", session.greeting)
        equal(session.enter("w"), "42")


class Lines(PromptTest):
    def test_a_chunk_may_take_several_lines(self):
        session = self.session()
        equal(session.enter("function f(x)", CONTINUATION), "")
        equal(session.enter("return 2*x", CONTINUATION), "")
        equal(session.enter("end"), "")
        equal(session.enter("f(", CONTINUATION), "")
        equal(session.enter("21)"), "42")

    def test_a_pasted_block_runs_once_and_shows_its_last_value(self):
        session = self.session()
        session.press("\x1b[200~n = (n or 0) + 1\nfor i = 1, 2 do\n\tprint('line', i)\nend\nn * 10\x1b[201~")
        shown = session.enter("")
        self.assertRegex(shown, r"line\s+1\nline\s+2\n10$")

    def test_ctrl_d_in_a_continuation_drops_it_and_ctrl_d_at_the_prompt_leaves(self):
        session = self.session()
        session.enter("f(", CONTINUATION)
        session.press(CTRL_D)
        contained("near <eof>", session.until_prompt())
        equal(session.enter("1"), "1")  # and no blank line before it
        equal(session.leave(), 0)
        self.assertTrue(session.child.before.endswith("\r\n"))

    def test_a_dumb_terminal_gets_no_escape_sequences(self):
        session = self.session(prompt="> ", TERM="dumb")
        session.press("{ 1, 'two' }" + ENTER)
        session.child.expect_exact('{ 1, "two" }\r\n> ')
        equal(session.leave(), 0)
        self.assertNotIn("\x1b", session.greeting + session.child.before)

    def test_prompts_can_be_set_as_in_lua(self):
        session = self.session()
        session.press("_PROMPT = 'lab> '" + ENTER)
        session.until_prompt("lab> ")
        session.press("_G = setmetatable(_G, { __index = function(_, k) error(k) end }) _PROMPT = nil" + ENTER)
        session.until_prompt()


class History(PromptTest):
    def test_entries_of_several_lines_come_back_whole_in_the_next_session(self):
        first = self.session()
        first.enter("for i = 1, 2 do", CONTINUATION)
        first.enter("  print(i)", CONTINUATION)
        first.enter("end")
        first.enter("'later'")
        equal(first.leave(), 0)
        second = self.session()
        second.press(UP + UP)
        self.assertTrue(second.enter("").endswith("1\n2"))

    def test_the_up_arrow_moves_within_a_block(self):
        session = self.session()
        session.enter("do", CONTINUATION)
        session.enter("  x = 1", CONTINUATION)
        session.enter("end")
        session.press(UP + UP + "y")  # the block, and the line above its end: "  xy = 1"
        session.enter("")
        equal(session.enter("xy"), "1")

    def test_the_file_is_for_its_user_only(self):
        session = self.session(XDG_STATE_HOME=str(self.home / "some" / "state"))
        session.enter("1")
        folder = self.home / "some" / "state" / "dinal"
        equal(stat.S_IMODE(folder.stat().st_mode), 0o700)
        equal(stat.S_IMODE((folder / "history").stat().st_mode), 0o600)
        contained("\n1\n", (folder / "history").read_text())

    def test_a_session_that_ends_by_os_exit_is_kept(self):
        session = self.session()
        session.press("os.exit()" + ENTER)
        session.exit_code()
        contained("os.exit()", (self.home / ".local/state/dinal/history").read_text())

    def test_the_prompt_works_where_no_history_can_be_written(self):
        session = self.session(XDG_STATE_HOME="/dev/null")
        equal(session.enter("1 + 1"), "2")

    def test_blank_and_repeated_lines_are_not_kept(self):
        session = self.session()
        for line in ["'a'", "", "'b'", "'b'"]:
            session.enter(line)
        session.press(UP + UP)
        self.assertTrue(session.enter("").endswith('"a"'))


class Interrupts(PromptTest):
    def test_ctrl_c_clears_the_line_and_drops_a_continuation(self):
        session = self.session()
        session.press("x = 1 -- never")
        session.press(CTRL_C)
        session.until_prompt()
        equal(session.enter("x"), "nil")
        session.enter("do", CONTINUATION)
        session.press("x = 2")
        session.press(CTRL_C)
        session.until_prompt()
        equal(session.enter("x"), "nil")

    def test_ctrl_c_stops_lua_code_and_keeps_the_session(self):
        session = self.session()
        for line in ["busy() while true do end", "coroutine.wrap(function() busy() while true do end end)()",
                     "while true do pcall(function() busy() while true do end end) end",
                     "return setmetatable({}, { __tostring = function() busy() while true do end end })",
                     "return { 1, { setmetatable({}, { __tostring = function() busy() while true do end end }) } }"]:
            self.assertRegex(self.interrupted(session, line), r"^\n?interrupted( at input:1)?\n")
            equal(session.enter("1 + 1"), "2")

    def test_a_second_ctrl_c_ends_c_code_that_never_returns(self):
        session = self.session()
        self.run_on(session, "busy() return ('a'):rep(40):find(('a-'):rep(40) .. 'b')")
        began = processor_time(session.child.pid)
        while processor_time(session.child.pid) - began < AT_ONCE:  # before find is called, one would stop the Lua code
            time.sleep(0.05)
        while session.child.isalive():  # two that come at the same time, to a machine that does other work, are one
            session.press(CTRL_C)
            time.sleep(0.3)
        equal(session.exit_code(), 130)

    def test_the_rows_of_an_interrupted_run_are_kept_in_ans(self):
        session = self.session()
        session.enter("nd = nondimensional{ zeta = 0.01 }")
        # busy() when there are rows already; a native M is asked for its value by nobody, but its terms may be scripted
        for M in ["function(t) if t > 9 then busy() end return math.sin(t) end",
                  "excitation.harmonic{ amplitude = 1, frequency = 0.3 } + "
                  "excitation.scripted(function(t) if t > 9 then busy() end return 0 end)"]:
            shown = self.interrupted(session, f"return nd:simulate{{ M = {M}, t_end = 1e6, dt = 1 }}")
            contained("interrupted at input:1", shown)
            contained("the finished part of the run is in dinal.partial and in ans (ans:continue()\ncontinues it):\n", shown)
            equal(session.enter("#ans > 0 and #ans < 1000001 and #ans.theta == #ans"), "true")

    def test_a_run_that_is_stopped_within_M_is_marked_interrupted(self):
        session = self.session()
        session.enter("function M(t) if t > 9 then busy() while true do end end return 1 end")
        self.interrupted(session, "nondimensional{}:simulate{ M = M, t_end = 20, dt = 1 }")
        equal(session.enter("ans.outcome"), '"interrupted"')

    def test_ctrl_c_is_not_lost_while_keys_are_read(self):
        # The terminal throws away what was typed before: readline must not wait for a key that is gone.
        session = self.session()
        for i in range(200):
            session.press("x = 1 -- never")
            session.press(CTRL_C)
            session.until_prompt()
        equal(session.enter("x"), "nil")

    def test_the_rows_of_a_run_whose_excitation_failed_are_kept_in_ans(self):
        session = self.session()
        session.enter("M = function(t) if t > 2 then error('broken') end return 0 end")
        shown = session.enter("nondimensional{}:simulate{ M = M, t_end = 10, dt = 0.1 }")
        contained("input:1: broken", shown)
        contained("is in dinal.partial and in ans", shown)
        equal(session.enter("ans.t[#ans] > 1.5"), "true")
        self.assertNotIn("ans", session.enter("error('another')"))  # the old run is not announced again

    def test_a_closed_terminal_ends_the_program(self):
        session = self.session()
        self.assertTrue(end(session.child))


class PlainLines(SessionTest):
    """What a build without readline does at a terminal; one with readline does it, too, on a dumb one."""

    def session(self, *arguments):
        return super().session(*arguments, prompt="\n> ", TERM="dumb")

    def test_lines_continuations_and_both_control_keys(self):
        session = self.session()
        session.enter("1")
        session.press("x = (" + ENTER)
        session.until_prompt("\n>> ")
        session.enter("7)")
        session.press("x = 8")
        session.press(CTRL_C)
        session.until_prompt()
        equal(session.enter("x"), "7")
        session.press("f(" + ENTER)
        session.until_prompt("\n>> ")
        session.press(CTRL_D)
        contained("near <eof>", session.until_prompt())
        contained("interrupted at input:1", self.interrupted(session, "busy() while true do end"))
        equal(session.leave(), 0)


if __name__ == "__main__":
    unittest.main()
