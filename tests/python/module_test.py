"""The Python module: objects, arrays, callables, errors, signals, threads.

Run by ctest with PYTHONPATH set to the module's folder: python3 module_test.py SOURCE PROGRAM.
"""

import concurrent.futures
import contextlib
import copy
import gc
import importlib.util
import inspect
import io
import math
import multiprocessing
import os
import pathlib
import pickle
import random
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import traceback
import unittest
import warnings
import weakref

import numpy as np
import pandas

import dinal

check = unittest.TestCase()
equal, contained, raises, raises_with, greater = check.assertEqual, check.assertIn, check.assertRaises, check.assertRaisesRegex, check.assertGreater

SOURCE, PROGRAM = [*sys.argv, "", ""][1:3]


def python(code, **more):
    """What another Python prints."""
    return subprocess.run([sys.executable, "-c", "import dinal, math, os, signal, sys, threading, time\n" + code],
                          capture_output=True, text=True, timeout=30, **more)


class Objects(unittest.TestCase):
    def setUp(self):
        self.sys = dinal.system(I=1, k=4, Rd=.3, Re=.4)
        self.run = self.sys.simulate(theta0=1, t_end=20)

    def test_members(self):
        equal(self.sys.omega0, 2)
        equal(self.sys.with_(Rd=0).Rd, 0)
        equal(self.sys.with_(k=9).omega0, 3)
        theta, velocity = self.run.at(1.25)
        self.assertIsInstance(theta, float)
        equal(self.run.status, "rest")
        equal(self.run.system.k, 4)
        self.assertIsInstance(self.run, dinal.Run)
        equal(dinal.nondimensional().I, dinal.nondimensional(zeta=0).I)

    def test_names_in_a_run(self):
        run = dinal.system(I=1, k=4).simulate(theta0=1, t_end=1)
        self.assertTrue("theta" in run and run[0] in run and "x" not in run)
        equal(dinal.version, dinal.__version__)

    def test_what_is_shown(self):
        lua = subprocess.run([PROGRAM, "-e", "print(system{ I = 1, k = 4, Rd = .3, Re = .4 }:simulate{ theta0 = 1, t_end = 20 })"],
                             capture_output=True, text=True)
        equal(str(self.run), lua.stdout.rstrip("\n"))
        contained("rows", repr(self.run))
        contained("simulate", dir(self.sys))
        contained("kind", dir(self.run.events))
        for value in (self.run, self.run.events, dinal, self.run[0]):
            equal(len(dir(value)), len(set(dir(value))))

    def test_events_and_data(self):
        events = self.run.events
        equal(events.kind[-1], "rest")
        equal(events[0]["kind"], "turn")
        equal(events[-1].t, events.t[-1])
        equal(len(list(events)), len(events))
        equal(len(events[1:3]), 2)
        equal(np.count_nonzero(events.kind == "rest"), 1)
        with raises(IndexError):
            events[len(events)]

    def test_frames(self):
        equal(list(pandas.DataFrame(dict(self.run)).columns), self.run.names)
        frame = pandas.DataFrame(dict(self.run.events))
        equal(frame.kind.iloc[-1], "rest")
        data = dinal.data(r=[1, 2], word=["a", "b"])
        equal(pandas.DataFrame(dict(data)).word.tolist(), ["a", "b"])
        again = dinal.data(pandas.DataFrame({"r": [1., 2.], "A": [3., 4.]}))
        equal(again.A.tolist(), [3, 4])

    def test_order_of_fields(self):
        """The same in each process, although Lua's tables have another order in each."""
        balance = ["input", "kinetic", "spring", "viscous", "dry", "error", "belt", "base", "acts", "impacts", "flow", "closure"]
        equal(list(pandas.DataFrame(self.run)), self.run.names)
        equal(list(self.run[0]), self.run.names)
        equal(list(pandas.DataFrame(self.run.events)), self.run.events.names)
        equal(list(self.run.events[0]), self.run.events.names)
        equal(list(dinal.data([["w", [1]], ["a", [2]], ["t", [3]]])[0]), ["w", "a", "t"])
        equal(list(self.run.energy().total), balance)
        equal(list(self.run.energy().half_cycles[0])[:6], ["t_start", "t_end", "theta_start", "theta_end", *balance[:2]])
        equal(list(dinal.lua("{ d = 1, c = 2, b = 3, a = 4, [2.5] = 5, [-1] = 6, [true] = 7 }")),
              [-1, 2.5, "a", "b", "c", "d", True])
        equal(list(dinal.lua("(function() local row = d[1] row.t, row.new, row.also = nil, 1, 2 return row end)()",
                             d=self.run)), [*self.run.names[1:], "also", "new"])
        equal(dinal.lua("{ 1, nil, 3, x = 5 }"), {1: 1, 3: 3, "x": 5})

    def test_links(self):
        links = dict(clutch=("motor", "load", dict(Rd=2)))
        rig = dinal.system(bodies=dict(motor=dict(I=1), load=dict(I=3)), links=links)
        equal((list(rig.bodies), list(rig.links)), (["load", "motor"], ["clutch"]))
        self.assertAlmostEqual(rig.simulate(velocity0=dict(motor=3), t_end=4).motor.velocity[-1], .75, 12)
        equal(links, dict(clutch=("motor", "load", dict(Rd=2))))
        weights = dinal._objects.link_of(({"carrier": 2.5, "sun": -1}, dict(rigid=True)))
        equal(weights, {"carrier": 2.5, "sun": -1, "rigid": True})
        equal(dinal.lua("#t, t.k, #u", t=("a", "b", dict(k=3)), u=(dict(a=1), dict(b=2))), (2, 3, 2))

    def test_curves(self):
        x = np.linspace(0, 1, 5)
        for curves in ((x, x**2), ([x, x],), ((x, x, dict(label="twice")), [x, 2 * x]), (self.run, (self.run, dict(label="twice")))):
            contained("<svg", dinal.plot(*curves, title="two", show=False)._repr_svg_())

    def test_excitations(self):
        e = dinal.excitation.harmonic(amplitude=2, frequency=1)
        equal((2 * e - e / np.float64(2))(.25), 3)
        equal((-e)(.25), -2)
        equal((np.float64(3) * e)(.25), 6)
        with raises(TypeError):
            self.run + 1

    def test_keywords_in_their_places(self):
        e = dinal.excitation.harmonic(frequency=1)
        equal(e.value(t=.25), e.value(.25))

    def test_unknown_names(self):
        with raises_with(AttributeError, "did you mean 'theta'"):
            self.run.tetha
        with raises_with(AttributeError, "did you mean 'system'"):
            dinal.sistem
        with raises_with(AttributeError, "make a new one"):
            self.sys.I = 2
        with raises_with(TypeError, "cannot create"):
            dinal.Run()

    def test_tables(self):
        equal(dinal.lua("{ 1, 2, { a = true } }"), [1, 2, {"a": True}])
        equal(dinal.lua("{ x = 1 }").x, 1)
        equal(dinal.lua("1, 'two'"), (1, "two"))
        equal(dinal.lua("#t, t.a[2]", t={"a": (1, 2), 1: 5}), (1, 2))
        equal(dinal.lua("'\\xff'").encode("utf-8", "surrogateescape"), b"\xff")
        circle = dinal.lua("(function() local t = {} t.t = t return t end)()")
        self.assertIs(circle.t, circle)
        equal(dinal.lua("n", n=2**70), 2.**70)
        equal(dinal.lua("name", name=pathlib.Path("a")), "a")
        word = object()
        self.assertIs(dinal.lua("x", x=word), word)
        self.assertIs(dinal.lua("f", f=math.sin), math.sin)

    def test_depth(self):
        """Tables and lists may be 100 deep in both directions; a deeper one is an error, not a crash."""
        nested = "(function() local t = {} for i = 1, %d do t = { %st } end return t end)()"
        deep = dinal.lua(nested % (100, ""))
        equal(dinal.lua("x", x=deep), deep)
        circle = []
        circle.append(circle)
        for too_deep in ([deep], {"x": {"x": deep}}, circle):
            with raises_with(ValueError, "too deep"):
                dinal.lua("x", x=too_deep)
        for table in (nested % (101, ""), nested % (100_000, ""), nested % (100_000, "x = ")):
            for text in (table, f"f({table})"):
                with raises_with(ValueError, "too deep"):
                    dinal.lua(text, f=lambda x: None)

    def test_order_of_output(self):
        buffered = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}
        shown = python("print(1); dinal.lua('print(2)'); print(3); dinal.lua('print(4)')\n"
                       "dinal.lua('f() print(6)', f=lambda: print(5))\n"
                       "dinal.sweep(over={'r': [7]}, run=dinal.lua('function(p) print(p.r) return { A = 1 } end'))", env=buffered)
        equal(shown.stdout, "1\n2\n3\n4\n5\n6\n7.0\n", shown.stderr)

    def test_axes(self):
        """The figure goes to axes of Matplotlib; here to something that notes what they are told."""
        class Axes:
            def __init__(self):
                self.told = {}

            def __getattr__(self, name):
                if name.startswith("_"):
                    raise AttributeError(name)
                return lambda *arguments, **options: self.told.setdefault(name, []).append((arguments, options))
        ax = Axes()
        self.assertIs(self.run.plot(ax=ax, title="a run"), ax)
        (t, theta, form), options = ax.told["plot"][0]
        self.assertLess(np.abs(theta - self.run.at(t)[0]).max(), 1e-9)
        equal((form, ax.told["set_title"][0][0][0], ax.told["set_xscale"][0][0][0]), ("-", "a run", "linear"))
        equal(len(ax.told["axvspan"]), len(self.run.events.t[self.run.events.kind == "rest"]))
        dinal.plot([[1, 10], [1, 100]], xlog=True, ax=(log := Axes()))
        equal([log.told[f"set_{of}scale"][0][0][0] for of in "xy"], ["log", "linear"])
        two = [Axes(), Axes()]
        self.run.plot(y=["theta", "velocity"], ax=two)
        equal([len(one.told["plot"]) for one in two], [1, 1])
        with raises_with(ValueError, "has 2 parts, and ax 1"):
            self.run.plot(y=["theta", "velocity"], ax=ax)
        dinal.plot([[0, 1], [1, 2]], ([0, 1], [2, 3], dict(style="fill")), ([0, 1], [2, 3], dict(style="fill", base=[1, 2])), ax=ax)
        equal([np.ravel(filled[0][2]).tolist() for filled in ax.told["fill_between"]], [[0], [1, 2]])

    def test_matplotlib(self):
        if not importlib.util.find_spec("matplotlib"):
            self.skipTest("no matplotlib: apt-get install python3-matplotlib")
        import matplotlib
        matplotlib.use("agg")
        from matplotlib import pyplot
        figure, axes = pyplot.subplots(2)
        self.run.plot(y=["theta", "velocity"], ax=axes)
        self.run.phase_plot(ax=axes[0])
        self.sys.response(over={"frequency": [.1, .2, .3]}).plot(ax=axes[1])
        dinal.identify(data=self.run).plot(ax=axes)
        with tempfile.NamedTemporaryFile(suffix=".png") as file:
            figure.savefig(file.name)
            greater(os.path.getsize(file.name), 5000)

    def test_at(self):
        times = np.linspace(0, 20, 7)
        theta, velocity = self.run.at(times)
        equal(theta.tolist(), [self.run.at(t)[0] for t in times])
        equal(self.run.at([1, 2])[1].tolist(), [self.run.at(1)[1], self.run.at(2)[1]])
        equal([len(part) for part in self.run.at([])], [0, 0])
        run = self.sys.simulate(states={"e": {"rate": lambda t: 1}}, t_end=5)
        self.assertLess(np.abs(run.at(times / 5)[2].e - times / 5).max(), 1e-12)

    def test_pages(self):
        contained("<table", self.run.events._repr_html_())
        picture = self.run.plot(show=False)
        self.assertIsInstance(picture, dinal.Picture)
        contained("<svg", self.run._repr_svg_())
        contained("<svg", picture._repr_svg_())
        contained("data:image/svg+xml;base64,", picture._repr_html_())
        for shown in (self.sys, self.run.energy(), dinal.nondimensional(zeta=.1).steady(M=dinal.excitation.harmonic(frequency=1))):
            self.assertTrue(shown._repr_html_().startswith("<pre>"), shown)
        equal(self.run._ipython_key_completions_(), self.run.names)
        contained("stuck", python("dinal.system(I=1, k=4, Rd=1).simulate(theta0=1, t_end=9).plot()").stdout)


