"""dinal in a Jupyter notebook: Debian's ipykernel speaks with the notebook, `dinal --kernel` does the work.

Written by `dinal --jupyter-install`, which also says in kernel.json where the program is (DINAL) and its options. What
scripts print comes on standard output and standard error, answers as lines of JSON on a pipe of their own
(docs/notebook.md).
"""

import base64
import codecs
import json
import os
import re
import selectors
import signal
import subprocess
import sys
import uuid

sys.modules["debugpy"] = None  # ipykernel's debugger of Python: a third of the start, and a warning on the terminal

from ipykernel.kernelapp import IPKernelApp
from ipykernel.kernelbase import Kernel

MOST_OUTPUT = 1 << 20  # bytes of one cell: more makes a notebook slow that nobody can read


class Ended(Exception):
    """The program is no more."""


class Dinal:
    """One process of dinal, and what it writes."""

    def __init__(self):
        answers, answers_end = os.pipe()
        # Its own session: Jupyter's Ctrl-C reaches Python only, which passes it on while a cell runs.
        options = os.environ.get("DINAL_KERNEL_OPTIONS", "").split()
        self.process = subprocess.Popen([os.environ.get("DINAL", "dinal"), *options, f"--kernel={answers_end}"],
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        pass_fds=[answers_end], start_new_session=True)
        os.close(answers_end)
        self.answers = answers
        self.streams = {self.process.stdout.fileno(): "stdout", self.process.stderr.fileno(): "stderr"}
        self.selector = selectors.DefaultSelector()
        for descriptor in (answers, *self.streams):
            os.set_blocking(descriptor, False)
            self.selector.register(descriptor, selectors.EVENT_READ)
        self.rest = b""
        self.number = 0

    def interrupt(self):
        self.process.send_signal(signal.SIGINT)

    def end(self):
        self.process.kill()
        self.process.wait()
        self.selector.close()
        os.close(self.answers)
        for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
            try:
                pipe.close()
            except BrokenPipeError:  # a request that nobody read any more
                pass

    def printed(self, descriptor, hear):
        """All that has come; false at the end of the stream."""
        while True:
            try:
                piece = os.read(descriptor, 1 << 16)
            except BlockingIOError:
                return True
            if not piece:
                return False
            hear(self.streams[descriptor], piece)

    def messages(self, hear):
        """The lines of JSON that have come. What was printed before is heard first."""
        try:
            piece = os.read(self.answers, 1 << 20)
        except BlockingIOError:
            return []
        for descriptor in self.streams:
            self.printed(descriptor, hear)
        if not piece:
            raise Ended()
        *lines, self.rest = (self.rest + piece).split(b"\n")
        return [json.loads(line) for line in lines]

    def ask(self, request, hear=lambda name, piece: None, show=lambda message: None):
        """The answer to a request; meanwhile hear(stream, bytes) and show(message)."""
        self.number += 1
        try:
            self.process.stdin.write(json.dumps({**request, "id": self.number}).encode() + b"\n")
            self.process.stdin.flush()
        except BrokenPipeError as error:
            raise Ended() from error
        while True:
            try:
                ready = [key.fd for key, _ in self.selector.select()]
                for descriptor in ready:
                    if descriptor in self.streams and not self.printed(descriptor, hear):
                        self.selector.unregister(descriptor)
                if self.answers not in ready:
                    continue
                for message in self.messages(hear):
                    if "done" not in message:
                        show(message)
                    elif message["done"] in (self.number, None):  # None: the request was not understood
                        return message
            except KeyboardInterrupt:
                self.interrupt()


def with_image(forms):
    """A picture as an image of HTML, too: as SVG in the page, nbconvert 6.5 (Debian 12) takes all lines out of it, and
    several on a page mix up their names."""
    if "image/svg+xml" not in forms or "text/html" in forms:
        return forms
    svg = base64.b64encode(forms["image/svg+xml"].encode()).decode()
    told = [re.search(f"<{name}>(.*?)</{name}>", forms["image/svg+xml"], re.DOTALL) for name in ("title", "desc")]
    words = ". ".join(part.group(1).replace('"', "&quot;") for part in told if part) or "a picture"
    return {**forms, "text/html": f'<img alt="{words}" style="max-width: 100%" src="data:image/svg+xml;base64,{svg}">'}


