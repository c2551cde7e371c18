#!/usr/bin/env python3
"""Runs a case with its own time step and with fractions of it, and prints the numbers of the verdict as a Markdown table.

    python3 scripts/step_table.py build/release/uplift examples/02_building_on_soil/case.toml

The runs are made one after the other in a temporary copy of the folder of the case. The last column is the difference of the first
step from the last one. Changes compared with the bonded run and rows of zeros are left out. `--scheme energy_decay` replaces the scheme
of the dynamic stages."""
import argparse
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1, ""), (1e-3, "m"), (1e-6, "µ"))


def with_step(text, factor, scheme):
    """The case with `factor` times the steps of its dynamic stages, and the first of these steps [s]."""
    steps = []

    def edit(stage):
        step = re.search(r'^step\s*=\s*"?([0-9.eE+-]+)\s*(ms|s)?"?', stage.group(0), re.M)
        if step is None:
            return stage.group(0)
        steps.append(float(step.group(1)) * (1e-3 if step.group(2) == "ms" else 1) * factor)
        line = f"step = {steps[-1]:.12g}" + (f'\nscheme = "{scheme}"' if scheme else "")
        return stage.group(0)[: step.start()] + line + stage.group(0)[step.end() :]

    text = re.sub(r"^\[\[stage\]\].*?(?=^\[|\Z)", edit, text, flags=re.M | re.S)
    return text, steps[0]


def run(program, folder, case, text):
    """All numbers of the verdict by (part, name), with the numerical energy error and the iterations per step."""
    (folder / case).write_text(text)
    done = subprocess.run([program, "run", folder / case, "--out", folder / "table", "--quiet"], capture_output=True, text=True)
    summaries = sorted(folder.glob("table*/summary.json"), key=lambda path: path.stat().st_mtime)
    if done.returncode not in (0, 3) or not summaries:
        sys.exit(done.stderr)
    summary = json.loads(summaries[-1].read_text())
    shutil.rmtree(summaries[-1].parent)
    verdict, first = summary["verdict"], summary["runs"][0]
    numbers = {("", name): (n["value"], n["unit"]) for name, n in verdict["numbers"].items()}
    for part in verdict["interfaces"] + verdict.get("beams", []):
        numbers |= {(part["name"], name): (n["value"], n["unit"]) for name, n in part["numbers"].items()}
    for name in ("energy_created", "energy_lost"):
        numbers[("", name)] = (100 * first[name]["value"] / first["energy_scale"], "%")
    numbers[("", "iterations of a step")] = (first["iterations"] / first["steps"], "1")
    return numbers


def cell(number):
    if number is None or not math.isfinite(number[0]):
        return "-"
    value, unit = number
    if unit in ("1", "%", "s") or value == 0:
        return f"{value:.4g}".replace("-", "−", value < 0) + ("" if unit == "1" else f" {unit}")
    scale, prefix = next((p for p in PREFIXES if abs(value) >= 0.9995 * p[0]), PREFIXES[-1])
    return f"{value / scale:.4g} {prefix}{unit}".replace("-", "−")


def difference(name, first, last):
    if not first or not last or not last[0] or "energy" in name or "iterations" in name:
        return "-"
    return f"{100 * (first[0] / last[0] - 1):+.2f} %".replace("+0.00", "0.00").replace("-0.00", "0.00").replace("-", "−")


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("program", type=pathlib.Path)
    options.add_argument("case", type=pathlib.Path)
    options.add_argument("--factors", default="1,0.5,0.25", help="of the step of the case")
    options.add_argument("--scheme", help="of the dynamic stages, instead of that of the case")
    given = options.parse_args()
    columns = {}
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name, "case")
        shutil.copytree(given.case.resolve().parent, folder, ignore=shutil.ignore_patterns("out"))
        for factor in given.factors.split(","):
            text, step = with_step(given.case.read_text(), float(factor), given.scheme)
            columns[f"{1e3 * step:.4g} ms"] = run(given.program.resolve(), folder, given.case.name, text)
    runs = list(columns.values())
    names = dict.fromkeys(key for numbers in runs for key in numbers)
    parts = {part for numbers in runs for part, name in numbers if part}
    print("| number | " + " | ".join(columns) + " | difference |\n|---|" + "---|" * (len(runs) + 1))
    for part, name in names:
        numbers = [numbers.get((part, name)) for numbers in runs]
        if name.startswith("change_of") or not any(number and number[0] for number in numbers):
            continue
        title = name if len(parts) < 2 or not part else f"{part}: {name}"
        print(f"| {title} | " + " | ".join(map(cell, numbers)) + f" | {difference(name, numbers[0], numbers[-1])} |")


main()