def law(speed):
    return .3 + .1 * speed


def drive(t):
    return math.sin(t)


class Travel(unittest.TestCase):
    """Objects are pickled and copied."""

    def both(self, value):
        self.assertIs(copy.deepcopy(value), value)
        again = pickle.loads(pickle.dumps(value))
        self.assertIs(type(again), type(value))
        equal(str(again), str(value))
        return again

    def test_what_has_a_text(self):
        rig = dinal.system(bodies=dict(a=dict(I=1, k=2, friction=dinal.friction.law(law, Re=.5)), b=dict(I=2)), units=dict(theta="m"),
                           links=dict(l=("a", "b", dict(k=3, Rd=.1))))
        for value in (dinal.system(I=1, k=4, Rd=.3, Re=.4, C=.1, walls=dict(upper=1), spring=dinal.spring.polynomial({3: .1})), rig,
                      dinal.friction.stribeck(Rd=.3, Re=.6, speed=.1), dinal.friction.law(law), dinal.integrator.rk4(h=.01),
                      dinal.integrator.dopri5(tolerance=1e-9), dinal.spring.polynomial({3: .5}), dinal.system(I=1, k=1, spring=dinal.lua("function(x) return x^3 end"))):
            self.both(value)
        again = self.both(rig)
        starts = dict(theta0=dict(a=1, b=0), t_end=5)
        equal(again.simulate(**starts).a.theta.tolist(), rig.simulate(**starts).a.theta.tolist())

    def test_excitations(self):
        t = np.linspace(0, 5, 20_001)
        times = np.linspace(0, 6, 50)
        for e in (2 * dinal.excitation.harmonic(frequency=.4) - dinal.excitation.pulse(at=1, width=.3).delay(.5).window(0, 3),
                  dinal.excitation.samples(t=t, M=np.sin(t), interpolation="cubic"), dinal.excitation.scripted(drive),
                  dinal.excitation.scripted(dinal.lua("function(t) return A*v[2]*t end", A=2, v=[1, 3.]))):
            again = pickle.loads(pickle.dumps(e))
            equal(again(times).tolist(), e(times).tolist())

    def test_lua_functions(self):
        weights = np.random.default_rng(1).uniform(size=30_000)
        helper = dinal.lua("function(x) return w[1] + #w + x + f(x) end", w=weights, f=math.sqrt)
        f = dinal.lua("function(p) return { y = h(p.x), z = s.omega0, n = d.n[2] } end", h=helper, s=dinal.system(I=1, k=4), d=dinal.data(n=[1, 2]))
        again = pickle.loads(pickle.dumps(f))
        equal(again({"x": 4}), f({"x": 4}))
        equal(again({"x": 4}).y, weights[0] + 30_000 + 4 + 2)
        recursive = dinal.lua("(function() local function f(n) return n < 2 and 1 or n * f(n - 1) end return f end)()")
        equal(pickle.loads(pickle.dumps(recursive))(5), 120)
        equal(dinal.lua("function() return { 1, nil, 3 }, { 1, 2 } end")(), ({1: 1, 3: 3}, [1, 2]))  # a hole makes no list

    def test_what_remembers_its_call(self):
        osc = dinal.system(I=1, k=4, Rd=.3)
        times = np.array([0, 1, 2.])
        run = osc.simulate(M=drive, theta0=1, times=times)
        times[1] = 1.5
        equal(self.both(run).t.tolist(), [0, 1, 2])
        equal(self.both(run.continue_(t_end=4)).theta[-1], run.continue_(t_end=4).theta[-1])
        s = osc.steady(M=dinal.excitation.harmonic(frequency=.4))
        self.both(s.run)
        equal(self.both(s).amplitude, s.amplitude)
        self.both(run.energy())
        self.both(dinal.identify(data=osc.simulate(theta0=1, t_end=9)))

    def test_data(self):
        frame = dinal.system(I=1, k=4, Rd=.3).simulate(theta0=1, t_end=5)
        equal(self.both(frame.events).kind.tolist(), frame.events.kind.tolist())
        swept = dinal.sweep(over={"a": [1, 2], "b": [1, 2]}, run=dinal.lua("function(p) return { y = p.a } end"))
        contained("<svg", self.both(swept).plot(x="a", y="b", z="y", show=False)._repr_svg_())
        equal(pickle.loads(pickle.dumps(frame[0])).theta, 1)

    def test_what_cannot(self):
        for value, words in ((dinal.excitation.scripted(lambda t: 1.), "lambda"), (dinal.lua("coroutine.create(print)"), "thread"),
                             (dinal.system(I=1, k=1).simulate(M=lambda t: 1., t_end=1), "lambda"),
                             (dinal.report(title="x"), "report"), (dinal.lua("{ r = s:simulate{ t_end = 1 } }", s=dinal.system(I=1, k=4)).r, "within a call"),
                             (dinal.lua("(function() function again(n) return again(n - 1) end return again end)()"), "make it local")):
            with raises_with((pickle.PicklingError, AttributeError), words):
                pickle.dumps(value)

    def test_errors(self):
        for call in (lambda: dinal.system(I=-1, k=4), lambda: dinal.system(K=4), lambda: dinal.lua("error('x')")):
            with raises(dinal.Error) as caught:
                call()
            again = pickle.loads(pickle.dumps(caught.exception))
            equal((type(again), str(again), again.culprit), (type(caught.exception), str(caught.exception), caught.exception.culprit))

    def test_processes(self):
        with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as pool:
            systems = [dinal.system(I=1, k=k) for k in (1, 4)]
            equal(list(pool.map(frequency, systems)), [1, 2])


