"""Fields of a run ([output.fields]): judged by a reader of its own, against closed forms and against the histories of the same run."""

import base64
import csv
import signal
import struct
import time
import xml.etree.ElementTree as xml

from support import *


def array_of(element):
    """Tuples of a <DataArray>: inline base64 of a length (8 bytes) and the numbers."""
    code, size = {"Float32": ("f", 4), "Float64": ("d", 8), "Int32": ("i", 4), "UInt8": ("B", 1)}[element.get("type")]
    data = base64.b64decode(element.text)
    (length,) = struct.unpack_from("<Q", data)
    assert len(data) == 8 + length
    numbers = struct.unpack_from(f"<{length // size}{code}", data, 8)
    width = int(element.get("NumberOfComponents"))
    assert len(numbers) == width * int(element.get("NumberOfTuples"))
    return [numbers[i : i + width] for i in range(0, len(numbers), width)]


class Block:
    """One .vtu file: points, cells (lists of nodes), fields of points and of cells."""

    def __init__(self, path):
        piece = xml.parse(path).getroot().find("UnstructuredGrid").find("Piece")
        arrays = lambda part: {array.get("Name"): array_of(array) for array in piece.find(part)}
        self.points = array_of(piece.find("Points")[0])
        cells = arrays("Cells")
        ends = [end for (end,) in cells["offsets"]]
        nodes = [node for (node,) in cells["connectivity"]]
        self.cells = [nodes[a:b] for a, b in zip([0] + ends, ends)]
        self.at_points, self.at_cells = arrays("PointData"), arrays("CellData")

    def point(self, x, y):
        (found,) = [i for i, at in enumerate(self.points) if abs(at[0] - x) + abs(at[1] - y) < 1e-9]
        return found


def frames_of(path):
    """The frames of a .pvd in its order: time, blocks by name."""
    frames = []
    for entry in xml.parse(path).getroot().iter("DataSet"):
        when = float(entry.get("timestep"))
        if not frames or frames[-1][0] != when:
            frames.append((when, {}))
        frames[-1][1][entry.get("name")] = Block(path.parent / entry.get("file"))
    return frames


def size_of(folder):
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


# Soil from -4 m to 0 and a block of the same width on it, to 3 m: nothing moves sideways.
COLUMN = """\
title = "column"
bonded = false
[mesh.soil_box]
cell = "quad8"
[mesh.soil_box.soil]
width = 3
size = 1
layers = [{ thickness = 4, size = 1 }]
[mesh.soil_box.block]
width = 3
height = 3
size = 1
[[solid]]
group = "soil_1"
E = 5e7
poisson = 0.3
density = 1900
[[solid]]
group = "block"
E = 2e9
poisson = 0.2
density = 700
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[[support]]
group = "soil_left"
fixed = ["ux"]
[[support]]
group = "soil_right"
fixed = ["ux"]
[[support]]
group = "block_left"
fixed = ["ux"]
[[support]]
group = "block_right"
fixed = ["ux"]
[[interface]]
name = "joint"
surface = { group = "interface", lower = ["soil_1"] }
[interface.law]
type = "springs"
K_n = 1e10
K_t = 1e10
tangential = "coulomb"
friction = 0.5
[gravity]
acceleration = [0, -10]
[[stage]]
type = "static"
[output.fields]
precision = "float64"
"""

# A block that rocks on soil under a pulse at its roof, until it has lifted off and come down.
ROCKING = """\
title = "rocking"
bonded = false
[mesh.soil_box.soil]
width = 30
size = 3
layers = [{ thickness = 8, size = 2 }]
[mesh.soil_box.block]
width = 8
height = 16
size = 2
[[solid]]
group = "soil_1"
shear_wave_speed = 250
poisson = 0.3
density = 1900
[[solid]]
group = "block"
E = 2e9
poisson = 0.2
density = 400
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[[support]]
group = "soil_left"
fixed = ["ux"]
[[support]]
group = "soil_right"
fixed = ["ux"]
[[interface]]
name = "joint"
surface = { group = "interface", lower = ["soil_1"] }
[interface.law]
type = "springs"
K_n = 1e10
K_t = 5e9
tangential = "coulomb"
friction = 0.7
[gravity]
acceleration = [0, -9.81]
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.2 }
[[load]]
name = "pulse"
group = "block_top"
force = [1.5e5, 0]
function = "pulse"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.5
step = 2e-3
[[output.history]]
node = "top"
quantity = "ay"
"""


