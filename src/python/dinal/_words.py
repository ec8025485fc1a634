"""Texts of the program in the words of Python: calls, examples and values in them; types of options and results."""

import inspect
import keyword
import re

TOKEN = re.compile(r"(--[^\n]*)|(\"(?:\\.|[^\"\\])*\")|([A-Za-z_]\w*)|(\.?\d[\w.]*)|(\.{2,3}|[=~<>]=|[^\s\w])|(\s+)")
COMMENT, STRING, NAME, NUMBER, SIGN, SPACE = range(1, 7)
NAMES = {"nil": "None", "true": "True", "false": "False", "sys": "osc", "local": "", "vector": "numpy"}
SIGNS = {"^": "**", "~=": "!=", ":": "."}
NEVER = set("do end for if while repeat goto string table io os pairs ipairs pcall error assert tostring tonumber type "
            "coroutine setmetatable progress help check report lab match abs deg rest .. %".split())  # examples with these words stay in Lua
members = set()  # names that need "dinal." before them
classes = {}  # Python's names of classes by those of Lua


class NoPython(Exception):
    """Raised for Lua that cannot be translated."""


def python_name(name):
    return name + "_" if keyword.iskeyword(name) else name


class Reader:
    """Translates the tokens of a piece of Lua."""

    def __init__(self, text):
        self.tokens = [(m.lastindex, m[0]) for m in TOKEN.finditer(text)]
        self.at = 0

    def peek(self):
        """Returns the next token that is not blank."""
        return next(((kind, text) for kind, text in self.tokens[self.at:] if kind != SPACE), (SIGN, ""))

    def take(self):
        self.at += 1
        return self.tokens[self.at - 1]

    def until(self, *ends):
        """Translates up to one of these tokens, which is consumed; returns the text and that token."""
        out, before = "", (SIGN, "")
        while self.at < len(self.tokens):
            kind, text = self.take()
            if text in ends:
                return out.strip(" ") if ends[-1] != "" else out, text
            called = before[0] == NAME and before[1] not in ("and", "or", "not", "return", "=") or before[1] in (")", "]")
            if text == "string" and [word for _, word in self.tokens[self.at:self.at + 3]] == [".", "format", "("]:
                self.at += 3
                form, *values = [value for _, value in self.entries(")")]
                one = form.count("%") == 1
                values = [value + "[0]" if one and ".at(" in value else value for value in values]  # Lua takes the first
                out += f"{form} % " + (values[0] if len(values) == 1 and not one else f"({', '.join(values)},)")
            elif text in NEVER:
                raise NoPython(text)
            elif text == "#":
                word = self.take()[1]
                while self.peek()[1] == ".":
                    word += self.take()[1] + self.take()[1]
                if self.peek()[1] in (":", "(") or word in NEVER:
                    raise NoPython("the length of a call")
                out += f"len({word})"
            elif kind == COMMENT:
                out += "#" + text.lstrip("->")
            elif text == "{":
                is_list = out.endswith("numpy") and called
                out = out[:-5] if is_list else out
                out += self.table(called and not is_list)
            elif text == "(":
                out += "(" + self.arguments(called)
            elif text == "[" and called:
                inner = self.until("]")[0]
                out += f"[{int(inner) - 1 if inner.isdigit() else -1 if inner.startswith('len(') else inner}]"
            elif text == "function":
                parameters = self.function()
                out += f"lambda {parameters}" if parameters else "lambda"
                out += ": " + self.until("end")[0]
            elif kind == NAME:
                is_field = before[1] in (".", ":")
                if text == "vector" and self.tokens[self.at:self.at + 1] == [(SIGN, ".")] and self.tokens[self.at + 1][1] != "linspace":
                    raise NoPython("a vector that NumPy makes otherwise")
                own = text in members and not is_field and self.peek()[1] != "="
                text = python_name(text) if is_field or own else NAMES.get(text, text)
                out += ("dinal." if own else "") + text
                if text == "" and self.tokens[self.at][0] == SPACE:
                    self.at += 1
            elif kind == STRING and called:
                out += f"({text})"
            else:
                out += SIGNS.get(text, text) if kind == SIGN else text
            if kind != SPACE:
                before = (kind, text)
        if "" not in ends:
            raise NoPython("an end is missing")
        return out, ""

    def function(self):
        """Returns the parameters and moves to the expression behind `return`."""
        while self.take()[1] != "(":
            if self.at == len(self.tokens) or self.tokens[self.at - 1][0] == NAME:
                raise NoPython("a named function")
        parameters = self.until(")")[0]
        if self.peek()[1] != "return":
            raise NoPython("statements in a function")
        while self.take()[1] != "return":
            pass
        return parameters

    def entries(self, end):
        """Returns the entries of a table, or arguments, as (name or None, Python)."""
        found = []
        while True:
            name = None
            if self.peek()[1] == "[":
                while self.take()[1] != "[":
                    pass
                name = ("key", self.until("]")[0])
                self.until("=")
            elif self.peek()[0] == NAME:
                here, word = self.at, self.peek()[1]
                while self.take()[1] != word:
                    pass
                if self.peek()[1] == "=":
                    name = word
                    self.until("=")
                else:
                    self.at = here
            text, stop = self.until(",", ";", end)
            if text.strip():
                found.append((name, text.strip()))
            if stop == end:
                return found

    def table(self, called):
        entries = self.entries("}")
        listed = [text for name, text in entries if name is None]
        named = [(name, text) for name, text in entries if name is not None]
        listed = [text for text in listed if text != "..." or not named]
        is_plain = all(isinstance(name, str) and not keyword.iskeyword(name) for name, _ in named)
        if called:
            if not all(text[0] in "([" for text in listed):
                listed = [f"[{', '.join(listed)}]"]
            keys = [f"{python_name(name)}={text}" for name, text in named if isinstance(name, str)]
            rest = [] if is_plain or keys else [literal(named)]
            return f"({', '.join(listed + keys + rest)})"
        if not named:
            return f"[{', '.join(listed)}]"
        fields = f"dict({', '.join(f'{name}={text}' for name, text in named)})" if is_plain else literal(named)
        return f"({', '.join(listed)}, {fields})" if listed else fields

    def arguments(self, called):
        """Translates arguments; a table of options at the end becomes keywords."""
        entries = self.entries(")")
        texts = [text for _, text in entries]
        if called and texts and texts[-1].startswith("dict(") and texts[-1].endswith(")"):
            texts[-1] = texts[-1][5:-1]
        return ", ".join(texts) + ")"


