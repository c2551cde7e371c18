"""What a run leaves behind: complete files, never mixed with those of an earlier run, and the exit codes."""

import csv
import hashlib
import signal
import time

from support import *


class Results(CliTest):
    def test_floor_spectra_of_a_run_shorter_than_a_period(self):
        # in 0.5 s an oscillator of 1.9 Hz does not swing once, one of 2.1 Hz does
        for lowest, warned in ((1.9, True), (2.1, False)):
            self.write(BASE + f'[[output.floor_spectrum]]\nname = "top"\nnode = "top"\ndirection = [1, 0]\nfrequencies = [{lowest}, 5]\n')
            self.assertEqual("has not completed a cycle" in self.uplift("check", "case.toml").stdout, warned)

    def test_run_writes_every_file(self):
        case = self.write(BASE, "tower/case.toml")
        done = self.uplift("run", "tower")  # a folder stands for its case.toml
        folder = self.folder / "out" / "tower"
        self.assertIn("out/tower/report.html", done.stdout)
        self.assertEqual({p.name for p in folder.iterdir()} - {"report.html"}, {"histories.csv", "load_steps.csv", "summary.json", "case.resolved.toml"})
        summary = self.summary("out/tower")
        self.assertEqual(summary["case"]["sha256"], hashlib.sha256(case.read_bytes()).hexdigest())
        (run,) = summary["runs"]
        self.assertEqual(run["status"], "completed")
        self.assertEqual(run["steps"], 500)
        for key in ("name", "retries", "wall_seconds", "step_seconds", "factorisations", "back_solves"):
            self.assertIn(key, run)
        for key in ("max_uplifted_ratio", "max_opening", "max_base_moment", "max_base_shear", "max_pressure", "energy_created", "energy_lost"):
            self.assertEqual(set(run[key]), {"value", "time", "unit"}, key)
        self.assertLess(run["energy_created"]["value"], 1e-9 * run["energy_scale"])

    def test_histories_have_units_and_agree_with_the_peaks(self):
        self.write(BASE)
        self.uplift("run", "case.toml", "-o", "r")
        with open(self.folder / "r" / "histories.csv", newline="") as file:
            rows = list(csv.reader(file))
        head, values = rows[0], [[float(cell) for cell in row] for row in rows[1:]]
        self.assertEqual(head[0], "time [s]")
        self.assertTrue(all(re.fullmatch(r"[^\[\]]+ \[[^\[\]]+\]", cell) for cell in head))
        self.assertIn("top.ux [m]", head)
        self.assertEqual(len(values), 501)
        self.assertAlmostEqual(values[-1][0], 0.5, places=12)
        for name, peak in self.summary("r")["runs"][0]["peaks"].items():
            step_mean = name.startswith("soil.") and peak["unit"] in ("N", "N m", "Pa")  # of a traction law: forces belong to the step, motions to its end
            column = head.index(f"{name} [{peak['unit']}{'; mean of the step' if step_mean else ''}]")
            largest = max(abs(row[column]) for row in values)
            self.assertLessEqual(abs(abs(peak["value"]) - largest), 1e-9 * largest + 1e-300, name)

    def test_section_forces_are_said_to_be_means_of_the_step(self):
        """The shear of a column without mass is the mass on it times its mean acceleration over the step."""
        self.write(BASE + """
[[output.history]]
beam = "column"
position = 0
quantity = "shear"
[[output.history]]
node = "top"
quantity = "abs_ax"
""")
        self.uplift("run", "case.toml", "-o", "r")
        with open(self.folder / "r" / "histories.csv", newline="") as file:
            head, *rows = list(csv.reader(file))
        shear, acceleration = head.index("column.0.shear [N; mean of the step]"), head.index("top.abs_ax [m/s2; mean of the step]")
        rows = [row for row in rows if float(row[0]) > 0.101]  # after the pulse
        inertia = [24317 * float(row[acceleration]) for row in rows]
        largest = max(map(abs, inertia))
        self.assertGreater(largest, 1e3)
        for force, row in zip(inertia, rows):
            self.assertLess(abs(abs(float(row[shear])) - abs(force)), 1e-6 * largest)

    def test_a_number_is_rounded_once(self):
        """A residual still varies: its criterion has the decimals of its own row."""
        self.write(BASE + """
[[verdict.criterion]]
quantity = "residual_settlement"
limit = "10 mm"
source = "none"
""")
        lines = self.uplift("run", "case.toml", "-o", "r").stdout.splitlines()
        heads = [line for line in lines if re.fullmatch(r"  quantity +value +twice the step", line)]
        self.assertEqual(len(heads), 1)
        (row,) = [re.match(r"  Residual settlement +(-?[\d.]+ mm) .*remaining variation ±[\d.]+ mm$", line) for line in lines if "Residual settlement" in line]
        (criterion,) = [line for line in lines if line.startswith("criterion met: residual settlement of soil")]
        self.assertEqual(criterion, f"criterion met: residual settlement of soil {row[1]}, at most 10.0 mm (none)")

    def test_verdict_with_criteria(self):
        self.write(BASE + """
[verdict]
uplifted_ratio_thresholds = [0.05]
[[verdict.criterion]]
quantity = "max_opening"
limit = "1 m"
source = "no code says so"
[[verdict.criterion]]
quantity = "max_uplifted_ratio"
limit = 0.001
source = "specification, 4.2"
""")
        done = self.uplift("run", "case.toml", "-o", "r")
        self.assertRegex(done.stdout, r"criterion met: largest gap of soil [\d.]+ mm, at most 1\.00 m \(no code says so\)")
        self.assertIn("criterion not met: uplifted area of soil", done.stdout)
        summary = self.summary("r")
        verdict, (run,) = summary["verdict"], summary["runs"]
        self.assertEqual(verdict["top"], {"node": "top", "centre_of_mass": False, "place": [0, 5]})
        self.assertRegex(done.stdout, r"Top motion +[\d.]+ mm .*node top, at ")
        (soil,) = verdict["interfaces"]
        self.assertAlmostEqual(soil["static_force"]["value"], 1e6, delta=1)
        numbers = soil["numbers"]
        for name, of_run in (("max_uplifted_ratio", "max_uplifted_ratio"), ("max_opening", "max_opening")):
            self.assertAlmostEqual(numbers[name]["value"], run[of_run]["value"], delta=1e-12 * run[of_run]["value"])
            self.assertEqual(numbers[name]["time"], run[of_run]["time"])
        pressure = numbers["max_toe_pressure"]  # the mean over the window, beside the largest mean over one step
        self.assertAlmostEqual(pressure["peak_of_step_mean"], run["max_step_pressure"]["value"], delta=1e-12 * run["max_step_pressure"]["value"])
        self.assertAlmostEqual(pressure["value"], run["max_pressure"]["value"], delta=1e-12 * run["max_pressure"]["value"])
        self.assertLess(pressure["value"], pressure["peak_of_step_mean"])
        self.assertGreater(pressure["value"], 0.97 * pressure["peak_of_step_mean"])
        # a base that cannot pull keeps its thrust inside
        self.assertLess(numbers["max_eccentricity"]["value"], 0.5)
        self.assertGreater(numbers["min_overturning_safety"]["value"], 1)
        self.assertGreater(soil["above"][0]["duration"], 0)
        self.assertLessEqual(soil["above"][0]["duration"], numbers["uplifted_time"]["value"])
        self.assertEqual([c["result"] for c in verdict["criteria"]], ["met", "not met"])
        self.assertEqual(verdict["criteria"][1]["source"], "specification, 4.2")

    def test_resolved_case_gives_the_same_results(self):
        self.write(BASE)
        self.uplift("run", "case.toml", "-o", "first")
        self.uplift("run", "first/case.resolved.toml", "-o", "second")
        self.assertEqual((self.folder / "first/histories.csv").read_text(), (self.folder / "second/histories.csv").read_text())
        self.assertEqual((self.folder / "first/case.resolved.toml").read_text(), (self.folder / "second/case.resolved.toml").read_text())

    def test_earlier_results_are_moved_aside(self):
        self.write(BASE)
        self.uplift("run", "case.toml", "-o", "r")
        (self.folder / "r" / "mine.txt").write_text("kept")
        done = self.uplift("run", "case.toml", "-o", "r")
        self.assertIn("earlier results moved to r.1", done.stdout)
        self.assertEqual((self.folder / "r.1" / "mine.txt").read_text(), "kept")
        self.assertFalse((self.folder / "r" / "mine.txt").exists())
        self.uplift("run", "case.toml", "-o", "r", "--quiet")
        self.assertTrue((self.folder / "r.2").is_dir())
        self.assertEqual([p.name for p in self.folder.iterdir() if ".part" in p.name], [])

    def test_report_shows_a_load_on_the_surface_beside_a_cut(self):
        # a raft of 2.6 x 0.8 m on a plane inside a row of cells, 20 kPa on the ground beside it; the surface is no group of the mesh
        self.write("""title = "raft"
[mesh.soil_box.soil]
width = 10
size = 0.5
layers = [{ thickness = 4 }]
[[solid]]
group = "soil_1"
E = 5e7
poisson = 0.3
density = 1900
[[solid]]
group = "raft"
E = 3e10
poisson = 0.2
density = 2500
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[gravity]
acceleration = [0, -10]
[[load]]
group = "meadow"
pressure = 2e4
[[interface]]
name = "base"
cut = { through = ["soil_1"], level = -1.2, upper = "raft", x = [-1.2, 1.4], height = 0.8, free = "meadow" }
law = { type = "springs", K_n = 1e9, K_t = 1e9, tangential = "coulomb", friction = 0.5 }
[[output.history]]
group = "soil_bottom"
quantity = "reaction_y"
[[stage]]
type = "static"
""")
        self.uplift("run", "case.toml", "-o", "r")
        with open(self.folder / "r" / "histories.csv", newline="") as file:
            rows = list(csv.reader(file))
        reaction = float(rows[-1][rows[0].index("soil_bottom.reaction_y [N]")])
        expected = 10 * (1900 * 10 * 2.8 + 2500 * 2.6 * 0.8) + 2e4 * (10 - 2.6)
        self.assertAlmostEqual(reaction, expected, delta=1e-8 * expected)
        model = report_of(self.folder / "r")["model"]
        (load,) = model["loads"]
        x, y = next((node["x"], node["y"]) for node in model["nodes"] if node["name"] == load["node"])
        self.assertLess(abs(y + 1.2), 0.5)
        self.assertFalse(-1.2 < x < 1.4)

    def test_report_is_one_page_with_data(self):
        self.write(BASE.replace("bonded = false\n", "") + "# </script> must not end the page's data\n")
        self.uplift("run", "case.toml", "-o", "r")
        page = self.folder / "r" / "report.html"
        if not page.exists():
            self.skipTest("the program was built without web/dist/report.html")
        report = report_of(page.parent)
        self.assertEqual(report["format"], "uplift-report-2")
        charts = {chart["id"]: chart for chart in report["charts"]}
        for name in ("loads", "top_displacement", "top_velocity", "base_moment", "moment_rotation", "energy_error", "energy_ledger", "law"):
            self.assertIn(name, charts)
        for chart in charts.values():
            for series in chart["series"]:
                self.assertEqual(len(series["x"]), len(series["y"]))
                self.assertGreater(len(series["x"]), 1)
                self.assertLess(len(series["x"]), 4000)
        # Force and displacement of an elastic structure have one sign: the loop of the bonded run is a rising line with the slope of its stiffness.
        bonded = next(series for series in charts["force_displacement"]["series"] if series["label"] == "bonded")
        stiffness = sum(u * f for u, f in zip(bonded["x"], bonded["y"])) / sum(u * u for u in bonded["x"])
        self.assertGreater(stiffness, 0)
        # The animation holds the frame of the largest uplift, and its shares are those of the run.
        shares = report["animations"][0]["uplifted"]["soil"]
        self.assertAlmostEqual(max(shares), self.summary("r")["runs"][0]["max_uplifted_ratio"]["value"], places=5)
        self.assert_page_has(self.summary("r"), report)
        self.assertEqual(len(report["model"]["interfaces"][0]["points"]), 11)

    def test_floor_spectra_stand_beside_the_bonded_run(self):
        roof = '[[output.floor_spectrum]]\nname = "roof, x"\nnode = "top"\ndirection = [1, 0]\n'
        foot = '[[output.floor_spectrum]]\nname = "foot"\nat = [0, 0]\ndirection = [0, 1]\ndamping = [0.05]\nrange = { from = 1, to = 40, count = 9 }\n'
        self.write(BASE.replace("bonded = false\n", "") + roof + foot)
        checked = json.loads(self.uplift("check", "case.toml", "--json").stdout)
        self.assertEqual(checked["floor_spectra"], {"floors": 2, "bytes": 2 * 501 * 8})
        self.uplift("run", "case.toml", "-o", "r")
        with open(self.folder / "r" / "floor_spectra.csv", newline="") as file:
            head, *rows = csv.reader(file)
        self.assertEqual(len(rows), 2 * (2 * 75 + 9))
        self.assertEqual(head[5], "pseudo-acceleration [m/s2]")
        blocks = {}
        for group, run, floor, damping, frequency, raw, broad, bonded, ratio in rows:
            blocks[run, floor, float(damping), float(frequency)] = [float(cell) if cell else None for cell in (raw, broad, bonded, ratio)]
        # a bonded value below a thousandth of the largest floor acceleration counts as that: the foot hardly moves up and down while bonded
        least = 1e-3 * max(abs(floor["zero_period_acceleration"]["value"]) for run in self.summary("r")["runs"] for floor in run["floor_spectra"])
        for (run, *at), (raw, broad, bonded, ratio) in blocks.items():
            self.assertGreaterEqual(broad, raw * (1 - 1e-9))
            if run == "bonded":
                self.assertEqual((bonded, ratio), (None, None))
                continue
            self.assertEqual(bonded, blocks["bonded", *at][0])
            if max(raw, bonded) > least:
                self.assertAlmostEqual(ratio, raw / max(bonded, least), delta=2e-9 * ratio)
            else:
                self.assertIsNone(ratio)
        run, bonded = self.summary("r")["runs"]
        spectra = run["floor_spectra"][0]["spectra"]
        self.assertEqual([each["damping"] for each in spectra], [0.02, 0.05])
        for each, beside in zip(spectra, bonded["floor_spectra"][0]["spectra"]):
            largest = max((values[0], at[2]) for (name, *at), values in blocks.items() if name == "run" and at[:2] == ["roof, x", each["damping"]])
            self.assertAlmostEqual(each["peak"]["value"], largest[0], delta=1e-9 * largest[0])
            self.assertEqual(each["peak"]["frequency"], largest[1])
            self.assertEqual([band["band"] for band in each["beside_bonded"]],
                             ["below 2 Hz", "2 to 5 Hz", "5 to 10 Hz", "10 to 20 Hz", "above 20 Hz"])
            most = max(band["change"] for band in each["beside_bonded"])
            self.assertGreater(abs(most), 1e-3)  # it uplifts
            self.assertNotIn("beside_bonded", beside)
        self.uplift("run", "r/case.resolved.toml", "-o", "again")
        self.assertEqual((self.folder / "r/floor_spectra.csv").read_text(), (self.folder / "again/floor_spectra.csv").read_text())
        page = self.folder / "r" / "report.html"
        if not page.exists():
            return
        report = report_of(page.parent)
        charts = {chart["id"]: chart for chart in report["charts"]}
        for name, curves in {"floor_roof, x_2": 3, "floor_roof, x_5": 3, "floor_foot_5": 3, "floor_ratio_roof, x": 2, "floor_ratio_foot": 1}.items():
            self.assertEqual(len(charts[name]["series"]), curves, name)
            self.assertTrue(charts[name]["x"]["log"])
        self.assert_page_has(self.summary("r"), report)

    def test_json_on_standard_output_is_the_summary(self):
        self.write(BASE)
        done = self.uplift("run", "case.toml", "-o", "r", "--json")
        self.assertEqual(json.loads(done.stdout), self.summary("r"))
        self.assertEqual(done.stderr, "")

    def test_quiet_says_nothing(self):
        self.write(BASE)
        done = self.uplift("run", "case.toml", "--quiet")
        self.assertEqual((done.stdout, done.stderr), ("", ""))

    def test_no_control_characters_in_a_pipe(self):
        self.write(BASE)
        done = self.uplift("run", "case.toml")
        self.assertNotRegex(done.stdout + done.stderr, r"[\x1b\r]")


