"""The types of the module: mypy --strict accepts the examples of docs/python.md and refuses ten wrong ones; what the types
say of a value is what it is.

    python3 types_test.py SOURCE PROGRAM, with PYTHONPATH set to the module's folder
"""

import doctest
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import dinal
import numpy as np

SOURCE = pathlib.Path(sys.argv[1])
HEAD = "import dinal\nimport numpy as np\n"
SYSTEM = "osc = dinal.system(I=1, k=4, Rd=.3, Re=.4)\n"
RIGHT = """
from dinal.types import Number
osc = dinal.system(I=1, k=4, Rd=.3, Re=.4)
run = osc.simulate(M=lambda t: np.sin(t), theta0=np.float64(1), t_end=20)
peak: float = run.theta.max()
kinds: list[str] = [str(kind) for kind in run.events.kind[:2]]
theta, velocity = run.at(1.5)
angles, velocities = run.at(np.linspace(0, 20, 7))
sum_of_two: float = theta + velocity
s = osc.steady(M=dinal.excitation.harmonic(frequency=.4))
amplitude: float = s.amplitude
e: dinal.Excitation = 2*dinal.excitation.harmonic(omega=.4) - 1
stiffer: dinal.System = osc.with_(k=5)
fit = dinal.identify(data={"t": run.t, "theta": run.theta})
k: float = fit.k + fit["Rd"]
rig = dinal.system(bodies=dict(motor=dict(I=1), load=dict(I=3)), links=dict(clutch=("motor", "load", dict(Rd=2))))
both = rig.simulate(velocity0=dict(motor=3), t_end=4, integrator=dinal.integrator.rk4(h=.01))
column = both.motor.theta[-1]
total = run.energy().total.dry
def M(t: Number) -> float: return float(t)
osc.simulate(M=M, times=[0, 1, 2]).save("run.csv", columns=["t", "theta"])
"""
WRONG = ["osc.simulate(tend=3)", "run.thta", "dinal.foo", "dinal.system(I=1)", "dinal.system(I='1', k=2)", "osc.simulate(M='sin')",
         "osc.steady(M=1).amplitud", "dinal.excitation.square(period=1, duty=[.5])", "dinal.integrator.rk4()",
         "osc.simulate(integrator='rk4')", "x: str = osc.omega0", "run.energy().totals", "dinal.excitation.harmonic(1, 2)",
         "osc.with_(kk=3)", "run.at()", "dinal.excitation.harmonic(omega=1) / dinal.excitation.harmonic(omega=1)"]
failures = []


def mypy(code):
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "example.py").write_text(code)
        path = str(pathlib.Path(dinal.__file__).parents[1])
        return subprocess.run([sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--cache-dir", os.path.join(tempfile.gettempdir(), "dinal-mypy"),
                               "example.py"], capture_output=True, text=True, cwd=folder, env={**os.environ, "MYPYPATH": path}).stdout


def examples():
    """The transcript of the page; what raises on purpose is left out."""
    parts = doctest.DocTestParser().get_examples((SOURCE / "docs/python.md").read_text())
    return "".join(part.source for part in parts if not part.exc_msg)


try:
    import mypy as _
except ImportError:
    print("no mypy: apt-get install python3-mypy mypy")
    sys.exit(77)
for code in (examples(), HEAD + RIGHT):
    if shown := mypy(code):
        failures.append(f"{shown}\nin\n{code}")
shown = mypy(HEAD + SYSTEM + "run = osc.simulate(t_end=1)\n" + "\n".join(WRONG) + "\n")
lines = {int(number) for number in re.findall(r"^example.py:(\d+): error", shown, re.M)}
missed = [text for number, text in enumerate(WRONG, 5) if number not in lines]
if missed or min(lines) < 5:
    failures.append(f"mypy accepts {missed}; it says\n{shown}")


def check(value):
    """The fields of the value are what the types say."""
    kinds = {"float": (float, int), "int": int, "str": str, "bool": bool, "Vector": np.ndarray, "Record": dict, "list[str]": list,
             "list[Record]": list, "list[SteadyMotion]": list, "None": type(None), "str | bool": (str, bool)}
    for name, member in vars(type(value)).items():
        if not isinstance(member, property):
            continue
        try:
            found = getattr(value, name)
        except AttributeError:
            continue
        said = dinal._words.type_of_field(member)
        allowed = tuple(kind for part in said.split(" | ") for kind in np.atleast_1d(kinds.get(part) or getattr(dinal, part)))
        if found is not None and not (isinstance(found, dict) and not found) and not isinstance(found, allowed):
            failures.append(f"{type(value).__name__}.{name} is {type(found).__name__}, and not {said}")


osc = dinal.system(I=1, k=4, C=.1, Rd=.3, Re=.4, spring=dinal.spring.polynomial({3: .1}), walls=dict(upper=2))
run = osc.simulate(M=dinal.excitation.harmonic(frequency=.4), theta0=1, t_end=20)
steady = dinal.system(I=1, k=4, Rd=.3).steady(M=dinal.excitation.harmonic(frequency=.4))
fit = dinal.identify(data=dinal.system(I=1, k=4, Rd=.1).simulate(theta0=1, t_end=9))
for value in (osc, run, steady, fit, run.energy(), run.events, dinal.friction.coulomb(Rd=1), dinal.integrator.exact()):
    check(value)
print("\n".join(failures) or f"{len(WRONG)} wrong examples are refused")
sys.exit(1 if failures else 0)