def literal(named):
    return "{" + ", ".join(f"{name[1] if isinstance(name, tuple) else repr(name)}: {text}" for name, text in named) + "}"


def python(lua):
    """Translates Lua text to Python; returns None where that is not possible."""
    try:
        text = "\n".join(line.strip(" ") for line in Reader(lua).until("")[0].split("\n"))
        compile(text.replace("...", "0"), "example", "exec")
        takes_first = re.search(r"^\w+ = [\w.]+\.(at|linearised|den_hartog\w*)\(", text, re.M)
        return None if takes_first else text
    except (NoPython, SyntaxError, IndexError):
        return None


def in_sentence(text):
    """Translates the names, examples and values in a message."""
    out, at = "", 0
    for found in re.finditer(r"[\w.:]*\{|[\w.:]+\(", text):
        if found.start() < at:
            continue
        depth, end = 0, found.end() - 1
        while end < len(text) and (depth := depth + ("({".count(text[end]) - ")}".count(text[end]))) > 0:
            end += 1
        piece = text[found.start():end + 1]
        out += text[at:found.start()] + (python(piece) or piece)
        at = end + 1
    out += text[at:]
    for lua, own in WORDS:
        out = re.sub(lua, own, out)
    return out


WORDS = [(r"\bsys([:.])(?=[a-z])", r"osc\1"), (r"\b([a-z]\w*):(?=[a-z])", r"\1."), (r"\b(got|returned) nil\b", r"\1 None"), (r"\bgot true\b", "got True"),
         (r"\bgot false\b", "got False"), (r"\btrue or false\b", "True or False"), (r"\bmath\.huge\b", "math.inf"),
         (r"\b(got|returned) a table\b", r"\1 a dict or a list"), (r"\ba vector or a table of\b", "an array or a list of"),
         (r"\ba table or a vector\b", "a list or an array"),
         (r"\ba table of numbers or a vector\b", "a list or an array of numbers"), (r"\ba vector\b", "an array"),
         (r"\bone table of (curves and )?named options\b", r"\1keyword arguments"), (r"\bnamed options\b", "keyword arguments"),
         (r"\ba table\b", "a dict")]


