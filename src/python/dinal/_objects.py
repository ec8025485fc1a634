"""The classes and functions of Python, made of the tables that describe those of Lua."""

import base64
import difflib
import html
import importlib
import inspect
import pickle
import re
import sys
import types
import warnings

from . import _dinal, _words
from ._words import python_name


class Error(Exception):
    """What is wrong, where the limit is and what to do, in one sentence; and facts: call, option, culprit."""

    call = option = culprit = ""
    __str__ = Exception.__str__  # KeyError would put the message into quotes

    def __reduce__(self):
        return error_again, (type(self).__mro__[2], str(self), self.call, self.option, self.culprit)


class RunWarning(RuntimeWarning):
    """A run ended before its time. run.status says how, run.outcome where and why."""


# Patterns in messages, and the exception that Python raises in such a case.
KINDS = [(r"has no option| needs | is needed|takes |must be an? (?!finite|whole).*, got |must be [a-zT].*, got (None|True|False|an? |the string)",
          TypeError), (r"No such file", FileNotFoundError),
         (r"has no (field|column|row)|there is no ", KeyError), (r" must |at most|exclude each other|of another sweep", ValueError)]

class Record(dict):
    """A table with named fields: p["r"] and p.r are the same."""

    def __getattr__(self, name):
        if name in self:
            return self[name]
        raise AttributeError(f"there is no {name!r} among {', '.join(map(str, self))}")

    __setattr__ = dict.__setitem__

    def __dir__(self):
        return sorted({*super().__dir__(), *map(str, self)})


class Object(_dinal.Reference):
    """A value of Lua. Its class says what it has."""

    __slots__ = ("_recipe",)  # the call that made an object without a Lua text: name, owner, arguments, options
    __array_ufunc__ = None  # 2 * e is a matter of e, also when the 2 is NumPy's

    def __getattr__(self, name):
        if name.startswith("_"):  # Python and IPython look for many such names, and Lua has none of them
            raise AttributeError(f"{type(self).__name__} has no {name!r}")
        try:
            return self[name]
        except Error as error:
            raise AttributeError(str(error)) from None

    def __setattr__(self, name, value):
        raise AttributeError(f"{type(self).__name__} objects cannot be changed; make a new one")

    def __getitem__(self, key):
        """A column by its name, or a row by its number: the first is 0."""
        if isinstance(key, slice):
            return [self[i] for i in range(*key.indices(len(self)))]
        if hasattr(key, "__index__"):
            place = key.__index__() + (len(self) if key < 0 else 0)
            if not 0 <= place < len(self):
                raise IndexError(f"there is no row {key} among {len(self)}")
            return _dinal.operated("element", self, place + 1)
        value = remembered(_dinal.operated("element", self, key), "__getitem__", self, (key,), {})
        import numpy  # late, here and below: the types for editors are written where there may be none
        is_words = isinstance(value, list) and value and all(isinstance(word, str) for word in value)
        return numpy.array(value) if is_words else value

    def __contains__(self, key):
        """A word is tested as the name of a column, as by a dictionary; anything else as a value."""
        return key in self.keys() if isinstance(key, str) and hasattr(type(self), "keys") else any(key == one for one in self)

    def __copy__(self):
        return self  # objects never change

    def __deepcopy__(self, memo):
        return self

    def __reduce__(self):
        """Pickles the Lua text of an object; a run, an energy or a fit is made again by the same call and must look the same."""
        if type(self).__name__ == "Data":
            return of_parts, _dinal.parts(self)
        if type(self) in BY_RECIPE:
            if not hasattr(self, "_recipe"):
                raise pickle.PicklingError(f"this {type(self).__name__} cannot be pickled: it was made in Lua, within a call")
            return again, (*self._recipe, str(self))
        text, variables, why = _dinal.written(self)
        if why:
            raise pickle.PicklingError(f"this {type(self).__name__} cannot be pickled: {why}")
        return of_text, (text, variables)

    def __repr__(self):
        return _dinal.operated("card", self, None)

    def __str__(self):
        return _dinal.operated("text", self, None)

    def __dir__(self):
        return sorted({*super().__dir__(), *self._ipython_key_completions_()})

    def _ipython_key_completions_(self):
        names = [getattr(self, name) for name in ("names", "bodies", "links") if hasattr(type(self), name)]
        return [str(name) for some in names for name in some]

    def _repr_svg_(self):
        return _dinal.drawn(self.plot(show=False)) if hasattr(type(self), "plot") else None

    def _repr_html_(self):
        """The text of the prompt and the picture, as an image because Debian 12's nbconvert drops the lines of an SVG."""
        svg = self._repr_svg_()
        image = svg and "data:image/svg+xml;base64," + base64.b64encode(svg.encode()).decode()
        text = "" if svg and type(self).__name__ in ("Run", "Picture") else f"<pre>{html.escape(repr(self))}</pre>"
        return text + (f'<img style="max-width: 100%" src="{image}">' if svg else "")