class Failures(CliTest):
    def created(self):
        """A stiff joint with the traction at the end of the step and no velocity correction creates energy (k F = 13 makes 5e4)."""
        return (BASE.replace("K_n = 2e8", "K_n = 2e11").replace("step = 1e-3", 'step = 1e-3\ntraction = "end"').replace("duration = 0.5", "duration = 2")
                .replace('title = "test"\n', 'title = "test"\nimpact = "none"\n'))

    def test_created_energy_fails_the_run_and_keeps_its_results(self):
        self.write(self.created())
        done = self.uplift("run", "case.toml", "-o", "r", expect=3)
        self.assertIn("energy", done.stderr)
        (run,) = self.summary("r")["runs"]
        self.assertEqual(run["status"], "failed")
        self.assertGreater(run["energy_created"]["value"], 0.01 * run["energy_scale"])
        self.assertTrue((self.folder / "r" / "histories.csv").exists())
        self.assertNotRegex((self.folder / "r" / "histories.csv").read_text(), r"nan|inf")

    def test_a_failure_that_is_expected_does_not_fail_the_comparison(self):
        text = self.created() + '[[variant]]\nname = "path"\ntraction = "path"\n[[variant]]\nname = "end"\n'
        self.write(text)
        self.uplift("compare", "case.toml", "-o", "a", expect=3)
        self.write(text + 'expected = "may_fail"\n')
        self.uplift("compare", "case.toml", "-o", "b")
        runs = {run["name"]: run for run in self.summary("b")["runs"]}
        self.assertEqual((runs["path"]["status"], runs["end"]["status"]), ("completed", "failed"))
        self.assertEqual((runs["path"]["agreement"]["result"], runs["end"]["agreement"]["result"]), ("agrees", "failed"))

    def test_a_step_that_fails_leaves_its_problem(self):
        text = BASE.replace('title = "test"\n', 'title = "test"\nmethod = { type = "newton", most_iterations = 1 }\n').replace("step = 1e-3", "step = 1e-3\nhalvings = 0")
        self.write(text.replace('type = "springs"\nK_n = 2e8', 'type = "sdm"\nK_n = 2e8\nF_u = 1e4\nG_f = 10\nF_c = -1e3'))
        done = self.uplift("run", "case.toml", "-o", "r", expect=3)
        self.assertIn("did not converge in 1 iterations", done.stderr)
        self.assertIn("r/problem_run.json", done.stderr)
        done = self.uplift("replay", "r/problem_run.json", "--all", "--json")
        answers = json.loads(done.stdout)
        self.assertIn("did not converge in 1 iterations", answers["reason"])
        self.assertTrue(all(answer["converged"] for answer in answers["methods"]))

    def test_a_static_stage_without_equilibrium_leaves_its_problem(self):
        text = BASE.replace('[[stage]]', '[[load]]\nname = "push"\nnode = "top"\nforce = [9e6, 0]\n[[stage]]', 1)
        self.write(text)
        done = self.uplift("run", "case.toml", "-o", "r", expect=3)
        self.assertIn("static stage", done.stderr)
        done = self.uplift("replay", "r/problem_run.json", "--json", expect=3)
        self.assertIn("overturns", json.loads(done.stdout)["reason"])

    def test_a_static_stage_that_fails_keeps_its_load_steps(self):
        self.write(BASE.replace('[[stage]]', '[[load]]\nname = "push"\nnode = "top"\nforce = [9e6, 0]\n[[stage]]', 1))
        self.uplift("run", "case.toml", "-o", "r", expect=3)
        (head, *rows) = (self.folder / "r" / "load_steps.csv").read_text().splitlines()
        self.assertTrue(head.startswith("load_factor [1],"))
        self.assertEqual(len(rows), self.summary("r")["runs"][0]["load_steps"] + 1)

    def test_static_stages_alone_show_how_it_stands(self):
        self.write(BASE.split('[[stage]]\ntype = "dynamic"')[0])
        done = self.uplift("run", "case.toml", "-o", "r")
        self.assertIn("Under its constant loads the base is in full contact", done.stdout)
        self.assertIn("completed: static stages in", done.stdout)
        # 1 MN on 3 m2 of 2e8 Pa/m
        (head, *rows) = (self.folder / "r" / "histories.csv").read_text().splitlines()
        self.assertEqual(len(rows), self.summary("r")["runs"][0]["load_steps"] + 1)
        for row in rows:
            values = dict(zip(head.split(","), map(float, row.split(","))))
            self.assertAlmostEqual(values["base.uy [m]"] * 2e8 * 3 / -1e6, values["load_factor [1]"], places=9)
        self.assertEqual(values["load_factor [1]"], 1)
        self.assertFalse((self.folder / "r" / "load_steps.csv").exists())
        numbers = self.summary("r")["verdict"]["interfaces"][0]["numbers"]
        self.assertAlmostEqual(numbers["max_toe_pressure"]["value"] / (1e6 / 3), 1, places=9)
        self.assertAlmostEqual(numbers["residual_settlement"]["value"] * 2e8 * 3 / 1e6, 1, places=9)
        page = self.folder / "r" / "report.html"
        if page.exists():
            report = report_of(page.parent)
            self.assertLessEqual({"rest_gap", "rest_pressure", "base_displacement"}, {chart["id"] for chart in report["charts"]})

    def test_leaving_the_ground_is_an_outcome_not_a_failure(self):
        pulled = BASE.replace("force = [3e5, 0]", "force = [0, 1e7]").replace("duration = 0.1", "duration = 3").replace("duration = 0.5", "duration = 3")
        self.write(pulled)
        done = self.uplift("run", "case.toml", "-o", "r")
        self.assertIn("Full loss of contact: at", done.stdout)
        (run,) = self.summary("r")["runs"]
        self.assertEqual(run["status"], "separated")
        self.assertLess(run["end_time"], 3)

    def test_overturning_is_an_outcome_not_a_failure(self):
        self.write(BASE.replace("force = [3e5, 0]", "force = [9e6, 0]").replace("duration = 0.5", "duration = 3"))
        done = self.uplift("run", "case.toml", "-o", "r")
        self.assertEqual(self.summary("r")["runs"][0]["status"], "overturned")
        self.assertIn("Overturning: the rotation exceeds", done.stdout)


