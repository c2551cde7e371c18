"""The reactor building in Python: floor response spectra with any damping, compared with the bonded model.

    PYTHONPATH=python python3 examples/04_reactor_building/example.py [FIGURE.png]
"""

import pathlib
import sys

import uplift as up

run = up.load(pathlib.Path(__file__).parent).run(step_check=False)
print(run.verdict.headline)
floor = run.floor("floor 3, +25 m")
for damping in (0.02, 0.05, 0.07):
    frequencies, psa = floor.psa(damping=damping)
    print(f"damping {damping:.0%}: largest {psa.max():.2f} m/s2 at {frequencies[psa.argmax()]:.2f} Hz; floor acceleration {abs(floor.acceleration).max():.2f} m/s2")

if len(sys.argv) > 1:
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(9, 4))
    for damping in (0.02, 0.05, 0.07):
        axes.semilogx(*floor.psa(damping=damping), label=f"{damping:.0%}")
    axes.set(xlabel="frequency [Hz]", ylabel="pseudo-acceleration [m/s2]", title=floor.name)
    axes.legend()
    figure.savefig(sys.argv[1])
