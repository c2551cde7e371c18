"""Studies from Python: python3 tests/python/test_studies.py PROGRAM LIBRARY. Needs NumPy."""

import base64
import concurrent.futures
import html
import json
import math
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import unittest
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.path.abspath(sys.argv.pop(1))
os.environ["UPLIFT_PROGRAM"] = PROGRAM
os.environ["UPLIFT_LIBRARY"] = os.path.abspath(sys.argv.pop(1))
sys.path.insert(0, str(ROOT / "python"))

import numpy as np  # noqa: E402

import uplift as up  # noqa: E402

STRIPES = {"type": "stripes", "levels": [0.2, 0.5, 1, 2]}
IDA = {"type": "ida", "start": 0.1, "largest": 20}
PGA = {"measure": "pga", "unit": "g_n"}
UPLIFT = {"name": "uplift", "quantity": "max_opening", "limit": "1 mm"}
STIFFNESS = {"name": "K", "paths": ["interface[0].law.K_n"], "distribution": {"type": "lognormal", "median": 1, "beta": 0.4}}


def block(duration="1 s"):
    """A mass on a column whose footing may lift off, on ground that a pulse moves."""
    case = up.Case("block")
    case.node("top", 0, 5)
    case.node("base", 0, 0)
    case.beam("column", ["base", "top"], E="20 GPa", I="0.2 m4")
    case.mass("top", mass=24317)
    case.rigid("footing", "base", mass="10 t", inertia=7500)
    case.support("base", ["ux"])
    case.footing("soil", body="base", width="3 m", points=11, law=up.springs(K_n=2e8))
    case.load("top", name="dead", force=[0, -1e6])
    case.function("pulse", up.functions.ricker(frequency="2 Hz", delay="0.5 s"))
    case.ground_acceleration([1, 0], amplitude="1 m/s2", function="pulse")
    case.static()
    case.dynamic(duration, step="1 ms")
    return case


def burst(frequency, decay):
    rows = (f"{i * 0.005:.3f},{math.exp(-decay * i * 0.005) * math.sin(2 * math.pi * frequency * i * 0.005):.9f}\n" for i in range(161))
    return "t [s],a [m/s2]\n" + "".join(rows)


