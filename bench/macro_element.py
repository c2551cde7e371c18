#!/usr/bin/env python3
"""Time of a step of a macro-element beside that of springs on 40 points: the benchmark footing (bench/cases, 10 000 steps with uplift, without
yielding). A step is what it takes until its values are recorded, energies and checks among it; the whole run, divided by its steps, is beside it.
All cases run in turns, so that what else the machine does is shared by them; each counts with its least time. Usage: bench/macro_element.py build/release/uplift [rounds]"""
import json
import pathlib
import subprocess
import sys
import tempfile

program = pathlib.Path(sys.argv[1]).resolve()
rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 9
cases = pathlib.Path(__file__).resolve().parent / "cases"

with tempfile.TemporaryDirectory() as folder:
    runs = {"springs": cases / "footing_springs.toml"}
    for place, name in (("plane", "footing_macro_element"), ("space", "footing_macro_element_space")):
        text = (cases / f"{name}.toml").read_text()
        for shape in (4, 6, 8):
            case = pathlib.Path(folder, f"{place}_{shape}.toml")
            case.write_text(text.replace('type = "macro_element"', f'type = "macro_element", shape_number = {shape}'))
            runs[f"{place}, shape number {shape}"] = case
    least = dict.fromkeys(runs, float("inf"))
    whole = dict(least)
    iterations = {}
    for turn in range(rounds):
        for name, case in runs.items():
            out = pathlib.Path(folder, f"out_{turn}")
            done = subprocess.run([program, "run", case, "--out", out / case.stem, "--quiet"], capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{name}: exit code {done.returncode}\n{done.stderr}")
            run = json.loads((out / case.stem / "summary.json").read_text())["runs"][0]
            least[name] = min(least[name], run["step_seconds"])
            whole[name] = min(whole[name], run["wall_seconds"] / run["steps"])
            iterations[name] = run["iterations"] / run["steps"]
for name, seconds in least.items():
    print(f"{name:24} {1e6 * seconds:8.3f} us a step, {seconds / least['springs']:6.2f} times springs, {1e6 * whole[name]:8.3f} us of the whole run, "
          f"{iterations[name]:.2f} iterations a step")
