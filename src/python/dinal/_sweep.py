"""dinal.sweep on any concurrent.futures.Executor: the caller hands out chunks of points and alone keeps what comes back."""

import argparse
import concurrent.futures
import functools
import hashlib
import inspect
import itertools
import os
import pathlib
import pickle
import signal
import sys
import threading
import types

from . import _dinal
from ._objects import Error, Function, Object, parameters_of


class LuaFile:
    """The run of a Lua file that returns { over = ..., run = ... }. It travels as the text of the file."""

    def __init__(self, text, name):
        self.text, self.name = text, name

    @functools.cached_property
    def options(self):
        options = _dinal.run_text("load(text, name)()", {"text": self.text, "name": "@" + self.name})
        if not isinstance(options, dict) or not isinstance(options.get("run"), Function):
            raise Error(f"{self.name} must return a table of the options of sweep, such as {{ over = ..., run = ..., file = ... }}")
        return options


@functools.lru_cache(2)
def run_of_file(text, name):
    return LuaFile(text, name).options["run"]


def is_own(value):
    """Whether a user wrote it: its module is neither dinal nor in a library folder."""
    module = sys.modules.get(getattr(value, "__module__", None) or getattr(value, "__name__", ""))
    file = getattr(module, "__file__", None) or ""
    return module is None or module.__name__.partition(".")[0] not in {*sys.stdlib_module_names, "dinal"} and "-packages" not in file


def names_in(code):
    return {*code.co_names, *(name for part in code.co_consts if isinstance(part, types.CodeType) for name in names_in(part))}


def digest(value, seen):
    """Describes a value the same way in all processes. A function counts by its code and all that it uses."""
    if isinstance(value, (int, float, complex, str, bytes, type(None), type(...))):
        return [type(value).__name__, repr(value)]
    if isinstance(value, tuple):
        return [digest(part, seen) for part in value]
    if isinstance(value, types.CodeType):
        return [value.co_code.hex(), value.co_names, value.co_varnames, digest(value.co_consts, seen)]
    if id(value) in seen:
        return seen[id(value)][0]
    seen[id(value)] = len(seen), value  # keeps the value, so that no other one gets its id
    if isinstance(value, types.ModuleType):
        return [value.__name__, pathlib.Path(value.__file__).read_text() if is_own(value) and value.__file__ else ""]
    if isinstance(value, types.FunctionType) and is_own(value):
        names = sorted(names_in(value.__code__) & set(value.__globals__))
        return [digest(part, seen) for part in (value.__code__, value.__defaults__, value.__kwdefaults__, [value.__globals__[name] for name in names],
                                                [cell.cell_contents for cell in value.__closure__ or () if cell != types.CellType()])]
    if isinstance(value, types.MethodType):
        return [digest(part, seen) for part in (value.__func__, value.__self__)]
    if isinstance(value, type) and is_own(value):
        # Since Python 3.13 a class knows where it stands in its file, which does not change what it does.
        parts = {name: getattr(part, "__func__", getattr(part, "fget", part)) for name, part in vars(value).items()
                 if name not in ("__firstlineno__", "__static_attributes__")}
        return [value.__qualname__, *(digest(base, seen) for base in value.__bases__),
                digest({name: part for name, part in parts.items() if isinstance(part, (int, float, str, tuple, types.FunctionType))}, seen)]
    if isinstance(value, functools.partial):
        return [digest(part, seen) for part in (value.func, value.args, value.keywords)]
    if isinstance(value, dict):
        return [[str(key), digest(value[key], seen)] for key in sorted(value, key=str)]
    if isinstance(value, list):
        return [digest(part, seen) for part in value]
    if isinstance(value, (set, frozenset)):
        return sorted(map(repr, value))
    if hasattr(value, "__qualname__") and not is_own(value):
        return [value.__module__, value.__qualname__]
    if is_own(type(value)) and hasattr(value, "__dict__"):
        return [digest(part, seen) for part in (type(value), vars(value))]
    return hashlib.sha256(pickle.dumps(value)).hexdigest()


def part(run, options, first, last, home):
    """The points from the first to the one before the last, as data."""
    if os.getpid() != home and threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that collects
        _dinal.show_no_progress_here()
    if isinstance(run, LuaFile):
        run = run_of_file(run.text, run.name)
    if not isinstance(run, Object) and parameters_of(run) == 2:
        import numpy
        numbers, own = itertools.count(first), run
        run = lambda p: own(p, numpy.random.default_rng([options["seed"], next(numbers)]))
    return _dinal.sweep({**options, "run": run, "points": [first + 1, last]})


def results(pool, chunks, call):
    """(first point, data) of each chunk, as they come."""
    futures = {pool.submit(*call, *chunk, os.getpid()): chunk[0] for chunk in chunks}
    try:
        for future in concurrent.futures.as_completed(futures):
            yield futures[future], future.result()
    finally:
        for future in futures:
            future.cancel()


