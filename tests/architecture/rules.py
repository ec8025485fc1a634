#!/usr/bin/env python3
"""The rules of the house that a program can check: docs/architecture.md says why they are there.

    rules.py SOURCE
"""

import os
import re
import sys

ROOT = sys.argv[1]
MOST_ONE_USER_HEADERS = 14
# Each header of these is one row of a list: a new law, term or integrator needs no second user.
LISTS = {"src/motion/integrators.hpp", "src/model/terms.hpp", "src/api/bind_friction.cpp"}

# The floors of the house, from the top: a room includes itself and rooms below it. Rooms within a room (motion/rk4) stand
# on the same floor as the room around them.
FLOORS = ["main", "notebook", "prompt", "python", "help", "lab", "sweep", "api", "errors", "source", "lua", "plots", "files", "analysis", "theory",
          "motion", "model", "algebra", "terminal", "text"]
MATHEMATICS = ("text", "algebra", "model", "motion", "theory", "analysis")  # know neither Lua nor the world around them
WITHOUT_LUA = MATHEMATICS + ("terminal", "files", "plots")

SOURCES = (".cpp", ".hpp")
CODE = SOURCES + (".lua", ".py", ".sh")

complaints = []


def complain(path, line, sentence):
    complaints.append(f"{path}:{line}: {sentence}")


def files(endings):
    for folder, folders, names in os.walk(ROOT):
        folders[:] = sorted(f for f in folders if f not in (".git", "build", "__pycache__"))
        for name in sorted(names):
            path = os.path.relpath(os.path.join(folder, name), ROOT)
            if path.endswith(endings) or (not endings and "." not in name):
                yield path


def lines(path):
    with open(os.path.join(ROOT, path), encoding="utf-8", errors="replace") as file:  # what a fuzzer found is no text
        return list(enumerate(file.read().split("\n"), 1))


def room(path):
    return path.split("/")[1] if path.count("/") > 1 else "main"


def includes_point_down():
    for path in files(SOURCES):
        if not path.startswith("src/"):
            continue
        own = room(path)
        if own not in FLOORS:
            complain(path, 1, f"{own} is no room of the house")
            continue
        for number, line in lines(path):
            quoted = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
            if not quoted:
                continue
            target = quoted[1].split("/")[0]
            if "/" not in quoted[1] or target not in FLOORS:
                complain(path, number, f'"{quoted[1]}" is not a path from src/')
            elif FLOORS.index(target) < FLOORS.index(own):
                complain(path, number, f"{own} must not include {target}: arrows point down, {' -> '.join(FLOORS)}")
            if not os.path.exists(os.path.join(ROOT, "src", quoted[1])):
                complain(path, number, f"src/{quoted[1]} does not exist")


def rooms_are_namespaces():
    for path in files(SOURCES):
        if not path.startswith("src/") or room(path) == "main":
            continue
        if all(not line or line.startswith(("#", "//")) for _, line in lines(path)):
            continue  # nothing but includes
        own = "::".join(["dinal"] + os.path.dirname(path).split("/")[1:])
        opened = [re.match(r"namespace (dinal[\w:]*) \{", line) for _, line in lines(path)]
        # A class of another room may be declared (`class X;`), but the file also opens its own namespace.
        if not any(m and (m[1] == own or m[1].startswith(own + "::")) for m in opened):
            complain(path, 1, f"what lives here belongs into namespace {own}")


FORBIDDEN = [
    # folders, pattern, why
    (WITHOUT_LUA, r"#\s*include\s+[<\"](lua|lauxlib|lualib)", "only lua and the rooms above it know Lua"),
    (MATHEMATICS, r"#\s*include\s+<(iostream|fstream|cstdio|stdio\.h|print)>", "the mathematics does not print or read"),
    (MATHEMATICS, r"\b(printf|fprintf|puts|fputs|fmt::print)\s*\(", "the mathematics does not print"),
    (MATHEMATICS, r"#\s*include\s+<(chrono|ctime|thread|mutex|future|csignal|clocale|random)>",
     "the mathematics has no clock, no threads, no signals and no chance"),
    (MATHEMATICS, r"\b(getenv|setlocale|isatty)\s*\(", "the mathematics does not look around"),
    (FLOORS[FLOORS.index("prompt") + 1:], r"#\s*include\s+<readline/", "only the line editor knows readline"),
    (FLOORS, r"\bcatch\s*\(\s*\.\.\.\s*\)", "it would swallow Lua's own errors"),
    (FLOORS, r"\bsetlocale\s*\(\s*(?!LC_CTYPE)", "only LC_CTYPE: 1.5 must not become 1,5"),
]


