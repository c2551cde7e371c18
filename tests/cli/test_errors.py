"""Bad input: every mistake is refused before the first step, with the place, what was expected and what was found."""

import math
import resource

from support import *


class BadInput(CliTest):
    def replace(self, old, new):
        self.assertIn(old, BASE)
        return BASE.replace(old, new, 1)

    def test_the_case_itself_is_in_order(self):
        self.write(BASE)
        self.uplift("check", "case.toml")

    def test_unknown_key(self):
        text = self.replace("width = 3\n", "widht = 3\n")
        self.refused(text, f'{{file}}:{line_of(text, "widht")}: interface[0].footing.widht: expected a key of footing, found "widht" (did you mean "width"?)')

    def test_missing_file(self):
        self.write(BASE)
        done = self.uplift("check", "cast.toml", expect=2)
        self.assertEqual(done.stderr.strip(), 'error: cast.toml: expected a file, found no file of this name (did you mean "case.toml"?)')

    def test_missing_file_of_a_function(self):
        text = self.replace('shape = { type = "half_sine", duration = 0.1 }', 'shape = { type = "csv", file = "none.csv" }')
        self.refused(text, f'{{file}}:{line_of(text, "none.csv")}: function[0].shape.file: expected a file, found no file "none.csv"')

    def test_unknown_command(self):
        done = self.uplift("chek", "case.toml", expect=2)
        self.assertRegex(done.stderr, r'^error: uplift: expected a command: new, check, .*, found "chek" \(did you mean "check"\?\)$')
        self.write(BASE)
        self.assertIn('found "case.toml"', self.uplift("case.toml", expect=2).stderr)

    def test_unknown_option(self):
        self.write(BASE)
        done = self.uplift("check", "case.toml", "--jsno", expect=2)
        self.assertEqual(done.stderr.strip(), 'error: uplift check: expected one of its options (--help lists them), found "--jsno" (did you mean "--json"?)')
        done = self.uplift("run", "case.toml", "--otu=here", expect=2)
        self.assertEqual(done.stderr.strip(), 'error: uplift run: expected one of its options (--help lists them), found "--otu" (did you mean "--out"?)')

    def test_empty_name_of_the_results(self):
        self.write(BASE)
        done = self.uplift("run", "case.toml", "-o", "", expect=2)
        self.assertEqual(done.stderr.strip(), "error: --out: expected a name, found an empty one")

    def test_tons_are_refused(self):
        text = self.replace("mass = 24317", 'mass = "24 tons"')
        self.refused(text, f'{{file}}:{line_of(text, "24 tons")}: mass[0].mass: expected a mass > 0 kg, found "24 tons" (a ton is 907, 1000 or 1016 kg; t is 1000 kg) (did you mean "t"?)')

    def test_wrong_dimension(self):
        text = self.replace("E = 2e10", 'E = "20000 kN"')
        self.refused(text, f'{{file}}:{line_of(text, "E = ")}: beam[0].E: expected a pressure > 0 Pa, found "20000 kN" (a force)')

    def test_unknown_unit(self):
        text = self.replace("E = 2e10", 'E = "20000 MPaa"')
        self.refused(text, f'{{file}}:{line_of(text, "E = ")}: beam[0].E: expected a pressure > 0 Pa, found "20000 MPaa" (unknown unit "MPaa") (did you mean "MPa"?)')

    def test_value_with_a_unit_without_quotation_marks(self):
        text = self.replace("width = 3\n", "width = 3m\n")
        self.refused(text, f'{{file}}:{line_of(text, "3m")}: expected TOML, found an error while parsing decimal integer: expected digit, '
                     "saw 'm' (texts and values with a unit need quotation marks: \"top\", \"5 m\")")

    def test_text_without_its_end(self):
        text = self.replace('name = "soil"\n', 'name = "soil\n')
        done = self.uplift("check", self.write(text).name, expect=2)
        self.assertRegex(done.stderr, rf'^error: case\.toml:{line_of(text, "soil")}: .* \(is the closing quotation mark missing in this line\?\)$')

    def test_what_toml_wants_is_said_where_it_is_known(self):
        for old, new, wanted in (('name = "soil"\n', "name = 'soil\n", "is the closing quotation mark missing"), ("[0, -1e6]", "[0 -1e6]", "error"),
                                 ('title = "test"\n', 'title = "test"\nbonded = False\n', "true and false are written in small letters")):
            err = self.uplift("check", self.write(self.replace(old, new)).name, expect=2).stderr
            self.assertIn(wanted, err)
            self.assertEqual("need quotation marks" in err, False, err)

    def test_gravity_upwards(self):
        """The static load of 1 MN in the other direction is left out; a load that pulls is no mistake of gravity."""
        text = self.replace("force = [0, -1e6]", "force = [0, 0]") + "[gravity]\nacceleration = [0, 9.81]\n"
        self.write(text)
        done = self.uplift("check", "case.toml", expect=None)
        self.assertIn(f"warning: case.toml:{line_of(text, 'acceleration')}: gravity acts upwards, along +y, and presses no base onto "
                      "the ground; is its sign right?", done.stdout)
        self.write(self.replace("force = [0, -1e6]", "force = [0, 1e6]") + "[gravity]\nacceleration = [0, -9.81]\n")
        self.assertNotIn("upwards", self.uplift("check", "case.toml", expect=None).stdout)

    def test_a_loose_body_is_named_at_its_own_line(self):
        text = self.replace("[nodes]\n", "[nodes]\nloose = [30, 5]\n") + '[[mass]]\nnode = "loose"\nmass = 100\n'
        err = self.uplift("check", self.write(text).name, expect=2).stderr
        self.assertRegex(err, rf'^error: case\.toml:{line_of(text, "loose")}: .* a mechanism: "loose" can move .*; hold it by a \[\[support\]\] or a \[\[spring\]\]$')

    def test_a_mechanism_of_a_variant_is_told_at_its_law(self):
        pier = (pathlib.Path(__file__).resolve().parents[2] / "examples" / "05_bridge_pier" / "case.toml").read_text()
        text = pier + '\n[[variant]]\nname = "smooth"\nlaw = { type = "springs", K_n = "80 MPa/m" }  # smooth\n'
        self.write(text)
        for command in ("check", "compare"):
            err = self.uplift(command, "case.toml", expect=2).stderr
            self.assertIn(f'case.toml:{line_of(text, "# smooth")}: expected a structure that stands', err)
            self.assertIn("K_t of an interface", err)

    def test_wrong_type(self):
        text = self.replace("points = 11", 'points = "many"')
        self.refused(text, f'{{file}}:{line_of(text, "points")}: interface[0].footing.points: expected an integer from 1 to 100000, found the text "many"')

    def test_missing_key(self):
        text = self.replace("I = 0.2\n", "")
        self.refused(text, f'{{file}}:{line_of(text, "[[beam]]")}: beam[0].I: expected a second moment of area > 0 m4, found nothing')

    def test_duplicate_key(self):
        text = self.replace("I = 0.2\n", "I = 0.2\nI = 0.3\n")
        done = self.uplift("check", self.write(text).name, expect=2)
        self.assertRegex(done.stderr, rf"^error: case\.toml:{line_of(text, 'I = 0.3')}: ")
        self.assertIn("I", done.stderr)

    def test_duplicate_name(self):
        text = BASE + '[[function]]\nname = "pulse"\nshape = "constant"\n'
        first = line_of(text, 'name = "pulse"')
        last = len(text.splitlines()) - 1
        self.refused(text, f'{{file}}:{last}: function[1].name: expected a name that no other function has, found "pulse", which line {first} uses already')

    def test_dangling_node(self):
        text = self.replace('nodes = ["base", "top"]', 'nodes = ["base", "tpo"]')
        self.refused(text, f'{{file}}:{line_of(text, "tpo")}: beam[0].nodes: expected the name of a node, found "tpo" (did you mean "top"?)')

    def test_dangling_function(self):
        text = self.replace('function = "pulse"', 'function = "puls"')
        self.refused(text, f'{{file}}:{line_of(text, "puls")}: load[1].function: expected the name of a function, found "puls" (did you mean "pulse"?)'.replace(
            str(line_of(text, "puls")), str(line_of(text, 'function = "puls"')), 1))

    def test_dangling_interface_of_a_history(self):
        text = BASE + '[[output.history]]\ninterface = "sol"\nquantity = "moment"\n'
        self.refused(text, f'{{file}}:{line_of(text, "sol" + chr(34))}: output.history[0].interface: expected the name of an interface, found "sol" (did you mean "soil"?)')

    def test_unknown_history_quantity(self):
        text = BASE + '[[output.history]]\ninterface = "soil"\nquantity = "momnt"\n'
        self.refused(text, f'{{file}}:{line_of(text, "momnt")}: output.history[0].quantity: expected a quantity of an interface: axial, shear, moment, rotation, '
                           'settlement, tilt, uplifted_ratio, max_opening, max_pressure, found "momnt" (did you mean "moment"?)')

    def test_point_beyond_the_interface(self):
        text = BASE + '[[output.history]]\ninterface = "soil"\npoint = 12\nquantity = "opening"\n'
        self.refused(text, f'{{file}}:{line_of(text, "point = 12")}: output.history[0].point: expected a point of "soil", from 1 to 11, found 12')

    def test_zero_mass_where_mass_is_needed(self):
        text = self.replace("mass = 24317\n", "mass = 0\n")
        self.refused(text, f'{{file}}:{line_of(text, "mass = 0")}: mass[0].mass: expected a mass > 0 kg, found 0 kg')

    def test_massless_footing(self):
        text = self.replace("mass = 1e4\ninertia = 7500\n", "").replace('type = "springs"\nK_n = 2e8\n', 'type = "unilateral"\n')
        self.refused(text, f'{{file}}:{line_of(text, "[[interface]]")}: interface.soil: expected a mass on everything that the interface touches, '
                           'found zero mass where mass is needed: base.rz has none')

    def test_snap_back(self):
        text = self.replace('type = "springs"\nK_n = 2e8\n', 'type = "sdm"\nK_n = 1e6\nF_u = 1e5\nG_f = 100\nF_c = -1e3\n')
        done = self.uplift("check", self.write(text).name, expect=2)
        # K > F_u^2/G_f = 1e8 Pa/m: the inequality with both numbers
        self.assertRegex(done.stderr, r"^error: case\.toml:\d+: interface\[0\]\.law\.K_n: expected .*F_u.*G_f.*1e\+?0?8")
        self.assertRegex(done.stderr, r"found .*1e\+?0?6|found 1000000")

    def test_negative_step(self):
        text = self.replace("step = 1e-3", "step = -1e-3")
        self.refused(text, f'{{file}}:{line_of(text, "step = -")}: stage[1].step: expected a time > 0 s, found -0.001 s')

    def test_step_longer_than_the_stage(self):
        text = self.replace("step = 1e-3", "step = 1")
        self.refused(text, f'{{file}}:{line_of(text, "step = 1")}: stage[1].step: expected a step shorter than the duration of 0.5 s, found 1 s')

    def test_mechanism_names_the_loose_body(self):
        text = self.replace('[[support]]\nnode = "base"\nfixed = ["ux"]\n', "")
        done = self.uplift("check", self.write(text).name, expect=2)
        self.assertIn('"base"', done.stderr)
        self.assertIn("move", done.stderr)

    def test_interface_inside_out(self):
        text = self.replace("points = 11\n", "points = 11\nnormal = [0, -1]\n")
        done = self.uplift("check", self.write(text).name, expect=2)
        self.assertRegex(done.stderr, r"^error: case\.toml:\d+: ")
        self.assertIn("soil", done.stderr)

    def test_no_stage(self):
        text = BASE[: BASE.index("[[stage]]")]
        self.refused(text, "{file}: expected at least one [[stage]], found none")

    def test_newton_with_a_cone(self):
        text = self.replace('[interface.law]\ntype = "springs"\nK_n = 2e8\n', 'law = "unilateral"\n') .replace('title = "test"\n', 'title = "test"\nmethod = "newton"\n')
        text = text.replace('law = "unilateral"\n', "").replace('name = "soil"\n', 'name = "soil"\nlaw = "unilateral"\n')
        self.refused(text, f'{{file}}:{line_of(text, "newton")}: method: expected a method for cones (penalty, augmented_lagrangian, lagrange), or a traction law, '
                           'found "newton" with a cone')

    def test_path_average_with_another_scheme(self):
        text = self.replace("step = 1e-3", 'step = 1e-3\nscheme = "hht"\ntraction = "path"')
        self.refused(text, f'{{file}}:{line_of(text, "traction = ")}: stage[1].traction: expected traction = "end" with this scheme (the path average belongs to the '
                           'average acceleration), found "path"')

    def test_mass_and_tuned_frequency(self):
        text = self.replace("mass = 24317\n", 'mass = 24317\ntuned_frequency = "10 Hz"\n')
        self.refused(text, f'{{file}}:{line_of(text, "tuned")}: mass[0].tuned_frequency: expected either mass or tuned_frequency, found both')

    def test_every_variant_is_checked(self):
        text = BASE + '[[variant]]\nname = "a"\n[[variant]]\nname = "b"\nlaw = "unilateral"\nmethod = "newton"\n'
        done = self.uplift("check", self.write(text).name, expect=2)
        self.assertRegex(done.stderr, r"variant\[1\]\.method")

    def test_compared_columns_must_exist(self):
        text = BASE + '[compare]\nagree_on = ["top.uxx"]\n'
        self.refused(text, f'{{file}}:{line_of(text, "agree_on")}: compare.agree_on: expected the name of a column of the output, found "top.uxx" (did you mean "top.ux"?)')

    def test_a_record_in_an_unlikely_unit_is_told(self):
        for peak, unit, asked in ((0.3, "m/s2", "in g"), (0.3, "cm/s2", "in g"), (3, "g", "in m/s2"), (3, "cm/s2", "in m/s2"),
                                  (300, "m/s2", "in cm/s2"), (300, "g", "in cm/s2"), (3, "m/s2", ""), (0.3, "g", ""), (300, "cm/s2", ""),
                                  (0.05, "g", ""), (50, "cm/s2", ""), (0.02, "m/s2", "")):
            (self.folder / "a.txt").write_text("".join(f"{0.01 * i:.2f} {peak * math.sin(0.5 * i)}\n" for i in range(100)))
            text = shaken("a.txt").replace('file = "a.txt"\n', f'file = "a.txt"\nunit = "{unit}"\n')
            out = self.uplift("check", self.write(text).name).stdout
            self.assertEqual(f"case.toml:{line_of(text, 'unit = ')}: in this unit the record" in out, asked != "", out)
            self.assertIn(f"are its numbers {asked}?" if asked else "", out)

    def test_a_length_in_the_plane_is_refused(self):
        text = """title = "block"
[mesh.soil_box.soil]
width = 8
size = 2
layers = [{ thickness = 4, size = 2 }]
[mesh.soil_box.block]
width = 2
length = "3 m"
height = 2
"""
        self.refused(text, f"{{file}}:{line_of(text, 'length')}: mesh.soil_box.block.length: expected no length in a mesh in the plane (a length of mesh.soil_box.soil makes it one in space), found 3 m")

    def test_variant_names_name_files(self):
        text = BASE + '[[variant]]\nname = "../a"\n'
        done = self.uplift("compare", self.write(text).name, expect=2)
        self.assertIn('"../a"', done.stderr)

    def test_nothing_is_written(self):
        self.write(self.replace("width = 3\n", "width = -3\n"))
        self.uplift("run", "case.toml", expect=2)
        self.assertFalse((self.folder / "out").exists())


class LittleMemory(CliTest):
    def test_a_limited_address_space_ends_in_an_error(self):
        """BLAS wants 134 MB of address space at once, and would ask for it for ever."""
        self.write(BASE)
        codes = []
        for megabytes in range(60, 320, 20):
            def limit(bytes=megabytes * 10**6):
                resource.setrlimit(resource.RLIMIT_AS, (bytes, bytes))

            if self.uplift("--version", expect=None, preexec_fn=limit).returncode != 0:
                continue  # not even its libraries can be loaded
            done = self.uplift("run", "case.toml", "--quiet", expect=None, timeout=30, preexec_fn=limit)
            codes.append(done.returncode)
            if done.returncode != 0:
                self.assertEqual(done.returncode, 3, f"{megabytes} MB: {done.stderr}")
                self.assertRegex(done.stderr, r"(?m)^error: not enough memory\. ")
        if not codes:
            self.skipTest("the program does not start with a limit on its address space (address sanitizer)")
        self.assertEqual((codes[0], codes[-1]), (3, 0))


if __name__ == "__main__":
    main()
