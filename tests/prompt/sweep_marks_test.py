"""Which sweep a file belongs to: another one is refused, the same one is read, in whatever process. Usage: sweep_marks_test.py PROGRAM"""

import os
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True  # no folder __pycache__ in the source tree

from home import PROGRAM, AtHome
from session import PATIENCE

LAUNCHERS = ("DINAL_", "OMPI_", "PMI_", "SLURM_")
LONG = "local t = {} for i = 1, 1000 do t[i] = i end t[500] = VALUE"
# What a function uses, and how. VALUE is 1, and then 2.
RUN = "nondimensional{}:simulate{ M = M, theta0 = 0.1, t_end = 0.7, dt = 0.7 }.theta[2]"
OTHER = {
    "a local variable": ("local c = VALUE", "c"),
    "a global variable": ("c = VALUE", "c"),
    "a global variable in _G": ("c = VALUE", "_G.c"),
    "the function that a local variable is": ("local f = ({ math.sin, math.cos })[VALUE]", "f(p.a)"),
    "a function of a library that was replaced": ("if VALUE == 2 then math.sin = math.cos end", "math.sin(p.a)"),
    "a function that was added to a library": ("function string.far() return VALUE end", "('x'):far()"),
    "a table deep in tables": ("local t = { { { x = VALUE } } }", "t[1][1].x"),
    # The numbers that a sum of plain FNV-1a digests gives the same to, when two of them are exchanged.
    "two fields with each other's values": ("local t = ({ { m = 1, Re = 2 }, { m = 2, Re = 1 } })[VALUE]", "t.m"),
    "two elements with each other's values":
        ("local t = {} for i = 1, 700 do t[i] = i end if VALUE == 2 then t[300], t[681] = t[681], t[300] end", "t[300]"),
    "a table that is there twice": ("local t = { {}, {} } if VALUE == 2 then t[2] = t[1] end", "t[1] == t[2] and 1 or 0"),
    "the order of a circle": ("local t = { x = 1, next = { x = VALUE } } t.next.next = t", "t.next.x"),
    "a metatable": ("local t = setmetatable({}, { __index = function() return VALUE end })", "t.x"),
    "an element of a long vector": (f"{LONG} local v = vector(t)", "v[500]"),
    "a row of long data": (f"{LONG} local d = data{{ x = t }}", "d.x[500]"),
    "a word in long data": (f"{LONG} for i, x in ipairs(t) do t[i] = 'n' .. x end local d = data{{ w = t }}",
                            "tonumber(d.w[500]:sub(2))"),
    "a system": ("local s = system{ I = VALUE, k = 1 }", "s.I"),
    "a law of friction": ("local c = VALUE local f = friction.law(function(v) return c + v end)", "f:torque(1)"),
    "a spring": ("local c = VALUE local s = system{ I = 1, k = 1, spring = function(x) return c*x end }",
                 "s:simulate{ theta0 = 0.1, t_end = 0.7, dt = 0.7 }.theta[2]"),
    "an excitation": ("local c = VALUE local M = excitation.scripted(function(t) return c*t end)", RUN),
    "samples": ("local M = excitation.samples{ t = vector.linspace(0, 1, 100), M = vector.linspace(0, VALUE, 100) }", RUN),
    "samples of a file": ("local f = io.open('s.csv', 'w') f:write('t,M\\n0,0\\n1,VALUE\\n') f:close() local M = excitation.samples 's.csv'", RUN),
    "a controller that samples":
        ("local c = VALUE local M = excitation.sampled(function(t, x) return c*x end, { every = 0.1 })", RUN),
    "a controller with a dead time":
        ("local c = VALUE local M = excitation.delayed(function(t, x) return c*x end, { by = 0.1 })", RUN),
    "a relay of a function": ("local c = VALUE local M = excitation.relay{ of = function(t, x) return c*x - 0.05 end, "
                              "on = 0.01, off = -0.01, amplitude = { 1, -1 } }", RUN),
    "a controller in a sum": ("local c = VALUE local M = 2*excitation.sampled(function(t, x) return c*x end, "
                              "{ every = 0.1 }) + excitation.harmonic{ frequency = 1 }", RUN),
}
# What must not make a difference. REMARK is nothing, and then a comment; the order of the fields of a table is by chance.
SAME = {
    "tables that lead to each other":
        ("P = { a = { n = 1 }, b = { n = 2 }, c = { n = 3 } } P.a.next = P.b P.b.prev = P.a P.b.next = P.c P.c.prev = P.b",
         "P.a.n"),
    "a table that two have": ("local s = { 1 } local t = { x = { s = s, a = { s } }, y = { s = s }, z = s }", "t.x.s[1]"),
    "tables and systems as keys":
        ("local a, b = { n = 'a' }, { n = 'b' } local t = { [a] = b, [b] = { a }, [system{ I = 1, k = 2 }] = 1, "
         "[system{ I = 2, k = 2 }] = 2, [print] = 3 }", "t[b][1].n == 'a' and 1 or 0"),
    "functions that call each other":
        ("local t = {} function t.a() return t.b and 1 end function t.b() return t.a() + t.c.x end t.c = { x = 2, of = t }",
         "t.b()"),
    "comments and lines":
        ("local M = excitation.scripted(function(t) REMARK return t end) local f = friction.law(function(v) REMARK "
         "return v end) REMARK", RUN + " + f:torque(1)"),
}


class SweepMarks(AtHome):
    def swept(self, before, y):
        """The mark in the file, and what was said when it is not this sweep's."""
        script = f'{before}\nsweep{{ over = {{ a = {{ 1, 2 }} }}, file = "map.csv", run = function(p) return {{ y = {y} }} end }}\n'
        (self.home / "map.lua").write_text(script)
        clean = {name: value for name, value in os.environ.items() if not name.startswith(LAUNCHERS)}
        done = subprocess.run([PROGRAM, "map.lua"], capture_output=True, timeout=PATIENCE, cwd=self.home, env=clean,
                              text=True)
        self.assertTrue((self.home / "map.csv").exists(), done.stderr)
        return (self.home / "map.csv").read_text().splitlines()[0], done.stderr

    def test_another_sweep_is_refused(self):
        for name, (before, y) in OTHER.items():
            (self.home / "map.csv").unlink(missing_ok=True)
            with self.subTest(name):
                _, said = self.swept(before.replace("VALUE", "1"), y)
                self.assertEqual(said, "")
                _, said = self.swept(before.replace("VALUE", "2"), y)
                self.assertIn("'map.csv' is there, and is not the result of this sweep", said)

    def test_the_same_sweep_is_the_same_in_each_process(self):
        for name, (before, y) in SAME.items():
            (self.home / "map.csv").unlink(missing_ok=True)
            with self.subTest(name):
                for i in range(8):  # half of them had another mark
                    _, said = self.swept(before.replace("REMARK", "--[[ why ]]\n" * (i % 2)), y)
                    self.assertEqual(said, "")


if __name__ == "__main__":
    unittest.main()
