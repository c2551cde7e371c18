"""Studies: one case under many motions and intensities, which survive the end of every process that takes part."""

import csv
import hashlib
import math
import shutil
import sqlite3
import sys
import time

from study_cases import *

class Study(StudyTest):
    def test_a_study_from_end_to_end(self):
        name = self.study()
        said = self.uplift("study", "check", name)
        self.assertIn("motions          4", said.stdout)
        self.uplift("study", "run", name, "-q")
        self.assertIn("complete", self.uplift("study", "status", name).stdout)
        self.evaluated(name)
        study = json.loads((self.folder / name / "study.json").read_text())
        self.assert_valid(study, "study")
        (limit,) = study["limits"]
        self.assertTrue(study["complete"] and limit["fit"]["fitted"])
        # every capacity lies between a survival and an exceedance 2 % apart, and the fit has the moments of their logarithms
        logs = []
        for curve, capacity in zip(study["curves"], limit["capacities"]):
            exceeded = [run["intensity"] for run in curve["runs"] if run["demands"][0] > 1e-3]
            survived = [run["intensity"] for run in curve["runs"] if run["demands"][0] <= 1e-3 and run["intensity"] < min(exceeded)]
            self.assertLess(min(exceeded) / max(survived), 1.021)
            self.assertTrue(max(survived) <= capacity["capacity"]["intensity"] <= min(exceeded))
            logs.append(math.log(capacity["capacity"]["intensity"]))
            self.assertLessEqual(len(curve["runs"]), 12)
        mean = sum(logs) / 4
        self.assertAlmostEqual(limit["fit"]["theta"], math.exp(mean), delta=1e-9)
        self.assertAlmostEqual(limit["fit"]["beta"], math.sqrt(sum((each - mean) ** 2 for each in logs) / 3), delta=1e-9)
        base = sqlite3.connect(self.folder / name / "study.db")
        self.assertEqual(base.execute("SELECT count(*) FROM run").fetchone()[0], len(self.runs(name)))
        self.assertEqual(base.execute("SELECT count(DISTINCT id) FROM run").fetchone()[0], len(self.runs(name)))

    def test_a_run_is_that_of_uplift_run_bit_for_bit(self):
        name = self.study(STRIPES)
        self.uplift("study", "run", name, "-q")
        self.evaluated(name)
        run = self.runs(name)[-1]
        path = self.uplift("study", "export", name, "--run", run["id"][:12]).stdout.strip()
        self.uplift("run", path, "-o", "alone", "-q", "--no-step-check")
        numbers = self.summary("alone")["verdict"]["interfaces"][0]["numbers"]
        self.assertEqual(numbers["max_opening"]["value"], float(run["uplift [m]"]))
        self.assertEqual(run["factor [1]"] != "1", True)
        # so are all the other numbers, whose columns alone a study records
        (part,) = (self.folder / name / "parts").glob("*.jsonl")
        kept = next(line for line in map(json.loads, part.read_text().splitlines()) if line["id"] == run["id"])["numbers"]
        said = self.summary("alone")["verdict"]
        of_interface = {quantity: value for quantity, of, value in kept if of}
        self.assertEqual(of_interface, {quantity: number["value"] for quantity, number in numbers.items() if quantity in of_interface})
        self.assertEqual({quantity: value for quantity, of, value in kept if not of}, {quantity: number["value"] for quantity, number in said["numbers"].items()})
        self.assertGreater(len(kept), 15)

    def test_runs_of_a_large_model_march_in_lockstep(self):
        self.write(LARGE)
        plan = STRIPES.replace("[0.2, 0.5, 1.0]", "[0.3, 0.6]").replace('"../m3.csv", "../m4.csv"', "").replace('"1 mm"', '"0.1 mm"')
        name, one_by_one = self.study(plan), self.study(plan, "t.study")
        self.uplift("study", "run", name, "-q")
        for shard in range(1, 3):
            self.uplift("study", "work", one_by_one, "--shard", f"{shard}/2", "-q")
        self.assertEqual(self.evaluated(name), self.evaluated(one_by_one))  # the result of a run does not depend on those beside it
        run = max(self.runs(name), key=lambda each: float(each["uplift [m]"]))
        path = self.uplift("study", "export", name, "--run", run["id"][:12]).stdout.strip()
        self.uplift("run", path, "-o", "alone", "-q", "--no-step-check")
        summary = self.summary("alone")
        self.assertGreater(json.loads(self.uplift("check", path, "--json").stdout)["unknowns"], 5000)
        alone = summary["verdict"]["interfaces"][0]["numbers"]["max_opening"]["value"]
        self.assertGreater(alone, 1e-6)
        self.assertAlmostEqual(float(run["uplift [m]"]) / alone, 1, delta=1e-9)

    def most_memory(self, *words):
        """Of the program and its workers, whichever held most [bytes]."""
        measure = "import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True); print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)"
        done = subprocess.run([sys.executable, "-c", measure, program(), *words], cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, 0, done.stderr)
        return 1024 * int(done.stdout)

    def test_check_foretells_the_memory_of_a_worker(self):
        if self.cannot_be_limited():
            self.skipTest("the address sanitizer keeps what is freed")
        self.write(LARGE)
        plan = STRIPES.replace("[0.2, 0.5, 1.0]", "[0.3, 0.5]") + "[run]\nworkers = 1\n"
        for together, limits in ((1, 'timeout = "1 h"\n'), (8, "")):
            with self.subTest(together=together):
                name = self.study(plan + limits, f"s{together}.study")
                forecast = json.loads(self.uplift("study", "check", name, "--json").stdout)
                self.assertEqual((forecast["runs"], forecast["runs_in_lockstep"]), (8, together))
                ratio = self.most_memory("study", "run", name, "-q") / forecast["bytes_of_memory"]
                # a forecast that takes every run for the second one, which has matrices of its own for a while, is at 0.67
                self.assertGreater(ratio, 0.75)
                self.assertLess(ratio, 1.35)

    def test_a_comparison_of_a_large_model_marches_in_lockstep(self):
        louder = 'process = [{ do = { type = "scale", factor = 6 } }]\n'  # it lifts off
        own = LARGE.replace('file = "quake.csv"\n', f'file = "quake.csv"\n{louder}')
        self.write(own + f'[[record]]\nname = "m3"\nfile = "m3.csv"\n{louder}[[compare.motion]]\nname = "m3"\nreplace = ["quake"]\nby = ["m3"]\n')
        said = self.uplift("compare", "case.toml", "-o", "all")
        self.assertIn("m3", said.stdout)
        self.write(own.replace('file = "quake.csv"', 'file = "m3.csv"'), "alone.toml")
        self.uplift("run", "alone.toml", "-o", "alone", "-q", "--no-step-check")
        self.write(own, "own.toml")
        self.uplift("run", "own.toml", "-o", "own", "-q", "--no-step-check")
        for single, together in (("own", "run"), ("alone", "run-m3")):
            header, rows = self.history(f"{single}/histories.csv")
            names, beside = self.history(f"all/histories/{together}.csv")
            self.assertEqual((names, len(beside)), (header, len(rows)))
            for name in ("top.ux", "underside.max_opening", "underside.moment", "underside.max_pressure"):
                (column,) = (k for k, each in enumerate(header) if each.startswith(name + " "))
                peak = max(abs(row[column]) for row in rows)
                self.assertGreater(peak, 0)
                self.assertLess(max(abs(a[column] - b[column]) for a, b in zip(rows, beside)), 1e-9 * peak, name)
        self.assertTrue((self.folder / "all/histories/bonded-m3.csv").is_file())

    def history(self, file):
        with open(self.folder / file, newline="") as opened:
            header, *rows = csv.reader(opened)
        return header, [[float(each) for each in row] for row in rows]

    def test_shards_make_the_same_study(self):
        self.uplift("study", "run", self.study(name="whole.study"), "-q")
        name = self.study()
        tasks = self.uplift("study", "tasks", name, "--count", "3").stdout.splitlines()
        self.assertEqual(tasks, [f"uplift study work s.study --shard {k}/3" for k in (1, 2, 3)])
        for task in [*reversed(tasks), tasks[0]]:
            self.uplift(*task.split()[1:], "-q")
        self.assertEqual(self.evaluated(name), self.evaluated("whole.study"))
        self.assertIn("K/N", self.uplift("study", "work", name, "--shard", "4/3", expect=2).stderr)

    def test_damaged_parts(self):
        name = self.study(STRIPES)
        self.uplift("study", "run", name, "-q")
        expected = self.evaluated(name)
        (part,) = (self.folder / name / "parts").glob("*.jsonl")
        content = part.read_bytes()
        lines = content.splitlines(keepends=True)
        changed = bytearray(lines[2])
        changed[len(changed) // 2] ^= 1
        part.write_bytes(b"".join([lines[0], lines[0], bytes(changed), *lines[3:]])[:-40])  # repeated, damaged, torn
        said = self.uplift("study", "status", name)
        self.assertIn("damaged lines of the parts, whose runs count as not computed: 1", said.stderr)
        self.assertIn("9/12 runs", said.stdout)
        self.uplift("study", "run", name, "-q")
        self.assertEqual(self.evaluated(name), expected)
        (self.folder / name / "study.db").write_text("no data base")
        self.uplift("study", "index", name)
        self.assertEqual(sqlite3.connect(self.folder / name / "study.db").execute("SELECT count(*) FROM run").fetchone()[0], 12)

    def test_parts_that_went_through_other_systems(self):
        name = self.study(STRIPES)
        self.uplift("study", "run", name, "-q")
        expected = self.evaluated(name)
        (part,) = (self.folder / name / "parts").glob("*.jsonl")
        (self.folder / name / "parts" / "folder.jsonl").mkdir()
        part.write_bytes(part.read_bytes().replace(b"\n", b"\r\n"))
        said = self.uplift("study", "status", name)
        self.assertIn("12/12 runs", said.stdout)
        self.assertNotIn("damaged", said.stderr)
        self.assertEqual(self.evaluated(name), expected)
        for wrong in ("", ".", "..", "a/.."):
            self.assertIn("expected the name of a new study", self.uplift("study", "new", wrong, expect=2).stderr)
        self.assertEqual(sorted(path.name for path in self.folder.glob("*.study")), [name])

    def test_a_cloud_states_runs_without_demand(self):
        plan = IDA.replace('type = "ida"\nstart = 0.1\nlargest = 20', 'type = "cloud"\nfactors = [0.001, 9, 14]')
        name = self.study(plan)
        self.uplift("study", "run", name, "-q")
        study = json.loads(self.uplift("study", "fit", name, "--json").stdout)
        (limit,) = study["limits"]
        demands = [run["demands"][0] for curve in study["curves"] for run in curve["runs"]]
        self.assertEqual(demands.count(0), 4)  # the weight keeps the joint closed under a thousandth of the motions
        self.assertEqual(limit["regression"]["without_demand"], 4)
        points = [(math.log(run["intensity"]), math.log(run["demands"][0])) for curve in study["curves"] for run in curve["runs"] if run["demands"][0]]
        self.assertEqual(len(points), 8)
        closed = [math.log(run["intensity"]) for curve in study["curves"] for run in curve["runs"] if not run["demands"][0]]

        def log_likelihood(a, b, sigma):
            """Demands on the line, and four that are at most the limit."""
            exact = sum(-math.log(sigma) - ((y - a - b * x) / sigma) ** 2 / 2 for x, y in points)
            return exact + sum(math.log(math.erfc(-(math.log(1e-3) - a - b * x) / sigma / math.sqrt(2)) / 2) for x in closed)

        fit = [limit["regression"][key] for key in ("a", "b", "sigma")]
        for i in range(3):
            ahead, back = (log_likelihood(*(value + (step if j == i else 0) for j, value in enumerate(fit))) for step in (1e-5, -1e-5))
            self.assertAlmostEqual((ahead - back) / 2e-5, 0, delta=1e-5)
            self.assertGreater(log_likelihood(*fit), max(ahead, back))
        self.assertAlmostEqual(limit["fit"]["theta"], math.exp((math.log(1e-3) - fit[0]) / fit[1]), delta=1e-9)

    def test_a_limit_of_a_number_that_no_run_has(self):
        # without friction there is no safety against sliding: that no run falls below the limit says nothing
        plan = IDA.replace('type = "ida"\nstart = 0.1\nlargest = 20', 'type = "stripes"\nlevels = [0.1, 2]')
        name = self.study(plan.replace('"max_opening"\nlimit = "1 mm"', '"min_sliding_safety"\nlimit = 1.1'))
        self.assertIn("the first run has no min_sliding_safety", self.uplift("study", "check", name).stderr)
        self.uplift("study", "run", name, "-q")
        (limit,) = json.loads(self.uplift("study", "fit", name, "--json").stdout)["limits"]
        self.assertIn("no run has the number min_sliding_safety", json.dumps(limit["fit"]))

    def test_what_the_site_asks_for(self):
        name = self.study()
        self.uplift("study", "run", name, "-q")
        before = json.loads(self.uplift("study", "fit", name, "--json").stdout)
        self.assertFalse({"design", "hazard"} & set(before))
        # another title, a comment, a design motion and a hazard curve: nothing is run again
        self.write("# as built\n" + CASE.replace('title = "test"', 'title = "Another title"\ndescription = "as built"'))
        hazard = [(0.5, 2e-3), (1.0, 5e-4), (3.0, 4e-5)]
        self.study(IDA + '[design]\nintensity = 0.9\nsource = "site report"\n[hazard]\nintensities = [0.5, 1, 3]\nrates = [2e-3, 5e-4, 4e-5]\n')
        self.assertIn("complete", self.uplift("study", "status", name).stdout)
        said = self.uplift("study", "fit", name).stdout
        study = json.loads((self.folder / name / "study.json").read_text())
        self.assert_valid(study, "study")
        self.assertEqual(study["title"], "Another title")
        self.assertEqual(study["curves"], before["curves"])
        (limit,) = study["limits"]
        theta, beta = limit["fit"]["theta"], limit["fit"]["beta"]

        def probability(intensity):
            return 0.5 * math.erfc(-math.log(intensity / theta) / beta / math.sqrt(2))

        pair = limit["performance"]
        for key, intensity in (("at_design", 0.9), ("at_one_and_a_half", 1.35)):
            self.assertAlmostEqual(pair[key] / probability(intensity), 1, delta=1e-9)
            self.assertTrue(pair[f"{key}_interval"]["lower"] <= pair[key] <= pair[f"{key}_interval"]["upper"])
            self.assertEqual(pair["unknown_survived"][key], pair[key])  # every run has an outcome
        self.assertEqual(pair["met"], probability(0.9) <= 0.01 and probability(1.35) <= 0.1)

        def rate(intensity):  # straight in both logarithms
            (a, p), (b, q) = hazard[:2] if intensity < 1 else hazard[1:]
            return p * math.exp(math.log(q / p) * math.log(intensity / a) / math.log(b / a))

        # midpoint rule of the integral of P |dH| over ln a, from 12 beta below the median to 12 above
        count = 20000
        grid = [theta * math.exp(beta * (24 * i / count - 12)) for i in range(count + 1)]
        risk = sum(probability(math.sqrt(a * b)) * (rate(a) - rate(b)) for a, b in zip(grid, grid[1:]))
        self.assertAlmostEqual(limit["risk"]["rate"] / risk, 1, delta=1e-5)
        self.assertEqual(limit["risk"]["unknown_exceeded"], limit["risk"]["rate"])
        self.assertAlmostEqual(float(re.search(r"annual rate ([\d.e-]+)", said)[1]) / risk, 1, delta=5e-3)
        self.assertIn("aims of ASCE/SEI 43", said)
        with open(self.folder / name / "fits.csv", newline="") as file:
            (row,) = csv.DictReader(file)
        self.assertEqual([float(row["probability at design [1]"]), float(row["annual rate [1/a]"])], [pair["at_design"], limit["risk"]["rate"]])
        # a hazard curve that ends far below the capacities, and one whose slope goes on to an endless rate
        for points, part in (("intensities = [0.001, 0.002]\nrates = [1e-3, 1e-4]", ", 100 % of it from beyond the points of the hazard curve"),
                             ("intensities = [1.5, 1.5000001]\nrates = [1e-3, 1e-4]", "; no annual rate (")):
            self.study(IDA + "[hazard]\n" + points + "\n")
            self.assertIn(part, self.uplift("study", "fit", name).stdout)
        # factors of safety and a bootstrap: nothing is run again
        factors = (
            '[[factor]]\nname = "anchors"\nmedian = 1.2\nbeta_r = 0.1\nbeta_u = 0.2\nsource = "tests"\n'
            '[[factor]]\nname = "shape"\nbeta_u = 0.15\n[design]\nintensity = 0.9\n')
        self.study(IDA.replace("[intensity]", "bootstrap = 4000\n[intensity]") + factors)
        said = self.uplift("study", "fit", name).stdout
        study = json.loads((self.folder / name / "study.json").read_text())
        self.assert_valid(study, "study")
        self.assertEqual([factor["name"] for factor in study["factors"]], ["anchors", "shape"])
        self.assertEqual(study["curves"], before["curves"])
        (with_factors,) = study["limits"]
        capacity, beta_r, beta_u = with_factors["capacity"], math.hypot(beta, 0.1), math.hypot(0.2, 0.15)
        for key, expected in (("median", 1.2 * theta), ("beta_r", beta_r), ("beta_u", beta_u), ("beta_c", math.hypot(beta_r, beta_u)),
                              ("hclpf", 1.2 * theta * math.exp(-1.65 * (beta_r + beta_u))),
                              ("hclpf_composite", 1.2 * theta * math.exp(-2.326 * math.hypot(beta_r, beta_u)))):
            self.assertAlmostEqual(capacity[key] / expected, 1, delta=1e-9)
        at_design = 0.5 * math.erfc(-math.log(0.9 / capacity["median"]) / capacity["beta_c"] / math.sqrt(2))
        self.assertAlmostEqual(with_factors["performance"]["composite"]["at_design"] / at_design, 1, delta=1e-9)
        self.assertIn("with the factors of safety", said)
        self.assertIn(f"HCLPF {capacity['hclpf']:.3g} g_n", said)
        # ln theta of four capacities of a normal sample scatters by beta/2, and beta^2 by chi^2 with 3 degrees of freedom
        bootstrap = with_factors["bootstrap"]
        self.assertEqual((bootstrap["draws"], bootstrap["refused"]), (4000, 0))
        self.assertAlmostEqual(bootstrap["se_log_theta"] / (beta / 2), 1, delta=0.04)
        for end, quantile in (("lower", 0.351846), ("upper", 7.814728)):
            self.assertAlmostEqual(bootstrap["beta_interval"][end] / (beta * math.sqrt(quantile / 3)), 1, delta=0.05)
        self.assertAlmostEqual(math.log(bootstrap["theta_interval"]["upper"] / theta) / (1.644854 * beta / 2), 1, delta=0.06)
        with open(self.folder / name / "fits.csv", newline="") as file:
            (row,) = csv.DictReader(file)
        self.assertEqual([float(row["HCLPF [g_n]"]), float(row["theta bootstrap upper [g_n]"])],
                         [capacity["hclpf"], bootstrap["theta_interval"]["upper"]])
        # fractiles of four curves at the limit: straight between the runs on both sides of it
        crossing = []
        for curve in study["curves"]:
            runs = [(0.0, 0.0)] + [(run["intensity"], run["demands"][0]) for run in curve["runs"]]
            crossing.append(next(a + (b - a) * (1e-3 - d) / (e - d) for (a, d), (b, e) in zip(runs, runs[1:]) if e >= 1e-3))
        first, second, third, fourth = sorted(crossing)
        for key, expected in (("p16", first + 0.48 * (second - first)), ("p50", (second + third) / 2), ("p84", third + 0.52 * (fourth - third))):
            self.assertAlmostEqual(limit["fractiles"][key][-1], expected, delta=1e-12)

    def test_a_changed_plan_runs_what_is_new(self):
        name = self.study(STRIPES)
        self.uplift("study", "run", name, "-q")
        self.study(STRIPES.replace("1.0]", "1.0, 2.0]").replace("1 mm", "3 mm"))
        self.assertIn("12/16 runs", self.uplift("study", "status", name).stdout)
        self.uplift("study", "run", name, "-q")
        lines = sum(len(part.read_text().splitlines()) for part in (self.folder / name / "parts").glob("*.jsonl"))
        self.assertEqual(lines, 16)

    def test_what_cannot_be_written(self):
        name = self.study(STRIPES)
        held = subprocess.Popen(["flock", "--no-fork", name, "sleep", "5"], cwd=self.folder)
        time.sleep(0.3)
        self.assertIn("no other process computes", self.uplift("study", "run", name, expect=2).stderr)
        held.kill()
        held.wait()
        (self.folder / name / "parts").mkdir()
        limited = f"ulimit -f 1; exec '{program()}' study run {name} -q"
        done = subprocess.run(["bash", "-c", limited], cwd=self.folder, capture_output=True, text=True)
        self.assertNotEqual(done.returncode, 0)
        self.assertNotIn("internal", done.stderr)
        self.uplift("study", "run", name, "-q")
        self.assertIn("12/12 runs", self.uplift("study", "status", name).stdout)

    def test_runs_without_an_outcome(self):
        name = self.study(STRIPES + "[run]\ntimeout = 1e-9\n")
        self.uplift("study", "run", name, "-q")
        self.evaluated(name)
        study = json.loads((self.folder / name / "study.json").read_text())
        self.assertEqual(study["outcomes"]["timeout"], 12)
        # what was beyond the limit before a run was ended has exceeded it; of the others nothing is known
        states = [(run["states"][0], run["demands"][0] > 1e-3) for curve in study["curves"] for run in curve["runs"]]
        self.assertEqual(set(states), {("exceeded", True), ("unknown", False)})
        self.assertEqual(study["limits"][0]["unknown"], states.count(("unknown", False)))
        self.assertTrue((self.folder / name / study["failures"][0]["case"]).is_file())
        self.study(STRIPES)
        self.uplift("study", "run", name, "-q", "--retry")
        self.assertEqual(json.loads(self.uplift("study", "fit", name, "--json").stdout)["outcomes"]["completed"], 12)

    def test_a_run_without_enough_memory(self):
        if self.cannot_be_limited():
            self.skipTest("the address space cannot be limited")
        name = self.study(STRIPES + "[run]\nmemory = 20\n")
        self.uplift("study", "run", name, "-q")
        study = json.loads(self.uplift("study", "fit", name, "--json").stdout)
        self.assertEqual(study["outcomes"]["memory"], 12)
        self.assertTrue(all((self.folder / name / failure["case"]).is_file() for failure in study["failures"]))

    def test_a_sample_that_is_no_case(self):
        variable = '[[variable]]\nname = "K"\npaths = ["interface[0].law.K_n"]\ndistribution = { type = "normal", mean = 0, deviation = 1 }\n'
        name = self.study(IDA.replace('case = "../case.toml"', 'case = "../case.toml"\nsamples = 6') + variable)
        for verb in ("check", "run"):
            self.assertRegex(self.uplift("study", verb, name, expect=2).stderr, r"interface\[0\]\.law\.K_n: expected .* > 0 Pa/m.*, found -")

    def test_samples(self):
        variable = '[[variable]]\nname = "K"\npaths = ["interface[0].law.K_n"]\ndistribution = { type = "lognormal", median = 1, beta = 0.4 }\n'
        name = self.study(IDA.replace("seed", "").replace('case = "../case.toml"', 'case = "../case.toml"\nsamples = 6') + variable)
        self.uplift("study", "run", name, "-q")
        study = json.loads(self.uplift("study", "fit", name, "--json").stdout)
        (values,) = [each["values"] for each in study["variables"]]
        # one value in every sixth of the probability
        strata = sorted(int(6 * 0.5 * math.erfc(-math.log(value) / 0.4 / math.sqrt(2))) for value in values)
        self.assertEqual(strata, [0, 1, 2, 3, 4, 5])
        self.assertEqual(len(study["curves"]), 24)
        self.assertTrue(study["limits"][0]["dispersion"]["known"])
        self.assertEqual(study["limits"][0]["tornado"][0]["variable"], "K")

    def test_the_report(self):
        name = self.study(STRIPES)
        said = self.uplift("study", "run", name)
        self.assertIn(f"results: {name}/report.html", said.stdout)
        told = report_of(self.folder / name)
        self.assertEqual(told["study"], json.loads((self.folder / name / "study.json").read_text()))
        self.assertEqual(told["resolved"], STRIPES)
        self.assertEqual(told["case"], {"file": f"{name}/plan.toml", "sha256": hashlib.sha256(STRIPES.encode()).hexdigest()})
        # more levels: no page of its own before the new runs are there, and `report` says what is missing
        self.study(STRIPES.replace("1.0]", "1.0, 1.5]"))
        self.assertIn("warning: 4 of 4 curves are not complete", self.uplift("study", "report", name).stderr)
        self.assertFalse(report_of(self.folder / name)["study"]["complete"])
        self.assertEqual(json.loads(self.uplift("study", "report", name, "--json").stdout)["outcomes"]["completed"], 12)

    def test_a_verb_that_is_none(self):
        for words in (("repotr",), ("repotr", "pier.study")):
            self.assertIn('found "repotr" (did you mean "report"?)', self.uplift("study", *words, expect=2).stderr)
        self.assertIn("study is required", self.uplift("study", "report", expect=2).stderr)

    def test_plans_are_checked(self):
        for old, new, message in [
            ('type = "ida"', 'type = "idas"', 'did you mean "ida"'),
            ("start = 0.1", "start = 30", "expected an intensity above start (30), found 20"),
            ('unit = "g_n"', 'unit = "m"', "expected a unit of an acceleration [m/s2]"),
            ('measure = "pga"', 'measure = "sa"', "expected period"),
            ("max_opening", "max_openin", 'did you mean "max_opening"'),
            ('limit = "1 mm"', 'limit = "1 kN"', "expected a length [m]"),
            ('replace = ["quake"]', 'replace = ["quak"]', 'did you mean "quake"'),
            ("m2.csv", "m1.csv", "expected a motion that differs from all others"),
            ("m2.csv", "m9.csv", "expected a file"),
            ('case = "../case.toml"', 'case = "../cas.toml"', "expected a case file"),
            ('case = "../case.toml"', 'case = "../case.toml"\nsamples = 3', "expected [[variable]] tables"),
            ("[[limit]]", "[design]\nintensity = 0\n[[limit]]", "design.intensity: expected"),
            ("[[limit]]", '[[factor]]\nname = "a"\nmedian = 0\n[[limit]]', "factor[0].median: expected"),
            ("[[limit]]", '[[factor]]\nname = "a"\nbeta_u = -0.1\n[[limit]]', "factor[0].beta_u: expected"),
            ("[[limit]]", '[[factor]]\nname = "a"\n[[limit]]', "found a factor that changes nothing"),
            ("[[limit]]", '[[factor]]\nname = "a"\nbeta_u = 0.1\n[[factor]]\nname = "a"\nbeta_u = 0.2\n[[limit]]', '"a"'),
            ('case = "../case.toml"', 'case = "../case.toml"\nbootstrap = 10', "expected 0 or at least 200 draws"),
            ("[[limit]]", "[hazard]\nintensities = [1]\nrates = [1e-3]\n[[limit]]", "expected two intensities at least"),
            ("[[limit]]", "[hazard]\nintensities = [1, 2]\nrates = [1e-3]\n[[limit]]", "expected a rate for each of the 2 intensities, found 1"),
            ("[[limit]]", "[hazard]\nintensities = [2, 1]\nrates = [2e-3, 1e-3]\n[[limit]]", "expected ascending numbers, found 1 after 2"),
            ("[[limit]]", "[hazard]\nintensities = [1, 2]\nrates = [1e-3, 1e-3]\n[[limit]]", "expected rates that fall as the intensity grows"),
            ("[[limit]]", "[hazard]\nintensities = [1, 2]\nrates = [1e-3, 0]\n[[limit]]", "hazard.rates"),
        ]:
            with self.subTest(new=new):
                name = self.study(IDA.replace(old, new))
                self.assertIn(message, self.uplift("study", "check", name, expect=2).stderr)


if __name__ == "__main__":
    main()