class Studies(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)
        self.files = []
        for i, (frequency, decay) in enumerate([(1.5, 2), (3, 3), (6, 3)], 1):
            self.files.append(self.folder / f"quake{i}.csv")
            self.files[-1].write_text(burst(frequency, decay))

    def test_reduced_model(self):
        case, file = block(), self.folder / "block.rom"
        said = case.reduce(file, size=400, controls=2, scale=(0.8, 1.2))
        self.assertIn("In 2 control runs", said)
        self.assertTrue(file.read_bytes().startswith(b"uplift reduced model"))
        whole = case.run(step_check=False)
        case.document["reduced_model"] = str(file)
        other = case.run(step_check=False)
        self.assertGreater(np.abs(whole["top.ux"]).max(), 1e-4)
        np.testing.assert_allclose(other["top.ux"], whole["top.ux"], rtol=0, atol=1e-9 * np.abs(whole["top.ux"]).max())
        study = block().study(self.folder / "kept.study", intensity=PGA, method=STRIPES, motions=self.files, limits=[UPLIFT], reduced_model=file)
        self.assertIn("control runs", study.fit().document.provenance.reduced_model)
        study = case.study(self.folder / "reduced.study", intensity=PGA, method=STRIPES, motions=self.files, limits=[UPLIFT])
        study.run()
        self.assertIn("control runs", json.loads((study.folder / "study.json").read_text())["provenance"]["reduced_model"])
        with self.assertRaisesRegex((up.InputError, up.UpliftError), "--target"):
            block().reduce(file, target=2)
        relative = block()
        relative.document["reduced_model"] = "block.rom"
        with self.assertRaisesRegex(ValueError, "relative"):
            relative.reduce(self.folder / "again.rom")

    def study(self, name="a.study", case=None, **changes):
        given = {"intensity": PGA, "method": STRIPES, "motions": self.files, "limits": [UPLIFT], **changes}
        return (case or block()).study(self.folder / name, **given)

    def test_the_command_line_gives_the_same_bytes(self):
        site = {"design": {"intensity": 0.5}, "hazard": {"intensities": [0.5, 2], "rates": [1e-4, 1e-4 * 4**-2.5]}}
        factors = [{"name": "strength", "median": 1.2, "beta_u": 0.15}]
        study = self.study(method=IDA, variables=[STIFFNESS], samples=2, factors=factors, bootstrap=200, **site)
        self.assertEqual(study.check().done, 0)
        status = study.run(progress=False)
        self.assertEqual((status.complete, status.curves, status.running, status.interrupted), (6, 6, False, False))
        fit = study.fit()
        own = self.folder / "b.study"
        own.mkdir()
        for file in ("plan.toml", "case.toml"):
            shutil.copy(study.folder / file, own)
        for verb in ("run", "fit"):
            subprocess.run([PROGRAM, "study", verb, str(own), "-q"], check=True)
        self.assertEqual((own / "fits.csv").read_bytes(), (study.folder / "fits.csv").read_bytes())
        # the fit has the moments of the logarithms of the capacities, and its curve is the normal distribution of the logarithm
        limit = fit["uplift"]
        logs = np.log([each.capacity.intensity for each in limit.capacities])
        self.assertAlmostEqual(limit.theta, math.exp(logs.mean()), delta=1e-9 * limit.theta)
        self.assertAlmostEqual(limit.beta, logs.std(ddof=1), delta=1e-9)
        self.assertLess(limit.theta_interval[0], limit.theta)
        self.assertGreater(limit.theta_interval[1], limit.theta)
        curve = limit.curve()
        expected = [0.5 * math.erfc(-math.log(im / limit.theta) / limit.beta / math.sqrt(2)) for im in curve["intensity"]]
        np.testing.assert_allclose(curve["probability"], expected, rtol=1e-9)
        self.assertEqual(limit.unknown_survived.theta, limit.theta)
        self.assertAlmostEqual(limit.capacity.median, 1.2 * limit.theta, delta=1e-9 * limit.theta)
        self.assertEqual(limit.bootstrap.draws, 200)
        at_design = 0.5 * math.erfc(-math.log(0.5 / limit.theta) / limit.beta / math.sqrt(2))
        self.assertAlmostEqual(limit.performance.at_design, at_design, delta=1e-9)
        rate = 1e-4 * (0.5 / limit.theta) ** 2.5 * math.exp((2.5 * limit.beta) ** 2 / 2)  # of the power law
        self.assertAlmostEqual(limit.risk.rate / rate, 1, delta=1e-9)
        self.assertEqual(len(limit.fractiles.p50), 40)
        for (intensities, demands), capacity in zip(fit.ida("uplift"), limit.capacities):
            self.assertLess(demands[intensities < capacity.capacity.intensity].max(), 1e-3)
            self.assertGreater(demands[intensities > capacity.capacity.intensity].min(), 1e-3)

    def test_runs_are_those_of_a_case(self):
        study = self.study()
        study.run(progress=False)
        row = study.runs()[-1]
        self.assertEqual(row["outcome"], "completed")
        # the record in the place of the pulse, by hand
        case = block()
        case.document["function"] = []
        case.record("quake", str(self.files[2]), process=[{"do": {"type": "scale", "factor": float(row["factor [1]"])}}])
        case.document["ground_acceleration"][0]["function"] = "quake"
        run = case.run(step_check=False)
        self.assertAlmostEqual(run.verdict.bases["soil"]["max_opening"] / float(row["uplift [m]"]), 1, delta=1e-9)

    def test_tasks_for_any_executor(self):
        self.study("whole.study").run(progress=False)
        study = self.study()
        tasks = study.tasks(2)
        self.assertEqual(len(tasks), 2)
        with concurrent.futures.ThreadPoolExecutor(2) as executor:
            list(executor.map(subprocess.check_call, tasks + tasks))
        self.assertEqual(len(study.tasks(1000)), 3)  # not more than curves
        study.fit(), up.load_study(self.folder / "whole.study").fit()
        self.assertEqual((study.folder / "fits.csv").read_bytes(), (self.folder / "whole.study" / "fits.csv").read_bytes())

    def test_interrupt_keeps_results(self):
        study = self.study(case=block("20 s"), method=IDA, variables=[STIFFNESS], samples=20)

        def press():
            if next((study.folder / "parts").glob("*.jsonl"), None) is None:
                threading.Timer(0.02, press).start()
            else:
                os.kill(os.getpid(), signal.SIGINT)

        threading.Timer(0.02, press).start()
        status = study.run(progress=False, workers=1)
        self.assertTrue(status.interrupted and not status.running)
        self.assertGreater(status.runs, 0)
        self.assertLess(status.complete, status.curves)
        self.assertFalse(study.fit().complete)

    def test_a_notebook_shows_the_report(self):
        study = self.study()
        self.assertIsNone(study._repr_html_())  # nothing is computed
        study.run(progress=False)
        page = study.report()
        packed = re.search(r'<script[^>]*id="uplift-data"[^>]*>([^<]*)</script>', page).group(1)
        self.assertEqual(json.loads(zlib.decompress(base64.b64decode(packed)))["study"]["format"], "uplift-study-1")
        self.assertEqual(html.unescape(re.search('srcdoc="([^"]*)"', study._repr_html_()).group(1)).count("\n"), page.count("\n"))

    def test_a_changed_plan_keeps_its_runs(self):
        self.study().run(progress=False)
        study = self.study(method={**STRIPES, "levels": [0.2, 0.5, 1, 2, 4]})
        self.assertEqual((study.status.runs, study.status.expected), (12, 15))

    def test_errors_name_file_and_line(self):
        with self.assertRaises(up.InputError) as caught:
            self.study(method={"type": "idas"})
        plan = self.folder / "a.study" / "plan.toml"
        self.assertEqual((caught.exception.file, caught.exception.path), (str(plan), "method.type"))
        self.assertIn("idas", plan.read_text().splitlines()[caught.exception.line - 1])
        for changes, part in [
            ({"limits": [{**UPLIFT, "quantity": "max_openin"}]}, 'did you mean "max_opening"'),
            ({"motions": [self.folder / "none.csv"]}, "none.csv"),
            ({"motions": []}, '"factor" for a motion that is a function'),
            ({"variables": [{**STIFFNESS, "paths": ["interface[0].law.K"]}], "samples": 2}, "paths of numbers of the case"),
        ]:
            with self.subTest(changes=changes):
                with self.assertRaises(up.InputError) as caught:
                    self.study(**changes)
                self.assertIn(part, str(caught.exception))
        wrong = block()
        wrong.document["beam"][0]["E"] = "20 GPam"
        with self.assertRaises(up.InputError) as caught:
            self.study(case=wrong)
        self.assertEqual((caught.exception.file, caught.exception.path), (str(self.folder / "a.study" / "case.toml"), "beam[0].E"))
        with self.assertRaises(up.InputError):
            up.load_study(self.folder / "nothing")

    def test_plans_of_others_stay(self):
        study = self.study()
        plan = study.folder / "plan.toml"
        text = plan.read_text().partition("\n")[2]
        plan.write_text(text)
        with self.assertRaises(ValueError):
            self.study()
        self.assertEqual(plan.read_text(), text)
        self.assertEqual(up.load_study(study.folder).status.curves, 3)

    def test_a_loaded_case_is_not_copied(self):
        block().save(self.folder / "case.toml")
        study = self.study(case=up.load(self.folder))
        self.assertFalse((study.folder / "case.toml").exists())
        self.assertEqual(study.status.curves, 3)
        with self.assertRaises(ValueError):  # two things move the ground
            case = block()
            case.function("other", up.functions.ricker(frequency="1 Hz", delay="0.5 s"))
            case.ground_acceleration([0, 1], amplitude="1 m/s2", function="other")
            self.study(case=case)


if __name__ == "__main__":
    unittest.main()