# ---- types of options and results

ACCEPTED = {"number": "Number", "flag": "bool", "text": "str", "numbers": "Numbers"}
WANTED = {"a number": "Number", "excitation": "Excitation", "function": "Callback", "law": "Friction", "a spring": "Spring",
          "integrator": "Integrator", "system": "System", "table": "Options", "name and its": "Options", "names and": "Options",
          "list": "Iterable[Any]", "or {": "Options", '"theta"': "str", "or two": "Numbers"}
TORQUE = "Number | Excitation | Callback | Options"
NAMED = {"M": TORQUE, "belt": TORQUE, "base": TORQUE, "theta0": "Number | Options", "velocity0": "Number | Options", "data": "Columns",
         "x": "str | int", "y": "str | int | Iterable[str]", "z": "str | int", "time": "str | int", "value": "str | int",
         "overlay": "Iterable[Any]", "zlim": "Numbers", "file": "Path", "free": "Iterable[str]"}
POSITIONAL = {"file": "Path", "name": "str", "f": "Callback", "times": "Numbers", "text": "str", "question": "str", "run": "Run",
              "data": "Columns", "value": "Any", "x": "Any"}
RESULTS = {"number": "float", "integer": "int", "string": "str", "boolean": "bool", "vector": "Vector", "table": "Record",
           "steady": "SteadyMotion", "law": "Friction", "": "None", "vector or table": "Vector", "string or false": "str | bool",
           "theta, velocity, z": "tuple[float, ...]", "vector, ...": "tuple[Vector, ...]", "run or data": "Any",
           "number or vector": "Any", "number or nil, or vector": "Any", "run, data or nil": "Any", "t, theta": "tuple[Vector, Vector]"}
FIELDS = {"names": "list[str]", "silent": "list[str]", "notes": "list[str]", "half_cycles": "list[Record]", "multipliers": "list[Record]", "others": "list[SteadyMotion]",
          "plot": "Picture | None", "phase_plot": "Picture | None"}


class Type(str):
    """A string that a signature shows without quotes."""

    __repr__ = str.__str__


def type_of_option(name, kind, choices, wanted, is_theory):
    wanted = re.sub(r"\{.*\}", "{", wanted)  # words of the example do not count
    if choices:
        return Type(f"Literal[{', '.join(map(repr, choices))}]")
    if kind in ACCEPTED and name != "file":
        return Type(ACCEPTED[kind])
    found = dict.fromkeys(own for word, own in WANTED.items() if word in wanted)
    if re.match("a function (of a point|that returns)", wanted):
        found = ["Callback"]
    return Type("System" if name == "system" else "Number | Numbers" if is_theory else
                NAMED.get(name) if name in ("M", "belt", "theta0", "velocity0", "free") else
                " | ".join(found) or NAMED.get(name, "Number | Numbers"))


def type_of_result(name, text):
    base = text.strip().removesuffix(" or nil").split(", ")[0] if text.strip() not in RESULTS else text.strip()
    known = FIELDS.get(name) if base in ("table", "") else None
    known = known or RESULTS.get(base) or classes.get(base) or "Any"
    return Type(known + (" | None" if text.strip().endswith(" or nil") and known != "Any" else ""))


