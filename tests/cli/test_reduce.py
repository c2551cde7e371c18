"""Reduced models: made, used, stated on every result, refused for another structure."""

import math
import signal
import subprocess
import time

from support import *

USES = BASE.replace("bonded = false\n", 'bonded = false\nreduced_model = "case.rom"\n')

MOVES = shaken("m0.csv")

PLAN = """\
case = "../case.toml"
[intensity]
measure = "pga"
unit = "g_n"
[method]
type = "stripes"
levels = [0.4, 0.8]
[[motions]]
name = "m"
replace = ["quake"]
files = ["../m0.csv", "../m1.csv"]
unit = "m/s2"
[[limit]]
name = "uplift"
quantity = "max_opening"
limit = "1 mm"
"""


class Reduce(CliTest):
    def test_is_made_used_and_stated(self):
        self.write(BASE)
        out = self.uplift("reduce", "case.toml", "--size", "3", "--controls", "2", "-o", "case.rom").stdout
        self.assertIn("3 coordinates for", out)
        self.assertIn("In 2 control runs", out)
        out = self.uplift("reduce", "case.toml", "--target", "1e-9", "-o", "all.rom").stdout
        self.assertRegex(out, r"^[1-9]\d* coordinates for [1-9]\d* unknowns")
        self.assertNotIn("is not reached", out)
        self.write(USES)
        err = self.uplift("run", "case.toml", "-o", "r").stderr
        self.assertIn("reduced model case.rom: 3 coordinates in place of", err)
        reduced = self.summary("r")["reduced_model"]
        self.assertEqual(reduced["coordinates"], 3)
        self.assertEqual(reduced["control_errors"]["runs"], 2)
        self.assertAlmostEqual(reduced["control_errors"]["confidence"], 1 - 0.95**2, places=12)
        self.assertIn("control runs", json.dumps(report_of(self.folder / "r")))
        self.uplift("reduce", "case.toml", "--size", "2", "--quiet", "-o", "case.rom")
        self.assertTrue((self.folder / "case.rom.1").exists())
        err = self.uplift("run", "case.toml", "-o", "r").stderr
        self.assertIn("It has no control runs", err)
        self.assertNotIn("control_errors", self.summary("r")["reduced_model"])

    def test_gets_control_runs_later(self):
        self.write(BASE)
        self.uplift("reduce", "case.toml", "--size", "3", "--controls", "2", "-o", "at_once.rom")
        self.uplift("reduce", "case.toml", "--size", "3", "-o", "later.rom")
        out = self.uplift("reduce", "case.toml", "--model", "later.rom", "--controls", "2", "-o", "later.rom").stdout
        self.assertIn("In 2 control runs", out)
        self.assertEqual((self.folder / "later.rom").read_bytes(), (self.folder / "at_once.rom").read_bytes())
        self.assertTrue((self.folder / "later.rom.1").exists())
        for words, wanted in ((["--model", "later.rom"], "requires --controls"), (["--model", "later.rom", "--controls", "1", "--size", "3"], "--model excludes --size"),
                              (["--model", "no.rom", "--controls", "1"], "no file"), (["--model", "case.toml", "--controls", "1"], "`uplift reduce` has written")):
            self.assertIn(wanted, self.uplift("reduce", "case.toml", *words, expect=2).stderr)
        self.assertIn("at least one run", self.uplift("reduce", "case.toml", "--model", "later.rom", "--controls", "0", expect=2).stderr)
        self.write(BASE.replace("mass = 24317", "mass = 24318"))
        err = self.uplift("reduce", "case.toml", "--model", "later.rom", "--controls", "1", expect=2).stderr
        self.assertIn("uplift reduce: --model: expected the reduced model of this structure", err)
        self.assertIn("have changed since `uplift reduce`", err)

    def test_a_place_that_is_no_file_is_told_before_the_work(self):
        self.write(BASE)
        (self.folder / "folder.rom").mkdir()
        done = self.uplift("reduce", "case.toml", "--size", "3", "-o", "folder.rom", expect=4)
        self.assertIn("folder.rom: this is not a file that can be replaced", done.stderr)
        self.assertNotIn("basis", done.stderr)
        self.assertTrue((self.folder / "folder.rom").is_dir())

    def test_an_interruption_of_control_runs_leaves_the_model(self):
        self.write(BASE)
        path = self.folder / "case.rom"
        with subprocess.Popen([program(), "reduce", "case.toml", "--size", "3", "--controls", "10000", "-o", "case.rom"], cwd=self.folder,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
            while not path.exists() and running.poll() is None:
                time.sleep(0.02)  # it is written before the control runs begin
            running.send_signal(signal.SIGINT)
            _, err = running.communicate(timeout=120)
        self.assertEqual(running.returncode, 130)
        self.assertRegex(err, r"interrupted: case\.rom states \d+ control runs; uplift reduce case\.toml --model case\.rom --controls 10000 makes all of them")
        self.assertFalse((self.folder / "case.rom.1").exists())
        self.write(USES)
        self.assertIn("reduced model case.rom: 3 coordinates", self.uplift("run", "case.toml", "-o", "r").stderr)

    def test_is_refused_with_a_sentence(self):
        self.write(USES)
        err = self.uplift("run", "case.toml", expect=2).stderr
        self.assertIn("case.rom", err)
        (self.folder / "case.rom").write_text("no model")
        err = self.uplift("run", "case.toml", expect=2).stderr
        self.assertIn("a file that `uplift reduce` has written", err)
        self.write(BASE)
        self.uplift("reduce", "case.toml", "--size", "3", "-o", "case.rom")
        changed = USES.replace("mass = 24317", "mass = 24318")
        self.write(changed)
        err = self.uplift("run", "case.toml", expect=2).stderr
        self.assertIn("have changed since `uplift reduce`", err)
        self.write(USES)
        err = self.uplift("trust", "case.toml", expect=2).stderr
        self.assertIn("the whole model", err)
        err = self.uplift("reduce", "case.toml", "--scale", "2,1", expect=2).stderr
        self.assertIn("the smaller factor", err)

    def make_study(self, case, name, plan=""):
        """A study of two motions of the case, each at two factors."""
        self.write(case)
        folder = self.folder / (name + ".study")
        folder.mkdir()
        (folder / "plan.toml").write_text(PLAN + plan)
        return name + ".study"

    def test_serves_a_study(self):
        for k, frequency in enumerate((3, 5)):
            rows = [f"{0.01 * i} {4 * math.sin(2 * math.pi * frequency * 0.01 * i) * math.exp(-0.02 * i)}" for i in range(100)]
            (self.folder / f"m{k}.csv").write_text("time[s] a[m/s2]\n" + "\n".join(rows) + "\n")
        whole = self.make_study(MOVES, "whole")
        self.assertEqual(json.loads(self.uplift("study", "check", whole, "--json").stdout)["seconds_before_a_sample"], 0)
        self.uplift("study", "run", whole)
        self.uplift("reduce", "case.toml", "--size", "400", "--controls", "1", "-o", "case.rom")
        reduced = self.make_study("reduced_model = \"case.rom\"\n" + MOVES, "reduced")
        self.assertIn("In 1 control runs", self.uplift("study", "check", reduced).stderr)
        found = json.loads(self.uplift("study", "check", reduced, "--json").stdout)
        before = found["seconds_before_a_sample"]  # the four runs of the one sample share it
        self.assertGreater(before, 0)
        self.assertAlmostEqual(found["seconds_on_one_core"], 4 * found["seconds_of_a_run"] + before, delta=1e-6 + 1e-3 * before)
        self.assertIn("reduced model case.rom", self.uplift("study", "run", reduced).stdout)
        of_whole, of_reduced = (json.loads((self.folder / name / "study.json").read_text()) for name in (whole, reduced))
        self.assertEqual(of_whole["provenance"]["reduced_model"], "")
        self.assertIn("In 1 control runs", of_reduced["provenance"]["reduced_model"])
        runs, others = ([run for curve in each["curves"] for run in curve["runs"]] for each in (of_whole, of_reduced))
        self.assertEqual(len(runs), 4)
        for run, other in zip(runs, others):  # the basis holds every motion: only round-off may differ
            self.assertNotEqual(run["id"], other["id"])
            opening = run["demands"][0]
            self.assertGreater(opening, 1e-5)
            self.assertAlmostEqual(other["demands"][0] / opening, 1, delta=1e-8)
        self.write(MOVES)  # the plan may name the reduced model, too
        planned = self.make_study(MOVES, "planned")
        plan = self.folder / planned / "plan.toml"
        plan.write_text('reduced_model = "../case.rom"\n' + plan.read_text())
        self.assertIn("In 1 control runs", self.uplift("study", "run", planned).stdout)
        of_planned = json.loads((self.folder / planned / "study.json").read_text())
        self.assertIn("In 1 control runs", of_planned["provenance"]["reduced_model"])
        self.assertIn("In 1 control runs", json.dumps(report_of(self.folder / planned)))
        self.assertEqual([run["demands"] for curve in of_planned["curves"] for run in curve["runs"]], [run["demands"] for run in others])
        self.write("reduced_model = \"case.rom\"\n" + MOVES)
        self.uplift("study", "export", reduced, "--run", others[0]["id"])
        case = next((self.folder / reduced / "runs").glob("*/case.resolved.toml"))
        self.uplift("run", str(case), "-o", "alone")
        self.assertEqual(self.summary("alone")["runs"][0]["max_opening"]["value"], others[0]["demands"][0])

    def test_is_refused_where_a_sample_changes_the_structure(self):
        (self.folder / "m0.csv").write_text("time[s] a[m/s2]\n" + "".join(f"{0.01 * i} {math.sin(i)}\n" for i in range(99)))
        (self.folder / "m1.csv").write_text("time[s] a[m/s2]\n" + "".join(f"{0.01 * i} {math.cos(i)}\n" for i in range(99)))
        self.write(MOVES)
        self.uplift("reduce", "case.toml", "--size", "3", "-o", "case.rom")
        variable = 'samples = 2\n[[variable]]\nname = "v"\npaths = ["PATH"]\ndistribution = { type = "lognormal", median = 1, beta = 0.2 }\n'
        case = "reduced_model = \"case.rom\"\n" + MOVES
        of_law = self.make_study(case, "of_law")
        plan = self.folder / of_law / "plan.toml"
        plan.write_text(variable.replace("PATH", "interface[0].law.K_n").replace("samples = 2\n", "samples = 2\n" + PLAN, 1))
        self.uplift("study", "run", of_law)
        stiff = self.make_study(case, "stiff")
        plan = self.folder / stiff / "plan.toml"
        plan.write_text(variable.replace("PATH", "mass[0].mass").replace("samples = 2\n", "samples = 2\n" + PLAN, 1))
        for command in (["check"], ["run"], ["work", "--shard", "1/2"]):
            err = self.uplift("study", command[0], stiff, *command[1:], expect=2).stderr
            self.assertIn("have changed since `uplift reduce`", err)
        self.assertFalse(list((self.folder / stiff).glob("parts/*")))


if __name__ == "__main__":
    main()
