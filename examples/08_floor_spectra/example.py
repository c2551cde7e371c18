"""Floor spectra at the top of the building for the motion of the case, whole and reduced.

    PYTHONPATH=python python3 examples/08_floor_spectra/example.py [FIGURE.png [BUILDING.rom]]

With a reduced model, which `uplift reduce` makes in some minutes (README.md), it prints the difference as well.
"""

import pathlib
import sys

import uplift as up

case = up.load(pathlib.Path(__file__).parent)
case.document["bonded"] = False
floors = {"whole model": case.run(step_check=False).floor("top, x")}
if len(sys.argv) > 2:
    case.document["reduced_model"] = str(pathlib.Path(sys.argv[2]).resolve())
    floors["reduced model"] = case.run(step_check=False).floor("top, x")

FREQUENCIES = [0.5 * 40 ** (k / 99) for k in range(100)]  # Hz, up to 20 Hz
for name, floor in floors.items():
    frequencies, psa = floor.psa(damping=0.05, frequencies=FREQUENCIES)
    print(
        f"{name}: floor acceleration {abs(floor.acceleration).max():.2f} m/s2, "
        f"largest {psa.max():.2f} m/s2 at {frequencies[psa.argmax()]:.2f} Hz"
    )

if len(sys.argv) > 1:
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(5, 4))
    for name, floor in floors.items():
        axes.semilogx(*floor.psa(damping=0.05, frequencies=FREQUENCIES), label=name)
    axes.set(xlabel="frequency [Hz]", ylabel="pseudo-acceleration [m/s2]")
    axes.legend()
    figure.savefig(sys.argv[1])
