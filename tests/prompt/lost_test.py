"""Somebody who is lost at the prompt: pasted lines, other languages, blocks that go on. Usage: lost_test.py PROGRAM"""

import sys
import unittest

sys.dont_write_bytecode = True  # no folder __pycache__ in the source tree

import pexpect

from home import PROGRAM, AtHome
from session import CONTINUATION, ESCAPES, PATIENCE, environment

check = unittest.TestCase()
equal, contained = check.assertEqual, check.assertIn

RUN = "run = nondimensional{ zeta = 0.1 }:simulate{ theta0 = 1, t_end = 1.2, dt = 0.1 }"
RIGHT, PASTE, PASTED = "\x1b[C", "\x1b[200~", "\x1b[201~"


class Walked(AtHome):
    """What a student, a MATLAB user and an engineer typed, and where they stuck."""

    CASES = (
        ("x = 0:0.1:1", "vector.range(0, 1, 0.1)"),
        ("v = vector{1, 2}", ""),
        ("v .* v", "act on each element"),
        ("v.^2", "act on each element"),
        ("v(end)", "the last element of v is v[#v]"),
        ("v[v > 0 & v < 1]", "in Lua and, or and not are words"),
        ("% comment", "a comment begins with --"),
        ("f = @(t) 2*t", "a function is written: function(t) return 2*t end"),
        ("%matplotlib inline", "no magic commands"),
        ("clear all", ":reset deletes your variables"),
        ("hold on", "several curves are one picture"),
        ("size(v)", "#x"),
        ("zeros(3)", "vector.linspace(0, 0, n)"),
        ("ode45(1, 2)", "sys:simulate"),
        ("fft(v)", "run:spectrum()"),
        ("bode(sys)", "sys:response"),
        ("title('x')", "plot{ { x, y }, title"),
        ("plt.plot(v)", "plot(x, y)"),
        ("save('run.mat')", 'run:save("run.csv")'),
        (":record lab.lua", ":save writes your inputs to a script"),
        ("save run.csv", 'run:save("run.csv")'),
        ("load de.csv", 'load "file.csv"'),
        ("load 'table.xlsx'", "save the table as CSV"),
        ("excitation.samples(data{ t = {0, 1}, M = {0, 1} })", "excitation.samples{ t = d.t, M = d.M }"),
        ("for i in range(5): print(i)", "a loop is: for i = 1, 10 do ... end"),
        ("while x < n: print(x)", "a loop is: while x < 3 do ... end"),
        ("if x > n: print(x)", "in Lua: if x > 3 then ... end"),
        ("a = { k = 1, C = 2 }", ""),
        ("a.T0", "there is no 'T0' in it: it has C, k"),
        ("run = nondimensional{}:simulate{ theta0 = 1, t_end = 2, dt = 0.1 }", ""),
        ("run:to_csv('x.csv')", "did you mean 'save'?"),
        ("dir(run)", "Tab after a name and a point lists its fields"),
        ("cd", ":cd folder changes the current folder"),
        ("ls", ":ls lists the files"),
        ("cd /tmp", ":cd folder changes the current folder"),
        ("cd ..", ":cd folder changes the current folder"),
        ("ls *.lua", ":ls lists the files"),
        ("ls -l", ":ls lists the files"),
        ("ayuda()", "help() starts a tour"),
        ("excitation.ramps{}", "did you mean 'ramp'?"),
        ("excitation.whatever{}", "it has constant, harmonic"),
        ("_", "ans holds the last value"),
        ("run.whatisit", "it also has at, columns"),
        ("2*run.events[1]", "as in run.events[1].theta"),
        ("run.events[run.events.theta > 0]", "rows are selected by d:filter"),
    )

    def test_each_line_is_answered_with_what_to_type(self):
        session = self.session()
        for line, answer in self.CASES:
            shown = " ".join(session.enter(line).split())
            contained(answer, shown, line)
            self.assertTrue(answer or not shown, f"{line}: {shown}")

    def test_an_error_is_not_blamed_on_the_line_of_an_earlier_one(self):
        session = self.session()
        M = "function(t) return sin(t) end"
        contained("in M at t = 0", session.enter(f"system{{ I = 1, k = 1 }}:simulate{{ M = {M}, t_end = 1 }}"))
        shown = session.enter("sin(3)")
        contained("1 | sin(3)", shown)
        self.assertNotIn("in M", shown)


