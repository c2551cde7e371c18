"""Reduced models: made, used, stated on every result, refused for another structure."""

from support import *

USES = BASE.replace("bonded = false\n", 'bonded = false\nreduced_model = "case.rom"\n')


class Reduce(CliTest):
    def test_is_made_used_and_stated(self):
        self.write(BASE)
        out = self.uplift("reduce", "case.toml", "--size", "3", "--controls", "2", "-o", "case.rom").stdout
        self.assertIn("3 coordinates for", out)
        self.assertIn("In 2 control runs", out)
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


if __name__ == "__main__":
    main()
