"""[[foundation]] as a user runs it: columns, numbers and figures of the strength of its ground."""
import math

from support import CliTest, main, report_of

CASE = """title = "pier"
[nodes]
base = [0, 0, 0]
top = [0, 0, 10]
[[mass]]
node = "top"
mass = 100e3
inertia = 1e5
[[beam]]
name = "column"
nodes = ["base", "top"]
E = 3e10
A = 1
I_y = 0.2
I_z = 0.2
J = 0.3
[[rigid]]
name = "footing"
node = "base"
mass = 30e3
inertias = [60e3, 60e3, 100e3]
[[foundation]]
name = "soil"
body = "base"
width = 6
length = 5
[foundation.model]
type = "macro_element"
K_v = 6e8
K_h = 3e8
K_r = 1.8e9
K_t = 1e9
V_s = 3e6
V_u = 5e6
w_ref = 0.02
friction_angle = "30 deg"
cohesion = 5e3
shape_number = 4
[gravity]
[damping]
alpha = 0.3
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.4 }
[[ground_acceleration]]
direction = [0.8, 0.6, 0]
function = "pulse"
amplitude = 4
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = 5e-3
"""
V_S = 3e6


class Foundation(CliTest):
    def run_case(self, text):
        self.write(text)
        self.uplift("run", "case.toml", "-o", "r", "--no-step-check")
        summary = self.summary("r")
        charts = {}
        if (self.folder / "r" / "report.html").exists():
            charts = {chart["id"]: chart for chart in report_of(self.folder / "r")["charts"]}
        head = (self.folder / "r" / "histories.csv").read_text().splitlines()[0].split(",")
        return summary, charts, head

    def test_strength_is_in_histories_and_summary(self):
        summary, _, head = self.run_case(CASE)
        self.assertIn("soil.bearing_utilisation [1]", head)
        self.assertIn("soil.bearing_capacity [N]", head)
        self.assertIn("soil.sliding_utilisation [1]", head)
        run, bonded = summary["runs"]
        numbers = summary["verdict"]["interfaces"][0]["numbers"]
        for name in ("bearing_utilisation", "sliding_utilisation"):
            self.assertEqual(numbers["max_" + name]["value"], run["peaks"]["soil." + name]["value"])
            self.assertNotIn("soil." + name, bonded["peaks"])
        self.assertGreater(run["peaks"]["soil.bearing_capacity"]["value"], V_S)

    def test_no_pressure_is_stated(self):
        summary, charts, head = self.run_case(CASE)
        self.assertEqual([name for name in head if "pressure" in name or "[Pa" in name], [])
        self.assertEqual([key for run in summary["runs"] for key in run if "pressure" in key], [])
        self.assertNotIn("max_pressure", charts)

    def test_elastic_ground_has_no_strength(self):
        model = '[foundation.model]\ntype = "elastic"\nK_v = 6e8\nK_h = 3e8\nK_r = 1.8e9\nK_t = 1e9\n'
        start, end = CASE.index("[foundation.model]"), CASE.index("[gravity]")
        summary, charts, head = self.run_case(CASE[:start] + model + CASE[end:])
        self.assertEqual([name for name in head if "utilisation" in name or "capacity" in name], [])
        self.assertFalse([name for name in summary["verdict"]["interfaces"][0]["numbers"] if "utilisation" in name])
        for chart in charts.values():
            if chart["id"].startswith(("moment_vertical", "shear_vertical")):
                self.assertEqual({series["label"] for series in chart["series"]} - {series.get("run") for series in chart["series"]}, set())

    def test_figures_show_the_limits(self):
        """The formulas of docs/theory/macro_element.md at H = 0 and at M = 0, for both axes."""
        summary, charts, _ = self.run_case(CASE)
        if not charts:
            self.skipTest("the program was built without web/dist/report.html")
        grown = summary["runs"][0]["peaks"]["soil.bearing_capacity"]["value"]
        friction, cohesion = math.tan(math.pi / 6), 5e3 * 6 * 5
        for suffix, length in (("", 6), ("_soil_y", 5)):
            moment, shear = charts["moment_vertical" + suffix]["series"], charts["shear_vertical" + suffix]["series"]
            self.assertIn("moment_rotation" + suffix, charts)
            for part, limit in (
                (self.series(moment, "bearing capacity at the beginning"), lambda n: n * length / 2 * (1 - n / V_S)),
                (self.series(moment, "bearing capacity at the end"), lambda n: n * length / 2 * (1 - n / grown)),
                (self.series(moment, "limit of uplift"), lambda n: n * length / 2),
                (self.series(moment, "first uplift, N D/4"), lambda n: n * length / 4),
                (self.series(shear, "sliding resistance"), lambda n: n * friction + cohesion),
            ):
                self.assertGreater(max(part["x"]), 0.5e6)
                for n, value in zip(part["x"], part["y"]):
                    self.assertAlmostEqual(abs(value), limit(n), delta=1e-5 * V_S)  # the page has rounded numbers
                self.assertLess(min(part["y"]), 0)
            for n, h in zip(*(self.series(shear, "bearing capacity at the beginning")[key] for key in "xy")):
                if n > 0:
                    self.assertAlmostEqual(V_S * (1 - abs(h) / n) ** 3, n, delta=1e-5 * V_S)

    def test_radiation_is_part_of_the_ground_force_and_not_of_the_strength(self):
        """The law keeps |M| below N D/2 at the end of every step; the dashpots know no such limit."""
        stiffness = "K_v = 6e8\nK_h = 3e8\nK_r = 1.8e9\nK_t = 1e9\n"
        soil = "[foundation.soil]\nG = 60e6\npoisson = 0.3\ndensity = 1900\nfrequency = 3\nradiation = true\n"
        text = CASE.replace(stiffness, "").replace("[gravity]", soil + "[gravity]").replace("step = 5e-3", 'step = 5e-3\ntraction = "end"')
        summary, charts, head = self.run_case(text)
        names = [name.split(" [")[0] for name in head]
        rows = [dict(zip(names, map(float, line.split(",")))) for line in (self.folder / "r" / "histories.csv").read_text().splitlines()[1:]]
        for k, length in ((2, 6), (1, 5)):
            for row in rows:
                self.assertLessEqual(abs(row[f"soil.law_moment_{k}"]), -row["soil.law_axial"] * length / 2 + 1)
        for run in summary["runs"]:  # the bonded one has the same dashpots
            self.assertNotAlmostEqual(run["peaks"]["soil.shear"]["value"], run["peaks"]["soil.law_shear"]["value"], delta=1e3)
        numbers = summary["verdict"]["interfaces"][0]["numbers"]
        self.assertAlmostEqual(numbers["max_moment"]["peak_of_step_mean"], max(row["soil.moment"] for row in rows), delta=1)
        if not charts:
            self.skipTest("the program was built without web/dist/report.html")
        for figure, column in (("moment_vertical", "soil.law_moment_2"), ("shear_vertical", "soil.law_shear_1")):
            loop = self.series(charts[figure]["series"], "as in the case")
            self.assertEqual(len(loop["x"]), len(rows))
            for n, force, row in zip(loop["x"], loop["y"], rows):
                self.assertAlmostEqual(n, -row["soil.law_axial"], delta=1e-5 * V_S)  # the page has rounded numbers
                self.assertAlmostEqual(force, row[column], delta=1e-5 * V_S)
            self.assertIn("without those of the radiation dashpots", charts[figure]["caption"])
        loop = self.series(charts["moment_rotation"]["series"], "as in the case")
        for moment, row in zip(loop["y"], rows):
            self.assertAlmostEqual(moment, row["soil.moment_2"], delta=1e-5 * V_S)

    def test_figures_of_a_turned_foundation(self):
        """Columns are in the axes of the model, the limits in those of the foundation: |M| <= N D/2 holds along its sides alone."""
        text = CASE.replace("length = 5\n", 'length = 5\nazimuth = "82 deg"\n').replace("step = 5e-3", 'step = 5e-3\ntraction = "end"')
        _, charts, head = self.run_case(text)
        names = [name.split(" [")[0] for name in head]
        lines = (self.folder / "r" / "histories.csv").read_text().splitlines()[1:]
        rows = [dict(zip(names, map(float, line.split(",")))) for line in lines]
        c, s = math.cos(math.radians(82)), math.sin(math.radians(82))

        def along_sides(quantity):
            pairs = [(row[f"soil.{quantity}_1"], row[f"soil.{quantity}_2"]) for row in rows]
            return [c * x + s * y for x, y in pairs], [c * y - s * x for x, y in pairs]

        vertical = [-row["soil.axial"] for row in rows]
        moment, rotation, shear = along_sides("moment"), along_sides("rotation"), along_sides("shear")
        for k, length in ((1, 6), (0, 5)):  # a moment about the length tilts the width
            used = [abs(m) / (n * length / 2) for m, n in zip(moment[k], vertical) if n > 1e3]
            self.assertLessEqual(max(used), 1 + 1e-6)
            self.assertGreater(max(used), 0.2)
        if not charts:
            self.skipTest("the program was built without web/dist/report.html")
        # the length is near x, the direction of the shaking
        for suffix, k, about, along in (("", 0, "the width", "the length"), ("_soil_x", 1, "the length", "the width")):
            for figure, x, y, title in (
                ("moment_rotation", rotation[k], moment[k], f"about {about}"),
                ("moment_vertical", vertical, moment[k], f"about {about}"),
                ("shear_vertical", vertical, shear[1 - k], f"along {along}"),
            ):
                chart = charts[figure + suffix]
                self.assertIn(title, chart["title"])
                loop = self.series(chart["series"], "as in the case")
                for shown, expected in ((loop["x"], x), (loop["y"], y)):
                    self.assertEqual(len(shown), len(expected))
                    most = max(map(abs, expected))
                    for one, other in zip(shown, expected):
                        self.assertAlmostEqual(one, other, delta=2e-5 * most)  # the page has rounded numbers

    def test_figures_of_the_other_surfaces(self):
        """M = D V b n^e (1 - n)^f and H = V a n^c (1 - n)^d; Annex F with its N_max divided by the model factor."""
        power = {"a": 0.5, "b": 0.45, "c": 0.3, "d": 0.6, "e": 0.8, "f": 0.9}
        clay = {"a": 1 / 2.57, "b": 1 / 1.85, "c": 0.70 / 2, "d": 1.29 / 2, "e": 2.14 / 2, "f": 1.81 / 2}
        keys = 'surface = "power_law"\n' + "".join(f"{key} = {value}\n" for key, value in power.items())
        standard = 'surface = "en_1998_5"\nsoil_type = "cohesive"\nmodel_factor = 1.15\n'
        for added, of, capacity in ((keys, power, V_S), (standard, clay, V_S / 1.15)):
            summary, charts, head = self.run_case(CASE.replace("V_u = 5e6\n", "V_u = 5e6\n" + added))
            self.assertIn("soil.bearing_utilisation [1]", head)
            self.assertLessEqual(summary["verdict"]["interfaces"][0]["numbers"]["max_bearing_utilisation"]["value"], 1 + 1e-9)
            if not charts:
                continue
            for suffix, length in (("", 6), ("_soil_y", 5)):
                moment, shear = charts["moment_vertical" + suffix]["series"], charts["shear_vertical" + suffix]["series"]
                (moment,) = [each for each in moment if each["label"].startswith("bearing capacity") and "end" not in each["label"]]
                (shear,) = [each for each in shear if each["label"].startswith("bearing capacity") and "end" not in each["label"]]
                self.assertAlmostEqual(max(moment["x"]), capacity, delta=1e-5 * V_S)
                for part, size, low, high in ((moment, of["b"] * length, of["e"], of["f"]), (shear, of["a"], of["c"], of["d"])):
                    for x, value in zip(part["x"], part["y"]):
                        n = min(x / capacity, 1)
                        if n >= 0.0501:  # below, the exponent of n is at most 0.9
                            self.assertAlmostEqual(abs(value), capacity * size * n**low * (1 - n) ** high, delta=3e-5 * V_S)

    def test_a_reduced_capacity_below_the_dead_load_is_said(self):
        """1.28 MN on N_max/gamma_Rd = 1 MN."""
        keys = 'V_s = 1.5e6\nsurface = "en_1998_5"\nsoil_type = "cohesive"\n'
        text = CASE.replace("V_s = 3e6\nV_u = 5e6\nw_ref = 0.02\n", keys)
        self.write(text)
        self.assertNotIn("no equilibrium", self.said_by_check())
        self.write(text.replace("V_s = 1.5e6", "V_s = 1.5e6\nmodel_factor = 1.5"))
        said = self.said_by_check()
        self.assertIn('capacity of "soil" 1.00 MN', said)
        self.assertIn("equilibrium up to 78.41 % of the load", said)  # 1 MN of 130 t

    def said_by_check(self):
        made = self.uplift("check", "case.toml")
        return made.stdout + made.stderr

    def test_describe_names_the_surfaces(self):
        said = self.uplift("describe", "foundation", "macro_element").stdout
        for word in ("effective_width", "power_law", "en_1998_5", "soil_type", "soil_inertia", "model_factor"):
            self.assertIn(word, said)

    def series(self, all_series, label):
        (found,) = [each for each in all_series if each["label"].startswith(label)]
        return found


if __name__ == "__main__":
    main()
