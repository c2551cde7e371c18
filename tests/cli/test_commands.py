"""The other commands: new, check, modes, describe, schema, replay, completion, help."""

import math
import re

from support import *


class New(CliTest):
    def test_a_new_case_passes_check_and_runs(self):
        done = self.uplift("new", "my tower")
        self.assertIn("my tower/case.toml written; next: uplift check 'my tower'", done.stdout)
        text = (self.folder / "my tower" / "case.toml").read_text()
        self.assertGreater(sum("#" in line for line in text.splitlines()), 15)
        self.assertIn("in order", self.uplift("check", "my tower").stdout)
        done = self.uplift("run", "my tower")
        self.assertIn("The base uplifts", done.stdout)
        self.uplift("compare", "my tower/case.toml", "-o", "c")
        results = {run["name"]: run["agreement"]["result"] for run in self.summary("c")["runs"] if run["name"] != "bonded"}
        self.assertEqual(results, {"sdm": "agrees", "springs": "agrees"})

    def test_a_new_study_names_what_drives_the_case(self):
        self.uplift("new", "my tower")
        done = self.uplift("study", "new", "my tower")
        self.assertIn("my tower.study/plan.toml written; next: uplift study check 'my tower.study'", done.stdout)
        said = self.uplift("study", "check", "my tower.study", expect=2).stderr  # a gust drives the new case, no motion of the ground
        self.assertIn('of a ground acceleration, prescribed motion or incident wave, of which the case has none, found "quake"', said)
        shaken = (self.folder / "my tower" / "case.toml").read_text()
        gust, after = shaken.index("[[load]]"), shaken.index("# An earthquake instead of the gust")
        ground = '[[ground_acceleration]]\ndirection = [1, 0]\namplitude = "2 m/s2"\nfunction = "pulse"\n\n'
        (self.folder / "shaken").mkdir()
        (self.folder / "shaken" / "case.toml").write_text(shaken[:gust] + ground + shaken[after:])
        self.uplift("study", "new", "shaken")
        plan = self.folder / "shaken.study" / "plan.toml"
        self.assertIn('replace = ["pulse"]', plan.read_text())
        plan.write_text(plan.read_text().replace("count = 20", "count = 1").replace("duration = 20", "duration = 5"))
        self.uplift("study", "check", "shaken.study")

    def test_a_new_study_of_a_case_file(self):
        self.uplift("new", "tower")
        (self.folder / "shaken.toml").write_bytes((self.folder / "tower" / "case.toml").read_bytes())
        for given, study, of in (("shaken.toml", "shaken.study", "../shaken.toml"), ("tower/", "tower.study", "../tower/case.toml")):
            self.uplift("study", "new", given)
            self.assertIn(f'case = "{of}"', (self.folder / study / "plan.toml").read_text())
            self.assertTrue((self.folder / study / of).is_file())

    def test_names_that_lead_nowhere(self):
        self.assertIn("expected the name of a folder, found an empty one", self.uplift("new", "", expect=2).stderr)
        self.assertEqual(list(self.folder.iterdir()), [])
        (self.folder / "empty").mkdir()
        self.assertIn("error: empty/case.toml: expected a file, found no file of this name", self.uplift("check", "empty", expect=2).stderr)

    def test_an_existing_case_is_not_overwritten(self):
        self.write("# mine\n", "tower/case.toml")
        done = self.uplift("new", "tower", expect=2)
        self.assertIn("exists already", done.stderr)
        self.assertEqual((self.folder / "tower/case.toml").read_text(), "# mine\n")


