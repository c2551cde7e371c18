"""The capacity of the pier for its own motion, by hand: the intensity is raised until the drift reaches the limit of plan.toml.

    PYTHONPATH=python python3 examples/07_pier_fragility/example.py [FIGURE.png]

`uplift study run` does the same for 40 motions and four samples of the soil, in parallel, and fits the fragility curve.
"""

import pathlib
import sys

import uplift as up

LIMIT = 0.4  # m


def drift(amplitude):
    """Largest drift [m] of the pier under the motion of the case times a factor."""
    case = up.load(pathlib.Path(__file__).parent)
    case.document["ground_acceleration"][0]["amplitude"] = amplitude
    return float(case.run().verdict.structure["max_drift"])


found = {factor: drift(factor) for factor in (0.5, 1.0, 1.5, 2.0)}
for factor, value in found.items():
    print(f"{factor:.1f} times the motion: drift {1e3 * value:.1f} mm, {'beyond' if value > LIMIT else 'below'} the limit")

if len(sys.argv) > 1:
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(5, 4))
    axes.plot([1e3 * value for value in found.values()], list(found), "o-")
    axes.axvline(1e3 * LIMIT, linestyle="--")
    axes.set(xlabel="drift [mm]", ylabel="factor on the motion")
    figure.savefig(sys.argv[1])