def forbidden_things_are_absent():
    for path in files(SOURCES):
        if not path.startswith("src/"):
            continue
        for number, line in lines(path):
            code = re.sub(r'"(\\.|[^"\\])*"', '""', line) if "include" not in line else line
            code = code.split("//")[0]
            for folders, pattern, why in FORBIDDEN:
                if room(path) in folders and re.search(pattern, code):
                    complain(path, number, f"{why}: {line.strip()}")
        if "readline/" in "".join(l for _, l in lines(path)) and os.path.basename(path) != "line_editor.cpp":
            complain(path, 1, "only prompt/line_editor.cpp knows readline")


def decompositions_are_compiled_once():
    """Each of them takes seconds to compile in each file that uses it."""
    for path in files(SOURCES):
        if not path.startswith("src/") or path == "src/algebra/decompositions.cpp":
            continue
        for number, line in lines(path):
            if re.match(r"\s*#\s*include <Eigen/(?!Core>)", line):
                complain(path, number, "only src/algebra/decompositions.cpp includes more of Eigen than Core")


def headers_say_what_they_hold():
    for path in files((".hpp",)):
        first = [line for _, line in lines(path) if line.strip() and line.strip() != "#pragma once"][0]
        if not re.match(r"//+ \S.*", first):
            complain(path, 1, "a header starts with a sentence that says what lives there")


def headers_have_two_users():
    """A header that one file includes is a part of that file. The limit may fall, never rise."""
    users = {}
    for path in files(SOURCES):
        for _, line in lines(path):
            quoted = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
            if quoted:
                users.setdefault("src/" + quoted[1], set()).add(path)
    lonely = []
    for path in files((".hpp",)):
        # Its own source does not count; a test that looks into it does.
        other = {user for user in users.get(path, ()) if user != path[:-4] + ".cpp"}
        if path.startswith("src/") and len(other) < 2 and not other & LISTS:
            lonely.append(path)
    if len(lonely) > MOST_ONE_USER_HEADERS:
        complain("src", 1, f"{len(lonely)} headers have fewer than two users, {MOST_ONE_USER_HEADERS} are the limit: "
                           f"{' '.join(lonely)}")


def lua_tests_can_fail():
    """What stands behind the finish of a test file fails without a word to anybody."""
    for path in files((".lua",)):
        if re.search(r"tests/lua/\w+_test\.lua$", path) and any(re.match(r"test\(", line) for _, line in lines(path)):
            said = [line for _, line in lines(path) if line.strip()]
            if "finish()" not in said[-1]:
                complain(path, len(lines(path)), "a file of tests ends with finish()")


def tests_are_namespaces():
    """They are compiled together, and what one of them uses or calls something is no matter of the next."""
    for path in files((".cpp",)):
        own = f"namespace dinal::{os.path.basename(path)[:-4]} {{"
        if path.startswith("tests/core/") and own not in dict(lines(path)).values():
            complain(path, 1, f"a test lives in a {own[:-2]}")


def catch_is_included_once():
    """Debian 12 and 13 have two versions of it."""
    for path in files(SOURCES):
        for number, line in lines(path):
            if "#include <catch2/" in line and not path.startswith("tests/support/catch"):
                complain(path, number, 'include "support/catch.hpp"')


def nothing_is_left_for_later():
    words = "|".join(("TO" + "DO", "FIX" + "ME", "X" * 3, "HA" + "CK"))
    for path in list(files(CODE + (".md", ".txt", ".json", ".1"))) + list(files(())):
        for number, line in lines(path):
            if re.search(rf"\b({words})\b", line):
                complain(path, number, f"do it or file it: {line.strip()}")


def links_lead_somewhere():
    for path in files((".md",)):
        text = "\n".join(line for _, line in lines(path))
        text = re.sub(r"```.*?```", lambda m: "\n" * m[0].count("\n"), text, flags=re.S)
        for match in re.finditer(r"\]\(([^)\s]+)\)", text):
            target, _, anchor = match[1].partition("#")
            number = text.count("\n", 0, match.start()) + 1
            if re.match(r"[a-z]+:", target):
                continue
            goal = os.path.normpath(os.path.join(ROOT, os.path.dirname(path), target)) if target else os.path.join(ROOT, path)
            if not os.path.exists(goal):
                complain(path, number, f"the link {match[1]} leads nowhere")
            elif anchor and goal.endswith(".md") and anchor not in anchors(goal):
                complain(path, number, f"the link {match[1]} names no heading")


