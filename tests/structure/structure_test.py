#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The house in the source: sizes of functions and classes, and which folder includes which.

structure_test.py ROOT: a line for each thing that breaks a rule of CONTRIBUTING.md, and exit code 1; else 0.
structure_test.py --self: checks that a function and a class that are too long and a circle are found.
It reads text as clang-format leaves it: what stands at a line's start begins and ends there.
"""

import collections
import pathlib
import re
import sys
import tempfile

MOST_FUNCTION_LINES = 60
MOST_CLASS_LINES = 250  # its body and all its member functions, with comments and blank lines
FOLDERS = ("modules", "tools", "examples")

CLASS = re.compile(r"^(?:class|struct) (?:\[\[\w+\]\] )?((?:\w+::)*\w+)(?: final)?(?: :(?!:).*)?(?: \{|$)")
MEMBER = re.compile(r"^(?!template|using|static_assert|namespace|return)(?:[^\s/#}].*?[\s*&])?((?:\w+::)+)~?(?:\w+|operator.{1,3})\(")
# The first line of a function that may be long: a name with what it returns before it, or a constructor outside its class.
FUNCTION = re.compile(r"^ {0,4}(?![ :]|if|for|while|switch|do|else|try|catch|return|class|struct|namespace|enum|using|new|throw)(?:[\w:<>,&*\[\] ]+[ &*][\w:~]+|(\w+)::~?\1)\(")
BODY = re.compile(r"\)(?: const)?(?: noexcept)?(?: override)?(?: final)?(?: -> .*)? \{$|^ *: .*\{$")


def sources(root):
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in (".cpp", ".hpp", ".inl"):
                yield path


def function_sizes(lines):
    """(first line, lines, its text) of each function that begins at a line's start or in a class."""
    found = []
    for i, line in enumerate(lines):
        if not FUNCTION.match(line) or line.endswith("\\"):
            continue
        opens = next((k for k in range(i, min(i + 12, len(lines))) if re.search(r"[{;}]$", lines[k])), None)
        if opens is None or not BODY.search(lines[opens]):
            continue
        close = " " * (len(line) - len(line.lstrip())) + "}"
        last = next((k for k in range(opens + 1, len(lines)) if lines[k].startswith(close)), None)
        if last is not None:
            found.append((i + 1, last - i + 1, line.strip()))
    return found


def spaces_of(lines):
    """The namespaces that each line stands in, outermost first; "" for an unnamed one."""
    spaces, result = [], []
    for line in lines:
        if match := re.match(r"^namespace ([\w:]*) ?\{", line):
            spaces = [*spaces, match.group(1)]
        elif line.startswith("}  // namespace") and spaces:
            spaces = spaces[:-1]
        result.append(spaces)
    return result


def full_name(path, spaces, name):
    """"map::PlaneMapper"; what stands in an unnamed namespace is its file's own."""
    return ("" if "" not in spaces else path.stem + " ") + "::".join([*filter(None, spaces), name])


def class_sizes(files):
    """Lines of each class by its full name, its body and its member functions; and where each stands."""
    sizes, places, members = collections.Counter(), {}, []
    for path, lines in files.items():
        for i, (line, spaces) in enumerate(zip(lines, spaces_of(lines))):
            last = next((k for k in range(i, len(lines)) if lines[k].startswith("}")), None)
            if last is None:
                break
            if (match := CLASS.match(line)) and not re.search(r"[;}]$", line):
                name = full_name(path, spaces, match.group(1))
                sizes[name] += last - i + 1
                places.setdefault(name, (path, i + 1))
            elif match := MEMBER.match(line):
                text = "\n".join(lines[i : last + 1])
                if 0 <= text.find("{") and not 0 <= text.find(";") < text.find("{"):
                    members.append((full_name(path, spaces, match.group(1)[:-2]), last - i + 1))
    for owner, count in members:
        # A member of a class that is defined within another's body adds to the outer one.
        while owner not in sizes and "::" in owner:
            owner = owner.rpartition("::")[0]
        sizes[owner] += count if owner in sizes else 0
    return sizes, places


