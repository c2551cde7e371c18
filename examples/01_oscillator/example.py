"""The oscillator of the paper in Python: all methods in one table, and the share of the base that uplifts.

    PYTHONPATH=python python3 examples/01_oscillator/example.py [FIGURE.png]
"""

import pathlib
import sys

import uplift as up

case = up.load(pathlib.Path(__file__).parent)
compared = case.compare()
for row in compared.table:
    print(f"{row['group']:<12} {row['label']:<44} {row['status']:<10} {row['uplifted_ratio']:6.1%} {row['max_base_moment']:12.4g} N m")

if len(sys.argv) > 1:
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(9, 4))
    for run in compared.runs:
        if run.name.endswith("-damped") and not run.name.startswith("bonded"):
            axes.plot(run.time, 100 * run["soil.uplifted_ratio"], label=run.name.removesuffix("-damped"), linewidth=0.8)
    axes.set(xlabel="time [s]", ylabel="uplifted share of the base [%]")
    axes.legend(fontsize=7)
    figure.savefig(sys.argv[1])
