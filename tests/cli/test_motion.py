"""uplift motion: records, processing, generation to a target."""

import math

from support import *

RECORD = "time [s],north [cm/s2]\n" + "".join(f"{0.01 * i:.2f},{100 * math.sin(2 * math.pi * i / 50):.6f}\n" for i in range(501))
SHORT = ("step=0.02", "duration=8", "from=0.5", "to=15")


class Records(CliTest):
    def test_a_record_has_its_numbers_and_its_page(self):
        self.write(RECORD, "quake.csv")
        done = self.uplift("motion", "quake.csv")
        self.assertRegex(done.stdout, r"PGA \[m/s2\].*D5-95 \[s\].*Housner")
        folder = self.folder / "out/motion_quake"
        self.assertEqual(report_of(folder)["format"], "uplift-report-2")
        found = self.summary("out/motion_quake")
        # 1 m/s2 at 2 Hz for 10 whole periods: Arias = pi/(2 g) T/2, CAV = 2 T/pi
        numbers, motion = found["intensities"][0], found["motions"][0]
        self.assertAlmostEqual(numbers["pga"], 1, delta=0.003)
        self.assertAlmostEqual(numbers["arias"], math.pi / (2 * 9.80665) * 2.5, delta=0.003)
        self.assertAlmostEqual(numbers["cav"], 2 * 5 / math.pi, delta=0.01)
        self.assertEqual((motion["count"], motion["step"], motion["factor"], motion["unit"]), (501, 0.01, 0.01, "cm/s2"))
        self.assertRegex(motion["sha256"], "^[0-9a-f]{64}$")

    def test_processing_is_told_and_leaves_the_record_as_it_is(self):
        self.write(RECORD, "quake.csv")
        done = self.uplift("motion", "quake.csv", "--process", "scale pga=2", "--process", "taper", "--json")
        found = json.loads(done.stdout)
        self.assertAlmostEqual(found["intensities"][0]["pga"], 2, delta=0.01)
        self.assertEqual(len(found["motions"][0]["processing"]), 2)
        self.assertEqual((self.folder / "quake.csv").read_text(), RECORD)

    def test_earlier_results_stay(self):
        self.write(RECORD, "quake.csv")
        self.uplift("motion", "quake.csv")
        done = self.uplift("motion", "quake.csv", "--damping", "0.02,0.05")
        self.assertIn("earlier results moved to out/motion_quake.1/", done.stdout)
        self.assertTrue((self.folder / "out/motion_quake.1/report.html").exists())

    def test_spectra_at_the_frequencies_that_are_asked_for(self):
        self.write(RECORD, "quake.csv")
        self.write(RECORD.replace("north", "east"), "other.csv")
        self.uplift("motion", "quake.csv", "other.csv", "--damping", "0.05,0", "--frequencies", "50,0.1,2", "-o", "list")
        head, *rows = (self.folder / "list/spectra.csv").read_text().splitlines()
        columns = dict(zip(head.split(","), zip(*(map(float, row.split(",")) for row in rows))))
        self.assertEqual(columns["frequency [Hz]"], (0.1, 2, 50))
        # at resonance the undamped response to sin(w t) grows as w t/2: 10 pi after five seconds; PSA = w2 SD; twice the same motion
        self.assertAlmostEqual(columns["quake PSA 0 % [m/s2]"][1], 10 * math.pi, delta=0.02 * 10 * math.pi)
        self.assertAlmostEqual(columns["quake SD 0 % [m]"][1] * (4 * math.pi) ** 2, columns["quake PSA 0 % [m/s2]"][1], delta=1e-4)
        self.assertAlmostEqual(columns["quake SA 5 % [m/s2]"][2], 1, delta=0.02)
        for row in range(3):
            self.assertAlmostEqual(columns["RotD100 PSA 5 % [m/s2]"][row], math.sqrt(2) * columns["other PSA 5 % [m/s2]"][row], delta=1e-6)
        self.uplift("motion", "quake.csv", "--frequencies", "rg_1_122", "-o", "guide")
        self.assertEqual(len((self.folder / "guide/spectra.csv").read_text().splitlines()), 76)
        self.uplift("motion", "quake.csv", "--frequencies", "1:16:5", "-o", "range")
        first = [float(row.split(",")[0]) for row in (self.folder / "range/spectra.csv").read_text().splitlines()[1:]]
        for found, wanted in zip(first, (1, 2, 4, 8, 16), strict=True):
            self.assertAlmostEqual(found, wanted, delta=1e-6)

    def test_spectra_over_all_directions_of_the_horizontal_components(self):
        rows = (f"{0.01 * i:.2f},{math.sin(0.1 * i):.6f},{math.cos(0.13 * i):.6f},{math.sin(0.2 * i):.6f}\n" for i in range(200))
        table = "".join(rows)
        self.write("time [s],NS [g],EW [g],UD [g]\n" + table, "three.csv")
        self.write("time [s],NS [g],N45E [g],UD [g]\n" + table, "slanting.csv")
        self.uplift("motion", "three.csv", "--frequencies", "1,10", "-o", "three")
        head, *rows = (self.folder / "three/spectra.csv").read_text().splitlines()
        self.assertTrue(head.endswith(",RotD50 PSA 5 % [m/s2],RotD100 PSA 5 % [m/s2]"))
        for row in rows:
            cells = dict(zip(head.split(","), map(float, row.split(","))))
            north, east = (cells[f"three {name} PSA 5 % [m/s2]"] for name in ("NS", "EW"))
            self.assertGreaterEqual(cells["RotD100 PSA 5 % [m/s2]"], max(north, east))
            self.assertLessEqual(cells["RotD100 PSA 5 % [m/s2]"], math.hypot(north, east))
        self.assertIn("of three NS and three EW", json.dumps(report_of(self.folder / "three")))
        self.uplift("motion", "slanting.csv", "--frequencies", "1,10", "-o", "slanting")
        self.assertNotIn("RotD", (self.folder / "slanting/spectra.csv").read_text())

    def test_motions_of_one_name_are_told_apart(self):
        self.write(RECORD, "quake.csv")
        done = self.uplift("motion", "quake.csv", "quake.csv", "--json")
        self.assertEqual([each["name"] for each in json.loads(done.stdout)["motions"]], ["quake", "quake (2)"])

    def test_a_name_with_blanks_is_that_of_the_folder(self):
        for name in ("quake of May", "quake of June"):
            self.write(RECORD, f"{name}.csv")
            self.uplift("motion", f"{name}.csv")
        self.assertEqual(sorted(each.name for each in (self.folder / "out").iterdir()), ["motion_quake of June", "motion_quake of May"])

    def test_what_is_wrong_is_refused(self):
        self.write(RECORD, "quake.csv")
        for words, part in (
            (("missing.at2",), "missing.at2"),
            ((), "a file of a recorded motion, or --generate TARGET"),
            (("quake.csv", "--process", "tapir"), '(did you mean "taper"?)'),
            (("quake.csv", "--process", "bandpass low=a"), "low"),
            (("--generate", "rg_1_61", "pga=3"), '(did you mean "rg_1_60"?)'),
            (("--generate", "rg_1_60"), "pga"),
            (("--generate", "rg_1_60", "pga"), "KEY=VALUE"),
            (("--generate", "rg_1_60", "pga=3", "to=200"), "to"),
            (("--generate", "rg_1_60", "pga=3", "step=0.01", "--step", "0.02"), "step: expected one value, found two"),
            (("--generate", "rg_1_60", "pga=3", "--unit", "g"), "no options for files"),
            (("quake.csv", "--frequencies", "1,0"), 'frequencies > 0 Hz with commas, FROM:TO:COUNT or rg_1_122, found "0"'),
            (("quake.csv", "--frequencies", "5"), "a single one"),
            (("quake.csv", "--frequencies", "9:1:5"), 'found "9:1:5"'),
        ):
            done = self.uplift("motion", *words, expect=2)
            self.assertIn(part, done.stderr)
            self.assertTrue(done.stderr.startswith("error: "), done.stderr)
            self.assertEqual(done.stdout, "")
        self.assertFalse((self.folder / "out").exists())