class Check(CliTest):
    def test_says_what_will_be_computed(self):
        self.write(BASE)
        text = self.uplift("check", "case.toml").stdout
        for part in ("unknowns", "11 points, springs", "k F_ii", "frequencies, bonded base", "suggested step", "what is computed"):
            self.assertIn(part, text)
        self.assertFalse((self.folder / "out").exists())

    def test_frequencies_and_ratio_are_right(self):
        # Fixed base: f = sqrt(3 E I/(M h^3))/(2 pi). Bonded on springs K_n: one stiff and one slow mode of [k, -k h; -k h, k h^2 + k_theta].
        self.write(BASE)
        found = json.loads(self.uplift("check", "case.toml", "--json").stdout)
        mass, stiffness, height = 24317.0, 3 * 2e10 * 0.2 / 125, 5.0
        self.assertAlmostEqual(found["frequencies_fixed_base"][0], math.sqrt(stiffness / mass) / (2 * math.pi), places=6)
        # Composite trapezoid of k x^2 over 3 m with 11 points: b = 1.5, spacing 0.3
        points = [-1.5 + 0.3 * i for i in range(11)]
        area = [0.15 if i in (0, 10) else 0.3 for i in range(11)]
        k_theta = sum(2e8 * a * x * x for a, x in zip(area, points))
        inertia = 7500.0
        a, b, c = mass * inertia, -(stiffness * inertia + mass * (stiffness * height**2 + k_theta)), stiffness * k_theta
        slow = math.sqrt((-b - math.sqrt(b * b - 4 * a * c)) / (2 * a)) / (2 * math.pi)
        self.assertAlmostEqual(found["frequencies_bonded"][0], slow, places=6)
        self.assertAlmostEqual(found["weight"], 1e6, places=3)

    def test_without_an_interface_there_is_no_base_that_carries(self):
        text = BASE.replace('[[interface]]\nname = "soil"\n', '').split("[interface.footing]")[0]
        text = text.replace('fixed = ["ux"]', 'fixed = ["ux", "uy", "rz"]') + '[[stage]]\ntype = "dynamic"\nduration = 0.5\nstep = 1e-3\n'
        self.write(text)
        self.assertNotIn("dead load", self.uplift("check", "case.toml").stdout)
        self.assertNotIn("weight", json.loads(self.uplift("check", "case.toml", "--json").stdout))

    def test_warns(self):
        law = 'type = "sdm"\nK_n = 2e8\nF_u = 1e3\nG_f = 0.1\nF_c = -1e4\ntangential = "none"\n'
        text = BASE.replace('type = "springs"\nK_n = 2e8\n', law).replace("step = 1e-3", "step = 0.02").replace("E = 2e10", "E = 2e4")
        done = self.uplift("check", self.write(text).name)
        self.assertRegex(done.stdout, r"warning: case\.toml:\d+: the closure stress of 10\.0 kPa is 3\.0 % of the mean bearing pressure 333 kPa")
        self.assertRegex(done.stdout, r"warning: the step of 20\.0 ms is coarse")
        self.assertRegex(done.stdout, r"beam\[0\]\.E = 20000 Pa is unusual")

    def test_warns_of_constraints_without_velocity_correction(self):
        text = BASE.replace('[interface.law]\ntype = "springs"\nK_n = 2e8\n', "").replace('name = "soil"\n', 'name = "soil"\nlaw = "unilateral"\n')
        text = text.replace('title = "test"\n', 'title = "test"\nimpact = "none"\n')
        self.assertIn("create energy without bound", self.uplift("check", self.write(text).name).stdout)


    def test_lists_where_the_points_of_an_interface_lie(self):
        name = self.write(BASE).name
        self.assertIn("1 (-1.5, 0), 2 (-1.2, 0), 3 (-0.9, 0)", self.uplift("check", name).stdout)
        position = json.loads(self.uplift("check", name, "--json").stdout)["interfaces"][0]["positions"]
        for k in range(11):
            self.assertAlmostEqual(position["x"][k], -1.5 + 0.3 * k, delta=1e-12)
            self.assertAlmostEqual(position["area"][k], 0.15 if k in (0, 10) else 0.3, delta=1e-12)
        self.uplift("run", name, "-o", "out")
        summary = json.loads((self.folder / "out/summary.json").read_text())
        self.assertEqual(summary["interfaces"][0]["positions"], position)

    def test_another_scheme_takes_the_traction_at_the_end_of_the_step(self):
        name = self.write(BASE.replace('type = "dynamic"', 'type = "dynamic"\nscheme = { type = "hht", alpha = -0.1 }')).name
        checked = self.uplift("check", name).stdout
        self.assertNotIn('take traction = "path"', checked)
        self.uplift("run", name, "-o", "out")
        resolved = (self.folder / "out/case.resolved.toml").read_text()
        self.assertEqual(re.findall('traction = "(.*)"', resolved)[-1], "end")
        self.write(BASE)
        self.uplift("run", name, "-o", "path")
        self.assertEqual(re.findall('traction = "(.*)"', (self.folder / "path/case.resolved.toml").read_text())[-1], "path")


