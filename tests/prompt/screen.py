"""A session of dinal on a terminal whose screen can be looked at (needs the Debian packages python3-pexpect, -pyte)."""

import time

import pexpect
import pyte

from session import PATIENCE, environment

CTRL_C, CTRL_D, CTRL_R, TAB, UP, LEFT, ENTER = "\x03", "\x04", "\x12", "\t", "\x1b[A", "\x1b[D", "\r"


class Screen:
    """A program, and what it has drawn."""

    def __init__(self, program, home, *arguments, width=80, height=30, **variables):
        self.screen = pyte.Screen(width, height)
        self.stream = pyte.ByteStream(self.screen)
        self.child = pexpect.spawn(program, list(arguments), env=environment(home, **variables), cwd=str(home),
                                   dimensions=(height, width), timeout=PATIENCE)
        self.child.delaybeforesend = None
        self.raw = b""

    def close(self):
        try:
            self.child.close(force=True)
        except pexpect.ExceptionPexpect:
            self.child.wait()  # it was killed, but a busy machine has not ended it yet


class Terminal(Screen):
    """Every look at the screen waits until it shows what is looked for."""

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        self.wait(lambda: self.lines() and self.lines()[-1] == ">")

    def lines(self):
        """What stands on the screen, without blanks at the ends of lines."""
        rows = [row.rstrip() for row in self.screen.display]
        while rows and not rows[-1]:
            rows.pop()
        return rows

    def text(self):
        return "\n".join(self.lines())

    def read(self, seconds):
        try:
            data = self.child.read_nonblocking(65536, seconds)
        except (pexpect.TIMEOUT, pexpect.EOF):
            return False
        self.raw += data
        self.stream.feed(data)
        return True

    def wait(self, condition):
        end = time.monotonic() + PATIENCE
        while not condition():
            if not self.read(0.05) and time.monotonic() > end:
                raise AssertionError("never came:\n" + self.text())
        while self.read(0.02):
            pass  # what belongs to the same stroke

    def shows(self, text):
        self.wait(lambda: text in self.text())

    def type(self, keys):
        self.child.send(keys)

    def at_prompt(self, prompt):
        """In the last line, where that of a chunk that goes on says in grey what it waits for."""
        last = self.lines()[-1]
        return last == prompt or (prompt == ">>" and last.startswith(">> ") and "; Ctrl-C" in last)

    def enter(self, line, prompt=">"):
        """Types a line; the lines that it prints, up to the next prompt."""
        self.screen.reset()
        self.screen.cursor_position()
        self.child.send(line + ENTER)
        self.wait(lambda: self.lines()[1:] and self.at_prompt(prompt))
        return "\n".join(self.lines()[:-1]).partition("\n")[2]

    def row(self):
        """The row of the cursor."""
        return self.screen.display[self.screen.cursor.y].rstrip()

    def colour(self, word):
        """The colour of the first letter of the word, on the row of the cursor."""
        y = self.screen.cursor.y
        return self.screen.buffer[y][self.screen.display[y].index(word)].fg

    def resize(self, width):
        """A window with another width, which cuts what stands behind."""
        self.screen.resize(columns=width)
        self.child.setwinsize(self.screen.lines, width)