def type_of_field(value):
    """Returns the type of a property, whose documentation begins with its signature."""
    head, _, result = value.__doc__.partition("\n")[0].partition(" ->")
    return type_of_result(head.rpartition(".")[2], result)


# ---- signatures and documentation

class Default(Type):
    """The default of an option, in the words of its documentation."""


def takes_one_table(member):
    """f{ ... }, not f(...)"""
    bracket = re.search("[({]", member["signature"].partition(" ->")[0])
    return bracket is not None and bracket[0] == "{"


def in_python(signature):
    """sys:simulate{ M } -> run as osc.simulate(M) -> run."""
    head, arrow, result = signature.partition(" ->")
    head = re.sub(r"^sys\b", "osc", re.sub(r"^(\w+):(\w)", r"\1.\2", head))
    return re.sub(r"^([\w.]+)\{ ?(.*?) ?\}$", r"\1(\2)", head) + arrow + result


def documentation(member):
    options = "".join(f"    {name}: {in_sentence(meaning)}\n" for _, name, meaning, *_ in member["options"])
    options += "    ax: axes of Matplotlib to draw into, as many as the picture has parts\n" if "    show = " in options else ""
    example = python(member["example"])
    shown = "\n    " + (example or member["example"]).replace("\n", "\n    ")
    return (f"{in_python(member['signature'])}\n\n{in_sentence(member['summary'])}\n\n{options}\n"
            f"{'Example' if example else 'In Lua'}:\n{shown}")


def positional_names(member):
    """The names in the brackets of the call, where they are names: t of e:value(t, theta)."""
    inner = re.match(r"[\w.:]+\(([^{}\[\]]*?)[,\[ ]*(\[?, )?(\{.*)?\)", member["signature"])
    names = [part.partition("=")[0].strip() for part in inner[1].split(",")] if inner and inner[1].strip() else []
    return [python_name(name) for name in names] if all(name.isidentifier() for name in names) else []


def signature_of(member, has_self, owner):
    """The signature for editors, type checkers and help(); Lua checks the call itself."""
    P = inspect.Parameter
    shown = {"self": P("self", P.POSITIONAL_ONLY)} if has_self else {}
    head = member["signature"].partition(" ->")[0]
    optional = re.findall(r"\w+(?= =)", head) + re.findall(r"\w+", head.partition("[")[2])
    with_curves = "{ {" in head
    several = len(re.findall(r"OPTIONS", member["form"])) > 1  # a call with two forms: no option is needed in both
    for name in [] if with_curves else positional_names(member):
        default = Default("...") if several or name in optional or member["kind"] == "metamethod" else P.empty
        shown[name] = P(name, P.POSITIONAL_OR_KEYWORD, default=default, annotation=Type(POSITIONAL.get(name, "Number")))
    only_options = takes_one_table(member) and member["options"] and not with_curves
    if len(shown) == has_self and not only_options and not re.search(r"(\(|\{ ?)[)}]$", head):
        shown["arguments"] = P("arguments", P.VAR_POSITIONAL, annotation=Type("Any"))
    for name, words, _, needed, kind, choices, wanted in member["options"]:
        default = P.empty if needed and not several else Default(NAMES.get(words.partition(" = ")[2]) or words.partition(" = ")[2] or "...")
        if name == "k" and owner == "":
            default = Default("...")
        own = python_name(name)
        annotation = type_of_option(name, kind, choices, wanted, owner == "theory")
        shown.setdefault(own, P(own, P.KEYWORD_ONLY, default=default, annotation=annotation))
    if "show" in shown:
        shown["ax"] = P("ax", P.KEYWORD_ONLY, default=Default("None"), annotation=Type("Any"))
    if "arguments" in shown and not member["options"]:
        shown["options"] = P("options", P.VAR_KEYWORD, annotation=Type("Any"))
    result = type_of_result(member["name"], member["signature"].partition(" ->")[2])
    return inspect.Signature(list(shown.values()), return_annotation=result)