class Function(Object):
    """A function of Lua."""

    __slots__ = ()

    def __call__(self, *arguments, **options):
        return _dinal.call_value(self, *arguments, **options)


class Module(types.ModuleType):
    """A module of Lua; some can be called."""

    def __call__(self, *arguments, **options):
        return self._call(*arguments, **options)

    def __reduce__(self):
        return importlib.import_module, (self.__name__,)


# ---- for the C++ side

def error_of(cause, is_own, message, *facts):
    """The exception for an error of Lua. Errors of the program get Python's words and kind; those of a user's Lua stay."""
    message, call, option, culprit = (text.decode(errors="replace") for text in (message, *facts))
    message = _words.in_sentence(message) if is_own else message
    kind = next((kind for said, kind in KINDS if is_own and re.search(said, message)), None)
    error = error_again(kind or Exception, message, _words.in_sentence(call), option, culprit)
    error.__cause__ = cause
    return error


def error_again(kind, message, *facts):
    error = ERRORS.get(kind, Error)(message)
    error.call, error.option, error.culprit = facts
    return error


# ---- objects that travel

def kept(value):
    """A copy that later changes of lists and arrays do not reach."""
    if isinstance(value, dict):
        return {key: kept(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(map(kept, value))
    return value.copy() if not isinstance(value, Object) and hasattr(value, "copy") else value


def remembered(value, name, owner, arguments, options):
    """Returns the value; an object without a Lua text remembers the call that made it."""
    if type(value) in BY_RECIPE:
        Object._recipe.__set__(value, (name, owner, kept(arguments), kept(options)))
    return value


def of_text(text, variables):
    return _dinal.run_text(text, variables)


def of_parts(*parts):
    return _dinal.joined(*parts)


def again(name, owner, arguments, options, said):
    value = getattr(sys.modules["dinal"] if owner is None else owner, name)
    if arguments is not None:
        value = value(*arguments, **options)
    if str(value) != said:
        raise pickle.UnpicklingError(f"the same call of {name} gives something else here: {value}, and not {said}")
    return value


def noted(exception, during):
    if during and hasattr(exception, "add_note"):
        exception.add_note(during.strip())
    return exception


def type_for(name):
    return CLASSES.get(name, Object)


def parameters_of(function):
    """How many arguments a callable must have; many for *arguments."""
    try:
        if type(function) is types.FunctionType and not function.__code__.co_flags & inspect.CO_VARARGS:
            return function.__code__.co_argcount - len(function.__defaults__ or ())
        if type(function).__name__ == "ufunc":  # of NumPy, whose signature has *args since version 2
            return function.nin
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return 1
    if any(p.kind is p.VAR_POSITIONAL for p in parameters):
        return 256
    return sum(p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD) and p.default is p.empty for p in parameters)


def has_buffer(value):
    try:
        return bool(memoryview(value).format)
    except (TypeError, BufferError, ValueError):
        return False


def plain(value):
    """A number, text, a list, a dictionary or an array of floats in place of what is like one; others as they are."""
    kind = type(value)
    if hasattr(kind, "keys") and hasattr(kind, "__getitem__") and getattr(value, "ndim", 2) != 1:
        return {key: value[key] for key in value.keys()}
    if hasattr(kind, "__array__") or has_buffer(value):
        import numpy
        array = numpy.asarray(value.astype(float).filled(numpy.nan) if hasattr(kind, "filled") else value)
        return array.astype(float) if array.ndim == 1 and array.dtype.kind in "biuf" else array.tolist()
    if hasattr(kind, "__float__"):
        return float(value)
    if hasattr(kind, "__fspath__"):
        return value.__fspath__()
    return list(value) if hasattr(kind, "__len__") and hasattr(kind, "__iter__") and not callable(value) else value


def in_notebook():
    shell = sys.modules["IPython"].get_ipython() if "IPython" in sys.modules else None
    return hasattr(shell, "kernel")


def show_picture(picture):
    sys.modules["IPython"].display.display(picture) if in_notebook() else print(picture)


def show_animation(svg):
    sys.modules["IPython"].display.display(sys.modules["IPython"].display.SVG(svg))


# ---- members

def class_name(name):
    return "".join(word.capitalize() for word in name.split())


def meant(name, known):
    likely = difflib.get_close_matches(name, known, 1)
    return f"; did you mean {likely[0]!r}?" if likely else ""


def callable_of(member, has_self, owner):
    """The function for a member. Named arguments of one that takes no options are put in their places."""
    number, one_table, call = member["number"], _words.takes_one_table(member), _dinal.call
    names = _words.positional_names(member) if not member["options"] else []
    is_run, with_curves = member["result"] == "run", member["form"].startswith("plot(")
    one_table = one_table or with_curves
    renamed = {python_name(name): name for name, *_ in member["options"] if python_name(name) != name}

    def called(self, arguments, options):
        while len(arguments) < len(names) and names[len(arguments)] in options:
            arguments += (options.pop(names[len(arguments)]),)
        if renamed:
            options = {renamed.get(name, name): value for name, value in options.items()}
        if "links" in options and hasattr(options["links"], "items"):
            options["links"] = {name: link_of(link) for name, link in options["links"].items()}
        if with_curves:
            is_one = len(arguments) == 2 and all(map(is_row, arguments))
            arguments = ([arguments] if is_one else list(arguments),)
        axes = options.pop("ax", None)
        if axes is not None:
            draw(axes, call(number, self, arguments, {**options, "show": False}, one_table))
            return axes
        result = call(number, self, arguments, options, one_table)
        remembered(result, function.__name__, self, arguments, options)
        if is_run and getattr(result, "status", None) == "failed":
            warnings.warn(f"{member['name']}: {result.outcome}", RunWarning, stacklevel=3)
        return result

    if has_self:
        def function(self, *arguments, **options):
            return called(self, arguments, options)
    else:
        def function(*arguments, **options):
            return called(None, arguments, options)
    function.__name__ = python_name(member["name"])
    function.__qualname__ = f"{owner}.{function.__name__}" if owner else function.__name__
    function.__module__ = "dinal"
    function.__doc__ = _words.documentation(member)
    function.__signature__ = _words.signature_of(member, has_self, owner)
    return function


def draw(axes, picture):
    """Draws each figure of a picture into axes of Matplotlib."""
    import numpy
    figures, several = _dinal.figures(picture), numpy.ravel(axes)
    if len(figures) != len(several):
        raise ValueError(f"this picture has {len(figures)} parts, and ax {len(several)}: give a list of as many axes")
    for ax, (title, x, y, curves, stuck, is_map) in zip(several, figures):
        if is_map:
            raise ValueError("a map is not drawn into axes: use ax.pcolormesh with the columns of the data")
        for times, values, label, style, base in curves:
            name = label or "_nolegend_"
            if style == "fill":
                ax.fill_between(times, values, 0 if base is None else base, label=name, alpha=.5)
            else:
                ax.plot(times, values, "." if style == "points" else "-", label=name)
        for low, high in stuck:
            ax.axvspan(low, high, alpha=.1)
        for of, (label, is_log, limits) in zip("xy", (x, y)):
            getattr(ax, f"set_{of}label")(label)
            getattr(ax, f"set_{of}scale")("log" if is_log else "linear")
            limits and getattr(ax, f"set_{of}lim")(limits)
        ax.set_title(title)
        if any(curve[2] for curve in curves):
            ax.legend()


def is_row(value):
    """Whether the value is a row of numbers, as x of plot(x, y), and not a curve (x, y)."""
    import numpy
    try:
        return not isinstance(value, Object) and numpy.ndim(value) == 1
    except ValueError:  # rows of several lengths
        return False


def link_of(link):
    """Joins a link given as (weights, options); to_lua joins ("motor", "load", options)."""
    return {**link[0], **link[1]} if isinstance(link, (list, tuple)) and len(link) == 2 and all(isinstance(part, dict) for part in link) else link


def operators(name):
    """The methods of Python for a metamethod of Lua. The numbers are those of lua_arith."""
    number, word = {"__add": (0, "add"), "__sub": (1, "sub"), "__mul": (2, "mul"), "__div": (5, "truediv"),
                    "__unm": (12, "neg")}.get(name, (None, name))
    if name == "__unm":
        return {"__neg__": lambda self: _dinal.operated(number, self, None)}
    if number is not None:
        return {f"__{word}__": lambda self, other: _dinal.operated(number, self, other),
                f"__r{word}__": lambda self, other: _dinal.operated(number, other, self)}
    if name == "__len":
        return {"__len__": lambda self: _dinal.operated("length", self, None),
                "__iter__": lambda self: (self[i] for i in range(len(self)))}
    return {"__call__": Function.__call__} if name == "__call" else {}


def field_of(member):
    number = member["number"]
    name = python_name(member["name"])
    return property(lambda self: remembered(_dinal.call(number, self, (), {}, False), name, self, None, {}),
                    doc=_words.documentation(member))


def class_of(title, name, signature, summary, members):
    own = {"__slots__": (), "__doc__": f"{title}: {_words.in_python(signature)}\n\n{summary}", "__module__": "dinal"}
    for member in members:
        if member["kind"] == "metamethod":
            own.update(operators(member["name"]))
        else:
            own[python_name(member["name"])] = (
                callable_of(member, True, class_name(name)) if member["kind"] == "method" else field_of(member))
    if "names" in own:
        own["keys"] = lambda self: list(self.names)
    if name == "data":
        own.update(_repr_html_=lambda self: _dinal.drawn(self), _repr_svg_=lambda self: None)
    if name == "picture":
        own["_repr_svg_"] = lambda self: _dinal.drawn(self)
    made = type(class_name(name), (Object,), own)
    if name in ("run", "steady motion", "energy", "fit", "picture"):
        BY_RECIPE.add(made)
    return made


def build():
    """All that Lua has, by its names here. Vectors are arrays, and loops of Python show no progress."""
    made = {}
    _words.members.update(name for section in _dinal.sections if not section[5]
                          for name in [member["name"] for member in section[6]])
    _words.members.update(section[1] for section in _dinal.sections if any(m["kind"] == "function" for m in section[6]))
    _words.members.add("data")
    _words.members.difference_update(("vector", "dinal"))
    for title, name, signature, summary, example, prefix, members in _dinal.sections:
        is_module = bool(prefix) and any(m["kind"] == "function" or (prefix, m["name"]) == (name, "__call") for m in members)
        functions = {python_name(m["name"]): callable_of(m, False, name if is_module else "") for m in members
                     if m["kind"] == "function"}
        if is_module:
            made[name] = sys.modules[f"dinal.{name}"] = Module(f"dinal.{name}", f"{summary}\n\nIn Lua:\n\n    {example}")
            functions.update((m["name"][1:], callable_of(m, False, name)) for m in members if m["name"] == "__call")
            vars(made[name]).update(functions)
        elif functions:
            made.update((key, function) for key, function in functions.items() if key != "progress")
        elif name not in ("dinal", "vector"):
            CLASSES[name] = made[class_name(name)] = class_of(title, name, signature, summary, members)
    return made


BY_RECIPE = set()
CLASSES = {"function": Function}
ERRORS = {kind: type("Error", (Error, kind), {"__module__": "dinal"}) for kind in (TypeError, KeyError, ValueError, FileNotFoundError)}
_words.classes.update((section[1], class_name(section[1])) for section in _dinal.sections)