def frequency(system):
    return system.omega0


class Arrays(unittest.TestCase):
    def test_no_copy(self):
        run = dinal.system(I=1, k=4).simulate(theta0=1, t_end=20)
        address = run.theta.__array_interface__["data"][0]
        equal(run.theta.__array_interface__["data"][0], address)
        theta = run.theta
        self.assertFalse(theta.flags.writeable)
        with raises(ValueError):
            theta[0] = 1
        with raises(ValueError):
            theta.flags.writeable = True
        sum_before = theta.sum()
        del run
        for _ in range(20):
            dinal.system(I=1, k=4).simulate(theta0=1, t_end=2000, dt=.01)
        gc.collect()
        dinal.lua("collectgarbage()")
        equal(theta.sum(), sum_before)

    def test_all_that_holds_numbers(self):
        import array
        import ctypes
        times = [0, 1, 2.5]
        sys = dinal.system(I=1, k=4)
        for given in (times, tuple(times), np.array(times), np.array(times, dtype="f4"), array.array("d", times),
                      memoryview(np.array(times)), (ctypes.c_double * 3)(*times), pandas.Series(times), np.array([9, 0, 1, 9, 2.5])[[1, 2, 4]],
                      np.array([0, 7, 1, 7, 2.5])[::2]):
            equal(sys.simulate(times=given, theta0=1).t.tolist(), times)
        for kind in (int, float):
            masked = np.ma.array([1, 2], mask=[False, True], dtype=kind)
            equal(dinal.lua("v[1], v[2] ~= v[2]", v=masked), (1, True))
        equal(sys.simulate(times=range(3), theta0=1).t.tolist(), [0, 1, 2])
        equal(dinal.lua("#v[1], v[2][3]", v=np.arange(6.).reshape(2, 3)), (3, 5.0))
        equal(dinal.lua("w[2]", w=np.array(["a", "b"])), "b")
        equal([dinal.lua("math.type(x)", x=x) for x in (np.int64(1), np.float32(1), np.array(1), True)],
              ["integer", "float", "integer", None])


