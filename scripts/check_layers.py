#!/usr/bin/env python3
"""A file may include only its own layer and layers to its left; Eigen is named in src/uplift/math only; nobody prints or exits but the command line.
A table of a file is read where its keys are declared: others use the structs of the folders "schema" (Case::input, StudyPlan). Sections and
equations of docs/theory that sources and tests cite exist."""
import pathlib
import re
import sys

ORDER = "base math statistics mesh laws elements interface model linear contact dynamics reduction motion run case verdict study io session capi ensemble cli distributed".split()
PARTS_OF = {"contact": "kernel newton lagrange impact".split()}  # folders of a layer, in order; its own files stand before all of them
ROOT = pathlib.Path(__file__).resolve().parent.parent / "src" / "uplift"

# A key of a table is read by its name where it is declared. Up to the layer of motions that is a folder of parts: a law reads its own
# parameters, and those that the laws of the folder have in common. From the layer of cases on it is a folder "schema", with the structs that
# everyone else uses, or the file that declares the key itself.
KEY_READ = re.compile(r'(?:\.|->)(?:number|integer|flag|text|texts|numbers|table|tables|part|has|given|is_word)\("([A-Za-z]\w*)"\)'
                      r'|\b(?:\w+_if|names?_used|vector_(?:of|used)|text_or|first_of_two)\([\w.>*()-]+, "(\w+)"|\bitems\(\)\.contains\("(\w+)"\)')
KEY_DECLARED = re.compile(r'\b(?:number|integer|flag|text|choice|numbers|vector|texts|table|tables|named|part|quantity)\(\s*"(\w+)"\s*,')
DECLARED_FOR = {"distributed": "linear"}  # the solver of uplift-mpi, which the program without it knows too

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
declared = {}  # keys by file and by folder
for path in ROOT.rglob("*.cpp"):
    for place in (path, path.parent):
        declared.setdefault(place, set()).update(KEY_DECLARED.findall(path.read_text()))
for path in sorted(ROOT.rglob("*")):
    if path.suffix not in (".h", ".cpp"):
        continue
    layer = path.relative_to(ROOT).parts[0]
    if layer not in ORDER:
        mistakes.append(f"{path.relative_to(ROOT)}: \"{layer}\" is not a layer ({' '.join(ORDER)})")
        continue
    lines = path.read_text().splitlines()
    of_parts = ORDER.index(layer) < ORDER.index("case") or layer in DECLARED_FOR
    known_keys = declared.get(ROOT / DECLARED_FOR[layer] if layer in DECLARED_FOR else path.parent if of_parts else path, set())
    for number, line in enumerate(lines, 1):
        place = f"src/uplift/{path.relative_to(ROOT)}:{number}"
        include = re.match(r'\s*#include "uplift/([a-z]+)/', line)
        if include and ORDER.index(include.group(1)) > ORDER.index(layer):
            mistakes.append(f"{place}: layer {layer} includes {include.group(1)}, which is to its right")
        part = re.match(r'\s*#include "uplift/([a-z]+)/([a-z]+)/', line)
        if part and layer == part.group(1) and layer in PARTS_OF:
            own, order = path.relative_to(ROOT).parts[1], PARTS_OF[layer]
            if own not in order or order.index(part.group(2)) > order.index(own):
                mistakes.append(f"{place}: {layer}/{own} includes {part.group(2)}, which is to its right ({' <- '.join(order)})")
        if re.match(r"\s*#include <(Eigen|unsupported/Eigen)", line) and layer != "math":
            mistakes.append(f"{place}: Eigen is included outside math")
        for key in (next(filter(None, found)) for found in KEY_READ.findall(line)):
            if path.parent.name != "schema" and layer != "base" and key not in known_keys:
                mistakes.append(f"{place}: \"{key}\" is read by its name where it is not declared; Case::input or StudyPlan has its member (folders schema)")
        if layer not in ("cli",) and re.search(r"std::(cout|cerr|exit|abort)\b|\bprintf\(|fmt::print\(", line):
            mistakes.append(f"{place}: the library prints or exits")
        following = lines[number] if number < len(lines) else ""
        if path.suffix == ".h" and re.match(r"\s*template\s*<", line) and re.search(r"\b(class|struct)\s+\w+", line.split(">", 1)[-1] + following):
            if layer not in ("math", "base"):
                mistakes.append(f"{place}: a class template in a header outside math and base")

print("\n".join(mistakes) if mistakes else f"layers: {' <- '.join(ORDER)}: in order; {cited} citations of docs/theory exist")
sys.exit(1 if mistakes else 0)
