"""What the tests of the prompt share: the program, which is their first argument, and a folder of its own for each."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from screen import Terminal
from session import Session

PROGRAM = os.path.abspath(sys.argv.pop(1))
HAS_READLINE = "edited with GNU Readline" in subprocess.run([PROGRAM, "--version"], capture_output=True, text=True).stdout


class AtHome(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.home = pathlib.Path(folder.name)

    def session(self, *arguments, **options):
        session = Session(PROGRAM, self.home, arguments, **options)
        self.addCleanup(session.child.close, True)
        return session

    def terminal(self, *arguments, **options):
        terminal = Terminal(PROGRAM, self.home, *arguments, **options)
        self.addCleanup(terminal.close)
        return terminal