class Folders(AtHome):
    def test_the_current_folder_is_shown_changed_and_listed(self):
        session = self.session()
        (self.home / "inner").mkdir()
        (self.home / "inner" / "a.lua").write_text("")
        equal(session.enter(f":cd {self.home}"), str(self.home))
        contained("inner/", session.enter(":ls"))
        self.assertTrue(session.enter(":cd inner").endswith("/inner"))
        equal(session.enter(":ls"), "a.lua")
        self.assertTrue(session.enter(":pwd").endswith("/inner"))
        contained("No such file", session.enter(":cd nowhere"))
        equal(session.enter(":cd"), str(self.home))

    def test_safe_mode_stays_where_it_is(self):
        session = self.session("--safe")
        contained("not possible in safe mode", session.enter(":cd /"))
        contained("the current folder only", session.enter(":ls /"))


class Pasted(AtHome):
    def test_a_prompt_in_front_is_no_part_of_the_line(self):
        session = self.session()
        for line in ("> 6 * 7", ">> 6 * 7", "dinal> 6 * 7", "In [12]: 6 * 7", "  > 6 * 7"):
            equal(session.enter(line), "42", line)
        equal(session.enter("> ?tutorial").split()[0], "help()")
        session.enter("> for i = 1, 2 do", CONTINUATION)
        session.enter(">   print(i)", CONTINUATION)
        equal(session.enter("> end"), "1\n2")

    def test_a_dialogue_is_typed_again_and_what_it_printed_is_left_out(self):
        session = self.session()
        session.press(PASTE + "> a = 6\n> a * 7\n42\n> for i = 1, 2 do\n>> print(i) end\n1\n2\n> a" + PASTED + "\r")
        shown = session.until_prompt()
        self.assertTrue(shown.rstrip().endswith("42\n1\n2\n6"), shown)

    def test_a_comparison_in_a_chunk_that_was_typed_stays_one(self):
        session = self.session()
        session.enter("x = (2", CONTINUATION)
        session.enter("> 1)", None)
        equal(session.enter("x"), "true")


class Blocks(AtHome):
    def test_a_block_says_what_it_waits_for_and_how_to_leave_it(self):
        terminal = self.terminal()
        terminal.type("for i = 1, 2 do\r")
        terminal.wait(lambda: terminal.row() == ">> line 1 waits for end; Ctrl-C cancels it")
        terminal.type("f{ i,\r")
        terminal.wait(lambda: terminal.row() == ">> { of line 2 waits for }; Ctrl-C cancels it")
        terminal.type("i")
        terminal.wait(lambda: terminal.row() == ">> i")

    def test_an_empty_line_and_words_for_leaving_are_answered(self):
        session = self.session()
        session.enter("for i = 1, 2 do", CONTINUATION)
        contained("(line 1 waits for end; Ctrl-C cancels it)", session.enter("", CONTINUATION))
        contained("(for of line 1 waits for end; Ctrl-C cancels it, and :quit then leaves dinal)",
                  session.enter("quit", CONTINUATION))
        equal(session.enter("print(i) end"), "1\n2")

    def test_the_arrow_up_brings_the_lines_of_the_block_back(self):
        session = self.session()
        session.enter("1 + 1")
        session.enter("for i = 1, 2 do", CONTINUATION)
        session.enter("print(10*i)", CONTINUATION)
        session.press("\x1b[A\r")
        session.until_prompt(CONTINUATION)
        equal(session.enter("end"), "10\n10\n20\n20")
        session.press("\x1b[A\r")  # the whole block, and no line of it alone
        self.assertTrue(session.until_prompt().rstrip().endswith("10\n10\n20\n20"))

    def test_a_colon_at_the_end_of_a_line_opens_no_block(self):
        contained("a colon needs the name of a method after it; a loop is: for i = 1, 10 do ... end",
                  self.session().enter("range(10):").replace("\n", " "))