class Beams(CliTest):
    def test_section_forces_in_the_verdict(self):
        """A massless column of 5 m under a mass without rotary inertia: the moment at its foot is 5 m times the shear, in the bonded run too."""
        self.write(BASE.replace("bonded = false", "bonded = true") + '[[output.beam_envelope]]\nbeam = "column"\n')
        self.uplift("run", "case.toml", "-o", "r")
        (beam,) = self.summary("r")["verdict"]["beams"]
        numbers = beam["numbers"]
        moment, shear = numbers["max_beam_moment"], numbers["max_beam_shear"]
        self.assertAlmostEqual(moment["value"] / (5 * shear["value"]), 1, places=9)
        self.assertAlmostEqual(moment["bonded"] / (5 * shear["bonded"]), 1, places=9)
        self.assertAlmostEqual(moment["change_percent"], 100 * (moment["value"] / moment["bonded"] - 1), places=9)
        self.assertAlmostEqual(numbers["change_of_beam_moment"]["value"], moment["value"] / moment["bonded"] - 1, places=12)
        self.assertEqual(numbers["max_beam_tension"]["value"], 0)
        self.assertGreaterEqual(numbers["max_beam_compression"]["value"], 1e6)
        (envelope,) = self.summary("r")["runs"][0]["beam_envelopes"]
        self.assertEqual((envelope["along"]["value"][0], envelope["along"]["value"][-1]), (0, 5))
        self.assertEqual(envelope["elevation"]["value"], envelope["along"]["value"])  # it stands on the origin