class Static(CliTest):
    def test_stress_of_a_confined_column_is_its_weight(self):
        self.write(COLUMN)
        self.uplift("run", "case.toml", "-o", "r")
        ((when, blocks),) = frames_of(self.folder / "r/fields/run.pvd")
        self.assertEqual(when, 0)
        self.assertEqual(set(blocks), {"soil_1", "block", "interfaces"})
        weight_of_block = 700 * 10 * 3
        for name, poisson, stress_yy in (
            ("block", 0.2, lambda y: -700 * 10 * (3 - y)),
            ("soil_1", 0.3, lambda y: -weight_of_block + 1900 * 10 * y),
        ):
            block = blocks[name]
            heights = set()
            for at, (xx, yy, zz, xy, yz, xz) in zip(block.points, block.at_points["stress [Pa]"]):
                heights.add(round(at[1], 9))
                self.assertAlmostEqual(yy / weight_of_block, stress_yy(at[1]) / weight_of_block, places=8)
                across = poisson / (1 - poisson) * stress_yy(at[1])
                self.assertAlmostEqual(xx / weight_of_block, across / weight_of_block, places=8)
                self.assertAlmostEqual(zz / weight_of_block, across / weight_of_block, places=8)
                self.assertLess(max(abs(xy), abs(yz), abs(xz)), 1e-7 * weight_of_block)
            self.assertGreater(len(heights), 6)
            for quantity in ("velocity [m/s]", "acceleration [m/s2]"):
                self.assertEqual(set(block.at_points[quantity]), {(0, 0, 0)})
        # displacement of the soil: integral of the strain from the fixed bottom
        constrained = 5e7 * 0.7 / (1.3 * 0.4)
        soil = blocks["soil_1"]
        for at, (ux, uy, uz) in zip(soil.points, soil.at_points["displacement [m]"]):
            wanted = -(weight_of_block * (at[1] + 4) + 1900 * 10 * (16 - at[1] ** 2) / 2) / constrained
            self.assertAlmostEqual(uy * 1e3, wanted * 1e3, places=9)
            self.assertEqual(uz, 0)
        joint = blocks["interfaces"].at_points
        for opening, traction, pressure, status in zip(*(joint[n] for n in ("opening [m]", "traction [Pa]", "pressure [Pa]", "status"))):
            self.assertAlmostEqual(pressure[0] / weight_of_block, 1, places=8)
            self.assertAlmostEqual(traction[1] / weight_of_block, -1, places=8)
            self.assertAlmostEqual(opening[0] / (-weight_of_block / 1e10), 1, places=8)
            self.assertEqual(status, (1,))

    def test_each_static_stage_has_a_frame(self):
        self.write(COLUMN.replace('[output.fields]', '[[stage]]\ntype = "static"\n[output.fields]'))
        self.uplift("run", "case.toml", "-o", "r")
        self.assertEqual([when for when, blocks in frames_of(self.folder / "r/fields/run.pvd")], [-1, 0])


# A mast of 8 m of four lines, the first of which is drawn downwards.
MAST = """\
title = "mast"
bonded = false
[mesh]
file = "mast.msh"
[[beam]]
name = "mast"
group = "mast lines"
elements = 2
E = 3e10
poisson = 0.2
I = 0.02
A = 0.3
mass = "consistent"
density = 2500
[[support]]
node = "foot"
fixed = ["ux", "uy", "rz"]
[[load]]
node = "tip"
force = [3e4, 0]
[gravity]
acceleration = [0, -10]
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.1
step = 0.01
[output.fields]
precision = "float64"
"""
MAST_MESH = """\
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
0 2 "foot"
0 3 "tip"
1 1 "mast lines"
$EndPhysicalNames
$Nodes
5
1 0 0 0
2 0 2 0
3 0 4 0
4 0 6 0
5 0 8 0
$EndNodes
$Elements
6
1 15 2 2 1 1
2 15 2 3 2 5
3 1 2 1 1 2 1
4 1 2 1 1 2 3
5 1 2 1 1 3 4
6 1 2 1 1 4 5
$EndElements
"""


class Beams(CliTest):
    def test_section_forces_of_a_mast(self):
        """A load of 30 kN across its tip, and its own weight of 7.5 kN/m: the same at rest and in a dynamic stage where nothing moves."""
        self.write(MAST_MESH, "mast.msh")
        for elements in (1, 2, 3):
            self.write(MAST.replace("elements = 2", f"elements = {elements}"))
            self.uplift("run", "case.toml", "-o", "r")
            frames = frames_of(self.folder / "r/fields/run.pvd")
            self.assertGreater(len(frames), 5)
            for when, blocks in frames:
                mast = blocks["mast lines"]
                for k, (a, b) in enumerate(mast.cells):
                    height = (mast.points[a][1] + mast.points[b][1]) / 2
                    sign = 1 if mast.points[b][1] > mast.points[a][1] else -1
                    at = {name: value[k][0] for name, value in mast.at_cells.items()}
                    self.assertAlmostEqual(at["axial [N]"], -7500 * (8 - height), delta=1e-6)
                    self.assertAlmostEqual(at["shear [N]"], -3e4, delta=1e-6)
                    self.assertAlmostEqual(at["moment [N m]"], -sign * 3e4 * (8 - height), delta=1e-6)

    def test_section_forces_can_be_left_out(self):
        self.write(MAST_MESH, "mast.msh")
        self.write(MAST.replace("[output.fields]", '[output.fields]\nquantities = ["displacement"]'))
        self.uplift("run", "case.toml", "-o", "r")
        for when, blocks in frames_of(self.folder / "r/fields/run.pvd"):
            self.assertEqual(set(blocks["mast lines"].at_cells), {"group"})


