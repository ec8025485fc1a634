#!/usr/bin/env python3
"""Runs what the documents show and compares it with what they say comes out.

    transcripts.py PROGRAM SOURCE [--update]

In README.md, docs/*.md and examples/README.md a block fenced as ```console is run:
  "$ command"   is given to the shell, in a folder of its own for each document, with the project's examples/ and docs/
                in it; scripts/dinal and dinal are the program under test;
  "> text"      after "$ scripts/dinal" or "$ dinal" alone is typed at the prompt, on a terminal;
  other lines   are the output (both channels); a line "..." stands for any lines, and numbers of more than nine digits
                are compared in nine: the rest depends on how a compiler orders sums.
A block fenced as ```sh is not run: it is for what can not be run here (git clone, apt); the scripts that it names must be
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
    kept = {name: os.environ[name] for name in ("ASAN_OPTIONS", "UBSAN_OPTIONS") if name in os.environ}
    return kept | {"HOME": folder, "PATH": f"{folder}/bin:/usr/local/bin:/usr/bin:/bin", "TERM": "dumb", "LC_ALL": "C.UTF-8"}


def run(command, folder):
    done = subprocess.run(["sh", "-c", command], cwd=folder, env=environment(folder), stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=TIMEOUT, check=False)
    return done.stdout.decode()


def type_at_prompt(command, typed, folder):
    """The screen after the lines were typed, without the prompt that the end of the input answered."""
    screen = pexpect.spawn("sh", ["-c", command], cwd=folder, env=environment(folder), encoding="utf-8", timeout=TIMEOUT,
                           dimensions=(50, 100))
    text = ""
    for line in typed + [None]:
        screen.expect(r"(^|\n)>>? $")
        text += screen.before + screen.after
        if line is None:
            screen.sendeof()
        else:
            screen.sendline(line)
    screen.expect(pexpect.EOF)
    return re.sub(r"\n>>? $", "\n", text.replace("\r", ""))


def parts(block):
    """(command, typed lines, expected text) of each "$ " line."""
    for chunk in re.split(r"^\$ ", block, flags=re.M)[1:]:
        command, _, expected = chunk.partition("\n")
        typed = re.findall(r"^>>? ?(.*)$", expected, re.M) if command in ("dinal", "scripts/dinal") else []
        yield command, typed, expected


def in_nine_digits(text):
    return re.sub(r"\d+\.\d{9,}(?:e[-+]\d+)?", lambda number: f"{float(number[0]):.9g}", text)


def same(expected, got):
    expected, got = in_nine_digits(expected), in_nine_digits(got)
    pattern = "".join("(?:.*\n)*" if line == "..." else re.escape(line.rstrip()) + "\n"
                      for line in expected.rstrip().splitlines())
    got = "".join(line.rstrip() + "\n" for line in got.rstrip().splitlines())
    return re.fullmatch(pattern, got) is not None


def check(path):
    """The number of commands, the complaints, and the text as --update would write it."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    count, complaints, fresh = 0, [], text
    folder = sandbox()
    try:
        for fence in FENCE.finditer(text):
            language, block = fence.groups()
            if language == "sh":
                for script in re.findall(r"(?:^|\s)(scripts/\w+)", block):
                    if not os.access(os.path.join(ROOT, script), os.X_OK):
                        complaints.append(f"{script} is not there")
            if language != "console":
                continue
            answer = ""
            for command, typed, expected in parts(block):
                count += 1
                got = type_at_prompt(command, typed, folder) if typed else run(command, folder)
                if same(expected, got):
                    answer += f"$ {command}\n{expected}"
                else:
                    answer += f"$ {command}\n{got}"
                    complaints.append(f"$ {command}\n--- it says\n{expected}--- it is\n{got}---")
            fresh = fresh.replace(block, answer)
    finally:
        shutil.rmtree(folder)
    return count, complaints, fresh


def main():
    documents = ["README.md", "examples/README.md"] + sorted(
        os.path.relpath(path, ROOT) for path in glob.glob(os.path.join(ROOT, "docs", "*.md")))
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
