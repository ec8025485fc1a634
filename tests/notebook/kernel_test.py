#!/usr/bin/env python3
"""The kernel in the hands of a real client of Jupyter, and a real notebook run from end to end.

    kernel_test.py PROGRAM SOURCE
"""

import base64
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from xml.etree import ElementTree

PROGRAM, SOURCE = sys.argv[1:]

try:
    import jupyter_client
    import nbconvert  # noqa: F401
    import nbformat
except ModuleNotFoundError as missing:
    print(f"not judged: {missing}")
    sys.exit(77)

HOME = tempfile.mkdtemp(prefix="dinal-notebook-")
for name in ("JUPYTER_DATA_DIR", "XDG_DATA_HOME"):
    os.environ.pop(name, None)
os.environ.update(HOME=HOME, IPYTHONDIR=HOME + "/ipython", JUPYTER_CONFIG_DIR=HOME + "/config",
                  JUPYTER_RUNTIME_DIR=HOME + "/runtime")
PATIENCE = 60  # seconds: far more than anything here takes

failures = 0


def check(what, truth, seen=""):
    global failures
    if not truth:
        failures += 1
        print(f"FAILED: {what}: {seen!r}")


class Notebook:
    def __init__(self, kernel="dinal"):
        self.manager, self.client = jupyter_client.manager.start_new_kernel(kernel_name=kernel, startup_timeout=PATIENCE)

    def end(self):
        self.client.stop_channels()
        self.manager.shutdown_kernel(now=True)

    def run(self, code, meanwhile=None):
        """What a cell shows: streams as text, displays and results as lists, the error."""
        seen = {"stdout": "", "stderr": "", "shown": [], "progress": [], "value": None, "error": None, "order": []}

        def hear(message):
            kind, content = message["msg_type"], message["content"]
            if kind == "stream":
                seen[content["name"]] += content["text"]
            elif content.get("metadata") == {"dinal": "progress"}:
                seen["progress"].append((kind, content["transient"]["display_id"], content["data"]["text/plain"]))
            elif kind == "display_data":
                seen["shown"].append(content["data"])
            elif kind == "execute_result":
                seen["value"] = content["data"]
            elif kind == "error":
                seen["error"] = content["evalue"]
            if kind != "status":
                seen["order"].append(kind)
            if meanwhile and kind == "stream":
                meanwhile()

        reply = self.client.execute_interactive(code, output_hook=hear, timeout=PATIENCE, stop_on_error=False)
        seen["reply"] = reply["content"]
        return seen


def image_in(html):
    """The SVG of an <img>, which a browser shows only with its namespace."""
    match = re.fullmatch('<img alt="[^"<]+" style="max-width: 100%" src="data:image/svg\\+xml;base64,([^"]+)">', html)
    svg = base64.b64decode(match.group(1)).decode() if match else "<nothing/>"
    return svg if ElementTree.fromstring(svg).tag == "{http://www.w3.org/2000/svg}svg" else ""