class Modes(CliTest):
    def test_table_and_shapes(self):
        self.write(BASE)
        text = self.uplift("modes", "case.toml").stdout
        self.assertIn("interfaces closed and bonded", text)
        self.assertIn("rigid motion", text)  # base free: nothing holds it
        modes = json.loads(self.uplift("modes", "case.toml", "--json", "-n", "2").stdout)
        self.assertEqual(len(modes["bonded"]), 2)
        shape = modes["bonded"][0]["shape"]
        self.assertEqual(set(shape), {"top", "base"})
        self.assertGreater(abs(shape["top"][0]), 10 * abs(shape["base"][0]))
        self.assertTrue(all(mode["frequency"] == 0 for mode in modes["base_free"][:1]))

    def test_a_model_without_interface_has_one_table(self):
        self.write('title = "spring"\n[nodes]\no = [0, 0]\n[[mass]]\nnode = "o"\nmass = 1\n[[support]]\nnode = "o"\nfixed = ["uy", "rz"]\n'
                   '[[spring]]\nnodes = ["o"]\ndirection = [1, 0]\nstiffness = 39.47841760435743\n'
                   '[[stage]]\ntype = "dynamic"\nduration = 1\nstep = 0.01\n')
        text = self.uplift("modes", "case.toml").stdout
        self.assertEqual(text.count("frequency [Hz]"), 1)
        self.assertRegex(text, r"\n +1 +1 +1 +100\.0")  # 1 Hz: (2 pi)^2 N/m under 1 kg
        self.assertNotIn("interfaces", text)


class Describe(CliTest):
    def test_every_listed_part_can_be_described(self):
        text = self.uplift("describe").stdout
        family, described = None, 0
        for line in text.splitlines():
            head = re.match(r"(\w+): ", line)
            if head and not line.startswith(" "):
                family = head.group(1)
            part = re.match(r"  ([\w.]+)", line)
            if part and family and family != "more":
                described += 1
                if sanitized() and described % 8:  # a tenth of a second each
                    continue
                done = self.uplift("describe", family, part.group(1))
                self.assertIn("parameters" if family != "section" else "meaning", done.stdout)
        self.assertGreater(described, 40)

    def test_quantities_of_the_verdict(self):
        text = self.uplift("describe", "quantity").stdout
        self.assertRegex(text, r"max_toe_pressure +Pa +base, wall +at most +largest pressure")
        self.assertRegex(text, r"min_sliding_safety +1 +base +at least ")
        self.assertIn('did you mean "max_slip"?', self.uplift("describe", "quantity", "max_slipp", expect=2).stderr)

    def test_law_with_units_defaults_and_source(self):
        text = self.uplift("describe", "law", "sdm").stdout
        for part in ("equations", "K_n", "Pa/m", "F_u", "G_f", "J/m2", "source", "eqs"):
            self.assertIn(part, text)

    def test_parameters_of_the_parts_of_a_section(self):
        text = self.uplift("describe", "section", "record.process").stdout
        self.assertRegex(text, r"bandpass +low \[Hz\], high \[Hz\], order = 4, keep_padding = false")
        self.assertIn("more: uplift describe process", text)

    def test_project_alone_creates_energy(self):
        self.assertIn("162 %", self.uplift("describe", "impact", "project").stdout)

    def test_nearest_name(self):
        done = self.uplift("describe", "law", "sdn", expect=2)
        self.assertIn('(did you mean "sdm"?)', done.stderr)

    def test_a_name_alone_is_enough(self):
        for kind, name in (("law", "sdm"), ("element", "beam"), ("section", "verdict.criterion"), ("quantity", "max_slip")):
            self.assertEqual(self.uplift("describe", name).stdout, self.uplift("describe", kind, name).stdout)
        self.assertIn("section interface.footing.bed:", self.uplift("describe", "bed").stdout)
        self.assertIn('(did you mean "springs"?)', self.uplift("describe", "sprngs", expect=2).stderr)


class Schema(CliTest):
    def test_is_a_schema_of_the_case_file(self):
        schema = json.loads(self.uplift("schema").stdout)
        self.assertIn("2020-12", schema["$schema"])
        self.assertTrue({"title", "nodes", "beam", "interface", "stage", "variant"} <= set(schema["properties"]))
        self.assertIn("title", schema["required"])
        self.assertFalse(schema["additionalProperties"])


