"""Variants that are other cases, which `uplift compare` shows beside the case."""

from support import *

CASE = """
title = "tower"
[nodes]
base = [0, 0]
top = [0, 10]
[[mass]]
node = "top"
mass = 100e3
[[beam]]
name = "column"
nodes = ["base", "top"]
E = 3e10
A = 1
I = 0.2
[[rigid]]
name = "footing"
node = "base"
mass = 30e3
inertia = 60e3
[[interface]]
name = "ground"
footing = { body = "base", width = 6, points = 21 }
law = { type = "springs", K_n = 1e8, K_t = 1e8 }
[gravity]
[damping]
rayleigh = [{ frequency = 1, ratio = 0.02 }, { frequency = 10, ratio = 0.02 }]
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.4 }
[[ground_acceleration]]
function = "pulse"
amplitude = 5
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = 4e-3
[[output.history]]
interface = "ground"
quantity = "tilt"
[[output.floor_spectrum]]
name = "top"
node = "top"
direction = [1, 0]
frequencies = [1, 2, 5]
"""
OTHER = """
[[variant]]
name = "other"
case = "other case.toml"
"""
SAME = """
[[variant]]
name = "same"
"""


class OtherCase(CliTest):
    def compare(self, text, other, expect=0):
        case = self.write(text)
        if other is not None:
            self.write(other, "other case.toml")
        return self.uplift("compare", case, "-q", "-o", "out", expect=expect)

    def summary(self, text, other):
        self.assertEqual(self.compare(text, other).stderr, "")
        return json.loads((self.folder / "out" / "summary.json").read_text())

    def stops(self, text, other, *words):
        done = self.compare(text, other, expect=2)
        for word in words:
            self.assertIn(word, done.stderr)
        self.assertFalse((self.folder / "out").exists())

    def test_the_same_case_gives_the_same_numbers(self):
        # its nodes have other numbers: the page must not take one unknown for another
        turned = CASE.replace("base = [0, 0]\ntop = [0, 10]", "far = [90, 0]\ntop = [0, 10]\nbase = [0, 0]")
        turned = turned.replace("[gravity]", '[[mass]]\nnode = "far"\nmass = 1\n[[support]]\nnode = "far"\nfixed = ["ux", "uy"]\n[gravity]')
        summary = self.summary(CASE + SAME + OTHER, turned)
        same, other = (next(run for run in summary["runs"] if run["name"] == name) for name in ("same", "other"))
        for name, peak in same["peaks"].items():
            if name == "energy.residual":
                continue
            self.assertAlmostEqual(peak["value"], other["peaks"][name]["value"], delta=1e-9 * abs(peak["value"]) + 1e-12, msg=name)
        self.assertEqual(other["agreement"]["result"], "agrees")
        self.assertEqual(len(other["floor_spectra"]), 1)
        charts = {chart["id"]: chart for chart in report_of(self.folder / "out")["charts"]}
        for name in ("top_displacement", "base_rotation", "force_displacement", "moment_tilt", "moment_rotation"):
            curves = {curve["label"]: curve for curve in charts[name]["series"]}
            self.assertEqual(set(curves), {"same", "other", "bonded"}, name)
            largest = max(abs(y) for y in curves["same"]["y"])
            self.assertGreater(largest, 0)
            for one, two in zip(curves["same"]["y"], curves["other"]["y"]):
                self.assertAlmostEqual(one, two, delta=1e-5 * largest, msg=name)

    def test_it_keeps_its_own_damping(self):
        undamped = re.sub(r"\[damping\]\n.*\n", "", CASE)
        summary = self.summary(CASE + SAME + OTHER, undamped)
        work = {run["name"]: run["peaks"]["energy.damping"]["value"] for run in summary["runs"]}
        self.assertGreater(work["same"], 0)
        self.assertEqual(work["other"], 0)

    def test_its_own_floors_and_variants_are_left_out(self):
        other = CASE.replace('name = "top"\nnode', 'name = "roof"\nnode') + SAME
        summary = self.summary(CASE + SAME + OTHER, other)
        floors = {run["name"]: run.get("floor_spectra", []) for run in summary["runs"]}
        self.assertEqual((len(floors["same"]), len(floors["other"])), (1, 0))
        self.assertEqual(set(floors), {"same", "other", "bonded"})

    def test_both_may_name_each_other(self):
        self.summary(CASE + OTHER, CASE + OTHER.replace("other case", "case"))

    def test_refusals(self):
        self.stops(CASE + OTHER, None, "case.toml:", "variant", "a case file", "other case.toml")
        self.stops(CASE + OTHER, CASE.replace("mass = 100e3", "mas = 100e3"), "other case.toml:8", "mass")
        self.stops(CASE + OTHER + 'step = "1 ms"\n', CASE, "case.toml:", "nothing beside another case")
        self.stops(CASE + OTHER + '[[compare.motion]]\nname = "m"\nreplace = []\nby = []\n', CASE, "motion")


if __name__ == "__main__":
    main()
