"""The asymmetric building in Python: which way the base moment turns.

    PYTHONPATH=python python3 examples/03_asymmetric_building/example.py [FIGURE.png]
"""

import pathlib
import sys

import numpy as np
import uplift as up

run = up.load(pathlib.Path(__file__).parent).run(step_check=False)
print(run.verdict.headline)
moments = np.stack([run["underside.moment_1"], run["underside.moment_2"]])
largest = np.hypot(*moments).argmax()
print(f"largest base moment {np.hypot(*moments[:, largest]) / 1e6:.2f} MN m at t = {run.time[largest]:.3f} s, "
      f"about an axis {np.degrees(np.arctan2(*moments[::-1, largest])):.0f} degrees from x")

if len(sys.argv) > 1:
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(5, 5))
    axes.plot(moments[0] / 1e6, moments[1] / 1e6, linewidth=0.8)
    axes.set(xlabel="moment about x [MN m]", ylabel="moment about y [MN m]", aspect="equal")
    figure.savefig(sys.argv[1])