def cells():
    notebook = Notebook()
    seen = notebook.run("x = 3\nprint('hello')\nx * 2")
    check("a value as at the prompt", seen["value"] == {"text/plain": "6"}, seen)
    check("what is printed", seen["stdout"] == "hello\n", seen)
    check("printed before the value", seen["order"] == ["execute_input", "stream", "execute_result"], seen["order"])

    for code in "io.read()", "io.read('n')", "for line in io.lines() do end", "io.stdin:read('a')":
        seen = notebook.run(code)
        check(f"{code} says that there is no keyboard", "has no keyboard" in (seen["error"] or seen["stderr"]), seen)
    seen = notebook.run("name = os.tmpname() f = io.open(name, 'w') f:write('7 8') f:close() io.input(name)\n"
                        "print(io.read('n', 'n')) io.input(io.stdin) for line in io.lines(name) do print(line) end")
    check("files are read", seen["stdout"].split() == ["7", "8", "7", "8"], seen)

    seen = notebook.run("run = nondimensional{}:simulate{ theta0 = 1, t_end = 3, dt = 0.01 }\nrun:plot()")
    check("a plot is an SVG", "<svg" in seen["shown"][0]["image/svg+xml"] and len(seen["shown"]) == 1, seen["stderr"])
    check("and an image for pages", image_in(seen["shown"][0]["text/html"]) == seen["shown"][0]["image/svg+xml"], seen)
    check("which is described to those who do not see it", 'alt="θ over t. Across: t, T0, 0 to 3. Up: ' in seen["shown"][0]["text/html"],
          seen["shown"][0]["text/html"][:300])
    seen = notebook.run("run:animate()")
    check("a run in motion, too", "<animateTransform" in image_in(seen["shown"][0]["text/html"]), seen["stderr"])
    seen = notebook.run("print(('\u00e4'):rep(200000))")
    check("letters are whole", seen["stdout"] == "\u00e4"*200000 + "\n", seen["stdout"][:100])
    seen = notebook.run("run:plot{ show = false }")
    check("so is a picture that is a value", "<svg" in seen["value"].get("image/svg+xml", ""), seen)
    seen = notebook.run("data{ a = { 1, 2 }, b = { '<b>', '&' } }")
    check("data are a table, and words are no HTML", "<td>&lt;b&gt;</td>" in seen["value"]["text/html"], seen["value"])
    seen = notebook.run("x = 1;")
    check("a statement shows nothing", seen["value"] is None and seen["error"] is None, seen)

    seen = notebook.run("x = 1\nlocal s = sistem{}")
    check("an error with its line and a mark", "sistem" in seen["error"] and "^" in seen["error"], seen["error"])
    check("and the cell has failed", seen["reply"]["status"] == "error", seen["reply"])
    seen = notebook.run("for i = 1, 3 do")
    check("an open block is an error", seen["error"] and "end" in seen["error"], seen["error"])
    for code, words in (("1 +", "line 1 goes on"), ("run:plot", "run:plot")):
        seen = notebook.run(code)
        check(f"{code} says what is missing", words in seen["error"].split("\n")[-1], seen["error"])
    seen = notebook.run("?t_end")
    check("a question", "run.t_end" in seen["stdout"], seen)
    seen = notebook.run("print(io.popen('cat'):read('a') == '')")
    check("standard input of a program is empty, and no request is lost", seen["stdout"] == "true\n", seen)
    seen = notebook.run("print('\\255\\0')")
    check("bytes that are no text", seen["stdout"] == "\ufffd\0\n", seen)

    reply = notebook.client.complete("run:pl", 6, reply=True, timeout=PATIENCE)["content"]
    check("completion", reply["matches"] == ["plot{"] and reply["cursor_start"] == 4, reply)
    reply = notebook.client.inspect("sys = nondimensional{}", 10, reply=True, timeout=PATIENCE)["content"]
    check("inspection", reply["found"] and "friction_ratio" in reply["data"]["text/plain"], reply)
    typed = "excitation.harmonic{ amp"
    reply = notebook.client.inspect(typed, len(typed), reply=True, timeout=PATIENCE)["content"]
    check("inspection of an option shows its call", "amplitude = 1, frequency" in str(reply["data"]), reply)
    reply = notebook.client.inspect("qwertzu", 3, reply=True, timeout=PATIENCE)["content"]
    check("an unknown name is not found", reply["found"] is False, reply)
    for code, state in (("x = 1", "complete"), ("for i = 1, 2 do", "incomplete"), ("x = = 1", "invalid")):
        asked = notebook.client.is_complete(code)
        reply = notebook.client.get_shell_msg(timeout=PATIENCE)
        while reply["parent_header"]["msg_id"] != asked:
            reply = notebook.client.get_shell_msg(timeout=PATIENCE)
        reply = reply["content"]
        check(f"{code} is {state}", reply["status"] == state, reply)

    # 2 s of the process's own time, however busy the machine is.
    seen = notebook.run("print('first') for i in progress(8, 'eight') do local c = os.clock() while os.clock() < c + 0.25 do end end\n"
                        "print('last')")
    lines = seen["progress"]
    check("a long loop shows its progress", len(lines) > 3 and lines[0][2].startswith("eight ") and "of 8" in lines[0][2], lines)
    check("in one place that changes", [kind for kind, _, _ in lines] == ["display_data"] + ["update_display_data"]*(len(lines) - 1)
          and len({place for _, place, _ in lines}) == 1, lines)
    check("and is empty in the end", lines and lines[-1][2] == "", lines)
    check("beside what is printed", seen["stdout"] == "first\nlast\n", seen["stdout"])
    seen = notebook.run("return #sweep{ over = { x = { 1, 2, 3, 4 } }, workers = 2, run = function(p)\n"
                        "  local c = os.clock() while os.clock() < c + 1 do end return { y = p.x } end }")
    check("so does a sweep", any(line[2].startswith("sweep ") for line in seen["progress"]) and seen["error"] is None, seen)
    check("and its line goes", seen["progress"] and seen["progress"][-1][2] == "", seen["progress"])
    seen = notebook.run("for i = 1, 3 do nondimensional{}:simulate{ theta0 = 1, t_end = 1, dt = 0.1 } end")
    check("a short run shows none", seen["progress"] == [], seen["progress"])

    def interrupt():
        time.sleep(0.3)
        notebook.manager.interrupt_kernel()

    seen = notebook.run("print('begun')\nlong = nondimensional{ zeta = 1e-9 }:simulate{ theta0 = 1, t_end = 1e7, dt = 0.1 }", interrupt)
    check("a run is interrupted", seen["error"] and "interrupted" in seen["error"], seen)
    check("and its progress is gone", all(line[2] == "" for line in seen["progress"][-1:]), seen["progress"])
    seen = notebook.run("#ans > 10, ans.outcome")
    check("and kept", seen["value"] and seen["value"]["text/plain"].startswith("true"), seen)
    seen = notebook.run("print('begun')\nwhile true do end", interrupt)
    check("a loop is interrupted", seen["error"] and "interrupted" in seen["error"], seen)
    seen = notebook.run("x")
    check("and nothing is lost", seen["value"] == {"text/plain": "1"}, seen)

    seen = notebook.run("for i = 1, 300 do print(string.rep('x', 1e5)) end\nx = 5")
    check("endless output is cut", len(seen["stdout"]) <= 1 << 20 and "more bytes were printed" in seen["stderr"], seen["stderr"])
    seen = notebook.run("os.exit(3)")
    check("a cell that ends the program", seen["error"] and "exit code 3" in seen["error"], seen)
    seen = notebook.run("x")
    check("is followed by a new one", seen["value"] is None or seen["value"] == {"text/plain": "nil"}, seen)

    notebook.run(":quit")
    seen = notebook.run("x = 7")
    check("so is :quit", seen["error"] and "exit code 0" in seen["error"], seen)
    seen = notebook.run("x = 7\nx")
    check("which is a new one as well", seen["value"] == {"text/plain": "7"}, seen)

    notebook.run("y = 2")
    notebook.manager.restart_kernel(now=False)
    notebook.client.wait_for_ready(timeout=PATIENCE)
    seen = notebook.run("y")
    check("a restart forgets", seen["value"] == {"text/plain": "nil"}, seen)
    notebook.end()


