#!/usr/bin/env python3
"""Writes the verification manual: a page for each test of tests/verification, with its text (the comments above the test and at the head of its
file), the figures that its last run left in a folder, and the command to repeat it; and the matrix of requirements, tests and results.
Usage: scripts/make_verification.py RECORD FOLDER"""
import html
import json
import math
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
TESTS = ROOT / "tests" / "verification"
COLOURS = ("#0b64a0", "#d1500a", "#2b8a3e", "#7a3fa0", "#a07a00", "#00868b", "#b0245c", "#555555")
SIGNS = {"less": "< {}", "greater": "> {}", "at_most": "≤ {}", "at_least": "≥ {}"}


def comment_text(lines):
    """The text of // lines; indented lines are equations and stay as they are."""
    return "\n".join(re.sub(r"^// ?", "", line) for line in lines).strip()


def escaped(text):
    """Plain text as Markdown."""
    return re.sub(r"([*_\[\]`\\|])", r"\\\1", text).replace("<", "&lt;")


def declared():
    """{"Suite.Name": case} of the sources: file, text, head of the file, requirement, title and source."""
    found = {}
    for path in sorted(TESTS.glob("*_test.cpp")):
        lines = path.read_text().splitlines()
        first = next(i for i, line in enumerate(lines) if not line.startswith("//") and not line.startswith("#") and line.strip())
        head = comment_text([line for line in lines[:first + 1] if line.startswith("//")])
        if not head:  # after the includes
            comments = [line for line in lines[: first + 3] if line.startswith("//")]
            head = comment_text(comments)
        for number, line in enumerate(lines):
            test = re.match(r"TEST(_P)?\((\w+), (\w+)\)", line)
            if not test:
                continue
            begin = number
            while lines[begin - 1].startswith("//"):
                begin -= 1
            stated = re.search(r"VERIFIES\(\s*(\{.*?\})\);", "\n".join(lines[number + 1 : number + 8]), re.S)
            if not stated:
                sys.exit(f"make_verification: {path.relative_to(ROOT)}:{number + 1}: {test.group(2)}.{test.group(3)} does not begin with VERIFIES")
            parts = re.findall(r'"((?:[^"\\]|\\.)*)"(?=\s*[,}])', re.sub(r'"\s*\n\s*"', "", stated.group(1)))
            requirement, title, source = (part.replace('\\"', '"') for part in parts)
            found[f"{test.group(2)}.{test.group(3)}"] = {
                "id": f"{test.group(2)}.{test.group(3)}", "file": path.name, "parametrised": bool(test.group(1)), "requirement": requirement, "title": title,
                "source": source, "head": head, "text": comment_text(lines[begin:number])}
    return found


def measured(folder):
    """{"Suite.Name": [record]}: of tests with a parameter one record for each."""
    found = {}
    if folder is not None and folder.is_dir():
        for path in sorted(folder.glob("*.json")):
            record = json.loads(path.read_text())
            suite, name = record["suite"].split("/")[-1], record["name"].split("/")
            record["instance"] = name[1] if len(name) > 1 else ""
            found.setdefault(f"{suite}.{name[0]}", []).append(record)
    return found


def figure(value):
    return "not finite" if value is None else f"{value:.10g}" if abs(value) >= 1e-3 or value == 0 else f"{value:.3e}"


def cell(text):
    return str(text).replace("|", "\\|")


def result_table(record):
    lines = ["| quantity | unit | reference | measured | tolerance | comparisons |", "|---|---|---|---|---|---|"]
    for row in record["rows"]:
        if row["comparison"] in SIGNS:
            reference, tolerance = SIGNS[row["comparison"]].format(figure(row["reference"])), " "
        else:
            reference, tolerance = figure(row["reference"]), "exact" if row["comparison"] == "equal" else f"{row['tolerance']:.3g}"
        lines.append("| " + " | ".join(map(cell, (row["quantity"], row["unit"], reference, figure(row["measured"]), tolerance, row["count"]))) + " |")
    return "\n".join(lines)


