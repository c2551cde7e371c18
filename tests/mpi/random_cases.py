"""Random models, each run by `uplift` and by `uplift-mpi` on 1, 2 and 4 ranks: same peaks, energies and verdict. `make test-mpi` takes some of them; all:

    python3 tests/mpi/random_cases.py build/release/uplift [first seed [number of cases]]
"""

import math
import random
import sys
import unittest


def pulse(pick, size):
    """A direction of the ground acceleration and a function of time; `size`: of the space."""
    shape = pick.choice(['{ type = "ricker", frequency = %.2f }' % pick.uniform(2, 6), '{ type = "half_sine", duration = %.3f }' % pick.uniform(0.05, 0.15)])
    along = [pick.uniform(0.4, 1), pick.uniform(-0.6, 0.6), pick.uniform(-0.5, 0.5)][:size]
    direction = [round(each / math.hypot(*along), 4) for each in along]
    return f'''
[[function]]
name = "pulse"
shape = {shape}
[[ground_acceleration]]
name = "earthquake"
direction = {direction}
amplitude = {pick.uniform(2, 9):.3f}
function = "pulse"
'''


def joint(pick):
    """A law or a cone of an interface, with its method."""
    stiffness = 10 ** pick.uniform(9.3, 10.5)
    tangential = pick.choice(['tangential = "bonded"', f'tangential = "coulomb", friction = {pick.uniform(0.4, 0.8):.2f}'])
    springs = f'{{ type = "springs", K_n = {stiffness:.4e}, K_t = {stiffness / 2:.4e}, {tangential} }}'
    kind = pick.random()
    if kind < 0.6:
        return "", springs
    if kind < 0.8:
        return "", springs.replace('"springs"', '"sdm"').replace("K_t", f"F_u = 0, G_f = {pick.uniform(0.05, 0.2):.3f}, F_c = -500, K_t")
    return 'method = "lagrange"\n', f'{{ type = "coulomb", friction = {pick.uniform(0.4, 0.8):.2f} }}'


def on_soil(pick, size):
    """A block, sometimes on a raft, on a mesh of soil in the plane or in space."""
    cell = pick.uniform(1.5, 2.5) if size == 2 else pick.uniform(2.5, 3.2)
    width, depth = pick.uniform(4, 8), pick.uniform(4, 8)
    axes = ["ux", "uy"] if size == 2 else ["ux", "uy", "uz"]
    raft = pick.random() < 0.5
    method, law = joint(pick)
    text = f'''title = "block on soil"
bonded = false
{method}[mesh.soil_box.soil]
width = {4 * width:.3f}
{"" if size == 2 else f"length = {3 * width:.3f}"}
size = {2 * cell:.3f}
[[mesh.soil_box.soil.layers]]
thickness = {depth:.3f}
size = {cell:.3f}
'''
    if raft:
        text += f"[mesh.soil_box.raft]\nwidth = {width + 2:.3f}\nheight = 1.5\nsize = {cell:.3f}\n"
    text += f'''[mesh.soil_box.block]
width = {width:.3f}
height = {pick.uniform(1.2, 2.5) * width:.3f}
size = {cell:.3f}
[[solid]]
group = "soil_1"
shear_wave_speed = {pick.uniform(150, 400):.1f}
poisson = 0.3
density = 1900
[[solid]]
group = "block"
E = {10 ** pick.uniform(8.7, 10):.4e}
poisson = 0.2
density = {pick.uniform(300, 800):.1f}
'''
    if raft:
        text += '[[solid]]\ngroup = "raft"\nE = 3e10\npoisson = 0.2\ndensity = 2500\n'
    sides = ["soil_left", "soil_right"] + (["soil_front", "soil_back"] if size == 3 else [])
    text += f'[[support]]\ngroup = "soil_bottom"\nfixed = {axes}\n'.replace("'", '"')
    for side in sides:
        text += f'[[support]]\ngroup = "{side}"\nfixed = ["{"ux" if side in ("soil_left", "soil_right") else "uy"}"]\n'
    return text + f'''[[interface]]
name = "underside"
law = {law}
surface = {{ group = "interface", lower = ["soil_1"] }}
[gravity]
acceleration = {[0] * (size - 1) + [-9.81]}
[damping]
rayleigh = [{{ frequency = 1, ratio = 0.03 }}, {{ frequency = 8, ratio = 0.03 }}]
'''


def on_footing(pick):
    """A column of many beams on a rigid footing with joints below it."""
    height, width, mass = pick.uniform(4, 9), pick.uniform(2.5, 4), pick.uniform(1e4, 4e4)
    stiffness = 10 ** pick.uniform(7.8, 8.8)
    return f'''title = "column"
bonded = false
[nodes]
top = [0, {height:.3f}]
base = [0, 0]
[[beam]]
name = "column"
nodes = ["base", "top"]
elements = 40
E = 2e10
I = {pick.uniform(0.1, 0.4):.4f}
A = 1.0
density = 2500
[[mass]]
node = "top"
mass = {mass:.1f}
[[rigid]]
name = "footing"
node = "base"
mass = 1e4
inertia = 7500
[[support]]
node = "base"
fixed = ["ux"]
[[interface]]
name = "underside"
[interface.footing]
body = "base"
width = {width:.3f}
points = {pick.randint(5, 25)}
[interface.law]
type = "springs"
K_n = {stiffness:.4e}
[gravity]
acceleration = [0, -9.81]
'''


def case(seed):
    """The case without a solver, and the table of its solver."""
    pick = random.Random(seed)
    kind = pick.choice(["plane", "plane", "space", "footing"])
    size = 3 if kind == "space" else 2
    text = on_footing(pick) if kind == "footing" else on_soil(pick, size)
    text += pulse(pick, size) + f'[[stage]]\ntype = "static"\n[[stage]]\ntype = "dynamic"\nduration = {pick.uniform(0.15, 0.3):.2f}\nstep = {pick.choice([1, 2, 4])}e-3\n'
    options = pick.choice(["", "-ksp_type cg -pc_type jacobi", "-ksp_type cg -pc_type bjacobi -sub_pc_type icc"])
    return text, f'solver = {{ type = "petsc", options = "{options}" }}\n'


if __name__ == "__main__":
    from test_mpi import RandomCases, take_program

    take_program()
    first, count = (int(word) for word in sys.argv[1:] + ["0", "50"][len(sys.argv) - 1:])

    class All(RandomCases):
        seeds = range(first, first + count)

    result = unittest.TextTestRunner(verbosity=1).run(All("test_like_the_program_for_one_process"))
    sys.exit(not result.wasSuccessful())