def room_of(root, path):
    """The folder that a file's purpose is told for: modules/map, modules/core/geometry, tools/run."""
    parts = path.relative_to(root).parts
    return "/".join(parts[:-1]) if parts[:3] == ("modules", "core", "geometry") else "/".join(parts[: min(2, len(parts) - 1)])


def includes(root, files):
    """Which room includes which, with one place for each pair."""
    arrows = {}
    for path, lines in files.items():
        for i, line in enumerate(lines):
            if match := re.match(r'#include "([^"]+)"', line):
                target = next((root / top / match.group(1) for top in ("modules", "tools") if (root / top / match.group(1)).exists()), None)
                if target is None:
                    continue
                pair = (room_of(root, path), room_of(root, target))
                if pair[0] != pair[1]:
                    arrows.setdefault(pair, f"{path.relative_to(root)}:{i + 1}")
    return arrows


def circles(arrows):
    """One circle for each room that reaches itself, as a list of rooms."""
    goes = collections.defaultdict(set)
    for a, b in arrows:
        goes[a].add(b)
    found = []
    for start in sorted(goes):
        way, seen = {start: None}, [start]
        for room in seen:
            for other in sorted(goes[room]):
                if other == start:
                    circle, at = [start], room
                    while at is not None:
                        circle.append(at)
                        at = way[at]
                    if start == min(circle):
                        found.append(circle[::-1])
                    break
                if other not in way:
                    way[other] = room
                    seen.append(other)
            else:
                continue
            break
    return found


def complaints(root):
    files = {path: path.read_text().split("\n") for path in sources(root)}
    for path, lines in files.items():
        for first, count, text in function_sizes(lines):
            if count > MOST_FUNCTION_LINES:
                yield f"{path.relative_to(root)}:{first}: a function of {count} lines, at most {MOST_FUNCTION_LINES}: {text}"
    sizes, places = class_sizes(files)
    for name, count in sizes.items():
        if count > MOST_CLASS_LINES:
            path, line = places[name]
            yield f"{path.relative_to(root)}:{line}: {name} has {count} lines with its member functions, at most {MOST_CLASS_LINES}"
    arrows = includes(root, files)
    for circle in circles(arrows):
        pairs = zip(circle[:-1], circle[1:])
        yield "includes go in a circle: " + " -> ".join(circle) + "; " + ", ".join(arrows[pair] for pair in pairs)
    for (a, b), place in sorted(arrows.items()):
        if a.startswith("modules/") and b.startswith("tools/"):
            yield f"{place}: a module includes a tool's header"


def self_test():
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        for folder, text in {
            "modules/a/long.cpp": '#include "b/b.hpp"\nint f(int a) {\n' + "    a += 1;\n" * 70 + "    return a;\n}\n",
            "modules/a/a.hpp": "namespace a {\nclass Big {\n  public:\n" + "    int x;\n" * 100 + "};\n}  // namespace a\n",
            "modules/a/big.cpp": "namespace a {\n\n" + "".join(f"int Big::f{i}() {{\n" + "    x;\n" * 30 + "}\n\n" for i in range(6)) + "}  // namespace a\n",
            "modules/b/b.hpp": '#include "a/a.hpp"\n',
        }.items():
            (root / folder).parent.mkdir(parents=True, exist_ok=True)
            (root / folder).write_text(text)
        said = list(complaints(root))
        print("\n".join(said))
        for what in ("a function of 73 lines", "a::Big has 295 lines", "in a circle: modules/a -> modules/b -> modules/a"):
            assert any(what in line for line in said), what
        assert len(said) == 3, said


def main():
    if sys.argv[1:] == ["--self"]:
        self_test()
        return 0
    said = list(complaints(pathlib.Path(sys.argv[1]).resolve()))
    print("\n".join(said))
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main())
