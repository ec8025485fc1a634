"""A session of dinal on a terminal, driven as a user would (needs the Debian package python3-pexpect)."""

import os
import re
import sys
import time

try:
    import pexpect
except ImportError:
    sys.exit("the tests of the prompt need pexpect: apt-get install python3-pexpect")

ESCAPES = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]|\x1b[=>]|\x07|\r")
# readline turns bracketed paste on just before it shows a prompt: nothing that Lua prints looks like that
PROMPT = "\x1b[?2004h> "
CONTINUATION = "\x1b[?2004h>> "
CTRL_C, CTRL_D, TAB, UP, ENTER = "\x03", "\x04", "\t", "\x1b[A", "\r"
PATIENCE = 60  # seconds: the sanitizers are slow, and the machine may do other work
# What stops, stops within this time of its own processor time, however little of it the machine gives. 0.1 s is
# promised; the sanitizers need more.
AT_ONCE = 0.5


def environment(home, **more):
    """The least that a session needs, so that nobody's own settings reach a test."""
    return {"HOME": str(home), "PATH": os.environ["PATH"], "TERM": "xterm", "LC_ALL": "C.UTF-8",
            "INPUTRC": "/dev/null", "PAGER": "cat", **more}


def processor_time(pid):
    """Seconds that the process has used: other than a clock, it stands still while the machine does other work."""
    with open(f"/proc/{pid}/stat", encoding="ascii", errors="replace") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def time_until_end(process):
    """Waits for the end of a subprocess; its processor time."""
    until = time.monotonic() + PATIENCE
    while os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT | os.WNOHANG) is None:
        if time.monotonic() > until:
            raise AssertionError("never ended")
        time.sleep(0.005)
    used = processor_time(process.pid)
    process.wait()
    return used


def end(child):
    """Hangs up, as a terminal that is closed; true when the program has ended."""
    child.ptyproc.fileobj.close()
    child.ptyproc.closed = child.closed = True
    until = time.monotonic() + PATIENCE
    while child.ptyproc.isalive():
        if time.monotonic() > until:
            return False
        time.sleep(0.01)
    return True


class Session:
    def __init__(self, program, home, arguments=(), prompt=PROMPT, **variables):
        self.prompt = prompt
        self.child = pexpect.spawn(program, list(arguments), env=environment(home, **variables), encoding="utf-8",
                                   cwd=str(home), dimensions=(24, 80), timeout=PATIENCE)
        self.child.delaybeforesend = None
        self.greeting = self.until_prompt()

    def until_prompt(self, prompt=None):
        """What appears until the next prompt, without escape sequences."""
        self.child.expect_exact(prompt or self.prompt)
        return ESCAPES.sub("", self.child.before)

    def enter(self, line, prompt=None):
        """Types a line; what it prints."""
        self.child.send(line + ENTER)
        shown = self.until_prompt(prompt)
        return shown[shown.find("\n") + 1:].rstrip("\n")  # without the echo of the line

    def press(self, keys):
        self.child.send(keys)

    def leave(self):
        """Ctrl-D; the exit code."""
        self.press(CTRL_D)
        return self.exit_code()

    def exit_code(self):
        self.child.expect(pexpect.EOF)
        self.child.wait()  # a busy machine may take a while to end what has closed its terminal
        self.child.close()
        return self.child.exitstatus