class Callables(unittest.TestCase):
    def test_M(self):
        sys = dinal.system(I=1, k=4, Rd=.3, Re=.4)
        same = sys.simulate(M=dinal.lua("function(t) return math.sin(t) end"), t_end=20)
        for M in (lambda t: math.sin(t), math.sin, np.sin, lambda t: np.sin(t), lambda t, A=1: A * math.sin(t)):
            self.assertLess(np.abs(sys.simulate(M=M, t_end=20).theta - same.theta).max(), 1e-9)
        equal(dinal.lua("f(2, 3, 4, 5)", f=np.power), 8)  # a ufunc gets as many arguments as it has inputs

    def test_what_is_written_of_a_function(self):
        with tempfile.TemporaryDirectory() as folder:
            dinal.system(I=1, k=4).simulate(M=lambda t: 1., t_end=1).save(folder + "/run.csv")
            text = pathlib.Path(folder, "run.csv").read_text()
        contained("a function written in Python could not be written down", text)
        contained("written in Python", str(dinal.excitation.scripted(lambda t: 1.)))

    def test_feedback_and_states(self):
        sys = dinal.system(I=1, k=4)
        lua = sys.simulate(M=dinal.lua("function(t, theta, velocity, z) return -velocity + z.e end"),
                           states={"e": {"rate": dinal.lua("function(t, theta) return -theta end")}}, theta0=1, t_end=5)
        run = sys.simulate(M=lambda t, theta, velocity, z: -velocity + z.e,
                           states={"e": {"rate": lambda t, theta: -theta}}, theta0=1, t_end=5)
        self.assertLess(np.abs(run.theta - lua.theta).max(), 1e-9)
        equal(list(run.states), ["e"])

    def test_events_with_acts(self):
        def bounce(t, theta, velocity, z):
            z.hits += 1
            return theta, -velocity
        run = dinal.system(I=1, k=4).simulate(
            theta0=1, t_end=5, states={"hits": {"rate": lambda t: 0}},
            events=[{"name": "floor", "when": lambda t, theta: theta + .5, "act": bounce, "direction": "down"}])
        greater(run.states.hits[-1], 1)
        greater(run.theta.min(), -.5 - 1e-6)
        contained("floor", run.events.name)

    def test_laws_and_springs(self):
        law = dinal.friction.law(lambda speed: .3 + .1 * speed, Re=.5)
        self.assertAlmostEqual(law.torque(2), .5)
        sys = dinal.system(I=1, k=4, friction=law)
        equal(sys.simulate(theta0=1, t_end=20).status, "rest")

    def test_controllers(self):
        M = dinal.excitation.sampled(lambda t, theta, velocity: -theta, every=.1)
        run = dinal.system(I=1, k=4).simulate(M=M, theta0=1, t_end=1)
        self.assertAlmostEqual(run.M[150], -run.at(.1)[0])

    def test_tables_are_lent(self):
        """What a function changes in a table that Lua gives it is changed in Lua."""
        def change(record, numbers):
            record.x += 1
            record["list"].append("b")
            numbers[0] = 7
            numbers.append(9)
        equal(dinal.lua("(function() local t, n = { x = 1, list = { 'a' } }, { 1, 2 } f(t, n) return t, n end)()",
                        f=change), ({"x": 2, "list": ["a", "b"]}, [7, 2, 9]))

    def test_sweep(self):
        def point(p):
            return {"A": p["r"]**2, "same": p.r == p["r"]}
        m = dinal.sweep(over={"r": [1, 2, 3]}, run=point)
        equal(m.A.tolist(), [1, 4, 9])
        equal(m.same.tolist(), [1, 1, 1])
        lua = dinal.sweep(over={"r": np.arange(3.)}, run=dinal.lua("function(p) return { A = k*p.r } end", k=2))
        equal(lua.A.tolist(), [0, 2, 4])
        contained("A", pandas.DataFrame(dict(lua)).columns)
        with raises_with(dinal.Error, "max_time needs a Lua function"):
            dinal.sweep(over={"r": [1]}, run=point, max_time=1)
        with tempfile.TemporaryDirectory() as folder, raises_with(dinal.Error, "file needs a Lua function"):
            dinal.bifurcation(over={"r": [1]}, at=point, period=1, file=folder + "/m.csv")
        best = dinal.minimise(over={"x": [0, 3]}, run=lambda p: (p.x - 1.25)**2)
        self.assertAlmostEqual(best.x, 1.25, 6)

    def test_two_sweeps_are_two(self):
        """The second is not taken for the first one, which Ctrl-C has broken off."""
        shown = python("""
import warnings; warnings.simplefilter("ignore")
def first(p):
    if p.r == 3: os.kill(os.getpid(), signal.SIGINT)
    return {"A": 1}
try: dinal.sweep(over={"r": [1, 2, 3, 4]}, run=first)
except KeyboardInterrupt: print(len(dinal.partial))
print(dinal.sweep(over={"r": [1, 2, 3, 4]}, run=lambda p: {"A": 2}).A.tolist())
""")
        equal(shown.stdout, "2\n[2.0, 2.0, 2.0, 2.0]\n", shown.stderr)


