#!/usr/bin/env python3
"""Writes the reference pages of the documentation from what the program declares: commands, tables of the case file, parts, quantities of
the verdict, and the keys and columns of its results. Usage: scripts/make_reference.py PROGRAM FOLDER"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
FILES = [("report.html", "the report: one page that opens from disk"),
         ("summary.json", "all numbers, files, hashes and processing steps; keys below"),
         ("histories.csv", "quantities over time, one row per recorded step (`histories/NAME.csv` for each run of a comparison)"),
         ("load_steps.csv", "the same columns for the load steps of the static stages"),
         ("case.resolved.toml", "the case as it was computed, with all defaults"),
         ("floor_spectra.csv", "floor spectra of all runs, with `[[output.floor_spectrum]]`"),
         ("trust.json", "all values of the repetitions, of `uplift trust`"),
         ("fields/", "displacements, stresses and interface states for ParaView, with `[output.fields]`"),
         ("problem_NAME.json", "the interface problem of a failed step, for `uplift replay`")]
TITLES = {"law": "Interface laws", "bulk_law": "Bulk laws", "element": "Elements", "method": "Contact methods",
          "impact": "Impact rules", "scheme": "Time schemes", "function": "Functions of time", "record": "Record formats",
          "process": "Processing steps", "target": "Target spectra", "solver": "Solvers"}


class Program:
    def __init__(self, path):
        self.path = pathlib.Path(path).resolve()

    def __call__(self, *words, folder="."):
        done = subprocess.run([self.path, *words], capture_output=True, text=True, cwd=folder)
        if done.returncode:
            sys.exit(f"make_reference: uplift {' '.join(words)} ended with code {done.returncode}: {done.stderr}")
        return done.stdout


def cell(text):
    return text.replace("|", "\\|").replace("<", "&lt;") or " "


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(cell, row)) + " |" for row in rows]) + "\n"


def columns(lines):
    """Rows of a printed table whose columns begin where those of its first line do; the last column takes what is left."""
    starts = [found.start() for found in re.finditer(r"\S+", lines[0])]
    return [[line[a:b].strip() for a, b in zip(starts, starts[1:] + [None])] for line in lines[1:] if line.strip()]


def named(lines):
    """(name, meaning) of an indented list."""
    return [tuple(line.strip().split(None, 1)) for line in lines if line.startswith("  ")]


def families(program):
    """{family: (meaning, [(name, meaning)])} of `uplift describe`."""
    found = {}
    for block in program("describe").split("\n\n"):
        head, _, rest = block.partition("\n")
        if ": " in head and rest:
            family, _, meaning = head.partition(": ")
            found[family] = (meaning, named(rest.split("\n")))
    return found


def field_table(lines):
    rows = columns(lines)
    return table(("key", "unit", "default", "range", "meaning"), [(f"`{row[0]}`", *row[1:]) for row in rows])


def part_page(program, family, meaning, parts):
    text = [f"# {TITLES.get(family, family.capitalize())}", "", meaning[0].upper() + meaning[1:] + f". The list is printed by `uplift describe {family}`.", ""]
    for name, summary in parts:
        described = program("describe", family, name).split("\n")
        at = {word: described.index(word) for word in ("equations", "parameters", "source")}
        text += [f"## {name}", "", summary[0].upper() + summary[1:] + ".", "", "```text"]
        text += [line[2:] for line in described[at["equations"] + 1 : at["parameters"]] if line] + ["```", ""]
        fields = [line for line in described[at["parameters"] + 1 : at["source"]] if line]
        text += ["No parameters." if fields[0].strip() == "no parameters" else field_table(fields), ""]
        text += ["Source: " + " ".join(line.strip() for line in described[at["source"] + 1 :]).strip() + ".", ""]
    return "\n".join(text)


def section_text(program, path, level):
    lines = program("describe", "section", path).split("\n")
    meaning = lines[0].split(": ", 1)[1]
    text = [f"{'#' * level} {path}", "", meaning[0].upper() + meaning[1:] + ".", "", "```text", lines[1], "```", ""]
    fields = [i for i, line in enumerate(lines) if re.match(r"  key +unit", line)]
    end = next((i for i in range(fields[0], len(lines)) if not lines[i]), len(lines)) if fields else 0
    text += [field_table(lines[fields[0] : end]) if fields else "No keys.", ""]
    for i in range(end, len(lines)):
        found = re.match(r"(\w+) = \{ type = \.\.\., \.\.\. \}", lines[i])
        if found:
            rest = []
            for line in lines[i + 1 :]:
                if not line.startswith("  "):
                    break
                rest.append(tuple(line.strip().split(None, 1)))
            text += [f"`{found.group(1)} = {{ type = ..., ... }}` takes one of these parts:", "", table(("type", "parameters and defaults"), [(f"`{a}`", b) for a, b in rest])]
    return "\n".join(text) + "\n"


def case_pages(program, sections, folder):
    folder.mkdir(parents=True, exist_ok=True)
    tops = {}
    for path, meaning in sections:
        tops.setdefault(path.split(".")[0], []).append((path, meaning))
    for top, inner in tops.items():
        (folder / f"{top}.md").write_text("\n".join(section_text(program, path, 1 if path == top else 2) for path, _ in inner))
    rows = [(f"[`{path}`]({path.split('.')[0]}.md#{anchor(path)})", meaning) for path, meaning in sections]
    (folder / "index.md").write_text(
        "# Case file\n\nEvery table of a case file with its keys, units, defaults and ranges, as `uplift describe section NAME` prints them. "
        "`uplift schema` prints the same as a JSON Schema, which editors use for completion.\n\n"
        "Values may carry units (`\"20000 MPa\"`); bare numbers are in the unit of the column \"unit\".\n\n" + table(("table", "meaning"), rows))


def anchor(title):
    return re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", title).strip().lower())


def command_page(program):
    text = ["# Commands", "", "```text", program("--help").strip(), "```", ""]
    names = re.findall(r"^  (\w+)  ", program("--help").split("Subcommands:")[1].split("Examples:")[0], re.M)
    for name in names:
        text += [f"## {name}", "", "```text", program(name, "--help").split("\nExit codes:")[0].strip(), "```", ""]
    return "\n".join(text)


def quantity_page(program):
    rows = columns(program("describe", "quantity").split("\n")[1:])
    return ("# Quantities of the verdict\n\nThese numbers are in `verdict` of `summary.json`, and `[[verdict.criterion]]` may limit each of them. The column \"limit\" states on which side of its "
            "limit a number meets the criterion. Definitions: [theory, section 10](../theory/README.md#10-what-the-verdict-says).\n\n"
            + table(("quantity", "unit", "of", "limit", "meaning"), [(f"`{row[0]}`", *row[1:]) for row in rows]))


def result_rows(schema, path=""):
    """(key, unit, meaning) of everything in a schema of results. A value with its unit, and perhaps a time, is one row."""
    for key, inner in schema.get("properties", {}).items():
        here, meaning, unit = f"{path}.{key}" if path else key, inner["description"], inner.get("unit", "-")
        members = inner.get("properties", {})
        if "$ref" in inner:
            yield here, unit, f"{meaning} ([number](#{anchor('number')}))"
        elif {"value", "unit"} <= set(members) <= {"value", "unit", "time"}:
            yield here, members["value"]["unit"], meaning + (", with its time" if "time" in members else "")
        elif "additionalProperties" in inner and not members:
            yield f"{here}.*", "-", meaning
            if set(inner["additionalProperties"]["properties"]) - {"value", "unit", "time"}:
                yield from result_rows(inner["additionalProperties"], f"{here}.*")
        elif members:
            yield here, "-", meaning
            yield from result_rows(inner, here)
        elif inner.get("items", {}).get("type") == "object":
            yield f"{here}[]", "-", meaning
            yield from result_rows(inner["items"], f"{here}[]")
        else:
            yield here, unit, meaning + (": " + ", ".join(f"`{word}`" for word in inner["enum"]) if "enum" in inner else "")


def document_text(title, schema):
    text = [f"## {title}", "", schema["description"], "", table(("key", "unit", "meaning"), [(f"`{key}`", *rest) for key, *rest in result_rows(schema)])]
    for kind, inner in schema.get("$defs", {}).items():
        text += [f"### {kind}", "", table(("key", "unit", "meaning"), [(f"`{key}`", *rest) for key, *rest in result_rows(inner)])]
    return text


STICK = ROOT / "docs" / "guide" / "first_case.md"


def sample_results(program, folder):
    """Runs the case of the first page of the guide, with floor spectra."""
    case = re.search(r'```toml title="stick.toml"\n(.*?)```', STICK.read_text(), re.S).group(1)
    case += '\n[[output.floor_spectrum]]\nname = "top"\nnode = "top"\ndirection = [1, 0]\ndamping = [0.02]\n'
    (folder / "stick.toml").write_text(case)
    program("run", "stick.toml", "-q", "-o", "run", folder=folder)
    program("motion", "--generate", "rg_1_60", "pga=3", "duration=10", "seed=1", "-q", "-o", "motion", folder=folder)


def result_page(program):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        sample_results(program, folder)
        heads = {file: next(csv.reader(row for row in (folder / file).read_text().splitlines() if not row.startswith("#")))
                 for file in ("run/histories.csv", "run/load_steps.csv", "run/floor_spectra.csv", "motion/spectra.csv", "motion/motion.csv")}
    text = ["# Result files", "", "`uplift run`, `compare` and `trust` write into `out/NAME`:", "",
            table(("file", "content"), FILES), "The report contains `summary.json` and `trust.json` and shows their numbers. All values are in SI units. "
            "`uplift schema results`, `uplift schema trust` and `uplift schema motion` print the JSON Schemas from which these tables are made. "
            "A `*` stands for a name that the case chooses, and `[]` for the entries of a list. A value with a time is `{ \"value\", \"unit\", \"time\" }`.", ""]
    for title, document in (("summary.json", "results"), ("trust.json", "trust"), ("summary.json of uplift motion", "motion")):
        text += document_text(title, json.loads(program("schema", document)))
    text += ["## Columns of the CSV files", "", "The head of a column is its name with its unit in brackets. \"Mean of the step\" marks forces that belong to the middle of the step "
             "([reading the report](../guide/reading_the_report.md#which-instant-a-force-belongs-to)). `[[output.history]]` adds columns; "
             "its key `quantity` lists them ([output.history](case/output.md#outputhistory)). The files of the first case of the guide contain:", ""]
    for file, head in heads.items():
        text += [f"### {file.split('/')[1]}" + (" of uplift motion" if file.startswith("motion") else ""), "", "```text", *head, "```", ""]
    return "\n".join(text)


def write_reference(path, folder):
    program, folder = Program(path), pathlib.Path(folder)
    known = families(program)
    sections = known.pop("section")[1]
    (folder / "parts").mkdir(parents=True, exist_ok=True)
    for family, (meaning, parts) in known.items():
        (folder / "parts" / f"{family}.md").write_text(part_page(program, family, meaning, parts))
    (folder / "parts" / "index.md").write_text("# Parts\n\nA part is chosen by its name (`type = \"...\"`). Each states its equations, parameters, units and source once; the input, its range checks, "
                                              "the schema and these pages follow from that.\n\n" + table(("family", "meaning", "parts"), [
        (f"[{family}]({family}.md)", meaning, ", ".join(f"[{name}]({family}.md#{anchor(name)})" for name, _ in parts)) for family, (meaning, parts) in known.items()]))
    case_pages(program, sections, folder / "case")
    (folder / "commands.md").write_text(command_page(program))
    (folder / "quantities.md").write_text(quantity_page(program))
    (folder / "results.md").write_text(result_page(program))
    (folder / "index.md").write_text("# Reference\n\nThese pages are generated from the declarations of the program.\n\n"
                                    "- [Commands](commands.md): what `uplift --help` prints\n- [Case file](case/index.md): all tables and keys\n"
                                    "- [Parts](parts/index.md): laws, methods, schemes, functions, record formats and more, with equations and sources\n"
                                    "- [Quantities of the verdict](quantities.md)\n- [Result files](results.md): `summary.json`, `trust.json` and the columns of the CSV files\n")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    write_reference(sys.argv[1], sys.argv[2])
