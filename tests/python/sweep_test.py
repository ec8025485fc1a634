"""dinal.sweep on engines: the same bytes from each, after any death. Engines that are not installed are skipped.

    python3 sweep_test.py SOURCE PROGRAM [--long] [[but] CLASS ...], with PYTHONPATH set to the module's folder
"""

import concurrent.futures as cf
import functools
import importlib.util
import multiprocessing
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import textwrap
import threading
import time
import unittest

import dinal
import numpy as np

check = unittest.TestCase()
equal = check.assertEqual

SOURCE, PROGRAM = [*sys.argv, "", ""][1:3]
LONG = "--long" in sys.argv
OVER = {"r": np.linspace(.3, 2, 20), "g": np.linspace(0, 1, 15)}
SCALE = 2.  # what point takes from outside


def point(p, chance):
    if p.r > 1.9 and p.g > .9:
        raise ValueError(f"far away, {p.r:.2f}")
    return {"y": SCALE * np.sin(p.r) / (p.g + .1), "u": chance.random(), "word": "low" if p.g < .5 else "high", "is": p.r > 1}


def slow(p):
    time.sleep(.002)
    return {"y": p.r * p.g}


def leave(p):
    sys.exit(7)


def die(p, places=(5,)):
    if p.r in places and not os.path.exists(f"died{p.r}"):
        pathlib.Path(f"died{p.r}").touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return {"y": p.r}


def die_often(p):
    return die(p, (4, 9, 14, 18))


MAP = """
return { over = { r = vector.linspace(0.3, 2, 20), g = vector.linspace(0, 1, 15) }, seed = 3, file = "map.csv", run = function(p)
    if p.r > 1.9 and p.g > 0.9 then error("far away") end
    local s = nondimensional{ friction_ratio = p.g }:steady{ M = excitation.harmonic{ frequency = p.r } }
    return { A = s.amplitude, stops = s.stops, u = math.random() }
end }
"""
SCRIPT = """
import concurrent.futures, os, sys, time
import dinal, numpy as np

def slow(p):
    time.sleep(.002)
    return {"y": p.r * p.g}

if __name__ == "__main__":
    executor = {"none": None, "pool": lambda: concurrent.futures.ProcessPoolExecutor(2)}[sys.argv[1]]
    told = lambda done, count: print(done, flush=True, file=sys.stdout)
    try:
        dinal.sweep(over={"r": np.linspace(0, 1, 20), "g": np.linspace(0, 1, 15)}, run=slow, executor=executor, file="map.csv", progress=told)
    except KeyboardInterrupt:
        sys.exit(130)
"""


