"""dinal: a laboratory for oscillators with dry friction.

    import dinal, numpy as np
    osc = dinal.system(I=1, k=4, Rd=.3, Re=.4)
    run = osc.simulate(M=lambda t: np.sin(t), theta0=1, t_end=20)
    run.theta, run.events.kind, osc.steady(M=dinal.excitation.harmonic(frequency=.4)).amplitude

These are the objects of Lua: sys:simulate{ M = M, t_end = 20 } there is osc.simulate(M=M, t_end=20) here. Named arguments
are the options, columns are NumPy arrays. Names that are keywords of Python end in an underscore: osc.with_(k=5). Each
function has its help: help(dinal.system), dinal.help("dead zone").
"""

import importlib.machinery as _machinery
import importlib.util as _util
import os as _os
import sys as _sys


def _find_numpy():
    """Makes Debian's NumPy, and nothing else of Debian, visible in a plain virtual environment."""
    if "numpy" in _sys.modules or _util.find_spec("numpy"):
        return
    spec = _machinery.PathFinder.find_spec("numpy", ["/usr/lib/python3/dist-packages"])
    if spec is not None:
        module = _sys.modules["numpy"] = _util.module_from_spec(spec)
        spec.loader.exec_module(module)


_find_numpy()

from . import _dinal, _objects, _words
from ._objects import Error, Function, Object, Record, RunWarning

version = __version__ = _dinal.__version__


def lua(text, **variables):
    """The value of a piece of Lua: dinal.lua("function(t) return A*math.sin(t) end", A=2). A function of Lua is faster
    than one of Python, and is run by all cores in a sweep. The variables are local ones of the piece."""
    return _dinal.run_text(text, variables)


def __getattr__(name):
    """dinal.partial: what was done of the last run that M or Ctrl-C broke off."""
    if name == "partial":
        return _dinal.operated("global", name, None)
    raise AttributeError(f"dinal has no {name!r}{_objects.meant(name, __all__)}")


def __dir__():
    return [*__all__, "version", "__version__", "__doc__"]


_dinal.set_up(_objects, _objects.in_notebook())
_members = _objects.build()
globals().update(_members)
from ._sweep import sweep  # noqa: E402: replaces that of Lua, because it takes an executor
sweep.__module__, _members["sweep"] = "dinal", sweep
__all__ = ["Error", "Function", "Object", "Record", "RunWarning", "lua", "partial", *_members]
for _class in (Error, Function, Object, Record, RunWarning):
    _class.__module__ = "dinal"
_os.register_at_fork(after_in_child=_dinal.after_fork)