class Trust(CliTest):
    def test_bands_of_a_run(self):
        self.write(BASE.replace("bonded = false", "bonded = true"))
        done = self.uplift("trust", "case.toml", "-o", "r")
        self.assertIn("What moves most numbers most is the joint stiffness.", done.stdout)
        self.assertIn("not changed: mesh: the case has no mesh", done.stdout)
        trust = json.loads((self.folder / "r" / "trust.json").read_text())
        self.assertTrue(trust["complete"])
        self.assertEqual([run["choice"] for run in trust["runs"]], ["time step", "joint stiffness", "joint stiffness", "points of the footing", "tolerance", "method"])
        for band in trust["bands"]:
            self.assertLessEqual(band["least"], band["value"])
            self.assertGreaterEqual(band["most"], band["value"])
        # the run itself is that of `uplift run`
        self.uplift("run", "case.toml", "-o", "a")
        one, other = self.summary("r")["runs"][0], self.summary("a")["runs"][0]
        self.assertEqual(one["peaks"], other["peaks"])
        value = {band["quantity"]: band["value"] for band in trust["bands"]}
        self.assertAlmostEqual(value["max_opening"], one["max_opening"]["value"], 12)
        self.assertEqual(report_of(self.folder / "r")["trust"], trust)
        self.assert_valid(trust, "trust")


