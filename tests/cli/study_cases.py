"""Cases and plans of the tests of studies."""

import csv
import math

from support import *

CASE = shaken("quake.csv")

IDA = """\
case = "../case.toml"
[intensity]
measure = "pga"
unit = "g_n"
[method]
type = "ida"
start = 0.1
largest = 20
[[motions]]
name = "m"
replace = ["quake"]
files = ["../m1.csv", "../m2.csv", "../m3.csv", "../m4.csv"]
unit = "m/s2"
[[limit]]
name = "uplift"
quantity = "max_opening"
limit = "1 mm"
"""

# A block on soil with more than 5000 unknowns, whose runs march in lockstep.
LARGE = """\
title = "A block on soil"
[mesh.soil_box.soil]
width = 50
size = 0.5
[[mesh.soil_box.soil.layers]]
thickness = 12
size = 0.5
[mesh.soil_box.block]
width = 4
height = 8
size = 0.5
[[solid]]
group = "soil_1"
shear_wave_speed = 300
poisson = 0.3
density = 1900
[[solid]]
group = "block"
E = 2e9
poisson = 0.2
density = 400
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[[interface]]
name = "underside"
[interface.surface]
group = "interface"
lower = ["soil_1"]
[interface.law]
type = "springs"
K_n = 2e10
K_t = 1e10
tangential = "coulomb"
friction = 0.7
[gravity]
acceleration = [0, -9.81]
[damping]
rayleigh = [{ frequency = 1, ratio = 0.03 }, { frequency = 8, ratio = 0.03 }]
""" + CASE[CASE.index("[[record]]"):].replace("duration = 1\nstep = 1e-3", "duration = 0.6\nstep = 5e-3")

STRIPES = IDA.replace('type = "ida"\nstart = 0.1\nlargest = 20', 'type = "stripes"\nlevels = [0.2, 0.5, 1.0]')


def motion(frequency, decay):
    """A burst whose largest acceleration is about 1 m/s2, as a table of times and accelerations."""
    rows = [(i * 0.005, math.exp(-decay * i * 0.005) * math.sin(2 * math.pi * frequency * i * 0.005)) for i in range(161)]
    return "t [s],a [m/s2]\n" + "".join(f"{t:.3f},{a:.9f}\n" for t, a in rows)


class StudyTest(CliTest):
    """A case and four records; studies of them."""

    def setUp(self):
        super().setUp()
        self.write(CASE)
        self.write(motion(2, 3), "quake.csv")
        for i, (frequency, decay) in enumerate([(1.5, 2), (3, 3), (6, 3), (10, 4)], 1):
            self.write(motion(frequency, decay), f"m{i}.csv")

    def study(self, plan=IDA, name="s.study"):
        self.write(plan, f"{name}/plan.toml")
        return name

    def evaluated(self, name):
        """What fit and export write, as bytes."""
        self.uplift("study", "fit", name, "-q")
        self.uplift("study", "export", name, "-q")
        return {file: (self.folder / name / file).read_bytes().replace(name.encode(), b"NAME") for file in ("fits.csv", "runs.csv", "curves.csv")} | {
            "study.json": (self.folder / name / "study.json").read_text().replace(f'"name": "{name.removesuffix(".study")}"', "")}

    def runs(self, name):
        with open(self.folder / name / "runs.csv", newline="") as file:
            return list(csv.DictReader(file))