@functools.cache
def dask():
    """A client of two workers for all tests, which outlive the folder of each."""
    from dask.distributed import Client, LocalCluster
    before = os.getcwd()
    os.chdir("/")
    client = Client(LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0"))
    os.chdir(before)
    unittest.addModuleCleanup(client.cluster.close)
    unittest.addModuleCleanup(client.close)
    return client


class InAFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.home = pathlib.Path(folder.name)
        before = os.getcwd()
        os.chdir(folder.name)
        self.addCleanup(os.chdir, before)

    def files(self):
        return sorted(entry.name for entry in self.home.iterdir())

    def python(self, *command, **more):
        return subprocess.run([sys.executable, *command], capture_output=True, text=True, timeout=120, **more)


class Engines(InAFolder):
    def check(self, executor, over=OVER, run=point, **more):
        """What the engine gives is what the caller alone gives."""
        alone = dinal.sweep(over=over, run=run, seed=3, file="alone.csv", **more)
        other = dinal.sweep(over=over, run=run, seed=3, executor=executor, file="other.csv", **more)
        equal(str(other), str(alone))
        equal(pathlib.Path("other.csv").read_bytes(), pathlib.Path("alone.csv").read_bytes())
        equal(self.files(), ["alone.csv", "other.csv"])
        for name in self.files():
            os.remove(name)

    def test_processes_and_threads(self):
        lua = dinal.lua("function(p) return { y = A*p.r, u = math.random(), d = d.n[2] } end", A=3, d=dinal.data(n=[1, 2]))
        for run in (point, lua):
            with cf.ProcessPoolExecutor(2) as pool, cf.ThreadPoolExecutor(2) as threads:
                self.check(pool, run=run)
                self.check(threads, run=run)
            self.check(lambda: cf.ProcessPoolExecutor(2, multiprocessing.get_context("spawn")), run=run)

    def test_joblib(self):
        if not importlib.util.find_spec("joblib"):
            self.skipTest("no joblib: apt-get install python3-joblib")
        from joblib.externals.loky import get_reusable_executor
        pool = get_reusable_executor(2)
        factor = 2
        self.check(pool, run=lambda p: {"y": factor * p.r})
        self.check(pool)
        pool.shutdown(kill_workers=True)

    def test_dask(self):
        if not importlib.util.find_spec("distributed"):
            self.skipTest("no dask.distributed: apt-get install python3-distributed")
        self.check(dask().get_executor())

    def test_many_machines(self):
        """What the page shows runs, with fewer points: its script and a map in Lua on each engine, and dinal itself."""
        page = (pathlib.Path(SOURCE) / "docs/many-machines.md").read_text()
        script, map_file = (re.search(f"```{language}\n(.*?)```", page, re.S)[1].replace("400", "20").replace("200", "10")
                            for language in ("python", "lua"))
        for text in (map_file, MAP):
            pathlib.Path("map.lua").write_text(text)
            subprocess.run([PROGRAM, "-e", "sweep(dofile('map.lua'))"], check=True)
            wanted = pathlib.Path("map.csv").read_bytes()
            os.remove("map.csv")
        pathlib.Path("map.py").write_text(script)
        commands = re.findall(r"`(python3 map.py .*?|mpirun .*? map.py mpi)`", page) + re.findall(r"^((?:python3|mpirun) .*-m dinal.sweep .*)$", page, re.M)
        equal(len(commands), 6)
        rows = set()
        for command in commands:
            if "dask" in command and not importlib.util.find_spec("distributed"):
                continue
            if "mpirun" in command and not (shutil.which("mpirun") and importlib.util.find_spec("mpi4py")):
                continue
            if "dask" in command:
                command = command.replace("tcp://head:8786", dask().scheduler.address)
            command = command.replace("mpirun -n 64", "mpirun --allow-run-as-root --oversubscribe -n 3").replace("python3 ", sys.executable + " ")
            with self.subTest(command):
                done = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=120)
                equal(done.returncode, 0, done.stderr)
                if "map.py" in command:
                    rows.add(pathlib.Path("map.csv").read_text().partition("\n")[2])
                else:
                    self.assertIn("data: 300 points, 4 of them failed", done.stdout)
                    equal(pathlib.Path("map.csv").read_bytes(), wanted)
                os.remove("map.csv")
        equal(len(rows), 1)
        equal(self.files(), ["map.lua", "map.py", "stops.svg"])
        pathlib.Path("map.lua").write_text("return 3")
        self.assertIn("must return a table of the options of sweep", self.python("-m", "dinal.sweep", "map.lua").stderr)


