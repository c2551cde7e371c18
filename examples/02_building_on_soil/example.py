"""The building on soil in Python: the base moment with uplift and bonded, for three stiffnesses of the joint.

    PYTHONPATH=python python3 examples/02_building_on_soil/example.py [FIGURE.png]
"""

import pathlib
import sys

import uplift as up

case = up.load(pathlib.Path(__file__).parent)
stiffness = float(up.parse(case.resolved()).document["interface"][0]["law"]["K_n"])
runs = {}
for factor in (0.5, 1, 2):
    changed = case.copy()
    changed.document["interface"][0]["law"]["K_n"] = factor * stiffness
    runs[factor] = run = changed.run(step_check=False)
    moment = run.verdict.bases["underside"]["max_moment"]
    print(f"K_n = {factor * stiffness:.3g} Pa/m: base moment {moment / 1e6:.3f} MN m, bonded {moment.bonded / 1e6:.3f} MN m; {run.verdict.headline}")

if len(sys.argv) > 1:
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(9, 4))
    runs[1].plot("underside.moment", axes=axes)
    figure.savefig(sys.argv[1])
