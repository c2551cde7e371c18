"""Embedded foundations as a user runs them: underside and walls are one group of the mesh and two interfaces of the results."""
import math

from support import CliTest, main, report_of

CASE = """title = "embedded raft"
bonded = false
[mesh.soil_box]
embedment = 2
[mesh.soil_box.soil]
width = 20
length = 20
size = 4
layers = [{ thickness = 6, size = 2 }]
[mesh.soil_box.raft]
width = 8
height = 4
size = 2
[[solid]]
group = "soil_1"
E = "100 MPa"
poisson = 0.3
density = 1900
[[solid]]
group = "raft"
E = "20 GPa"
poisson = 0.2
density = 2500
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy", "uz"]
[[interface]]
name = "skin"
surface = { group = "interface", lower = ["soil_1"] }
law = { type = "springs", K_n = 1e9, K_t = 5e8, tangential = "coulomb", friction = 0.6 }
[gravity]
acceleration = [0, 0, -9.81]
[[load]]
name = "push"
group = "raft_top"
force = [8e5, 6e5, 0]
[[stage]]
type = "static"
"""


class Embedded(CliTest):
    def test_walls_have_a_table_of_their_own(self):
        self.write(CASE)
        checked = self.uplift("check", "case.toml").stdout
        self.assertRegex(checked, r"interface skin +base, .* area 64 m2")
        self.assertRegex(checked, r"interface skin walls +wall, .* area 64 m2")
        self.uplift("run", "case.toml", "-o", "r")
        verdict = self.summary("r")["verdict"]
        base, walls = verdict["interfaces"]
        self.assertEqual((base["name"], base["role"], walls["name"], walls["role"]), ("skin", "base", "skin walls", "wall"))
        # equilibrium: base and walls carry the push together
        self.assertAlmostEqual(verdict["numbers"]["max_total_shear"]["value"] / math.hypot(8e5, 6e5), 1, places=6)
        share = walls["numbers"]["share_of_horizontal_force"]["value"]
        self.assertTrue(0.05 < share < 0.95, share)
        self.assertGreaterEqual(base["numbers"]["max_shear"]["value"], (1 - share) * 1e6 * (1 - 1e-6))  # the rest of it at least
        self.assertNotIn("max_eccentricity", walls["numbers"])
        report = report_of(self.folder / "r")
        self.assertEqual([each["name"] for each in report["space"]["interfaces"]], ["skin", "skin walls"])

    def test_a_stated_role_is_kept(self):
        self.write(CASE.replace('name = "skin"\n', 'name = "skin"\nrole = "base"\n'))
        self.assertRegex(self.uplift("check", "case.toml").stdout, r"interface skin +base, .* area 128 m2")
        self.write(CASE.replace('name = "skin"\n', 'name = "skin"\nrole = "roof"\n'))
        self.assertIn('interface[0].role', self.uplift("check", "case.toml", expect=2).stderr)


if __name__ == "__main__":
    main()
