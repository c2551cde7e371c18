#!/usr/bin/env python3
"""A file may include only its own layer and layers to its left; Eigen is named in src/uplift/math only; nobody prints or exits but the command line.
The tables of a case are read in case/schema alone: others use Case::input. Sections and equations of docs/theory that sources and tests cite
exist."""
import pathlib
import re
import sys

ORDER = "base math statistics mesh laws elements interface model linear contact dynamics reduction motion run case verdict study io session capi ensemble cli distributed".split()
ROOT = pathlib.Path(__file__).resolve().parent.parent / "src" / "uplift"

# Who takes a case from Case::input, and where tables are still asked for by their name: declared in the same file, or of elements and records.
TAKES_INPUT = ("case/", "verdict/", "study/trust", "io/", "session/", "capi/", "ensemble/", "cli/")
READS_TABLES = ("case/schema/", "case/build/criteria.cpp", "case/build/records.cpp", "case/build/model.cpp", "case/read.cpp", "case/mesh/mesh.cpp",
                "case/advice/warnings.cpp", "case/advice/input_warnings.cpp", "cli/soil.cpp")
READ_BY_NAME = re.compile(r"(\b(values|root|root_)(\.|->)(number|integer|flag|text|texts|numbers|table|tables|part|has|given)\(|table_if\([\w.>-]*(values|root),\s*)\"")

theory = (ROOT.parent.parent / "docs" / "theory" / "README.md").read_text()
sections = set(re.findall(r"^## (\d+)\.", theory, re.M))
equations = set(re.findall(r"\\tag\{(\d+[a-z]?)\}", theory))


def citations(text):
    """(what, number, where) of each section and equation of the theory that is cited; comments go on in the next line."""
    joined = re.sub(r"\n\s*(//+|#|\")\s?", " ", text)
    for found in re.finditer(r"docs/theory(?:/README\.md)?,? \(?(sections?|eqs?)((?:,? (?:and |to )?\(?\d+[a-z]?\)?)+)", joined):
        for number in re.findall(r"\d+[a-z]?", found.group(2)):
            yield ("section" if found.group(1).startswith("section") else "equation"), number


mistakes = []
cited = 0
for folder in ("src", "tests"):
    for path in sorted((ROOT.parent.parent / folder).rglob("*")):
        if path.suffix not in (".h", ".cpp", ".py"):
            continue
        for kind, number in citations(path.read_text()):
            cited += 1
            if number not in (sections if kind == "section" else equations):
                mistakes.append(f"{path.relative_to(ROOT.parent.parent)}: cites {kind} {number} of docs/theory, which does not exist")
for path in sorted(ROOT.rglob("*")):
    if path.suffix not in (".h", ".cpp"):
        continue
    layer = path.relative_to(ROOT).parts[0]
    if layer not in ORDER:
        mistakes.append(f"{path.relative_to(ROOT)}: \"{layer}\" is not a layer ({' '.join(ORDER)})")
        continue
    lines = path.read_text().splitlines()
    for number, line in enumerate(lines, 1):
        place = f"src/uplift/{path.relative_to(ROOT)}:{number}"
        include = re.match(r'\s*#include "uplift/([a-z]+)/', line)
        if include and ORDER.index(include.group(1)) > ORDER.index(layer):
            mistakes.append(f"{place}: layer {layer} includes {include.group(1)}, which is to its right")
        if re.match(r"\s*#include <(Eigen|unsupported/Eigen)", line) and layer != "math":
            mistakes.append(f"{place}: Eigen is included outside math")
        inside = str(path.relative_to(ROOT))
        if inside.startswith(TAKES_INPUT) and not inside.startswith(READS_TABLES) and READ_BY_NAME.search(line):
            mistakes.append(f"{place}: a table of the case is read by its name; Case::input has its members (case/schema)")
        if layer not in ("cli",) and re.search(r"std::(cout|cerr|exit|abort)\b|\bprintf\(|fmt::print\(", line):
            mistakes.append(f"{place}: the library prints or exits")
        following = lines[number] if number < len(lines) else ""
        if path.suffix == ".h" and re.match(r"\s*template\s*<", line) and re.search(r"\b(class|struct)\s+\w+", line.split(">", 1)[-1] + following):
            if layer not in ("math", "base"):
                mistakes.append(f"{place}: a class template in a header outside math and base")

print("\n".join(mistakes) if mistakes else f"layers: {' <- '.join(ORDER)}: in order; {cited} citations of docs/theory exist")
sys.exit(1 if mistakes else 0)
