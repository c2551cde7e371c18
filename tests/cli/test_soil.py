"""A building on soil, in plane strain: the example, and a mesh file, as a user runs them."""

from support import *

EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "examples" / "02_building_on_soil" / "case.toml"


def gmsh(columns, rows, base, torn=None):
    """A mesh of Gmsh 2.2: unit squares, the upper ones from row `base` on, with the groups of a soil and a block of the same width. Soil on
    the right of column `torn` has nodes of its own there, but for the surface."""
    node = lambda i, j: 1 + i + j * (columns + 1)
    nodes = [f"{node(i, j)} {i} {j - base} 0" for j in range(rows + 1) for i in range(columns + 1)]
    elements = []
    double = lambda j: (columns + 1) * (rows + 1) + 1 + j
    own = lambda i, j, cell: double(j) if cell == torn and j < base else node(i, j)
    add = lambda kind, group, *ends: elements.append(f"{len(elements) + 1} {kind} 2 {group} {group} " + " ".join(map(str, ends)))
    for i in range(columns):
        add(1, 3, node(i, 0), node(i + 1, 0))
        add(1, 4, node(i, base), node(i + 1, base))
        add(1, 5, node(i, rows), node(i + 1, rows))
    for j in range(rows):
        for i in range(columns):
            add(3, 1 if j < base else 2, own(i, j, i), node(i + 1, j), node(i + 1, j + 1), own(i, j + 1, i))
    nodes += [f"{double(j)} {torn} {j - base} 0" for j in range(base) if torn is not None]
    names = ['2 1 "soil"', '2 2 "block"', '1 3 "bottom"', '1 4 "contact"', '1 5 "roof"']
    parts = [["$MeshFormat", "2.2 0 8", "$EndMeshFormat"], ["$PhysicalNames", str(len(names)), *names, "$EndPhysicalNames"],
             ["$Nodes", str(len(nodes)), *nodes, "$EndNodes"], ["$Elements", str(len(elements)), *elements, "$EndElements"]]
    return "\n".join("\n".join(part) for part in parts) + "\n"


BLOCK = """\
title = "block on a mesh file"
[mesh]
file = "soil.msh"
[[solid]]
group = "soil"
shear_wave_speed = 200
poisson = 0.3
density = 2000
[[solid]]
group = "block"
E = 1e9
poisson = 0.2
density = 500
[[support]]
group = "bottom"
fixed = ["ux", "uy"]
[[interface]]
name = "joint"
[interface.surface]
group = "contact"
lower = ["soil"]
[interface.law]
type = "springs"
K_n = 1e10
tangential = "bonded"
[gravity]
acceleration = [0, -10]
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.1 }
[[load]]
name = "pulse"
group = "roof"
traction = [0, 1]
function = "pulse"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.2
step = 1e-3
"""


class Example(CliTest):
    def test_it_shows_what_it_claims(self):
        self.uplift("run", EXAMPLE, "-o", "r")
        runs = {run["name"]: run for run in self.summary("r")["runs"]}
        self.assertEqual([run["status"] for run in runs.values()], ["completed", "completed"])
        joint, bonded = runs["run"], runs["bonded"]
        share = joint["energy_created"]["value"] / joint["energy_scale"]
        self.assertLess(share, 1e-9)
        self.assertGreater(joint["max_uplifted_ratio"]["value"], 0.5)
        # Without tension the resultant stays in the base, which bounds the moment; bonded it leaves the base, M > W b.
        moment = lambda run: abs(run["max_base_moment"]["value"])
        self.assertLess(moment(joint), 0.7 * moment(bonded))
        self.assertGreater(moment(bonded), 200 * 400 * 9.81 * 5)
        # Its drawing knows what holds in static stages alone, and the faces through which waves leave.
        if (self.folder / "r" / "report.html").exists():
            model = report_of(self.folder / "r")["model"]
            self.assertTrue(model["supports"] and all(support.get("staticsOnly") for support in model["supports"]))
            self.assertEqual([(face["group"], face["incident"], face["freeField"]) for face in model["absorbing"]],
                             [("soil_bottom", True, False), ("soil_left", False, True), ("soil_right", False, True)])
            self.assertAlmostEqual(sum(abs(x2 - x1) for x1, _, x2, _ in model["absorbing"][0]["edges"]), 60, places=3)
        # The report of a mesh stays small: 0.8 MB of it are the page itself.
        self.assertLess((self.folder / "r" / "report.html").stat().st_size, 3.5e6)

    def test_check_tells_of_the_mesh(self):
        told = json.loads(self.uplift("check", "--json", EXAMPLE).stdout)
        self.assertEqual(told["mesh"]["pieces"], 2)
        solids = {solid["group"]: solid for solid in told["mesh"]["solids"]}
        self.assertEqual(set(solids), {"soil_1", "soil_2", "block"})
        for name, speed in (("soil_1", 250), ("soil_2", 400)):
            solid = solids[name]
            self.assertAlmostEqual(solid["shear_wave_speed"], speed, places=6)
            self.assertAlmostEqual(solid["highest_frequency"], speed / (10 * solid["longest_edge"]), places=6)
            self.assertEqual(solid["scaled_jacobian"], 1)
        # the node that stands for a place is named, with its distance
        note = next(note for note in told["notes"] if note.startswith("uy at (8, 0) m: node mesh."))
        x, y, away = map(float, re.search(r"at \((\S+), (\S+)\) m, (\S+) m away", note).groups())
        self.assertAlmostEqual(((x - 8) ** 2 + y ** 2) ** 0.5, away, delta=1e-3)
        self.assertLess(away, solids["soil_1"]["longest_edge"])
        # the dead load is the block alone: 10 x 20 m2 of 400 kg/m3
        self.assertAlmostEqual(told["weight"] / (200 * 400 * 9.81), 1, places=9)


    def test_a_held_face_stops_the_waves_that_move_along_its_held_direction(self):
        text = EXAMPLE.read_text()
        whole = re.search(r'\[\[support\]\]\ngroup = "soil_bottom"\n.*\n.*\n', text).group(0)
        support = '[[support]]\ngroup = "soil_bottom"\nfixed = ["{}"]\nstages = "{}"\n'
        for held, other, stopped in (("uy", "ux", False), ("ux", "uy", True)):
            name = self.write(text.replace(whole, support.format(held, "all") + support.format(other, "static"))).name
            warned = "the incident SV wave, which moves along ux, does not come in there" in self.uplift("check", name).stdout
            self.assertEqual(warned, stopped, held)


