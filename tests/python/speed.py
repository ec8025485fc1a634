"""What the Python module costs: python3 speed.py, with PYTHONPATH at the module. No test: docs/python.md has the numbers."""

import math
import time

import numpy as np

import dinal


def best(function, repeats=50):
    """The shortest time of some, in seconds."""
    times = []
    for _ in range(repeats):
        began = time.perf_counter()
        function()
        times.append(time.perf_counter() - began)
    return min(times)


def main():
    n = 2000
    e = dinal.excitation.harmonic(amplitude=2, omega=1)
    osc = dinal.system(I=1, k=4)

    def repeat(call):
        return lambda: [call() for _ in range(n)]
    nothing = best(repeat(lambda: None))
    lua = {"value": "e:value(.5)", "omega0": "sys.omega0", "system": "system{ I = 1, k = 4 }"}
    python = {"value": lambda: e.value(.5), "omega0": lambda: osc.omega0, "system": lambda: dinal.system(I=1, k=4)}
    for name, text in lua.items():
        loop = dinal.lua(f"function() for i = 1, {n} do local x = {text} end end", e=e, sys=osc)
        in_lua, here = best(loop), best(repeat(python[name])) - nothing
        print(f"{name:8} {1e6 * in_lua / n:6.3f} us in Lua, {1e6 * here / n:6.3f} us in Python, "
              f"{1e6 * (here - in_lua) / n:6.3f} us more")

    count = 0

    def M(t):
        nonlocal count
        count += 1
        return math.sin(t)

    def plain(t):
        return math.sin(t)
    osc.simulate(M=M, t_end=1000)
    times = [i * 1e-3 for i in range(count)]

    def calls():
        for t in times:
            plain(t)
    alone = best(calls)
    run = best(lambda: osc.simulate(M=plain, t_end=1000))
    rest = best(lambda: osc.simulate(M=dinal.lua("math.sin"), t_end=1000))  # a function in C, which costs next to nothing
    print(f"M        {count} calls: {1e3 * alone:.2f} ms alone; {1e3 * run:.2f} ms in a run that takes {1e3 * rest:.2f} ms "
          f"with a function in C: {(run - rest) / alone:.2f} times")

    long = osc.simulate(theta0=1, t_end=1000, dt=1e-3)
    print(f"columns  {len(long)} rows to NumPy: {1e3 * best(lambda: long.theta):.4f} ms; back: "
          f"{1e3 * best(lambda: dinal.lua('#v', v=np.asarray(long.theta))):.2f} ms")


if __name__ == "__main__":
    main()
