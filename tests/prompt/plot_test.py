"""Plots on a terminal: as wide as it is, in colour. Usage: plot_test.py PROGRAM [unittest arguments]"""

import sys
import unittest

sys.dont_write_bytecode = True  # no folder __pycache__ in the source tree

from home import AtHome

RUN = "run = nondimensional{ zeta = 0.1 }:simulate{ M = 3, theta0 = 1, t_end = 3, dt = 0.01 }"


class PlotTest(AtHome):
    def start(self, **variables):
        session = self.session(**variables)
        session.enter(RUN)
        return session

    def raw(self, session, line):
        """What appears until the next prompt, escape sequences included."""
        session.press(line + "\r")
        session.child.expect_exact(session.prompt)
        return session.child.before

    def test_a_plot_is_shown_once_and_fits_the_screen(self):
        session = self.start()
        shown = session.enter("run:plot()").split("\n")
        self.assertEqual(sum("M/k" in line for line in shown), 1)
        self.assertLessEqual(max(map(len, shown)), 79)
        self.assertTrue(20 <= len(shown) <= 22, len(shown))

    def test_a_picture_that_is_not_drawn_is_shown_by_the_prompt(self):
        session = self.start()
        self.assertIn("M/k", session.enter("run:plot{ show = false }"))
        self.assertNotIn("M/k", session.enter("p = run:plot{ show = false }"))
        self.assertIn("M/k", session.enter("p"))
        self.assertEqual(session.enter("p"), session.enter("print(p)"))  # its blanks, too

    def test_curves_have_colours_unless_the_user_or_the_terminal_has_none(self):
        session = self.start()
        self.assertIn("\x1b[36m", self.raw(session, "run:plot()"))
        session.enter('run:plot{ file = "run.txt" }')
        self.assertNotIn("\x1b", (self.home / "run.txt").read_text())
        self.assertNotIn("\x1b[36m", self.raw(self.start(NO_COLOR="1"), "run:plot()"))

    def test_a_dumb_terminal_gets_ascii(self):
        # readline says nothing of pasting to a dumb terminal, so the prompt is only known by its text
        session = self.start(TERM="dumb", prompt="> ")
        shown = session.enter("run:plot()")
        self.assertIn("theta", shown)
        self.assertTrue(shown.isascii(), shown)


if __name__ == "__main__":
    unittest.main()