class Replay(CliTest):
    def test_missing_file(self):
        done = self.uplift("replay", "problem.json", expect=2)
        self.assertIn("problem.json", done.stderr)

    def test_unknown_method(self):
        problem = self.stored()
        done = self.uplift("replay", problem, "--method", "lagrnge", expect=2)
        self.assertIn('(did you mean "lagrange"?)', done.stderr)

    def test_all_methods_solve_a_stored_problem(self):
        problem = self.stored()
        found = json.loads(self.uplift("replay", problem, "--all", "--json").stdout)["methods"]
        solved = {answer["method"]: answer for answer in found if answer["converged"]}
        self.assertIn("lagrange", solved)
        self.assertIn("augmented_lagrangian", solved)
        for name in ("lagrange", "augmented_lagrangian"):
            self.assertLess(solved[name]["residual"], 1e-8)
            # p = free opening / F on the closed point: 1e-3 m / 1e-8 m/N = 1e5 N in compression; the other point stays open by 1 mm
            self.assertAlmostEqual(solved[name]["force"][0], -1e5, delta=1e-4)
            self.assertAlmostEqual(solved[name]["force"][1], 0, delta=1e-4)
            self.assertAlmostEqual(solved[name]["opening"][1], 1e-3, delta=1e-12)
        text = self.uplift("replay", problem, "--method", "lagrange").stdout
        self.assertRegex(text, r"soil +1 +\S+ +2\.0+e\+05")  # 1e5 N on 0.5 m2

    def stored(self):
        return pathlib.Path(__file__).with_name("stored_problem.json")


