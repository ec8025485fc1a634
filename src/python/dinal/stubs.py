"""Types for editors: python3 -m dinal.stubs [FOLDER] writes __init__.pyi and py.typed there, or prints the former."""

import inspect
import pathlib
import sys
import types

import dinal

HEAD = '''"""Written by python3 -m dinal.stubs."""
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor
from typing import Any, Literal, overload
from .types import Callback, Columns, Number, Numbers, Options, Path, Vector

__version__: str
version: str
partial: Run | Data | None
class Error(Exception):
    call: str
    option: str
    culprit: str
class RunWarning(RuntimeWarning): ...
class Record(dict[Any, Any]):
    def __getattr__(self, name: str) -> Any: ...
class Object: ...
class Function(Object):
    def __call__(self, *arguments: Any, **options: Any) -> Any: ...
def lua(text: str, **variables: Any) -> Any: ...
def sweep(*, over: Options, run: Callback, executor: Executor | Callable[[], Executor] | None = ..., file: Path | None = ...,
          seed: int = ..., progress: Callable[[int, int], object] | None = ..., workers: int | None = ...,
          max_time: Number | None = ...) -> Data: ...
'''
COLUMNS = [*dinal.system(I=1, k=1).simulate(theta0=1, t_end=1).names, "acceleration"]
# Additions to the tables of the program: fields named by the user, and results that depend on the arguments.
MORE = {"Run": f'''    @overload
    def at(self, t: Number) -> tuple[float, ...]: ...
    @overload
    def at(self, t: Numbers) -> tuple[Vector, ...]: ...
    @overload
    def __getitem__(self, key: Literal[{", ".join(map(repr, COLUMNS))}], /) -> Vector: ...
    @overload
    def __getitem__(self, key: int, /) -> Record: ...
    @overload
    def __getitem__(self, key: slice, /) -> list[Record]: ...
    @overload
    def __getitem__(self, key: str, /) -> Any: ...
    def keys(self) -> list[str]: ...
''', "Data": '''    def __getattr__(self, name: str) -> Vector: ...
    @overload
    def __getitem__(self, key: str, /) -> Vector: ...
    @overload
    def __getitem__(self, key: int, /) -> Record: ...
    @overload
    def __getitem__(self, key: slice, /) -> list[Record]: ...
    def keys(self) -> list[str]: ...
''', "Fit": "".join(f"    {name}: float\n" for name in "I k C Rd Re omega0 zeta dead_zone theta0 velocity0 offset".split()) + '''
    def __getitem__(self, key: str, /) -> float: ...
''', "SteadyMotion": '''    def __getitem__(self, key: str, /) -> SteadyMotion: ...
'''}
# A system with named bodies and its runs have fields of these names.
AFTER = '''class RigRun(Run):
    def __getattr__(self, name: str) -> Run: ...
class Rig(System):
    def __getattr__(self, name: str) -> System: ...
    def __getitem__(self, key: str, /) -> System: ...
'''


def function(name, value, indent="", result=None):
    signature = inspect.signature(value)
    signature = signature.replace(return_annotation=dinal._words.Type(result)) if result else signature
    return f"{indent}def {name}{signature}: ...\n"


def operator(name):
    other = "" if name == "__neg__" else ", other: Number" if name in ("__mul__", "__rmul__", "__truediv__", "__rtruediv__") else \
        ", other: Excitation | Number"
    return f"    def {name}(self{other}, /) -> Excitation: ...\n"


def body(name, members):
    text = more = MORE.get(name, "")
    for own, value in vars(members).items():
        if f"def {own}(" in more or f"    {own}: " in more:
            continue
        if isinstance(value, property):
            text += f"    @property\n    def {own}(self) -> {dinal._words.type_of_field(value)}: ...\n"
        elif own in ("__len__", "__iter__"):
            text += "    def __len__(self) -> int: ...\n" if own == "__len__" else "    def __iter__(self) -> Iterator[Record]: ...\n"
        elif isinstance(value, types.FunctionType) and own.startswith("__") and own != "__call__":
            text += operator(own)
        elif isinstance(value, types.FunctionType) and hasattr(value, "__signature__"):
            if own == "_call":
                text += f"    def __call__(self, *arguments: Any, **options: Any) -> {inspect.signature(value).return_annotation}: ...\n"
                continue
            text += ("" if isinstance(members, type) else "    @staticmethod\n") + \
                function(own, value, "    ")
        elif own == "__call__":
            text += "    def __call__(self, t: Any, theta: Number = ..., velocity: Number = ...) -> Any: ...\n"
    return text or "    pass\n"


def stubs():
    dinal._words.Default.__repr__ = lambda self: "..."  # the words of the documentation are no Python
    text = HEAD
    for name, value in dinal._members.items():
        if name == "system":
            one = str(inspect.signature(value)).replace("k: Number = ...", "k: Number")
            text += f"@overload\ndef system{one}: ...\n@overload\n"
            text += "def system(*, bodies: Options, links: Options = ..., units: Options = ...) -> Rig: ...\n"
        elif isinstance(value, type):
            text += f"class {name}(Object):\n{body(name, value)}"
        elif isinstance(value, types.ModuleType):
            text += f"class _{name}:\n{body(name, value)}{name}: _{name}\n"
        elif name != "sweep":
            text += function(name, value)
    system = dinal._members["System"]
    return text + AFTER + function("simulate", system.simulate, "    ", "RigRun") + function("with_", system.with_, "    ", "Rig")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        pathlib.Path(sys.argv[1], "__init__.pyi").write_text(stubs())
        pathlib.Path(sys.argv[1], "py.typed").write_text("")
    else:
        print(stubs(), end="")