def documents_make_a_path():
    """The list of documents names each page, and each page ends with a link to the next one."""
    with open(os.path.join(ROOT, "docs/README.md"), encoding="utf-8") as file:
        index = file.read()
    for path in files((".md",)):
        if not re.match(r"(docs/(lab/|es/)?|examples/)[\w-]+\.md$", path):
            continue
        text = [line for _, line in lines(path) if line]
        if not re.match(r"(Next|Sigue): .*\]\([^)]+\)", text[-1]):
            complain(path, len(lines(path)), 'a page ends with "Next: [a title](page.md)."')
        if re.match(r"docs/[\w-]+\.md$", path) and path != "docs/README.md" and f"]({path[5:]})" not in index:
            complain(path, 1, "docs/README.md does not name this page")
    def words(path):
        return sum(len(line.split()) for _, line in lines(path))
    for path, most in (("README.md", 650), ("docs/theory.md", 4000), ("docs/architecture.md", 900), ("docs/bodies.md", 2700)):
        if words(path) > most:
            complain(path, 1, f"{words(path)} words, {most} are the limit: move what belongs elsewhere")
    with open(os.path.join(ROOT, "CHANGELOG.md"), encoding="utf-8") as file:
        newest = len(re.split(r"^## ", file.read(), flags=re.M)[1].split())
    if newest > 600:
        complain("CHANGELOG.md", 1, f"the newest version has {newest} words, 600 are the limit: say what users must know")
    total = sum(words(path) for path in files((".md",)) if re.match(r"(README|CHANGELOG)\.md$|docs/(?!es/)", path))
    if total > 50000:
        complain("docs/README.md", 1, f"the documents have {total} words, 50000 are the limit: say each thing once")


def documents_name_what_is_there():
    """Each source that the page of the house names, by its path or the end of it, exists."""
    path = "docs/architecture.md"
    known = ["/" + file for file in files(CODE)]
    for number, line in lines(path):
        for name in re.findall(r"`([\w/.-]+\.(?:[ch]pp|lua|py|sh))`", line):
            if "NAME" not in name and not any(file.endswith("/" + name) for file in known):
                complain(path, number, f"there is no {name}")


def the_tour_leads_through_the_code():
    """Each source that the tour names exists, and each function or type occurs in a source of the same item."""
    path, names = "docs/tour.md", 0
    text = "\n".join(line for _, line in lines(path))
    text = re.sub(r"```.*?```", lambda m: "\n" * m[0].count("\n"), text, flags=re.S)
    for item in re.finditer(r"\S(?:.|\n(?!\n|\d+\. |- ))*", text):
        number, words, sources = text.count("\n", 0, item.start()) + 1, re.findall(r"`([^`]+)`", item[0]), ""
        for source in (word for word in words if word.startswith("src/")):
            if os.path.exists(os.path.join(ROOT, source)):
                sources += "\n".join(line for _, line in lines(source))
            else:
                complain(path, number, f"there is no {source}")
        for name in (word for word in words if re.fullmatch(r"[A-Za-z]\w*(::\w+)*", word)):
            names += 1
            if not re.search(rf"\b{name}\b", sources):
                complain(path, number, f"{name} is in none of the sources named beside it")
    if names < 40:
        complain(path, 1, f"the tour names {names} functions and types: is it read right?")


def retired_words_are_gone():
    """What the page of the house calls retired is in no source."""
    text = " ".join(line for _, line in lines("docs/architecture.md"))
    retired = re.findall(r"`(\w+)`", re.search(r"Retired, and nowhere in `src`:([^.]*)\.", text)[1])
    assert len(retired) > 3
    for path in files(CODE):
        for number, line in lines(path):
            for word in re.findall(r"\w+", line) if path.startswith("src/") else ():
                if word in retired:
                    complain(path, number, f"{word} is retired: docs/architecture.md has the words")


def anchors(goal):
    with open(goal, encoding="utf-8") as file:
        text = re.sub(r"```.*?```", "", file.read(), flags=re.S)
    headings = re.findall(r"^#+ +(.*)$", text, flags=re.M)
    explicit = re.findall(r'<a (?:id|name)="([^"]+)"', text)
    return set(explicit) | {re.sub(r"[^\w\- ]", "", h.lower()).strip().replace(" ", "-") for h in headings}


for rule in (includes_point_down, rooms_are_namespaces, forbidden_things_are_absent, decompositions_are_compiled_once,
             headers_say_what_they_hold, headers_have_two_users, lua_tests_can_fail, tests_are_namespaces,
             catch_is_included_once, nothing_is_left_for_later, links_lead_somewhere, documents_make_a_path,
             documents_name_what_is_there, the_tour_leads_through_the_code, retired_words_are_gone):
    rule()
if not any(True for _ in files((".hpp",))):
    complaints.append("no headers found: is the folder right?")
print("\n".join(complaints) or "all rules hold")
sys.exit(1 if complaints else 0)
