"""Ctrl-C in a sweep at the prompt: what is done is kept, and the same call goes on if it has a file. Usage: sweep_test.py PROGRAM"""

import sys
import time
import unittest

sys.dont_write_bytecode = True  # no folder __pycache__ in the source tree

from home import AtHome
from session import CTRL_C, PATIENCE

# Each point notes itself and takes 5 ms of processor time.
POINT = ("function point(p) local file <close> = io.open('points', 'a') file:write(p.x, '\\n') local t = os.clock() "
         "while os.clock() - t < 0.005 do end return { y = 2*p.x } end")
SWEEP = "map = sweep{ over = { x = vector.linspace(1, 1000, 1000) }, workers = 2, file = 'map.csv', run = point }"


class Sweeps(AtHome):
    def setUp(self):
        super().setUp()
        self.prompt = self.session()

    def points(self):
        """How often each point was asked."""
        try:
            return (self.home / "points").read_text().split()
        except FileNotFoundError:
            return []

    def interrupt_after(self, count):
        self.prompt.press(SWEEP + "\r")
        until = time.monotonic() + PATIENCE
        while len(self.points()) < count and time.monotonic() < until:
            time.sleep(0.01)
        self.prompt.press(CTRL_C)
        return self.prompt.until_prompt()

    def test_what_is_done_is_kept_and_the_same_call_goes_on(self):
        self.prompt.enter(POINT)
        self.assertIn("interrupted", self.interrupt_after(20))
        done = int(self.prompt.enter("#dinal.partial"))
        self.assertGreaterEqual(done, 18)  # all but those that two workers were at
        self.assertLess(done, 1000)
        self.assertEqual(self.prompt.enter("dinal.partial.y == 2*dinal.partial.x"), "true")
        self.interrupt_after(len(self.points()) + 20)
        self.assertGreaterEqual(int(self.prompt.enter("#dinal.partial")), done + 18)
        self.prompt.enter(SWEEP)
        self.assertEqual(self.prompt.enter("map.y == vector.linspace(2, 2000, 1000)"), "true")
        asked = self.points()
        self.assertEqual(len(set(asked)), 1000)
        self.assertLessEqual(len(asked), 1004)  # what was broken off, twice two points, is asked again

    def test_another_sweep_begins_anew(self):
        self.prompt.enter(POINT)
        self.prompt.enter("factor = 1")
        self.interrupt_after(5)
        (self.home / "points").unlink()
        self.prompt.enter("sweep{ over = { x = { 1, 2, 3 } }, workers = 2, run = point }")
        self.assertEqual(len(self.points()), 3)


if __name__ == "__main__":
    unittest.main()
