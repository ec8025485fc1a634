#!/usr/bin/env python3
"""Runs what the documents show and compares it with what they say comes out.

    transcripts.py PROGRAM SOURCE [--update]

In README.md, docs/*.md, docs/lab/*.md, docs/es/*.md and examples/README.md a block fenced as ```console is run:
  "$ command"   is given to the shell, in a folder of its own for each document, with the project's examples/ and docs/
                in it; scripts/dinal and dinal are the program under test;
  "> text"      after "$ scripts/dinal" or "$ dinal" alone is typed at the prompt, on a terminal; a block that begins
                so goes on with the session of the block before;
  other lines   are the output (both channels); a line "..." stands for any lines, and numbers of more than nine digits
                are compared in nine: the rest depends on how a compiler orders sums. The version of Lua is not compared.
The blocks fenced as ```lua of a document are one script, which prints what stands behind "-->".
A block fenced as ```sh is not run: it is for what cannot be run here (git clone, apt); the scripts that it names must be
there. --update writes the present output into the documents (then read it!).
"""

import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

import pexpect

PROGRAM, ROOT = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
UPDATE = "--update" in sys.argv[3:]
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.S | re.M)
TIMEOUT = 120  # seconds for one command; the sanitizers are slow


def sandbox():
    folder = tempfile.mkdtemp(prefix="dinal-docs-")
    for name in ("examples", "docs"):
        shutil.copytree(os.path.join(ROOT, name), os.path.join(folder, name))
    for place in ("scripts", "bin"):
        os.mkdir(os.path.join(folder, place))
        start = os.path.join(folder, place, "dinal")
        with open(start, "w", encoding="utf-8") as file:
            file.write(f"#!/bin/sh\nexec '{PROGRAM}' \"$@\"\n")
        os.chmod(start, 0o755)
    return folder


def environment(folder):
    kept = {name: os.environ[name] for name in ("ASAN_OPTIONS", "LSAN_OPTIONS", "UBSAN_OPTIONS") if name in os.environ}
    return kept | {"HOME": folder, "PATH": f"{folder}/bin:/usr/local/bin:/usr/bin:/bin", "TERM": "dumb", "LC_ALL": "C.UTF-8"}


def run(command, folder):
    done = subprocess.run(["sh", "-c", command], cwd=folder, env=environment(folder), stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=TIMEOUT, check=False)
    return done.stdout.decode()


class Prompt:
    """A session of a document."""

    def __init__(self, command, folder):
        self.screen = pexpect.spawn("sh", ["-c", command], cwd=folder, env=environment(folder), encoding="utf-8",
                                    timeout=TIMEOUT, dimensions=(50, 100))
        self.screen.delaybeforesend = None  # the prompt appears when the terminal is ready: waiting was most of the test
        self.screen.expect(r"(^|\n)> $")
        self.greeting = self.screen.before.replace("\r", "") + "\n"

    def type(self, lines):
        """What is on the screen then, from the first prompt to before the last one."""
        text = "> "
        for line in lines:
            self.screen.sendline(line)
            self.screen.expect([r"(^|\n)>>? $", pexpect.EOF])
            text += self.screen.before + (self.screen.after if isinstance(self.screen.after, str) else "")
        return re.sub(r"\n>>? $", "\n", text.replace("\r", ""))

    def leave(self):
        if self.screen.isalive():
            self.screen.sendeof()
            self.screen.expect(pexpect.EOF)


def typed_lines(text):
    return re.findall(r"^>>? ?(.*)$", text, re.M)


def parts(block):
    """(command, expected text) of each "$ " line; the command is None for what is typed into the session so far."""
    if block.startswith(">"):
        yield None, block
        return
    for chunk in re.split(r"^\$ ", block, flags=re.M)[1:]:
        command, _, expected = chunk.partition("\n")
        yield command, expected


def without_accidents(text):
    """Nine digits of long numbers, and no version of Lua: both differ from machine to machine."""
    text = re.sub(r"\(Lua 5\.4\.\d+\)", "(Lua 5.4)", text)
    return re.sub(r"\d+\.\d{9,}(?:e[-+]\d+)?", lambda number: f"{float(number[0]):.9g}", text)


def same(expected, got):
    expected, got = without_accidents(expected), without_accidents(got)
    pattern = "".join("(?:.*\n)*" if line == "..." else re.escape(line.rstrip()) + "\n"
                      for line in expected.rstrip().splitlines())
    got = "".join(line.rstrip() + "\n" for line in got.rstrip().splitlines())
    return re.fullmatch(pattern, got) is not None


def lua_complaint(text, folder):
    """What the ```lua blocks of a document print, if it is not what stands behind their -->."""
    code = "".join(block for language, block in FENCE.findall(text) if language == "lua")
    expected = "".join(line + "\n" for line in re.findall(r"--> ?(.*)$", code, re.M))
    if not expected:
        return []
    with open(os.path.join(folder, "blocks.lua"), "w", encoding="utf-8") as file:
        file.write(code)
    got = run("dinal blocks.lua", folder)
    return [] if same(expected, got) else [f"--- its Lua blocks print\n{got}--- and not\n{expected}---"]


def check(path):
    """The number of commands, the complaints, and the text as --update would write it."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    count, complaints, fresh, done = 0, [], "", 0
    prompt = None
    folder = sandbox() if re.search(r"^```(console|lua)$", text, re.M) else None
    try:
        if not path.endswith("manual.md") and "/manual/" not in path:  # help_test runs its examples
            complaints += lua_complaint(text, folder)
        for fence in FENCE.finditer(text):
            language, block = fence.groups()
            if language == "sh":
                for script in re.findall(r"(?:^|\s)(scripts/\w+)", block):
                    if not os.access(os.path.join(ROOT, script), os.X_OK):
                        complaints.append(f"{script} is not there")
            if language != "console":
                continue
            answer = ""
            for command, expected in parts(block):
                count += 1
                typed = typed_lines(expected) if command in (None, "dinal", "scripts/dinal") else []
                head = f"$ {command}\n" if command is not None else ""
                if command is not None and prompt:
                    prompt.leave()
                    prompt = None
                if command is not None and typed:
                    prompt = Prompt(command, folder)
                    got = prompt.greeting + prompt.type(typed)
                else:
                    got = prompt.type(typed) if typed else run(command, folder)
                if same(expected, got):
                    answer += head + expected
                else:
                    answer += head + got
                    complaints.append(f"{head}--- it says\n{expected}--- it is\n{got}---")
            fresh += text[done:fence.start(2)] + answer
            done = fence.end(2)
        if prompt:
            prompt.leave()
    finally:
        if folder:
            shutil.rmtree(folder)
    return count, complaints, fresh + text[done:]


def main():
    documents = ["README.md", "examples/README.md"] + sorted(
        os.path.relpath(path, ROOT) for path in glob.glob(os.path.join(ROOT, "docs", "*.md")) +
        glob.glob(os.path.join(ROOT, "docs", "lab", "*.md")) + glob.glob(os.path.join(ROOT, "docs", "es", "*.md")))
    failed, total = False, 0
    for document in documents:
        path = os.path.join(ROOT, document)
        count, complaints, fresh = check(path)
        total += count
        for complaint in complaints:
            print(f"{document}: {complaint}")
        failed = failed or bool(complaints)
        if UPDATE and complaints:
            with open(path, "w", encoding="utf-8") as file:
                file.write(fresh)
    print(f"{total} commands in {len(documents)} documents")
    return 1 if failed or total == 0 else 0


sys.exit(main())