class Errors(unittest.TestCase):
    def test_sentence_and_facts(self):
        with raises(dinal.Error) as caught:
            dinal.system(I=1, k=4).simulate(tend=20)
        contained("has no option 'tend'", str(caught.exception))
        contained("did you mean 't_end'", str(caught.exception))
        equal(caught.exception.call, "osc.simulate")
        equal(caught.exception.culprit, "tend")

    def test_kinds(self):
        osc = dinal.system(I=1, k=4)
        run = osc.simulate(t_end=1)
        for kind, call in ((TypeError, lambda: osc.simulate(tend=20)), (TypeError, lambda: dinal.excitation.pulse(at=1)),
                           (TypeError, lambda: osc.simulate(t_end="20")), (ValueError, lambda: osc.simulate(t_end=-1)),
                           (ValueError, lambda: dinal.integrator.rk4(h=0)), (KeyError, lambda: run["tetha"]),
                           (ValueError, lambda: dinal.integrator.dinal1989(h=1, stop="no")), (TypeError, dinal.excitation.harmonic),
                           (TypeError, lambda: dinal.system(I=1, k=1, units=3)), (FileNotFoundError, lambda: dinal.load("nope.csv"))):
            with raises(kind) as caught:
                call()
            self.assertIsInstance(caught.exception, dinal.Error)
            equal(type(caught.exception).__name__, "Error")
            self.assertNotIn("'\"", str(caught.exception))

    def test_words(self):
        """Messages show Python: no tables, nil, colons and braces of Lua."""
        osc = dinal.system(I=1, k=4)
        for words, call in (("needs k, for example dinal.system(I=1, k=39.5", lambda: dinal.system(I=1)),
                            ("got None", lambda: dinal.lua("f(nil)", f=lambda x: osc.simulate(t_end=1).column(None))),
                            ("walls must be a dict such as dict(lower=-0.8", lambda: dinal.system(I=1, k=1, walls=3)),
                            ("for example dinal.friction.law(lambda speed: 0.3", lambda: dinal.friction.law(3)),
                            ("M returned None", lambda: osc.simulate(M=lambda t: None, t_end=1)),
                            ("osc.simulate has no option", lambda: osc.simulate(tend=1))):
            with raises(dinal.Error) as caught:
                call()
            contained(words, str(caught.exception))
            self.assertNotRegex(str(caught.exception), r"\{|nil|a table|[a-z]:[a-z]")

    def test_errors_of_users_stay(self):
        with raises(dinal.Error) as caught:
            dinal.lua("error('a:b must be { c = 1 }, got nil', 0)")
        equal((str(caught.exception), type(caught.exception)), ("a:b must be { c = 1 }, got nil", dinal.Error))

    def test_a_run_that_fails_warns(self):
        with self.assertWarnsRegex(dinal.RunWarning, "simulate: ") as caught:
            run = dinal.system(I=1, k=4).simulate(M=lambda t, theta: 9 * theta, theta0=1, t_end=1000)
        equal((run.status, caught.filename), ("failed", __file__))
        with warnings.catch_warnings(), raises(dinal.RunWarning):
            warnings.simplefilter("error")
            dinal.system(I=1, k=4).simulate(M=lambda t, theta: 9 * theta, theta0=1, t_end=1000)

    def test_exceptions_travel(self):
        class Own(Exception):
            pass
        thrown = Own("here")

        def M(t):
            if t > .5:
                raise thrown
            return 1.
        try:
            dinal.system(I=1, k=4).simulate(M=M, t_end=2)
        except Own as caught:
            self.assertIs(caught, thrown)
            contained("raise thrown", "".join(traceback.format_tb(caught.__traceback__)))
        greater(len(dinal.partial), 100)
        self.assertLess(abs(dinal.partial.t_end - .5), 1e-6)
        if sys.version_info >= (3, 11):
            contained("in M at t = 0.5", "".join(thrown.__notes__))

    def test_exceptions_travel_far(self):
        """Through Lua, a pcall, a coroutine, and a run within a run."""
        def inner():
            raise KeyError("x")
        with raises(KeyError):
            dinal.lua("coroutine.wrap(function() f() end)()", f=inner)
        equal(dinal.lua("pcall(f)", f=inner)[0], False)
        with raises(KeyError):
            dinal.system(I=1, k=1).simulate(
                M=lambda t: dinal.system(I=1, k=1).simulate(M=lambda t: inner(), t_end=1).t_end, t_end=1)
        with raises_with(dinal.Error, "KeyError: 'x'"):
            dinal.sweep(over={"r": [1]}, run=lambda p: inner())

    def test_nothing_keeps_an_exception(self):
        class Big:
            pass

        def fail():
            big = Big()
            seen.append(weakref.ref(big))
            def M(t):
                raise ValueError(big)
            try:
                dinal.lua("f(1)", f=M)
            except ValueError:
                pass
        seen = []
        fail()
        dinal.lua("collectgarbage()")
        dinal.lua("collectgarbage()")
        gc.collect()
        self.assertIsNone(seen[0]())

    def test_wrong_results(self):
        for wrong in (None, "1", float("nan"), [], object(), 1j):
            with raises_with(dinal.Error, "must return a finite number"):
                dinal.system(I=1, k=4).simulate(M=lambda t: wrong, t_end=2)

    def test_wrong_calls_do_not_crash(self):
        chance = random.Random(1)
        sys_ = dinal.system(I=1, k=4, Rd=.1)
        run = sys_.simulate(theta0=1, t_end=1)
        objects = [sys_, run, run.events, dinal.excitation.harmonic(omega=1), dinal.integrator.exact(), run.plot(show=False),
                   dinal.friction.coulomb(Rd=1), run.energy()]
        values = [None, 0, -1, 2.5, float("nan"), float("inf"), 2**80, "t", "", "\udcff", b"x", [], {}, (1, 2), [[]], {"t": 1},
                  np.arange(3.), np.array("x"), np.array([1j]), np.zeros((2, 2)), object(), len, lambda *a: a[0], lambda: 1,
                  lambda t: 1 / 0, int, Ellipsis, {1: 2}, {None: 1}, {float("nan"): 1}, {(1, 2): 3}, set(), range(3), 1j,
                  *objects]
        never = {"animate", "exit", "help", "save", "lua", "report", "experiment", "marks", "bifurcation"}
        functions = [f for m in vars(dinal).values() if inspect.ismodule(m) and m.__name__.startswith("dinal.")
                     for f in vars(m).values() if callable(f) and getattr(f, "__module__", "") == "dinal"]
        functions += [f for f in vars(dinal).values() if inspect.isfunction(f) and f.__module__ == "dinal"]
        functions += [getattr(o, name) for o in objects for name in dir(type(o)) if not name.startswith("_")]
        functions = [f for f in functions if callable(f) and getattr(f, '__name__', '') not in never]
        greater(len(functions), 80)
        options = ["M", "t_end", "dt", "theta0", "times", "I", "k", "over", "run", "data", "states", "events", "nonsense"]
        done = 0
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            for _ in range(2000):
                function = chance.choice(functions)
                arguments = [chance.choice(values) for _ in range(chance.choice((0, 0, 1, 2, 3)))]
                named = {chance.choice(options): chance.choice(values) for _ in range(chance.choice((0, 1, 2, 3)))}
                if getattr(function, '__name__', '') in ("plot", "phase_plot"):
                    named["show"] = False
                try:
                    function(*arguments, **named)
                    done += 1
                except (dinal.Error, TypeError, ValueError, KeyError, ZeroDivisionError, AttributeError, OverflowError):
                    pass
        greater(done, 20)

    def test_dead_and_foreign_objects(self):
        with raises_with(dinal.Error, "use a colon"):
            dinal.System.simulate(42, t_end=1)
        with raises(dinal.Error):
            dinal.System.omega0.fget(dinal.excitation.harmonic(omega=1))
        with raises(TypeError):
            dinal.Object.__new__(dinal.Run)
        with raises_with(dinal.Error, "table: 0x"):
            dinal.lua("error({})")
        with raises_with(dinal.Error, "unexpected symbol|syntax error|expected"):
            dinal.lua("function(")


