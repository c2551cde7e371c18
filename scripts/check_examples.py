#!/usr/bin/env python3
"""Runs every example and compares it with the table on its page. Usage: scripts/check_examples.py build/release/uplift

A page of a study (a folder with a plan) holds a table of limit states `| limit | motions | median [g] | beta |`, for as many motions as its row says.
Any other page `README.md` below `examples` holds one table with the head `| run | status | top motion [mm] | uplifted [%] | gap [mm] |`: figures are compared to the
tolerance that stands below the table as `tolerance: 2 %` (of the figure)."""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

program = pathlib.Path(sys.argv[1]).resolve()
root = pathlib.Path(__file__).resolve().parent.parent
mistakes = compared = 0


def study(folder, rows):
    """(limit, median, beta, what is computed) of the row with the fewest motions: the whole study takes a minute."""
    few = min(int(row[1]) for row in rows)
    with tempfile.TemporaryDirectory() as place:
        copy = pathlib.Path(place, "copy.study")
        shutil.copytree(folder, copy)
        plan = (copy / "plan.toml").read_text()
        (copy / "plan.toml").write_text(re.sub(r"^count = \d+", f"count = {few}", plan, flags=re.M))
        done = subprocess.run([program, "study", "run", copy, "--quiet"], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{folder.name}: exit code {done.returncode}\n{done.stderr}")
        fits = {limit["name"]: limit["fit"] for limit in json.loads((copy / "study.json").read_text())["limits"]}
    for name, motions, median, beta in rows:
        if int(motions) == few:
            fit = fits[name.strip("`")]
            yield name, median, beta, (fit["theta"], fit["beta"])


for page in sorted(root.glob("examples/**/README.md")):
    text = page.read_text()
    rows = [[cell.strip() for cell in line.strip("|\n ").split("|")] for line in text.splitlines() if line.startswith("| `")]
    tolerance = float(re.search(r"tolerance: ([0-9.]+) %", text).group(1)) / 100
    if (page.parent / "plan.toml").exists():
        for name, *figures, found in study(page.parent, rows):
            compared += 2
            for word, figure, value in zip(("median", "beta"), figures, found):
                if abs(value - float(figure)) > tolerance * float(figure):
                    print(f"{page.parent.name}: {name}: {word} {value:.4g}, the page says {figure}")
                    mistakes += 1
        continue
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([program, "compare", page.parent / "case.toml", "--out", f"{folder}/out", "--quiet"], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(f"{page.parent.name}: exit code {done.returncode}\n{done.stderr}")
        runs = {run["name"]: run for run in json.loads(pathlib.Path(folder, "out", "summary.json").read_text())["runs"]}
    for name, status, *figures in rows:
        run = runs.get(name.strip("`"))
        if run is None:
            sys.exit(f"{page}: no run {name}; there are {', '.join(runs)}")
        if run["status"] != status.split()[0]:
            print(f"{page.parent.name}: {name}: status {run['status']}, the page says {status}")
            mistakes += 1
        top = next(column for column in run["peaks"] if column.endswith(".ux"))[:-3]  # the first column: motion of the top
        axes = ("ux", "uy") if f"{top}.uz" in run["peaks"] else ("ux",)  # in space the larger of both
        sway = max(abs(run["peaks"][f"{top}.{axis}"]["value"]) for axis in axes)
        found = [1e3 * sway, 100 * run["max_uplifted_ratio"]["value"], 1e3 * run["max_opening"]["value"]]
        for word, figure, value in zip(("top motion", "uplifted", "gap"), figures, found):
            if figure == "-":
                continue
            compared += 1
            if abs(value - float(figure)) > tolerance * abs(float(figure)):
                print(f"{page.parent.name}: {name}: {word} {value:.4g}, the page says {figure}")
                mistakes += 1
print(f"examples: {compared} figures compared, {mistakes} wrong")
sys.exit(1 if mistakes or not compared else 0)
