"""The examples in Python print what the comment at their end says, docs/python.md shows what Python does, and the
notebook runs, and its pictures are there.

    python3 examples_test.py SOURCE, with PYTHONPATH set to the module's folder
"""

import doctest
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(sys.argv[1])
failures = []


def run(script):
    shown = subprocess.run([sys.executable, script], capture_output=True, text=True, cwd=tempfile.gettempdir(), timeout=120)
    said = "".join(re.findall("^# (.*\n)", script.read_text().partition("\n# prints\n")[2], re.M))
    if shown.returncode != 0 or shown.stdout != said or not said:
        failures.append(f"{script.name} printed\n{shown.stdout}{shown.stderr}and not\n{said}")


def run_notebook(notebook):
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "HOME": folder, "IPYTHONDIR": folder + "/ipython", "JUPYTER_RUNTIME_DIR": folder,
                       "JUPYTER_CONFIG_DIR": folder, "JUPYTER_DATA_DIR": folder}
        done = subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--stdout", notebook],
                              capture_output=True, text=True, env=environment, timeout=120)
    if done.returncode != 0:
        failures.append(f"{notebook.name}: {done.stderr[-2000:]}")
        return
    outputs = [output for cell in json.loads(done.stdout)["cells"] for output in cell.get("outputs", [])]
    forms = [form for output in outputs for form in output.get("data", {})]
    for form, wanted in (("image/svg+xml", 2), ("text/html", 3)):
        if forms.count(form) < wanted:
            failures.append(f"{notebook.name}: {forms.count(form)} outputs are {form}, {wanted} are wanted")


scripts = sorted(SOURCE.glob("examples/python/*.py"))
notebooks = sorted(SOURCE.glob("examples/python/*.ipynb"))
assert len(scripts) >= 3 and notebooks, "no examples found"
for script in scripts:
    run(script)
for notebook in notebooks:
    run_notebook(notebook)
shown = doctest.testfile(str(SOURCE / "docs/python.md"), module_relative=False, encoding="utf-8")
if shown.failed:
    failures.append("docs/python.md shows something else than Python")
print("\n".join(failures) or f"{len(scripts)} examples and {len(notebooks)} notebooks")
sys.exit(1 if failures else 0)