class Soil(CliTest):
    """Stiffness of a square footing of 10 m, G = 80 MPa, poisson 0.3 after Pais and Kausel: K_z = G B/(1 - nu) 4.7, B = 5 m."""
    WORDS = ("width=10 m", "length=1000 cm", "G=80 MPa", "poisson=0.3")

    def motions(self, *words):
        found = json.loads(self.uplift("soil", *words, "--json").stdout)["footings"]
        return [{each["motion"]: each for each in footing["soil"]["motions"]} for footing in found]

    def test_of_words(self):
        motions, = self.motions(*self.WORDS)
        self.assertAlmostEqual(motions["vertical"]["stiffness"] / (80e6 * 5 / 0.7 * 4.7), 1, 12)
        self.assertEqual(motions["vertical"]["damping"], 0)  # without density
        text = self.uplift("soil", *self.WORDS).stdout
        for part in ("Pais & Kausel", 'K_v = "2.68571429e+09 N/m"', "tilting the width: 39 % of the stiffness", "K_n = 2.68571e+07 Pa/m"):
            self.assertIn(part, text)

    def test_bed(self):
        """(H13) to (H15): K_z/A; a uniform bed rocks with K_z B^2/3; the other one has the mean 1 and the second moment of the ratio."""
        footing, = json.loads(self.uplift("soil", *self.WORDS, "density=1900 kg/m3", "--json").stdout)["footings"]
        motions, bed = {each["motion"]: each for each in footing["soil"]["motions"]}, footing["bed"]
        vertical = motions["vertical"]["stiffness"]
        self.assertAlmostEqual(bed["K_n"] / (vertical / 100), 1, 12)
        self.assertAlmostEqual(bed["K_t"] / (motions["along the width"]["stiffness"] / 100), 1, 12)
        self.assertAlmostEqual(bed["c"] / (motions["vertical"]["damping"] / 100), 1, 12)
        for rocking in bed["rocking"]:
            share = vertical * 25 / 3 / motions[rocking["motion"]]["stiffness"]
            self.assertAlmostEqual(rocking["uniform_share"], share, 12)
            self.assertAlmostEqual(rocking["uniform_K_n"] * 100 / vertical, 1 / share, 12)
            at = [(k + 0.5) / 40000 for k in range(40000)]
            growth = math.log(rocking["edge"] / rocking["middle"])
            stiffness = [rocking["middle"] * math.exp(growth * x * x) for x in at]
            self.assertAlmostEqual(sum(stiffness) / 40000, 1, 6)
            self.assertAlmostEqual(sum(k * x * x for k, x in zip(stiffness, at)) / 40000 * 3, 1 / share, 5)
        disc, = json.loads(self.uplift("soil", "shape=disc", "width=10", "G=80 MPa", "poisson=0.3", "--json").stdout)["footings"]
        self.assertEqual([each["edge"] for each in disc["bed"]["rocking"]], [None] * len(disc["bed"]["rocking"]))

    def test_what_it_prints_is_the_model_of_a_foundation(self):
        printed = re.findall(r'(K_\w+ = "[^"]+")', self.uplift("soil", *self.WORDS).stdout)
        foundation = '[[foundation]]\nname = "ground"\nbody = "base"\nwidth = 10\nlength = 10\n'
        plane = ", ".join(line for line in printed if line.split()[0] in ("K_v", "K_h", "K_r"))
        before, after = BASE.split("[[interface]]")[0], "[[load]]" + BASE.split("[[load]]", 1)[1]
        self.write(before + foundation + 'model = { type = "elastic", ' + plane + " }\n" + after, "stated.toml")
        self.write(before + foundation + 'model = "elastic"\n[foundation.soil]\nG = "80 MPa"\npoisson = 0.3\n' + after, "soil.toml")
        stated, soil = (json.loads(self.uplift("check", name, "--json").stdout) for name in ("stated.toml", "soil.toml"))
        for one, other in zip(stated["frequencies_bonded"], soil["frequencies_bonded"]):
            self.assertAlmostEqual(one / other, 1, 7)
        self.assertEqual(self.motions("soil.toml"), self.motions(*self.WORDS))

    def test_refusals(self):
        for words, parts in (((*self.WORDS, "lenght=3"), ("uplift soil: lenght", 'did you mean "length"')), (("width=2", "width=3"), ("width", "two")),
                             (("width=10", "G=1", "poisson=0.2"), ("the length of a rectangle",)), (("a=b",), ("uplift soil: a: expected a key",)),
                             (("width=10", "length=9", "layers=[{G=8e7, poisson=0.3, density=1900, thick=3}]"), ("layers[0].thick", 'thickness')),
                             (("wi\ndth=3",), ("on one line",)), (("nowhere.toml",), ("nowhere.toml", "no file")), (("x.toml", "y.toml"), ("y.toml",)),
                             (("shape=strip", "width=2", "G=1e6", "poisson=0.2"), ("rock_depth",)), (("width=-1", "length=1"), ("a length > 0 m",)),
                             (("shape=disc", "radius=5", "G=80 MPa", "poisson=0.3"), ("radius", "diameter of a disc", 'did you mean "width"'))):
            self.refused_words(words, parts)

    def refused_words(self, words, parts):
        done = self.uplift("soil", *words, expect=2)
        for part in parts:
            self.assertIn(part, done.stderr)
        self.assertEqual(done.stdout, "")


class Shell(CliTest):
    def test_help_has_examples_and_exit_codes(self):
        for command in ("new", "check", "run", "compare", "modes", "describe", "schema", "replay", "motion", "completion"):
            text = self.uplift(command, "--help").stdout
            self.assertIn("Examples:", text)
            self.assertIn(f"uplift {command}", text)
            self.assertIn("3 numerical failure", text)

    def test_unknown_command_and_option(self):
        self.uplift("rum", "case.toml", expect=2)
        self.uplift("run", "case.toml", "--jsn", expect=2)
        self.uplift(expect=2)

    def test_version(self):
        self.assertRegex(self.uplift("--version").stdout, r"\d+\.\d+\.\d+")

    def test_bash_completion_is_valid_and_complete(self):
        script = self.uplift("completion", "bash").stdout
        path = self.write(script, "complete.bash")
        subprocess.run(["bash", "-n", path], check=True)
        ask = f'source "{path}"; COMP_WORDS=(uplift co); COMP_CWORD=1; _uplift; echo "${{COMPREPLY[@]}}"; COMP_WORDS=(uplift run --j); COMP_CWORD=2; _uplift; echo "${{COMPREPLY[@]}}"'
        done = subprocess.run(["bash", "-c", ask], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout.split(), ["compare", "completion", "--json"])

    def test_zsh_completion(self):
        script = self.uplift("completion", "zsh").stdout
        self.assertIn("compdef _uplift uplift", script)
        self.assertIn("--json", script)
        self.uplift("completion", "fish", expect=2)


if __name__ == "__main__":
    main()
