"""Types for editors: python3 -m dinal.stubs [FOLDER] writes __init__.pyi and py.typed there, or prints the former."""

import inspect
import pathlib
import sys
import types

import dinal

HEAD = '''"""Written by python3 -m dinal.stubs."""
from typing import Any
import numpy

__version__: str
partial: Any
class Error(Exception):
    call: str
    option: str
    culprit: str
class Object:
    def __getattr__(self, name: str) -> Any: ...
    def __getitem__(self, key: Any) -> Any: ...
class Record(dict[str, Any]):
    def __getattr__(self, name: str) -> Any: ...
class Function(Object):
    def __call__(self, *arguments, **options) -> Any: ...
def lua(text: str, **variables: Any) -> Any: ...
'''
TYPES = {"number": "float", "string": "str", "vector": "numpy.ndarray", "boolean": "bool"}


def result_of(documentation):
    """The type behind the arrow of the first line."""
    name = documentation.partition("\n")[0].partition("-> ")[2].strip()
    made = dinal._objects.CLASSES.get(name)
    return TYPES.get(name) or (made.__name__ if made else "Any")


def function(name, value, indent=""):
    return f"{indent}def {name}{inspect.signature(value)} -> {result_of(value.__doc__ or '')}: ...\n"


def body(members, is_class):
    text = ""
    for name, value in vars(members).items():
        if isinstance(value, property):
            text += f"    @property\n    def {name}(self) -> {result_of(value.__doc__)}: ...\n"
        elif isinstance(value, types.FunctionType):
            name = "__call__" if name == "_call" else name
            text += ("" if is_class else "    @staticmethod\n") + function(name, value, "    ")
    return text or "    pass\n"


def stubs():
    dinal._objects.Default.__repr__ = lambda self: "..."  # the words of the documentation are no Python
    text = HEAD
    for name, value in dinal._members.items():
        if isinstance(value, type):
            text += f"class {name}(Object):\n{body(value, True)}"
        elif isinstance(value, types.ModuleType):
            text += f"class _{name}:\n{body(value, False)}{name}: _{name}\n"
        else:
            text += function(name, value)
    return text


if __name__ == "__main__":
    if len(sys.argv) > 1:
        pathlib.Path(sys.argv[1], "__init__.pyi").write_text(stubs())
        pathlib.Path(sys.argv[1], "py.typed").write_text("")
    else:
        print(stubs(), end="")