class Output:
    """What one cell prints, up to a limit."""

    def __init__(self, kernel):
        self.kernel = kernel
        self.left = MOST_OUTPUT
        self.dropped = 0
        self.letters = {name: codecs.getincrementaldecoder("utf-8")("replace") for name in ("stdout", "stderr")}

    def hear(self, name, piece):
        shown = piece[:self.left]
        self.left -= len(shown)
        self.dropped += len(piece) - len(shown)
        if shown:
            self.kernel.write(name, self.letters[name].decode(shown))  # a piece may end within a letter

    def finish(self):
        if self.dropped:
            self.kernel.write("stderr", f"\n({self.dropped} more bytes were printed; a cell shows {MOST_OUTPUT})\n")


class ProgressLine:
    """One line of a cell, which changes while a run or a sweep goes on and is empty in the end."""

    def __init__(self, kernel):
        self.kernel = kernel
        self.place = None  # its name for the notebook, once it is there

    def show(self, line):
        if not line and self.place is None:
            return
        kind = "update_display_data" if self.place else "display_data"
        self.place = self.place or str(uuid.uuid4())
        self.kernel.send_response(self.kernel.iopub_socket, kind,
                                  {"data": {"text/plain": line}, "metadata": {"dinal": "progress"},
                                   "transient": {"display_id": self.place}})


class DinalKernel(Kernel):
    implementation = "dinal"
    implementation_version = "1"
    banner = "dinal: a laboratory for oscillators with dry friction"
    language_info = {"name": "lua", "mimetype": "text/x-lua", "file_extension": ".lua", "pygments_lexer": "lua",
                     "codemirror_mode": "lua"}

    def __init__(self, **arguments):
        super().__init__(**arguments)
        self.dinal = Dinal()

    def write(self, name, text):
        self.send_response(self.iopub_socket, "stream", {"name": name, "text": text})

    def restart_after_end(self):
        self.dinal.end()
        code = self.dinal.process.returncode
        self.dinal = Dinal()
        how = f"exit code {code}" if code >= 0 else f"killed by {signal.Signals(-code).name}"
        return f"dinal has ended ({how}); what it knew is lost, and the next cell begins anew"

    def ask(self, request):
        try:
            return self.dinal.ask(request)
        except Ended:
            self.restart_after_end()
            return {}

    def do_execute(self, code, silent, store_history=True, user_expressions=None, allow_stdin=False):
        output = Output(self)
        progress = ProgressLine(self)

        def hear(name, piece):
            if not silent:
                output.hear(name, piece)

        def show(message):
            if silent:
                return
            if "progress" in message:
                progress.show(message["progress"])
            elif "show" in message:
                self.send_response(self.iopub_socket, "display_data", {"data": with_image(message["show"]), "metadata": {}})
            else:
                self.send_response(self.iopub_socket, "execute_result",
                                   {"data": with_image(message["value"]), "metadata": {},
                                    "execution_count": self.execution_count})

        try:
            answer = self.dinal.ask({"do": "execute", "code": code}, hear, show)
        except Ended:
            answer = {"ok": False, "error": self.restart_after_end()}
            if not silent:
                progress.show("")
        if not silent:
            output.finish()
            if answer.get("notice"):
                self.write("stderr", answer["notice"] + "\n")
        if answer.get("ok"):
            return {"status": "ok", "execution_count": self.execution_count, "payload": [], "user_expressions": {}}
        words = answer.get("error") or answer.get("wrong", "")
        error = {"ename": "error", "evalue": words, "traceback": words.split("\n")}
        if not silent:
            self.send_response(self.iopub_socket, "error", error)
        return {"status": "error", "execution_count": self.execution_count, **error}

    def do_complete(self, code, cursor_pos):
        answer = self.ask({"do": "complete", "before": code[:cursor_pos]})
        return {"status": "ok", "matches": [name.rstrip() for name in answer.get("names", [])],
                "cursor_start": cursor_pos - answer.get("word", 0), "cursor_end": cursor_pos, "metadata": {}}

    def do_inspect(self, code, cursor_pos, detail_level=0, omit_sections=()):
        text = self.ask({"do": "inspect", "before": code[:cursor_pos], "after": code[cursor_pos:]}).get("text", "")
        return {"status": "ok", "found": bool(text), "data": {"text/plain": text} if text else {}, "metadata": {}}

    def do_is_complete(self, code):
        return {"status": self.ask({"do": "check", "code": code}).get("state", "unknown"), "indent": ""}

    def do_shutdown(self, restart):
        self.dinal.end()
        return {"status": "ok", "restart": restart}


if __name__ == "__main__":
    IPKernelApp.launch_instance(kernel_class=DinalKernel)