class Terminal(CliTest):
    def test_progress_line(self):
        """On a terminal: time left and the present state, redrawn on one line, gone at the end."""
        import fcntl
        import pty
        import struct
        import termios

        self.write(BASE.replace("duration = 0.5", "duration = 600") + "[output]\nevery = 1000\n")
        ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 120, 0, 0))
        process = subprocess.Popen([program(), "run", "case.toml", "-o", "r"], cwd=self.folder, stdout=subprocess.PIPE, stderr=theirs, env={**os.environ, "TERM": "xterm"})
        os.close(theirs)
        said = b""
        while True:
            try:
                part = os.read(ours, 4096)
            except OSError:
                break
            if not part:
                break
            said += part
        os.close(ours)
        process.communicate()
        self.assertEqual(process.returncode, 0)
        text = said.decode()
        for part in ("s left", "t = ", "dt = ", "open ", "energy error"):
            self.assertIn(part, text)
        after = text.rsplit("\r\x1b[K", 1)[-1]  # warnings only
        self.assertNotIn("dt = ", after)
        self.assertRegex(after, r"^(warning: [^\r\n]*\r\n)*$")


class Interrupt(CliTest):
    def test_ctrl_c_leaves_complete_files(self):
        self.write(BASE.replace("duration = 0.5", "duration = 20000") + "[output]\nevery = 1000\n")
        process = subprocess.Popen([program(), "run", "case.toml", "-o", "r"], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and not any(len(path.read_text().splitlines()) > 3 for path in self.folder.glob("r.part-*/histories.csv")):
            time.sleep(0.1)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130, out + err)
        self.assertIn("interrupted at t =", err)
        (run,) = self.summary("r")["runs"]
        self.assertEqual(run["status"], "interrupted")
        self.assertGreater(run["end_time"], 0)
        last = (self.folder / "r" / "histories.csv").read_text().splitlines()[-1]
        self.assertGreater(float(last.split(",")[0]), 0)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["case.toml", "r"])


if __name__ == "__main__":
    main()