def drawing(curves):
    """Errors over the size or step relative to the coarsest one, logarithmic, with lines of the orders 1 and 2: SVG."""
    width, height, left, top, bottom = 560, 320, 70, 20, 48
    points = [[(x / max(curve["size"]), y) for x, y in zip(curve["size"], curve["error"]) if x > 0 and y is not None and y > 0] for curve in curves]
    xs, ys = [x for each in points for x, _ in each], [y for each in points for _, y in each]
    if len(set(xs)) < 2 or not ys:
        return ""
    low_x, high_y, low_y = math.log10(min(xs)), math.ceil(math.log10(max(ys)) + 0.01), math.floor(math.log10(min(ys)) - 0.01)

    def place(x, y):
        return (f"{left + (math.log10(x) - low_x) / -low_x * (width - left - 190):.1f}",
                f"{top + (high_y - math.log10(y)) / (high_y - low_y) * (height - top - bottom):.1f}")

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">', f'<rect width="{width}" height="{height}" fill="#fff"/>']
    for power in range(low_y, high_y + 1):
        (a, y), (b, _) = place(min(xs), 10.0**power), place(1, 10.0**power)
        out += [f'<line x1="{a}" y1="{y}" x2="{b}" y2="{y}" stroke="#ddd"/>', f'<text x="{left - 6}" y="{float(y) + 4:.1f}" text-anchor="end">1e{power}</text>']
    for x in sorted(set(f"{x:.3g}" for x in xs)):
        at = place(float(x), 10.0**low_y)[0]
        out += [f'<line x1="{at}" y1="{top}" x2="{at}" y2="{height - bottom}" stroke="#eee"/>', f'<text x="{at}" y="{height - bottom + 15}" text-anchor="middle">{x}</text>']
    for order, dash in ((1, "6 4"), (2, "2 3")):
        start = 10.0**high_y / 1.5
        end = max(start * min(xs) ** order, 10.0**low_y)
        (a, b), (c, d) = place(1, start), place((end / start) ** (1 / order), end)
        out.append(f'<line x1="{a}" y1="{b}" x2="{c}" y2="{d}" stroke="#999" stroke-dasharray="{dash}"/>')
        out += [f'<line x1="{width - 180}" y1="{height - bottom - 18 + 14 * order}" x2="{width - 160}" y2="{height - bottom - 18 + 14 * order}" stroke="#999" stroke-dasharray="{dash}"/>',
                f'<text x="{width - 155}" y="{height - bottom - 14 + 14 * order}">order {order}</text>']
    for number, (curve, each) in enumerate(zip(curves, points)):
        colour = COLOURS[number % len(COLOURS)]
        path = " ".join(",".join(place(x, y)) for x, y in sorted(each))
        out.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="1.6"/>')
        out += ['<circle cx="{}" cy="{}" r="2.6" fill="{}"/>'.format(*place(x, y), colour) for x, y in each]
        if number < 16:
            out += [f'<line x1="{width - 180}" y1="{top + 6 + 14 * number}" x2="{width - 160}" y2="{top + 6 + 14 * number}" stroke="{colour}" stroke-width="1.6"/>',
                    f'<text x="{width - 155}" y="{top + 10 + 14 * number}">{html.escape(curve["label"])}</text>']
    out += [f'<text x="{left + (width - left - 190) / 2:.0f}" y="{height - 12}" text-anchor="middle">size or step over the coarsest one</text>',
            f'<text transform="translate(16 {(height - bottom + top) / 2:.0f}) rotate(-90)" text-anchor="middle">error</text>', "</svg>"]
    return "\n".join(out)


def state(records):
    if not records:
        return "not run"
    return "passed" if all(record["passed"] for record in records) else "FAILED"


def commit():
    done = subprocess.run(["git", "rev-parse", "--short=10", "HEAD"], cwd=ROOT, capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def page(case, records, version, folder):
    text = [f"# {case['title']}", "", f"**Requirement:** {case['requirement']}. **Test:** `{case['id']}` in `tests/verification/{case['file']}`. **Result:** {state(records)}.", "",
            f"**Source:** {escaped(case['source'])}.", ""]
    if case["text"]:
        text += ["## What is verified", "", escaped(re.sub(r"^Claim[^:]*: (\w)", lambda found: found.group(1).upper(), case["text"])), ""]
    if case["head"] and case["head"] != case["text"]:
        text += ["## The problem", "", escaped(case["head"]), ""]
    text += ["## Figures", ""]
    if not records:
        text += ["This build has not run the test. `make test` fills this page.", ""]
    for record in records:
        text += ([f"### {record['instance']}", ""] if record["instance"] else []) + [result_table(record), ""]
    curves = [curve for record in records for curve in record.get("curves", [])]
    if picture := drawing(curves) if curves else "":
        (folder / f"{case['id']}.svg").write_text(picture)
        text += [f"![Error over size or step]({case['id']}.svg)", ""]
    if records:
        text += ["Where several comparisons have the same name, the row is the one nearest to its tolerance.", ""]
    wildcard = f"*{case['id']}/*" if case["parametrised"] else case["id"]
    text += ["## Repeat it", "", "```sh fragment", f"build/release/tests/test_verification --gtest_filter='{wildcard}'", "```", "", f"Commit {version}.", ""]
    return "\n".join(text)


def contents():
    """{requirement: [case]} in the order of the manual."""
    found = {}
    for case in declared().values():
        found.setdefault(case["requirement"], []).append(case)
    return found


def write_manual(record, folder):
    groups, records, version = contents(), measured(record), commit()
    folder.mkdir(parents=True)
    count = sum(len(records.get(case["id"], [])) for cases in groups.values() for case in cases)
    text = ["# Verification", "", f"{sum(map(len, groups.values()))} tests" + (f" with {count} cases" if count else "") + " compare the program with closed forms, published figures and independent computations, "
            "never with output of the program itself. The tests write these pages: the figures are those of their last run, and a changed tolerance changes the page. "
            "The property tests (`tests/property`) and the tests of single parts (`tests/unit`) are not listed here.", "",
            "| requirement | case | quantities | result |", "|---|---|---|---|"]
    for requirement, entries in groups.items():
        for case in entries:
            found = records.get(case["id"], [])
            (folder / f"{case['id']}.md").write_text(page(case, found, version, folder))
            quantities = len({row["quantity"] for each in found for row in each["rows"]})
            cases_of = f" ({len(found)} cases)" if len(found) > 1 else ""
            text.append(f"| {requirement} | [{cell(case['title'])}]({case['id']}.md){cases_of} | {quantities or ' '} | {state(found)} |")
            requirement = " "
    text += ["", "[Further cases](../verification.md) are part of the unit tests.", ""]
    (folder / "index.md").write_text("\n".join(text))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    write_manual(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