class Dynamic(CliTest):
    def run_it(self, fields, *, extra="", command=("run", "case.toml", "-o", "r")):
        self.write(ROCKING + extra + "[output.fields]\n" + fields)
        self.told = json.loads(self.uplift("check", "--json", "case.toml").stdout)["fields"]
        self.done = self.uplift(*command)
        with open(self.folder / "r" / "histories.csv", newline="") as file:
            head, *rows = csv.reader(file)
        names = [name.split(" ")[0] for name in head]
        self.history = {float(row[0]): dict(zip(names, map(float, row))) for row in rows}

    def near(self, when):
        return self.history[min(self.history, key=lambda time: abs(time - when))]

    def test_frames_agree_with_the_histories(self):
        self.run_it('precision = "float64"\n')
        frames = frames_of(self.folder / "r/fields/run.pvd")
        self.assertEqual(len(frames), self.told["frames"])
        every = 3  # 250 steps in about a hundred frames
        self.assertEqual([round(when / 2e-3) for when, blocks in frames], [*range(0, 250, every), 250])
        at_top = lambda blocks, quantity: blocks["block"].at_points[quantity][blocks["block"].point(0, 16)]
        opened = slipping = 0
        for when, blocks in frames:
            row = self.near(when)
            close = lambda a, b, scale: self.assertLess(abs(a - b), 1e-8 * max(scale, abs(b)), when)
            for k, letter in enumerate("xy"):
                close(at_top(blocks, "displacement [m]")[k], row["top.u" + letter], 0.01)
            close(at_top(blocks, "velocity [m/s]")[0], row["top.vx"], 0.1)
            close(at_top(blocks, "acceleration [m/s2]")[1], row["top.ay"], 1)
            joint = blocks["interfaces"]
            values = lambda name: joint.at_points[name]
            normal = shear = moment = 0
            widest = 0
            for cell, (side,) in zip(joint.cells, joint.at_cells["side"]):
                a, b = cell
                length = abs(joint.points[b][0] - joint.points[a][0])  # thickness 1 m
                if side == 0:
                    for end, other in ((a, b), (b, a)):
                        # of the trapezoid, so that the moment is that of forces at the nodes
                        normal += length / 2 * -values("pressure [Pa]")[end][0]
                        shear += length / 2 * values("traction [Pa]")[end][0]
                        moment += length / 2 * joint.points[end][0] * -values("pressure [Pa]")[end][0]
                for end in cell:
                    gap, status = values("opening [m]")[end][0], values("status")[end][0]
                    widest = max(widest, gap)
                    self.assertEqual(status == 0, gap > 1e-9)
                    opened += status == 0
                    slipping += status == 2
                    self.assertAlmostEqual(values("traction [Pa]")[end][1], -values("pressure [Pa]")[end][0], delta=1e-6)
                    if status == 2:
                        self.assertAlmostEqual(abs(values("traction [Pa]")[end][0]), 0.7 * values("pressure [Pa]")[end][0], delta=1)
            close(normal, row["joint.axial"], 1e6)
            close(shear, row["joint.shear"], 1e6)
            close(moment, row["joint.moment"], 1e6)
            close(widest, row["joint.max_opening"], 0.01)
            # the faces part by the opening: the displacement of the upper one less that of the lower one
            lower, upper = {}, {}
            for cell, (side,) in zip(joint.cells, joint.at_cells["side"]):
                for end in cell:
                    (upper if side else lower)[round(joint.points[end][0], 6)] = end
            u = values("displacement [m]")
            for x in lower:
                close(u[upper[x]][1] - u[lower[x]][1], values("opening [m]")[upper[x]][0], 0.01)
                close(u[upper[x]][0] - u[lower[x]][0], values("slip [m]")[lower[x]][0], 0.01)
        self.assertGreater(opened, 50)

    def test_sizes_are_as_foreseen(self):
        for format, list_name in (("vtu", "run.pvd"), ("xdmf", "run.xdmf")):
            for precision in ("float32", "float64"):
                self.run_it(f'format = "{format}"\nprecision = "{precision}"\nevery = 10\n', command=("run", "case.toml", "-o", "r"))
                self.assertEqual(self.told["frames"], 26)
                self.assertEqual(self.told["format"], format)
                self.assertIn(f"fields: r/fields/{list_name}", self.done.stdout)
                size = size_of(self.folder / "r/fields")
                self.assertLess(abs(size / self.told["bytes"] - 1), 0.02, (format, precision, size, self.told))

    def test_xdmf_lists_every_frame(self):
        self.run_it('format = "xdmf"\nevery = 50\n')
        grids = xml.parse(self.folder / "r/fields/run.xdmf").getroot().find("Domain").find("Grid")
        self.assertEqual([round(float(grid.find("Time").get("Value")) / 2e-3) for grid in grids], [0, 50, 100, 150, 200, 250])
        items = {item.text for item in grids.iter("DataItem")}
        self.assertTrue(all(item.startswith("./run.h5:/") for item in items))
        self.assertIn("./run.h5:/frames/000005/interfaces/points/pressure", items)
        self.assertTrue((self.folder / "r/fields/run.h5").read_bytes().startswith(b"\x89HDF"))

    def test_events(self):
        self.run_it('events = true\nquantities = ["displacement"]\ngroups = ["block"]\nprecision = "float64"\n')
        frames = frames_of(self.folder / "r/fields/run.pvd")
        run = self.summary("r")["runs"][0]
        wanted = sorted({run["first_uplift"], run["max_opening"]["time"], run["max_step_pressure"]["time"], 0.5})
        self.assertEqual(len(wanted), 4)
        self.assertEqual(len(frames), 4)
        for (when, blocks), time in zip(frames, wanted):
            self.assertAlmostEqual(when, time, places=9)
            self.assertEqual(set(blocks), {"block", "interfaces"})
            self.assertEqual(list(blocks["block"].at_points), ["displacement [m]"])
        at = lambda time: next(blocks["interfaces"].at_points for when, blocks in frames if abs(when - time) < 1e-9)
        gap, pressure = run["max_opening"], run["max_step_pressure"]
        self.assertAlmostEqual(max(at(gap["time"])["opening [m]"])[0] / gap["value"], 1, places=9)
        self.assertAlmostEqual(max(at(pressure["time"])["pressure [Pa]"])[0] / pressure["value"], 1, places=9)
        self.assertEqual(self.told["frames"], 4)

    def test_interrupted_run_leaves_complete_files(self):
        self.write(ROCKING.replace("duration = 0.5", "duration = 500") + '[output.fields]\nformat = "vtu"\nevery = 20\n')
        process = subprocess.Popen([program(), "run", "case.toml", "-o", "r"], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        deadline = time.monotonic() + 60
        while len(list(self.folder.glob("r.part-*/fields/run/block_00001*.vtu"))) < 3 and time.monotonic() < deadline:
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        frames = frames_of(self.folder / "r/fields/run.pvd")
        self.assertEqual({len(blocks) for when, blocks in frames}, {3})
        self.assertEqual(len(frames), len(list((self.folder / "r/fields/run").glob("block_*.vtu"))))
        self.assertAlmostEqual(frames[-1][0], self.summary("r")["runs"][0]["end_time"], places=9)
        self.assertFalse(list(self.folder.glob("r.part-*")))

    def test_compare_writes_fields_only_when_asked(self):
        variant = '[[variant]]\nname = "free"\nlaw = { type = "springs", K_n = 1e10, K_t = 1e10, tangential = "bonded" }\n'
        for asked in ("", "variants = true\n"):
            self.write(ROCKING + variant + "[output.fields]\nevery = 125\n" + asked)
            self.uplift("compare", "case.toml", "-o", "r")
            lists = [path.name for path in (self.folder / "r").glob("fields/*.pvd")]
            self.assertEqual(lists, ["free.pvd"] if asked else [])


class Errors(CliTest):
    def refuse(self, fields, key, message, text=ROCKING):
        text += "[output.fields]\n" + fields
        self.refused(text, f"{{file}}:{line_of(text, key)}: {message}")

    def test_what_is_not_there(self):
        self.refuse('quantities = ["stres"]\n', "quantities =", 'output.fields.quantities: expected "displacement", "velocity", "acceleration", "stress" or "section_forces", found "stres" (did you mean "stress"?)')
        self.refuse('groups = ["blok"]\n', "groups =", 'output.fields.groups: expected "soil_1" or "block", found "blok" (did you mean "block"?)')
        self.refuse("", "[output.fields]", "output.fields: expected a [mesh], on which fields are written, found none", text=BASE)


if __name__ == "__main__":
    main()