def sweep(*, over, run, executor=None, file=None, seed=0, progress=None, workers=None, max_time=None):
    """sweep(over, run, executor=None, file=None, seed=0, progress=None, workers=None, max_time=None) -> Data

    Calls run at each combination of the values in over, and returns a row for each. run gets a point, p.r or p["r"], and
    returns a dict of numbers and words; a function of two arguments also gets a numpy.random.Generator of its own.

        over: {"r": values, "g": values}; the last name changes fastest
        run: a function of Python, or of Lua (dinal.lua), which all cores run without an executor
        executor: a concurrent.futures.Executor: ProcessPoolExecutor, MPIPoolExecutor, client.get_executor() of Dask, or a
            function that makes one: then a killed worker does not end the sweep
        file: a .csv for the result. Finished points are kept in FILE.part, and the same call continues after any death
        seed: of the random numbers, which do not depend on the executor
        progress: a function of the number of finished points and of all
        workers: threads of a Lua function without an executor
        max_time: seconds of a point, of a Lua function

    Example:

        m = dinal.sweep(over={"r": [1, 2]}, run=lambda p: {"y": p.r**2})
    """
    over = [[name, values] for name, values in over.items()] if hasattr(over, "items") else over  # in the order of a dict
    options = {"over": over, "seed": seed, "max_time": max_time}
    is_lua = isinstance(run, (Function, LuaFile))
    if is_lua and executor is None:
        options["workers"] = workers
    elif workers is not None:
        raise TypeError("workers is of a Lua function without an executor: an executor has workers of its own")
    makes = isinstance(executor, type) or callable(executor) and not hasattr(executor, "submit")
    if executor is not None and not makes and not hasattr(executor, "submit"):
        raise TypeError("executor must be a concurrent.futures.Executor, such as ProcessPoolExecutor(8), or a function that "
                        f"makes one, not a {type(executor).__name__}")
    kept = {**options, "file": file and os.fspath(file)}
    own = run.options["run"] if isinstance(run, LuaFile) else run
    if is_lua and executor is None and progress is None:
        return _dinal.sweep({**kept, "run": own})
    # Without a file, the points that Ctrl-C leaves are not resumed: computing the digest might fail for a local function.
    mark = "" if is_lua else hashlib.sha256(repr(digest(run, {})).encode() if file else os.urandom(32)).hexdigest()
    parts = _dinal.sweep_in_parts({**kept, "run": own}, mark)
    call, tries = (part, run, options), 0
    try:
        while chunks := [(int(first), min(int(first) + parts.chunk, parts.size)) for first in parts.left(parts)]:
            pool = executor() if makes else executor
            try:
                for first, data in ((chunk[0], part(run, options, *chunk, os.getpid())) for chunk in chunks) if pool is None else \
                        results(pool, chunks, call):
                    done = parts.take(parts, first, data)
                    progress and progress(done, parts.size)
            except concurrent.futures.BrokenExecutor as broken:
                tries = tries + 1 if len(parts.left(parts)) == len(chunks) else 0
                if not makes or tries > 2:
                    raise Error("a worker was killed; " + ("the same call continues" if file else "with a file the same call would continue")) from broken
            finally:
                if makes:
                    pool.shutdown()
    except BaseException:
        parts.keep(parts)
        raise
    return parts.finish(parts)


def main():
    """python3 -m dinal.sweep MAP.lua"""
    parser = argparse.ArgumentParser("python3 -m dinal.sweep", description="Runs the sweep that a Lua file returns, { over = ..., run = "
                                     "..., file = ... }, on several processes. Under MPI: mpirun -n 64 python3 -m mpi4py.futures -m dinal.sweep MAP.lua --mpi")
    parser.add_argument("lua", metavar="MAP.lua")
    parser.add_argument("--workers", type=int, metavar="N", help="processes on this machine; by default one for each core")
    parser.add_argument("--mpi", action="store_true", help="the processes of MPI (needs mpi4py)")
    parser.add_argument("--dask", metavar="ADDRESS", help="the workers of that scheduler (needs dask.distributed)")
    asked = parser.parse_args()
    run = LuaFile(pathlib.Path(asked.lua).read_text(), asked.lua)
    if asked.mpi:
        from mpi4py.futures import MPIPoolExecutor as make
    elif asked.dask:
        from dask.distributed import Client
        make = Client(asked.dask).get_executor
    else:
        make = functools.partial(concurrent.futures.ProcessPoolExecutor, asked.workers)
    shown = sys.stderr.isatty()
    try:
        print(sweep(**{**run.options, "run": run, "workers": None, "executor": make, "progress":
                       lambda *told: shown and print("\r%d of %d points" % told, end="\n" if told[0] == told[1] else "", file=sys.stderr)}))
    except KeyboardInterrupt:
        sys.exit(130)
    except Error as wrong:
        sys.exit(f"dinal.sweep: {wrong}")
