#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""docs/formats.md beside what programs write: each key of their JSON stands, as `key`, in the section that is about it.

formats_test.py ROOT: a line for each key, section and file that is missing, and exit code 1; else 0.
formats_test.py --self: checks that these are found.
Keys are read from the sources of those who write: the first of the two in {"key", value}, and what stands in ["key"].
"""

import pathlib
import re
import sys
import tempfile

DOCUMENT = "docs/formats.md"
RUN, EVALUATE, ODOMETRY, MAP = "report.json, report.md", "What planemap-evaluate says", "planemap-bench-odometry", "planemap-bench-map"
# Who writes, and the sections that say what. The first pattern that fits a file counts; None: it writes nothing that stays.
WRITERS = [
    ("modules/exports/planes_json.cpp", ["planes.json"]),
    ("modules/exports/floor_plan.cpp", ["floor_plan.geojson"]),
    ("modules/simulator/planes_truth.cpp", ["groundtruth.txt, planes_truth.json"]),
    ("tools/run/*.cpp", [RUN]),
    ("tools/report*/page.cpp", ["report.html"]),
    ("tools/export/*.cpp", ["What planemap-export adds"]),
    ("tools/measure/*.cpp", ["What planemap-measure says"]),
    ("tools/evaluate/soundness_report.cpp", [RUN]),
    ("tools/evaluate/*.cpp", [EVALUATE, RUN, ODOMETRY, MAP]),
    ("tools/segment/*.cpp", ["What planemap-segment writes"]),
    ("tools/log/*.cpp", ["What planemap-log says"]),
    ("tools/report/*.cpp", ["What planemap-report says"]),
    ("tools/bench_segmentation/*.cpp", ["planemap-bench-segmentation"]),
    ("tools/bench_odometry/*.cpp", [ODOMETRY]),
    ("tools/bench_map/*.cpp", [MAP]),
    ("tools/bench_run/peers.cpp", None),  # from a process of its own to its parent
    ("tools/bench_run/*.cpp", ["planemap-bench-run"]),
    ("tools/bench_soak/*.cpp", ["planemap-bench-soak"]),
    ("tools/benchmark/*.cpp", None),  # the same
    ("tools/convert/*.cpp", None),  # cameras of others are read
]


def pairs(text):
    """The keys of {"key", value}: braces that hold two things."""
    for match in re.finditer(r'\{\s*"([a-z]\w*)",', text):
        depth = commas = 0
        for token in re.finditer(r'"(?:\\.|[^"\\])*"|[{}()\[\],]', text[match.start() :]):
            depth += token[0] in "{(["
            depth -= token[0] in "})]"
            commas += token[0] == "," and depth == 1
            if depth == 0:
                break
        if commas == 1:
            yield match[1]


def keys(text):
    """The keys that a source writes, in its order."""
    text = re.sub(r"(?m)^\s*//.*$", "", text)
    return list(dict.fromkeys([*pairs(text), *re.findall(r'\["([a-z]\w*)"\]', text), *re.findall(r'emplace\("([a-z]\w*)",', text)]))


def sections(text):
    """What stands under each heading, with the headings below it."""
    lines = text.split("\n")
    headings = [(i, len(m[1]), m[2]) for i, line in enumerate(lines) if (m := re.match(r"(#+) (.*)", line))]
    found = {}
    for i, level, name in headings:
        end = next((j for j, other, _ in headings if j > i and other <= level), len(lines))
        found[name] = "\n".join(lines[i:end])
    return found


def told(text):
    """The words that stand as code."""
    return {word for code in re.findall(r"`([^`]+)`", text) for word in re.findall(r"\w+", code)}


def complaints(root, writers):
    about = {name: told(text) for name, text in sections((root / DOCUMENT).read_text()).items()}
    for name in dict.fromkeys(name for _, names in writers for name in names or []):
        if name not in about:
            yield f'{DOCUMENT} has no section "{name}"'
    taken = {}
    for pattern, names in writers:
        files = sorted(root.glob(pattern))
        if not files:
            yield f"{pattern} is not there: say in {pathlib.Path(__file__).name} who writes it now"
        for path in files:
            taken.setdefault(path, names)
    for path in sorted((root / "tools").rglob("*.cpp")):
        text = path.read_text()
        if path not in taken and "Json" in text and keys(text):
            yield f"{path.relative_to(root)} writes JSON: say in {pathlib.Path(__file__).name} which section is about it"
    for path, names in taken.items():
        text = path.read_text()
        if names is None or not re.search("json", text, re.IGNORECASE):
            continue
        known = set().union(*(about.get(name, set()) for name in names))
        for key in keys(text):
            if key not in known:
                yield f'{path.relative_to(root)}: `{key}` does not stand in {DOCUMENT}, "{names[0]}"'


def self_test():
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        for file, text in {
            DOCUMENT: "# Formats\n## A\n`told`, `other.inner`\n### Below\n`below`\n## B\n`elsewhere`\n",
            "tools/a/a.cpp": 'Json j{{"told", f(1, 2)}, {"missing", {"x, }", 2}}, {"elsewhere", 0}};\nj["inner"]["below"] = 1;\n'
            'j["assigned"] = 2;\nj.emplace("emplaced", 3);\n// {"comment", 1}\nTable t{{"heading", "column", 3}};\n',
            "tools/b/new.cpp": 'Json j{{"key", 1}};\n',
        }.items():
            (root / file).parent.mkdir(parents=True, exist_ok=True)
            (root / file).write_text(text)
        said = list(complaints(root, [("tools/a/*.cpp", ["A"]), ("tools/gone.cpp", ["C"])]))
        print("\n".join(said))
        wanted = ["`missing`", "`elsewhere`", "`assigned`", "`emplaced`", "tools/b/new.cpp writes JSON", 'no section "C"', "tools/gone.cpp is not there"]
        for what in wanted:
            assert sum(what in line for line in said) == 1, what
        assert len(said) == len(wanted), said


def main():
    if sys.argv[1:] == ["--self"]:
        self_test()
        return 0
    said = list(complaints(pathlib.Path(sys.argv[1]).resolve(), WRITERS))
    print("\n".join(said))
    return 1 if said else 0


if __name__ == "__main__":
    sys.exit(main())
