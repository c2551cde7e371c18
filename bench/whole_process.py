#!/usr/bin/env python3
"""Whole-process time of `uplift run` on the benchmark footing: 40 joint points under a 10 Hz oscillator, 10 000 steps of 1 ms with uplift, histories
written. Prints medians of several runs: of the process, of a step as the run itself measured it (step_seconds of summary.json: all that is done in a
step, columns and energies included), and of the whole run (wall_seconds: with the static stage and all preparations) divided by its steps.
Usage: bench/whole_process.py build/release/uplift [runs]"""
import json
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

program = pathlib.Path(sys.argv[1]).resolve()
runs = int(sys.argv[2]) if len(sys.argv) > 2 else 15
here = pathlib.Path(__file__).resolve().parent

print(f"{'case':34} {'process [ms]':>13} {'least':>8} {'step [us]':>10} {'run/steps [us]':>15} {'iterations/step':>16}")
for case in sorted((here / "cases").glob("*.toml")):
    times, steps, runs_by_steps = [], [], []
    for _ in range(runs + 1):
        folder = tempfile.mkdtemp()
        start = time.perf_counter()
        done = subprocess.run([program, "run", case, "--out", f"{folder}/out", "--quiet"], capture_output=True, text=True)
        times.append(time.perf_counter() - start)
        if done.returncode != 0:
            sys.exit(f"{case.name}: exit code {done.returncode}\n{done.stderr}")
        summary = json.loads(pathlib.Path(folder, "out", "summary.json").read_text())
        run = summary["runs"][0]
        steps.append(run["step_seconds"])
        runs_by_steps.append(run["wall_seconds"] / run["steps"])
        iterations = run["iterations"] / run["steps"]
        shutil.rmtree(folder)
    times, steps, runs_by_steps = times[1:], steps[1:], runs_by_steps[1:]  # the first fills the caches
    print(f"{case.stem:34} {1e3 * statistics.median(times):13.1f} {1e3 * min(times):8.1f} {1e6 * statistics.median(steps):10.3f} "
          f"{1e6 * statistics.median(runs_by_steps):15.3f} {iterations:16.2f}")