class MeshFile(CliTest):
    def run_block(self, text=BLOCK):
        self.write(gmsh(4, 8, 4), "soil.msh")
        return self.write(text)

    def test_run(self):
        self.run_block()
        self.uplift("run", "case.toml", "-o", "r")
        # a traction is drawn as the force that it makes: 1 Pa on the roof of 4 m2
        if (self.folder / "r" / "report.html").exists():
            (loads,) = (chart for chart in report_of(self.folder / "r")["charts"] if chart["id"] == "loads")
            (curve,) = loads["series"]
            self.assertEqual(curve["label"], "pulse, vertical")
            self.assertAlmostEqual(max(curve["y"]), 4, places=3)
        summary = self.summary("r")
        run = summary["runs"][0]
        self.assertEqual(run["status"], "completed")
        # at rest the joint carries the block, 4 x 4 m2 of 500 kg/m3, and the pulse does not open it
        history = (self.folder / "r" / "histories.csv").read_text().splitlines()
        head = next(i for i, line in enumerate(history) if not line.startswith("#"))
        columns = [name.split(" ")[0].strip('"') for name in history[head].split(",")]
        first = next(line for line in history[head + 1:] if line[0].isdigit()).split(",")
        self.assertAlmostEqual(float(first[columns.index("joint.axial")]) / (-16 * 500 * 10), 1, places=7)
        self.assertEqual(run["max_uplifted_ratio"]["value"], 0)

    def test_a_mesh_that_is_torn(self):
        # nodes doubled below the surface, in three rows of cells and in the one that keeps the node of the surface
        self.assertNotIn("torn", self.uplift("check", self.run_block().name).stdout)
        self.write(gmsh(4, 8, 4, torn=2), "soil.msh")
        self.assertIn("the mesh is torn: cells lie side by side and do not share the sides between them, at 4 sides", self.uplift("check", "case.toml").stdout)
        # an interface of the doubled nodes, up to the node that both sides share, is meant; of the two lowest pairs alone it joins one side
        pairs = '[[interface]]\nname = "crack"\n[interface.line]\nlower = [{lower}]\nupper = [{upper}]\n[interface.law]\ntype = "springs"\nK_n = 1e9\nK_t = 1e9\n'
        named = lambda *numbers: ", ".join(f'"mesh.{number}"' for number in numbers)
        for count, said in ((4, None), (2, "at 3 sides")):
            text = pairs.format(lower=named(*range(46 + count - 1, 45, -1)), upper=named(*range(3 + 5 * (count - 1), 2, -5)))
            out = self.uplift("check", self.write(BLOCK + text).name).stdout
            self.assertEqual("torn" in out, said is not None, out)
            self.assertIn(said or "crack", out)

    def test_missing_file(self):
        self.refused(BLOCK, '{file}:3: expected a mesh file (Gmsh .msh or MED), found no file "soil.msh"')

    def test_missing_group(self):
        self.write(gmsh(4, 8, 4), "soil.msh")
        text = BLOCK.replace('group = "bottom"', 'group = "botom"')
        self.refused(text, f'{{file}}:{line_of(text, "botom")}: support[0].group: expected a group of the mesh, found no group "botom" in the mesh (did you mean "bottom"?)')

    def test_surface_elsewhere(self):
        self.write(gmsh(4, 8, 4), "soil.msh")
        text = BLOCK.replace('group = "contact"', 'group = "roof"')
        done = self.uplift("check", self.write(text).name, expect=2)
        self.assertTrue(done.stderr.startswith(f'error: case.toml:{line_of(text, "roof")}: group "roof": expected faces between a cell of the lower side and one of the upper side, found 4 of 4 elsewhere; '), done.stderr)

    def test_both_a_file_and_a_soil_box(self):
        text = BLOCK.replace('file = "soil.msh"', 'file = "soil.msh"\nsoil_box = { soil = { width = 10 }, block = { width = 2, height = 2 } }')
        self.refused(text, "{file}:2: mesh: expected either file or soil_box, found both")


if __name__ == "__main__":
    main()