class Signals(unittest.TestCase):
    """Each in a Python of its own, which gets SIGINT when it has said that it begins."""

    def interrupted(self, code):
        code = f"print('begins', flush=True)\ntry:\n    {code}\nexcept KeyboardInterrupt:\n    " \
               "print('interrupted', type(dinal.partial).__name__)\n"
        process = subprocess.Popen([sys.executable, "-c", "import dinal, math\n" + code], stdout=subprocess.PIPE, text=True)
        equal(process.stdout.readline(), "begins\n")
        time.sleep(.2)
        process.send_signal(signal.SIGINT)
        shown = process.communicate(timeout=30)[0]
        equal(process.returncode, 0)
        return shown

    def test_run(self):
        long = "t_end=1e9, times=[0, 1e9])"
        equal(self.interrupted("dinal.system(I=1, k=4).simulate(M=dinal.lua('function(t) return math.sin(t^2) end'), "
                               + long), "interrupted Run\n")
        equal(self.interrupted("dinal.system(I=1, k=4).simulate(M=lambda t: math.sin(t), " + long),
              "interrupted Run\n")

    def test_lua(self):
        equal(self.interrupted("dinal.lua('while true do pcall(function() end) end')"),
              "interrupted NoneType\n")

    def test_sweep(self):
        equal(self.interrupted("dinal.sweep(over={'r': [1, 2, 3]}, run=dinal.lua('function(p) while p.r > 1 do end "
                               "return { A = 1 } end'))"), "interrupted Data\n")

    def test_handlers_of_others(self):
        shown = python("""
signal.signal(signal.SIGINT, lambda *a: print("mine"))
dinal.system(I=1, k=4)
os.kill(os.getpid(), signal.SIGINT)
signal.signal(signal.SIGINT, signal.SIG_IGN)
dinal.system(I=1, k=4)
os.kill(os.getpid(), signal.SIGINT)
print("alive")
""")
        equal(shown.stdout, "mine\nalive\n", shown.stderr)


