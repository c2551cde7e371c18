"""The pier on five models of the ground, in Python: one table, and moment against tilt in one figure.

    PYTHONPATH=python python3 examples/06_foundation_models/example.py [FIGURE.png]
"""

import pathlib
import sys

import uplift as up

compared = up.load(pathlib.Path(__file__).parent).compare()
for row in compared.table:
    run = compared[row["name"]]
    moment = abs(run["underside.moment"]).max()
    print(f"{row['label']:20} top motion {1e3 * abs(run['deck.ux']).max():.1f} mm, base moment {moment / 1e6:.2f} MN m")

if len(sys.argv) > 1:
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 5))
    for name in ("springs", "sdm", "macro", "mesh", "cut", "bonded"):
        run = compared[name]
        dashes = "--" if name == "sdm" else "-"  # the SDM joint lies on the springs
        axes.plot(1e3 * run["underside.tilt"], run["underside.moment"] / 1e6, dashes, linewidth=0.8, label=name)
    axes.set(xlabel="tilt [mrad]", ylabel="moment [MN m]")
    axes.legend()
    figure.savefig(sys.argv[1])
