"""Plans of studies that are wrong are refused before any run, at the line of the plan."""

import csv

from support import *
from test_study import CASE, IDA, STRIPES, motion

VARIABLE = '[[variable]]\nname = "K"\npaths = ["interface[0].law.K_n"]\ndistribution = { type = "lognormal", median = 1, beta = 0.4 }\n'
SAMPLES = IDA.replace('case = "../case.toml"\n', 'case = "../case.toml"\nsamples = 6\n') + VARIABLE
OTHER = VARIABLE.replace('"K"', '"E"').replace("interface[0].law.K_n", "beam[0].E")


class StudyPlans(CliTest):
    def setUp(self):
        super().setUp()
        self.write(CASE)
        for name, frequency in [("quake", 2), ("m1", 1.5), ("m2", 3), ("m3", 6), ("m4", 10)]:
            self.write(motion(frequency, 3), f"{name}.csv")

    def study(self, plan, name="s.study"):
        self.write(plan, f"{name}/plan.toml")
        return name

    def refused(self, plan, line, message):
        """The plan is refused at the line that begins so, by a command that would compute, and nothing is computed."""
        name = self.study(plan)
        said = self.uplift("study", "run", name, "-q", expect=2).stderr
        self.assertIn(message, said)
        self.assertIn(f"{name}/plan.toml:{line_of(plan, line)}: ", said)
        self.assertFalse((self.folder / name / "parts").exists())

    def test_numbers_that_variables_set(self):
        path = "interface[0].law.K_n"
        for found, message in [
            ("interface[18446744073709551616].law.K_n", "expected paths of numbers of the case"),  # beyond the largest index
            ("interface[1].law.K_n", "expected paths of numbers of the case"),
            ("interface[0].law.Kn", '(did you mean "interface[0].law.K_n"?)'),
            ("interfaces[0].law.K_n", '(did you mean "interface[0].law.K_n"?)'),
            ("load[0].force[0]", "expected numbers that are not 0, for a factor"),
            (f'{path}", "{path}', "expected numbers that are set once"),
        ]:
            with self.subTest(found=found):
                self.refused(SAMPLES.replace(path, found), "paths", message)
        twice = SAMPLES + VARIABLE.replace('"K"', '"again"')
        self.assertIn("expected numbers that are set once", self.uplift("study", "check", self.study(twice), expect=2).stderr)

    def test_values_that_the_case_refuses(self):
        self.refused(SAMPLES.replace("beta = 0.4", "beta = 50"), "distribution", "expected values that the case takes, found sample")
        normal = SAMPLES.replace('type = "lognormal", median = 1, beta = 0.4', 'type = "normal", mean = 1, deviation = 3')
        self.refused(normal, "distribution", "interface[0].law.K_n: expected a pressure per length > 0")

    def test_correlations_are_given_once(self):
        correlation = '[[correlation]]\nvariables = ["K", "E"]\nvalue = 0.5\n'
        self.study(SAMPLES + OTHER + correlation)
        self.uplift("study", "check", "s.study")
        plan = SAMPLES + OTHER + correlation + correlation.replace('["K", "E"]', '["E",  "K"]')
        self.refused(plan, 'variables = ["E",  "K"]', "whose correlation is given once")

    def test_limits_are_for_what_the_case_has(self):
        limit = 'name = "uplift"\n'
        self.refused(IDA.replace(limit, limit + 'of = "soul"\n'), "of =", '(did you mean "soil"?)')
        self.refused(IDA.replace("max_opening", "max_beam_tension").replace("1 mm", "1 N"), "quantity", "expected a case with [[output.beam_envelope]]")
        self.study(IDA.replace(limit, limit + 'of = "soil"\n'))
        self.uplift("study", "check", "s.study")

    def test_a_negative_limit_is_one_of_a_change_alone(self):
        # the size of an opening counts: every run would exceed -1 mm, also one whose base stays closed
        self.refused(IDA.replace('"1 mm"', '"-1 mm"'), "limit =", "expected a number >= 0")
        self.study(IDA.replace("max_opening", "change_of_moment").replace('"1 mm"', "-0.1"))
        self.uplift("study", "check", "s.study")

    def test_a_reduced_model_that_does_not_exist(self):
        self.refused('reduced_model = "../no.rom"\n' + IDA, "reduced_model", 'expected a file, found no file')

    def test_a_cloud_is_of_demands_that_grow(self):
        # regressed on a safety, the curve would be the probability that the structure is safe
        cloud = IDA.replace('type = "ida"\nstart = 0.1\nlargest = 20', 'type = "cloud"')
        self.refused(cloud.replace('"max_opening"\nlimit = "1 mm"', '"min_overturning_safety"\nlimit = 1.1'), "quantity", "expected a number that grows with the intensity")
        # a moment that is less by 30 % is no demand of 0.3
        self.refused(cloud.replace('"max_opening"\nlimit = "1 mm"', '"change_of_moment"\nlimit = 0.1'), "quantity", "expected a number whose size counts")
        self.refused(cloud.replace('"1 mm"', '"0 mm"'), "limit =", "expected a number > 0")

    def test_percentiles_of_floors_need_common_levels(self):
        self.refused("floor_spectra = true\n" + IDA, "floor_spectra", "expected stripes or cloud as the method")

    def test_searches_end(self):
        for tolerance in ("1e-18", "2", "nan"):
            self.refused(IDA.replace("start = 0.1", f"start = 0.1\ntolerance = {tolerance}"), "tolerance", "expected a number from 1e-06 to 1")
        name = self.study(IDA.replace("start = 0.1", "start = 0.1\ntolerance = 1e-6\nmost_runs = 60").replace(', "../m2.csv", "../m3.csv", "../m4.csv"', ""))
        self.uplift("study", "run", name, "-q")
        self.uplift("study", "export", name, "-q")
        with open(self.folder / name / "runs.csv", newline="") as file:
            runs = [(float(run["intensity [g_n]"]), run["uplift"]) for run in csv.DictReader(file)]
        first = min(intensity for intensity, state in runs if state == "exceeded")
        last = max(intensity for intensity, state in runs if state == "survived" and intensity < first)
        self.assertLess(first / last - 1, 1e-6)

    def test_motions_take_a_place_once(self):
        self.refused(IDA.replace('replace = ["quake"]', 'replace = ["quake", "quake"]'), "[[motions]]", "expected every name once")
        self.refused(IDA.replace('unit = "g_n"', 'unit = ""'), "unit", "expected a unit of an acceleration")

    def test_memory_is_what_a_run_takes(self):
        if self.cannot_be_limited():
            self.skipTest("the address space cannot be limited")
        self.write(CASE.replace("duration = 1\n", "duration = 60\n"))
        plan = STRIPES.replace("[0.2, 0.5, 1.0]", "[0.2]") + "[run]\nmemory = {}\n"
        for memory, completed in [("1", 0), ("150", 4)]:  # MB; the program alone has reserved more than this
            name = self.study(plan.format(memory), f"{memory}.study")
            self.uplift("study", "run", name, "-q")
            outcomes = json.loads(self.uplift("study", "fit", name, "--json").stdout)["outcomes"]
            self.assertEqual(outcomes["completed"], completed)
            self.assertEqual(outcomes["completed"] + outcomes["memory"] + outcomes["crashed"], 4)

    def test_results_do_not_depend_on_where_they_are_asked_for(self):
        name = self.study(STRIPES, "it's $HOME.study")
        task = self.uplift("study", "tasks", name, "--count", "1").stdout
        said = subprocess.run(["bash", "-c", task.replace("uplift", f"'{os.path.abspath(program())}'", 1)], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(said.returncode, 0, said.stderr)
        expected = self.uplift("study", "fit", name, "--json").stdout
        elsewhere = subprocess.run([os.path.abspath(program()), "study", "fit", self.folder / name, "--json"], cwd="/", capture_output=True, text=True)
        self.assertEqual(elsewhere.stdout, expected)
        self.assertEqual(json.loads(expected)["provenance"]["case_file"], "../case.toml")


if __name__ == "__main__":
    main()
