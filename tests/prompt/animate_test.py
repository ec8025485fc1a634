"""run:animate() on a terminal. Usage: animate_test.py PROGRAM"""

import re
import sys
import unittest

sys.dont_write_bytecode = True  # no folder __pycache__ in the source tree

from home import AtHome
from screen import CTRL_C

RUN = ("run = system{ I = 1, k = 4, Rd = 0.3, Re = 0.5, walls = { lower = -0.6 } }:simulate"
       "{ theta0 = 1, t_end = 20, times = {} }")


class Animation(AtHome):
    def start(self, **options):
        terminal = self.terminal(**options)
        terminal.enter(RUN)
        return terminal

    def test_the_mass_moves_and_stays_where_it_stuck(self):
        terminal = self.start()
        shown = terminal.enter("run:animate{ speed = 20 }").split("\n")
        self.assertEqual(len(shown), 5, shown)  # one frame is left, the last
        self.assertRegex(shown[0], r"^t = 20\.0+  θ = [-+0-9.]+ rad  stuck$")
        self.assertIn("▓▓▓▓▓", shown[1])
        self.assertIn("▓▓▓▓▓", shown[2])
        self.assertRegex(shown[2], r"^▐[/\\]{8,}▓")
        places = set(re.findall(r"θ = ([-+0-9.]+)", terminal.raw.decode()))
        self.assertGreater(len(places), 5)
        self.assertTrue(terminal.raw.rfind(b"\x1b[?25h") > terminal.raw.rfind(b"\x1b[?25l"))  # the cursor is back

    def test_a_terminal_of_20_columns_gets_lines_that_fit(self):
        terminal = self.start(width=20)
        terminal.enter("run:animate{ speed = 50 }")
        self.assertEqual(len(terminal.lines()), 8, terminal.text())  # the call takes two of them, the prompt one

    def test_ctrl_c_ends_it(self):
        terminal = self.start()
        terminal.type("run:animate{ speed = 0.1 }\r")
        terminal.shows("θ = ")
        terminal.type(CTRL_C)
        terminal.shows("interrupted")
        terminal.wait(lambda: terminal.lines()[-1] == ">")
        self.assertIn(b"\x1b[?25h", terminal.raw)
        self.assertEqual(terminal.enter("6 * 7"), "42")

    def test_plain_characters_where_they_are_asked_for(self):
        terminal = self.start()
        shown = terminal.enter("run:animate{ speed = 50, ascii = true }")
        self.assertTrue(shown.isascii(), shown)
        self.assertIn("XXXXX", shown)


if __name__ == "__main__":
    unittest.main()