class Points(InAFolder):
    def test_order(self):
        m = dinal.sweep(over={"r": [1, 2], "g": ["a", "b"]}, run=lambda p: {"y": p.r})
        equal((m.names, m.y.tolist(), list(m.g)), (["r", "g", "y", "error"], [1, 1, 2, 2], ["a", "b", "a", "b"]))

    def test_errors_stay_with_their_points(self):
        m = dinal.sweep(over={"r": [0, 1, 2]}, run=lambda p: {"y": 1 // int(p.r)})
        equal(m.error[0], "ZeroDivisionError: integer division or modulo by zero")
        equal(m.y.tolist()[1:], [1, 0])
        with self.assertRaisesRegex(dinal.Error, "all 2 points failed; the first one, r = 1: KeyError: 'x'"):
            dinal.sweep(over={"r": [1, 2]}, run=lambda p: {}["x"])
        with self.assertRaisesRegex(dinal.Error, "must return a dict of named numbers such as dict"):
            dinal.sweep(over={"r": [1]}, run=lambda p: 3)

    def test_who_exits_exits(self):
        for executor in (None, lambda: cf.ProcessPoolExecutor(1)):
            with self.assertRaises(SystemExit) as caught:
                dinal.sweep(over={"r": [1, 2]}, run=leave, executor=executor)
            equal(caught.exception.code, 7)

    def test_random_numbers_are_of_the_point(self):
        def draw(seed):
            return dinal.sweep(over={"r": range(50)}, run=lambda p, chance: {"u": chance.random()}, seed=seed).u.tolist()
        equal(draw(1), draw(1))
        self.assertNotEqual(draw(1), draw(2))
        equal(len(set(draw(1))), 50)

    def test_progress(self):
        for run in (slow, dinal.lua("function(p) return { y = 1 } end")):
            told = []
            dinal.sweep(over=OVER, run=run, progress=lambda *now: told.append(now))
            equal(told[-1], (300, 300))
            equal(told, sorted(told))

    def test_what_is_wrong(self):
        for error, options in ((TypeError, dict(over={"r": [1]}, run=slow, workers=2)), (TypeError, dict(run=slow)),
                               (TypeError, dict(over={"r": [1]}, run=slow, executor=3)),
                               (dinal.Error, dict(over={"r": []}, run=slow)), (dinal.Error, dict(over={"r": [1]}, run=3)),
                               (dinal.Error, dict(over={"r": [1]}, run=slow, max_time=1)),
                               (ValueError, dict(over={"r": [1]}, run=slow, file="map.txt"))):
            with self.assertRaises(error):
                dinal.sweep(**options)
        equal(self.files(), [])


class Deaths(InAFolder):
    """Of a worker, of the caller, of the disk: the same call ends with the same bytes."""

    def test_a_killed_worker(self):
        over = {"r": range(20)}
        with cf.ProcessPoolExecutor(2) as pool, self.assertRaisesRegex(dinal.Error, "a worker was killed; the same call continues"):
            dinal.sweep(over=over, run=die, executor=pool, file="map.csv")
        self.assertIsInstance(dinal.partial, dinal.Data)
        equal(dinal.sweep(over=over, run=die, file="map.csv").y.tolist(), list(range(20)))
        told = []
        m = dinal.sweep(over=over, run=die_often, executor=lambda: cf.ProcessPoolExecutor(2), progress=lambda *now: told.append(now))
        equal((m.y.tolist(), told[-1]), (list(range(20)), (20, 20)))

    def started(self, engine):
        process = subprocess.Popen([sys.executable, "script.py", engine], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   start_new_session=True)
        self.addCleanup(self.end, process)
        return process

    def end(self, process):
        """With the workers of a pool, which outlive a caller that is killed and keep its output open."""
        process.wait(timeout=60)
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        return process.communicate(timeout=60)[1] if not process.stdout.closed else ""

    def test_the_caller_dies_or_is_interrupted(self):
        pathlib.Path("script.py").write_text(SCRIPT)
        equal(self.python("script.py", "none").returncode, 0)
        wanted = pathlib.Path("map.csv").read_bytes()
        chance = random.Random(1)
        for engine in ("none", "pool"):
            os.remove("map.csv")
            for _ in range(20 if LONG else 4):
                process = self.started(engine)
                for _ in range(chance.randrange(1, 30)):
                    process.stdout.readline()
                time.sleep(chance.uniform(0, .02))
                what = chance.choice([signal.SIGKILL, signal.SIGINT, signal.SIGINT])
                os.killpg(process.pid, what) if what == signal.SIGINT else process.kill()  # a terminal interrupts all of the group
                err = self.end(process)
                self.assertIn(process.returncode, (0, 130, -what), err)
                if what == signal.SIGINT:
                    self.assertNotIn("Traceback", err)
            done = self.python("script.py", engine)
            equal(done.returncode, 0, done.stderr)
            equal(pathlib.Path("map.csv").read_bytes(), wanted)
            equal(self.files(), ["map.csv", "script.py"])

    def test_two_callers(self):
        pathlib.Path("script.py").write_text(SCRIPT.replace(".002", ".02"))
        first = self.started("pool")
        first.stdout.readline()
        second = self.python("script.py", "none")
        self.assertIn("another process is at the same sweep", second.stderr)
        equal(self.end(first), "")
        equal(first.returncode, 0)

    def test_a_full_disk(self):
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        before = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (3000, limits[1]))
        try:
            with self.assertRaisesRegex(dinal.Error, "cannot write 'map.csv.part': File too large; finished points are kept"):
                dinal.sweep(over=OVER, run=slow, file="map.csv")
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
            signal.signal(signal.SIGXFSZ, before)
        done = []
        dinal.sweep(over=OVER, run=slow, file="map.csv", progress=lambda now, count: done.append(now))
        self.assertGreater(done[0], 30)
        equal(self.files(), ["map.csv"])

    def test_another_function_is_refused(self):
        code = """
            import dinal, numpy as np, helper
            A = 2
            def inner(x): return A * x
            class Tool:
                C = 5
                def __init__(self): self.d = 6
                def use(self, x): return self.C + self.d + 7 * x
            tool = Tool()
            def made(e): return lambda: e
            last = made(9)
            def point(p, b=1, *, c=3): return {"y": (lambda x: inner(x))(p.r) + b + c + helper.B + tool.use(1) + last()}
            dinal.sweep(over={"r": np.arange(3.)}, run=point, file="map.csv")
            """
        code = textwrap.dedent(code)
        pathlib.Path("helper.py").write_text("B = 1")
        for before in ("", "# a remark\n\n"):
            shown = self.python("-c", before + code)
            equal((shown.returncode, shown.stderr), (0, ""))
        changes = [("A = 2", "A = 3"), ("A * x", "A + x"), ("b=1", "b=2"), ("c=3", "c=5"), ("p.r)", "p.r + 1)"), ("3.", "4."), ("C = 5", "C = 4"),
                   ("d = 6", "d = 5"), ("7 * x", "8 * x"), ("made(9)", "made(8)")]
        # All in one process, as to start one takes longer than to refuse.
        others = "\n".join([f"for old, new in {changes}:",
                            "    try:",
                            f"        exec({code!r}.replace(old, new, 1), {{'__name__': '__main__'}})",
                            "    except dinal.Error as error:",
                            "        print(new, error)"])
        said = self.python("-c", "import dinal\n" + others).stdout
        for _, new in changes:
            self.assertRegex(said, re.escape(new) + " .* is not the result of this sweep")
        pathlib.Path("helper.py").write_text("B = 2")
        self.assertIn("is not the result of this sweep", self.python("-c", code).stderr)


class Lock(unittest.TestCase):
    """Python's lock is free while Lua computes, as long as it calls no function of Python."""

    def ticks(self, call):
        ticks, ends = [], threading.Event()
        thread = threading.Thread(target=lambda: [ticks.append(time.perf_counter()) for _ in iter(lambda: ends.wait(.005), True)])
        thread.start()
        start = time.perf_counter()
        call()
        end = time.perf_counter()
        ends.set()
        thread.join()
        return sum(start < t < end for t in ticks)

    def test_others_run(self):
        osc = dinal.system(I=1, k=4, Rd=.3)
        M = dinal.lua("function(t) return math.sin(t^1.01) end")
        for call in (lambda: osc.simulate(M=M, t_end=50_000, times=[]), lambda: dinal.lua("for i = 1, 2e8 do end"),
                     lambda: dinal.lua("for i = 1, 1e7 do local t = {} end"),
                     lambda: dinal.sweep(over={"r": np.linspace(.3, 2, 1000)}, run=dinal.lua("function(p) local s = 0 for i = 1, 4e5 do s = s + i end return { s = s } end"))):
            for _ in range(100):
                dinal.lua("f(1)", f=lambda x: None)  # which Lua drops while it computes
            self.assertGreater(self.ticks(call), 4)  # with the lock held there is one at most, at each end

    def test_python_is_called_all_the_same(self):
        seen = []

        class Dropped:
            def __del__(self):
                seen.append(threading.get_ident())
        osc = dinal.system(I=1, k=4)

        def work():
            dinal.lua("(function() f(1) for i = 1, 1e5 do local t = {} end collectgarbage() collectgarbage() print_it() end)()",
                      f=lambda x, keep=Dropped(): None, print_it=lambda: osc.simulate(M=lambda t: 1., t_end=1))
        threads = [threading.Thread(target=work) for _ in range(4)]
        busy = threading.Event()
        spinner = threading.Thread(target=lambda: [None for _ in iter(busy.is_set, True)])
        spinner.start()
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        busy.set()
        spinner.join()
        del work
        dinal.lua("collectgarbage()")
        dinal.lua("collectgarbage()")

    def test_the_end_of_the_program(self):
        code = ("import dinal, threading, time\n"
                "threading.Thread(target=lambda: dinal.lua('while true do local t = {} end'), daemon=True).start()\ntime.sleep(.1)")
        for _ in range(2):
            shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=30)
            equal((shown.returncode, shown.stderr), (0, ""))


if __name__ == "__main__":
    import warnings
    warnings.simplefilter("ignore", DeprecationWarning)  # of tornado, within Dask
    words = [word for word in sys.argv[3:] if word != "--long"]
    if words[:1] == ["but"]:
        words = [name for name, kind in globals().items() if isinstance(kind, type) and name not in words]
    unittest.main(argv=sys.argv[:1] + words)