class Words(AtHome):
    def test_hints_teach_what_works(self):
        session = self.session()
        session.enter(RUN)
        for line, method in (("max(run.theta)", "run.theta:max()"), ("sin(run.t)", "run.t:sin()"),
                             ("math.sin(2*run.t)", "(2*run.t):sin()"), ("explain(run)", "run:explain()")):
            shown = session.enter(line).replace("\n", " ")
            contained(f"did you mean '{method}'?", shown)
            self.assertNotIn("attempt", session.enter(method))
        for line, hint in (("2**3", "a power is x^2"), ("system I = 1", "write its options in braces: system{ ... }"),
                           ("run.events[10].t", "'run.events' has 2 elements"), ("who", ":who lists your variables"),
                           ("quit", ":quit or Ctrl-D leaves"),
                           ("5%", "5 percent are 5/100"),
                           ("hilfe", "help() starts a tour"), ("salir", ":quit or Ctrl-D leaves"),
                           ("run.theta[0]", "('run.theta' has 13 elements, which are counted from 1)"),
                           ("run.theta[99]", "('run.theta' has 13 elements)"),
                           ("run.events[1].theat", "there is no 'theat' in it; did you mean 'theta'?"),
                           ("log10(2)", "math.log(x, 10)")):
            contained(hint, session.enter(line).replace("\n", " "), line)

    def test_names_that_are_overwritten_are_noticed_and_come_back(self):
        session = self.session()
        contained("(system was a name of dinal", session.enter("system = 3"))
        session.enter("system = dinal.system")
        equal(session.enter("system{ I = 1, k = 1 }.omega0"), "1.0")
        contained("(math.pi existed before", session.enter("math.pi = 3"))
        session.enter(":reset")
        equal(session.enter("math.pi > 3"), "true")
        equal(session.enter("x = { system = 3 }"), "")
        equal(session.enter("local system = 3 print(system)"), "3")

    def test_ans_survives_a_look(self):
        session = self.session()
        session.enter("x = 1")
        session.enter("6 * 7")
        session.enter("x")
        equal(session.enter("ans"), "42")

    def test_help_answers_words_that_are_no_names(self):
        session = self.session()
        for word in ("degrees", "tutorial", "DRAAR", "READDIN", "DINAL", "governor", "noise", "fit", "dt",
                     "how do I fit a record", "matlab", "kernel", "safe", "limits", "Reibung", "rozamiento", "Dämpfung"):
            self.assertNotIn("nothing about", session.enter("?" + word), word)


class Typing(AtHome):
    def test_history_suggests_the_end_of_a_line_and_the_arrow_takes_it(self):
        terminal = self.terminal()
        terminal.enter("answer = 6*7")
        terminal.type("ans")
        terminal.wait(lambda: terminal.row() == "> answer = 6*7")
        equal(terminal.colour("wer"), "black")  # bright, as pyte calls it
        terminal.type("x")
        terminal.wait(lambda: terminal.row() == "> ansx")
        terminal.type("\x7f")
        terminal.wait(lambda: terminal.row() == "> answer = 6*7")
        terminal.type(RIGHT + "+1\r")
        terminal.enter("")
        equal(terminal.enter("answer"), "43")

    def test_tab_after_an_event_and_after_integrator(self):
        session = self.session()
        session.enter(RUN)
        session.press("run.events[1].th\t\r")
        contained("-0.7292", session.until_prompt())
        session.press("s = nondimensional{}:simulate{ theta0 = 1, t_end = 1, dt = 0.5, integrator = integrator.sp\t} }\r")
        session.until_prompt()
        contained("by spectral", session.enter("s"))

    def test_a_long_text_stops_at_the_end_of_the_page(self):
        session = self.session(PAGER="less")
        session.press("?simulate\r")
        session.child.expect_exact("Space goes on, q ends --")
        session.press(" ")
        session.child.expect_exact("lines: Space goes on, q ends --")
        session.press("q")
        session.until_prompt()
        equal(session.enter("6 * 7"), "42")

    def test_a_window_of_one_row_and_two_columns(self):
        child = pexpect.spawn(PROGRAM, env=environment(self.home), cwd=str(self.home), dimensions=(1, 2), timeout=PATIENCE)
        self.addCleanup(child.close, True)
        child.expect_exact("?2004h")
        for keys in ("p\t\t", "n", "\x03", "run:\t\t\x03"):
            child.send(keys)
        child.expect_exact("?2004h")
        child.setwinsize(1, 80)
        child.setwinsize(1, 2)
        child.send("os.exit(7)\r")
        child.expect(pexpect.EOF)
        child.close()
        equal((child.exitstatus, child.signalstatus), (7, None))

    def test_the_next_page_has_the_size_of_the_window_by_then(self):
        session = self.session(PAGER="less")
        session.press("?simulate\r")
        session.child.expect_exact("Space goes on, q ends --")
        session.child.setwinsize(12, 40)
        session.press(" ")
        session.child.expect_exact(" lines: Space goes on")
        shown = ESCAPES.sub("", session.child.before).splitlines()[:-1]
        rows = sum(max(1, -(-len(line) // 40)) for line in shown)  # the terminal goes on in the next row
        self.assertLessEqual(rows, 11, shown)
        self.assertGreater(rows, 7, shown)
        session.press("q")
        session.until_prompt()


if __name__ == "__main__":
    unittest.main()
