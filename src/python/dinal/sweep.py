"""python3 -m dinal.sweep MAP.lua runs the sweep of a Lua file; dinal.sweep(...) is the function."""

import sys

from dinal._objects import Module
from dinal._sweep import main, sweep as _call

if __name__ == "__main__":
    sys.exit(main())
sys.modules[__name__].__class__ = Module