def notebooks():
    folder = os.path.join(SOURCE, "examples", "notebooks")
    for name in sorted(os.listdir(folder)):
        if not name.endswith(".ipynb"):
            continue
        target = os.path.join(HOME, name)
        done = subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output", target,
                               os.path.join(folder, name)], capture_output=True, text=True, cwd=HOME, check=False)
        check(f"{name} runs", done.returncode == 0, done.stderr[-2000:])
        check(f"{name} runs without a word of the debugger of Python", "ebugger" not in done.stderr, done.stderr)
        if done.returncode != 0:
            continue
        before, after = nbformat.read(os.path.join(folder, name), 4), nbformat.read(target, 4)
        for number, (old, new) in enumerate(zip(before.cells, after.cells)):
            if old.cell_type == "code":
                told = ["".join(output.get("text", "")) or output.get("data", {}).get("text/plain", "")
                        for output in old.outputs if not output.get("data", {}).get("image/svg+xml")]
                # A slow machine shows progress, which leaves an empty line.
                lines = [output for output in new.outputs if output.get("metadata") == {"dinal": "progress"}]
                check(f"{name}: progress is gone", all(line["data"]["text/plain"] == "" for line in lines), lines)
                seen = ["".join(output.get("text", "")) or output.get("data", {}).get("text/plain", "")
                        for output in new.outputs
                        if output not in lines and not output.get("data", {}).get("image/svg+xml")]
                check(f"{name}, cell {number + 1}", told == seen, seen)
        page = subprocess.run([sys.executable, "-m", "nbconvert", "--to", "html", "--stdout", target],
                              capture_output=True, text=True, cwd=HOME, check=False).stdout
        pictures = sum("image/svg+xml" in output.get("data", {}) for cell in after.cells for output in cell.get("outputs", []))
        check(f"{name} has its pictures on a page", page.count('src="data:image/svg+xml;base64,') == pictures > 0, pictures)


said = subprocess.run([PROGRAM, "--jupyter-install"], capture_output=True, text=True, check=False)
check("--jupyter-install", said.returncode == 0 and "dinal (safe)" in said.stdout, said)
with open(HOME + "/.local/share/jupyter/kernels/dinal/kernel.json", encoding="utf-8") as file:
    check("the kernel knows its program", os.path.samefile(json.load(file)["env"]["DINAL"], PROGRAM))
notebook = Notebook("dinal-safe")
seen = notebook.run("print(os.execute, io.popen, dinal ~= nil)")
check("the safe kernel has no processes", seen["stdout"] == "nil\tnil\ttrue\n", seen)
seen = notebook.run("nondimensional{}:simulate{ theta0 = 1, t_end = 1, dt = 0.1 }:save('../outside.csv')")
check("and writes nothing outside of its folder", "safe mode allows files in the current folder" in (seen["error"] or ""), seen)
notebook.end()
said = subprocess.run([PROGRAM, "--kernel=77"], capture_output=True, text=True, check=False)
check("--kernel by hand", said.returncode == 2 and "--jupyter-install" in said.stderr, said)
cells()
notebooks()
subprocess.run(["rm", "-rf", HOME], check=True)
sys.exit(1 if failures else 0)