class Generated(CliTest):
    def test_a_motion_fits_and_comes_again_from_its_seed(self):
        words = ("motion", "--generate", "rg_1_60", "pga=0.2 g_n", "seed=5", *SHORT)
        self.uplift(*words, "-o", "a")
        self.uplift(*words, "-o", "b")
        first = (self.folder / "a/motion.csv").read_text()
        self.assertEqual(first, (self.folder / "b/motion.csv").read_text())
        fit = self.summary("a")["fits"][0]
        self.assertTrue(fit["good"])
        self.assertLessEqual(fit["mean_error"], 0.05)
        self.assertGreaterEqual(fit["least_ratio"], 0.90)

    def test_a_spectrum_out_of_its_bounds_is_told(self):
        words = ("motion", "--generate", "rg_1_60", "pga=2", *SHORT, "-q")
        # what was asked for was done
        done = self.uplift(*words[:-1], "--process", "bandpass low=2 high=5", "-o", "filtered")
        self.assertRegex(done.stderr, "warning: rg_1_60: after the processing the spectrum is beyond its bounds: mean error [0-9.]+ %")
        # a second and a half of motion cannot fill such a target
        self.write("", "unused")
        done = self.uplift("motion", "--generate", "table frequencies=[1,1.1,20] accelerations=[0.01,9,0.01] damping=0.005", "duration=1.5",
                           "step=0.02", "from=3", "to=12", "-q", "-o", "bad", expect=3)
        self.assertRegex(done.stderr, r"failed: table: the spectrum could not be brought within its bounds \(mean error")
        self.assertFalse(self.summary("bad")["fits"][0]["good"])

    def test_what_was_generated_can_be_read(self):
        self.uplift("motion", "--generate", "eurocode_8 ground=C", "a_g=2", *SHORT, "-o", "made")
        again = json.loads(self.uplift("motion", "made/motion.csv", "--json").stdout)["intensities"][0]
        made = self.summary("made")["intensities"][0]
        for key in ("pga", "pgv", "pgd", "arias", "cav", "housner"):
            self.assertEqual(again[key], made[key])

    def test_three_components_are_independent(self):
        self.uplift("motion", "--generate", "rg_1_60", "--generate", "rg_1_60", "--generate", "rg_1_60 direction=vertical", "pga=2",
                    *SHORT, "-o", "three", "-q")
        found = self.summary("three")
        self.assertEqual(len(found["fits"]), 3)
        self.assertEqual(len(found["correlations"]), 3)
        for pair in found["correlations"]:
            self.assertLessEqual(abs(pair["correlation"]), 0.16)
        self.assertEqual((self.folder / "three/motion.csv").read_text().splitlines()[-1].count(","), 3)

    def test_parts_are_described(self):
        self.assertIn("Regulatory Guide 1.60", self.uplift("describe", "target", "rg_1_60").stdout)
        self.assertIn("seed", self.uplift("describe", "section", "generate").stdout)
        self.assertIn("bandpass", self.uplift("describe", "process").stdout)


