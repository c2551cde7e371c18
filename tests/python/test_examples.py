"""Every example in Python runs and prints the numbers of the program: python3 tests/python/test_examples.py PROGRAM LIBRARY."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM, LIBRARY = (os.path.abspath(word) for word in sys.argv[1:3])
del sys.argv[1:3]
ENVIRONMENT = {**os.environ, "UPLIFT_LIBRARY": LIBRARY, "PYTHONPATH": str(ROOT / "python"), "MPLBACKEND": "Agg"}


def printed(name):
    with tempfile.TemporaryDirectory() as folder:
        figure = folder + "/figure.png"
        words = [sys.executable, "-B", str(ROOT / "examples" / name / "example.py"), figure]
        done = subprocess.run(words, env=ENVIRONMENT, capture_output=True, text=True)
        if done.returncode != 0:
            raise AssertionError(done.stderr)
        if os.path.getsize(figure) < 5000:
            raise AssertionError("the figure is empty")
        return done.stdout


def of_the_program(name, what="verdict"):
    """A part of the summary that the program writes."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([PROGRAM, "run", str(ROOT / "examples" / name), "-q", "--no-step-check", "-o", folder + "/out"], check=True)
        return json.loads(pathlib.Path(folder, "out", "summary.json").read_text())[what]


class Examples(unittest.TestCase):
    def test_every_example_has_a_script(self):
        for folder in sorted((ROOT / "examples").glob("0*")):
            self.assertTrue((folder / "example.py").exists(), folder.name)

    def test_01_oscillator(self):
        text = printed("01_oscillator")
        self.assertGreater(len(text.splitlines()), 15)
        self.assertNotIn("interrupted", text)

    def test_02_building_on_soil(self):
        numbers = of_the_program("02_building_on_soil")["interfaces"][0]["numbers"]["max_moment"]
        shipped = printed("02_building_on_soil").splitlines()[1]
        self.assertIn(f"base moment {numbers['value'] / 1e6:.3f} MN m, bonded {numbers['bonded'] / 1e6:.3f} MN m", shipped)

    def test_03_asymmetric_building(self):
        moment = of_the_program("03_asymmetric_building", "runs")[0]["peaks"]["underside.moment"]
        self.assertIn(f"largest base moment {moment['value'] / 1e6:.2f} MN m at t = {moment['time']:.3f} s", printed("03_asymmetric_building"))

    def test_04_reactor_building(self):
        floors = of_the_program("04_reactor_building", "runs")[0]["floor_spectra"]
        zero_period = next(each for each in floors if each["name"] == "floor 3, +25 m")["zero_period_acceleration"]["value"]
        self.assertEqual(printed("04_reactor_building").count(f"floor acceleration {abs(zero_period):.2f} m/s2"), 3)

    def test_06_foundation_models(self):
        lines = printed("06_foundation_models").splitlines()
        self.assertEqual([lines[0], lines[7], len(lines)], ["pier:", "oscillator:", 14])
        motion = [float(line.split("top motion ")[1].split(" mm")[0]) for line in lines if "top motion" in line]
        uplifting = motion[:5]
        self.assertLess(max(uplifting) - min(uplifting), 0.05 * max(uplifting))
        self.assertAlmostEqual(motion[9], motion[10], delta=0.01 * motion[9])  # the same soil, meshed for the footing and cut

    def test_05_bridge_pier(self):
        numbers = of_the_program("05_bridge_pier")["interfaces"][0]["numbers"]["max_moment"]
        shipped = printed("05_bridge_pier").splitlines()[1]
        self.assertIn(f"base moment {numbers['value'] / 1e6:.2f} MN m, bonded {numbers['bonded'] / 1e6:.2f} MN m", shipped)

    def test_07_pier_fragility(self):
        drift = of_the_program("07_pier_fragility")["numbers"]["max_drift"]["value"]
        self.assertIn(f"1.0 times the motion: drift {1e3 * drift:.1f} mm", printed("07_pier_fragility"))

    def test_08_floor_spectra(self):
        floors = of_the_program("08_floor_spectra", "runs")[0]["floor_spectra"]
        zero_period = next(each for each in floors if each["name"] == "top, x")["zero_period_acceleration"]["value"]
        self.assertIn(f"floor acceleration {abs(zero_period):.2f} m/s2", printed("08_floor_spectra"))


unittest.main()