class Processes(unittest.TestCase):
    def test_threads(self):
        """Calls from several threads wait for each other, also where a Python function lets others run."""
        sys_ = dinal.system(I=1, k=4, Rd=.1)
        ends, errors = [], []

        def work():
            try:
                for _ in range(3):
                    ends.append(sys_.simulate(M=lambda t: (time.sleep(0), math.sin(t))[1], t_end=10).theta[-1])
            except BaseException as error:
                errors.append(error)
        threads = [threading.Thread(target=work) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        equal((errors, len(ends), len(set(ends))), ([], 12, 1))

    def test_fork(self):
        with multiprocessing.get_context("fork").Pool(2) as pool:
            equal(pool.map(damped, [1, 2, 3]), [damped(1), damped(2), damped(3)])

    def test_fork_within_a_call_of_another_thread(self):
        shown = python("""
inside, go = threading.Event(), threading.Event()
def M(t):
    inside.set()
    go.wait()
    return 1.
thread = threading.Thread(target=lambda: dinal.system(I=1, k=4).simulate(M=M, t_end=1))
thread.start()
inside.wait()
child = os.fork()
if child == 0:
    try: dinal.system(I=1, k=4)
    except RuntimeError as error: print("forked while" in str(error), flush=True)
    os._exit(0)
os.waitpid(child, 0)
go.set()
thread.join()
print(dinal.system(I=1, k=4).omega0)
""")
        equal(shown.stdout, "True\n2.0\n", shown.stderr)

    def test_exit(self):
        for code in ("x = dinal.system(I=1, k=4).simulate(t_end=1); y = x.theta; z = dinal.lua('function() end')",
                     "import atexit; r = dinal.system(I=1, k=4); atexit.register(lambda: r.simulate(M=lambda t: 1, t_end=1))",
                     "class C:\n    def __del__(self, d=dinal): d.system(I=1, k=4)\nkeep = C(); dinal.lua('function() return c end', c=keep)",
                     "s = dinal.system(I=1, k=4); begun = threading.Event()\n"
                     "def M(t): begun.set(); time.sleep(1e-3); return 0.\n"
                     "for _ in range(2): threading.Thread(target=lambda: s.simulate(M=M, t_end=1e9, times=[0, 1e9]), daemon=True).start()\n"
                     "begun.wait()",
                     "sys.exit(dinal.system(I=1, k=4).simulate(M=lambda t: sys.exit(0), t_end=1))"):
            shown = python(code)
            equal((shown.returncode, shown.stderr), (0, ""), code)

    def test_exit_from_lua(self):
        """os.exit raises SystemExit."""
        for code, status in (("dinal.lua('os.exit()')", 0), ("dinal.lua('os.exit(true)')", 0), ("dinal.lua('os.exit(false)')", 1),
                             ("dinal.system(I=1, k=4).simulate(M=dinal.lua('function(t) os.exit(7) end'), t_end=1)", 7)):
            shown = python("import atexit; atexit.register(print, 'atexit')\n"
                           f"try: {code}; print('not reached')\nfinally: print('finally')")
            equal((shown.returncode, shown.stdout), (status, "finally\natexit\n"), shown.stderr)

    def test_memory_is_given_back(self):
        sys_ = dinal.system(I=1, k=4)

        def resident():
            with open("/proc/self/statm") as file:
                return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
        for _ in range(5):
            sys_.simulate(theta0=1, t_end=1000, dt=.01)
        before = resident()
        for _ in range(100):  # 5 MB each
            sys_.simulate(theta0=1, t_end=1000, dt=.01).theta
        self.assertLess(resident() - before, 400e6)


def damped(Rd):
    return dinal.system(I=1, k=4, Rd=Rd / 10).simulate(M=lambda t: math.sin(t), t_end=10).theta[-1]


class Help(unittest.TestCase):
    def test_documentation(self):
        text = dinal.system.__doc__
        contained("system(I, k, C = 0", text)
        contained("moment of inertia", text)
        contained("end stops: dict(lower=-1, upper=1, restitution=0.7)", text)
        contained("several bodies by name: dict(load=dict(I=0.3, Rd=0.4)),", text)
        simulate = dinal.system(I=1, k=4).simulate
        contained("osc.simulate(", simulate.__doc__)
        contained("Example:", simulate.__doc__)
        names = list(inspect.signature(simulate).parameters)
        self.assertTrue({"M", "theta0", "t_end"} <= set(names))
        contained("T0", dinal.System.T0.__doc__)
        equal(str(inspect.signature(dinal.excitation.harmonic).parameters["amplitude"].default), "1")
        parameters = inspect.signature(simulate).parameters.values()
        equal({p.kind for p in parameters}, {inspect.Parameter.KEYWORD_ONLY})
        equal(str(inspect.signature(dinal.integrator.rk4)), "(*, h: Number) -> Integrator")
        equal(str(inspect.signature(dinal.integrator.dopri5)), "(*, tolerance: Number) -> Integrator")
        import pydoc
        contained("moment of inertia", pydoc.render_doc(dinal.system))
        contained("harmonic", pydoc.render_doc(dinal.excitation))
        contained("simulate", pydoc.render_doc(dinal.System))

    def test_examples(self):
        """Those that are shown in Python are Python, and print the numbers that they say."""
        def numbers(text):
            return [float(number) for number in re.findall(r"(?<![\w.])[-+]?\d+\.?\d*(?:e[-+]?\d+)?", text)]

        shown = 0
        with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
            for *_, members in dinal._dinal.sections:
                for text in filter(None, (dinal._words.python(member["example"]) for member in members)):
                    if "dinal." in text and "dinal.vector" not in text and "dinal.version" not in text:
                        with contextlib.redirect_stdout(io.StringIO()) as printed:
                            exec(text, {"dinal": dinal, "numpy": np, "math": math})
                        np.testing.assert_allclose(numbers(printed.getvalue()), numbers(" ".join(re.findall("# (.*)", text))), 1e-5, err_msg=text)
                        shown += 1
        greater(shown, 140)

    def test_every_member_is_there(self):
        manual = "\n".join(page.read_text() for page in sorted(pathlib.Path(SOURCE, "docs/manual").glob("*.md")))
        owners = {"excitation": dinal.excitation, "theory": dinal.theory, "friction": dinal.friction,
                  "integrator": dinal.integrator, "run": dinal.Run, "sys": dinal.System}
        members = set(re.findall(r"^(?:### |- `)(%s)[.:](\w+)" % "|".join(owners), manual, re.M))
        for owner, own in owners.items():
            greater(len([name for of, name in members if of == owner]), 3, owner)
        for owner, name in sorted(members):
            if name.isupper() and len(name) > 1:  # NAME stands for any of them
                continue
            # "integrator" is what the manual calls the module, and one that it made.
            places = (owners[owner], getattr(dinal, owner.capitalize(), None))
            found = any(hasattr(place, name) or hasattr(place, name + "_") for place in places)
            self.assertTrue(found, f"{owner}.{name}")

    def test_completion(self):
        shown = python("""
from IPython.core.completer import provisionalcompleter
from IPython.core.interactiveshell import InteractiveShell
shell = InteractiveShell.instance()
shell.user_ns.update(dinal=dinal, sys_=dinal.system(I=1, k=4))
with provisionalcompleter():
    for text in ("sys_.sim", "sys_.simulate(th", "dinal.excitation.harm"):
        print([c.text for c in shell.Completer.completions(text, len(text))])
print(shell.object_inspect_text("sys_.simulate"))
""", env={**os.environ, "IPYTHONDIR": tempfile.gettempdir() + "/dinal-ipython"}).stdout
        for word in ("simulate", "theta0=", "harmonic", "Runs the system"):
            contained(word, shown)

    def test_stubs(self):
        stub = pathlib.Path(dinal.__file__).with_name("__init__.pyi").read_text()
        compile(stub, "__init__.pyi", "exec")
        contained("def theta(self) -> Vector", stub)
        self.assertTrue(pathlib.Path(dinal.__file__).with_name("py.typed").exists())
        printed = subprocess.run([sys.executable, "-m", "dinal.stubs"], capture_output=True, text=True)
        equal(printed.stdout, stub)

    def test_version(self):
        shown = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True).stdout
        self.assertTrue(shown.startswith(f"dinal {dinal.__version__} "))


class Truth(unittest.TestCase):
    """The numbers of the reference cases."""

    def test_a_sheet_of_the_lab(self):
        """Two of its answers; tests/lab has them all."""
        dinal.lab.number(4711)
        given = dinal.lab.given(1)
        run = dinal.system(**given.dry).simulate(theta0=given.theta0, t_end=100)
        record = dinal.lab.experiment(1)
        greater(record.theta[0], -record.theta[1])
        for question, value in (("1a", 2 * math.pi * math.sqrt(given.viscous.I / given.viscous.k)), ("1e", run.events[-1].theta)):
            dinal.check(question, value)
            said = dict(zip(dinal.lab.marks().question, dinal.lab.marks().said))
            self.assertTrue(said[question].startswith(f"{question}: right"), said[question])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
