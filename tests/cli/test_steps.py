"""What the verdict says must not depend on the step: example 02 with other steps and schemes, and the script that makes such tables."""

import sys

from support import *

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLE = (ROOT / "examples" / "02_building_on_soil" / "case.toml").read_text()
FORCES = ("max_moment", "max_shear", "max_compression", "min_compression", "max_toe_pressure")


class Steps(CliTest):
    def numbers(self, name, step, scheme="average_acceleration"):
        text = EXAMPLE.replace('step = "2 ms"', f'step = "{step} ms"\nscheme = "{scheme}"')
        self.assertNotEqual(text, EXAMPLE)
        self.write("bonded = false\n" + text, f"{name}/case.toml")
        self.uplift("run", f"{name}/case.toml", "--out", f"{name}/out", "--quiet")
        summary = self.summary(f"{name}/out")
        return summary["verdict"]["interfaces"][0]["numbers"], summary["runs"][0]

    def test_means_over_the_window_converge(self):
        fine, run = self.numbers("fine", 0.25)
        self.assertLess(run["energy_created_share"], 1e-10)
        shipped, _ = self.numbers("shipped", 2)
        decay, run = self.numbers("decay", 2, "energy_decay")
        self.assertLess(run["energy_created_share"], 1e-10)
        self.assertGreater(run["energy_lost"]["value"], 0)
        for name in FORCES:
            reference = fine[name]["value"]
            self.assertAlmostEqual(shipped[name]["value"] / reference, 1, delta=0.02, msg=name)
            self.assertAlmostEqual(decay[name]["value"] / reference, 1, delta=0.01, msg=name)

    def test_the_table_of_an_example(self):
        command = [sys.executable, ROOT / "scripts" / "step_table.py", program(), ROOT / "examples" / "05_bridge_pier" / "case.toml"]
        done = subprocess.run([*command, "--factors", "4,2"], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, 0, done.stderr)
        head, _, *rows = done.stdout.splitlines()
        self.assertEqual(head, "| number | 8 ms | 4 ms | difference |")
        moment = next(row.split("|")[2:5] for row in rows if row.startswith("| underside: max_moment |"))
        # the weight cannot balance more than N b = 29.0 MN m, and uplift begins at a third of it
        for value in moment[:2]:
            self.assertRegex(value, r"^ 2[0-8]\.\d+ MN m $")
        self.assertRegex(moment[2], r"^ (−|\+)?\d\.\d\d % $")


if __name__ == "__main__":
    main()