class Compared(CliTest):
    def test_the_hardest_motion_is_shown(self):
        shaking = lambda peak: "time [s],a [m/s2]\n" + "".join(
            f"{0.01 * i:.2f},{peak * math.sin(2 * math.pi * i / 50) * math.sin(math.pi * i / 100):.6f}\n" for i in range(101))
        self.write(shaking(0.2), "weak.csv")
        self.write(shaking(6), "strong.csv")
        text = BASE.replace("bonded = false\n", "")
        for name in ("weak", "strong"):
            text += f'[[record]]\nname = "{name}"\nfile = "{name}.csv"\n'
            text += f'[[compare.motion]]\nname = "{name}"\nlabel = "{name} shaking"\nreplace = ["weak"]\nby = ["{name}"]\n'
        text += '[[ground_acceleration]]\ndirection = [1, 0]\nfunction = "weak"\n'
        text += '[[verdict.criterion]]\nquantity = "max_uplifted_ratio"\nlimit = 0.01\nsource = "test"\n'
        self.write(text)
        self.uplift("compare", "case.toml", "-o", "out", "-q")
        found = self.summary("out")
        self.assertEqual(found["verdict"]["run"], "run-strong")
        self.assertRegex(found["verdict"]["headline"], r"The base uplifts: .* \(strong shaking, the most demanding of 2 motions\)")
        self.assertEqual(found["verdict"]["criteria"][0]["result"], "not met")
        self.assertEqual([run["name"] for run in found["runs"]], ["run-strong", "bonded-strong", "run-weak", "bonded-weak"])
        # the table keeps the user's order; its peaks are those of the runs
        table = found["over_motions"][0]
        self.assertEqual([row["motion"] for row in table["motions"]], ["weak shaking", "strong shaking"])
        self.assertGreater(table["motions"][1]["peaks"]["ratio"], table["motions"][0]["peaks"]["ratio"])
        page = json.dumps(report_of(self.folder / "out"))
        self.assertIn("This page shows the most demanding of 2 motions, strong shaking.", page)
        for name in ("run-weak", "bonded-weak", "run-strong", "bonded-strong"):
            self.assertTrue((self.folder / f"out/histories/{name}.csv").exists())


if __name__ == "__main__":
    main()
