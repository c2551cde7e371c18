"""Pier and oscillator on five models of the ground, in Python: one table each, and moment against tilt in one figure.

    PYTHONPATH=python python3 examples/06_foundation_models/example.py [FIGURE.svg]
"""

import pathlib
import sys

import uplift as up

folder = pathlib.Path(__file__).parent
compared = {"pier": up.load(folder).compare(), "oscillator": up.load(folder / "oscillator").compare()}
tops = {"pier": "deck", "oscillator": "top"}
for structure, runs in compared.items():
    print(f"{structure}:")
    seconds = {run["name"]: run["wall_seconds"] for run in runs.summary["runs"]}
    for row in runs.table:
        run = runs[row["name"]]
        moment = abs(run["underside.moment"]).max()
        print(f"  {row['label']:20} top motion {1e3 * abs(run[tops[structure] + '.ux']).max():.1f} mm, base moment {moment / 1e6:.2f} MN m, "
              f"{seconds[row['name']]:.2g} s")

if len(sys.argv) > 1:
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(1, 2, figsize=(10, 4.5))
    for axes, (structure, runs) in zip(panels, compared.items()):
        for name in ("springs", "sdm", "macro", "mesh", "cut", "bonded"):
            run = runs[name]
            dashes = "--" if name == "sdm" else "-"  # the SDM joint lies on the springs
            axes.plot(1e3 * run["underside.tilt"], run["underside.moment"] / 1e6, dashes, linewidth=0.8, label=name)
        axes.set(title=structure, xlabel="tilt [mrad]", ylabel="moment [MN m]")
    panels[0].legend()
    figure.tight_layout()
    figure.savefig(sys.argv[1], metadata={"Date": None})
