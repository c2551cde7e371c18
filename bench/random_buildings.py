"""Random buildings in space for bench/random_steps.py: sticks of one to three storeys whose masses stand beside their axis, some with a piece of
equipment, on rafts that lift off and slide under three components of El Centro."""
import math
import random


def beams(draw, positions, mass, frequency):
    """The columns of the storeys; bending stiffness for `frequency` [Hz], some inextensible, some with mass or shear."""
    storeys, height, young = len(positions) - 1, positions[-1][2], 3e10
    inertia = (2 * math.pi * frequency) ** 2 * mass * storeys * 0.4 * height**3 / (3 * young)
    area = 12 * inertia / (0.3 * height) ** 2
    text = ""
    for i in range(1, storeys + 1):
        below = f"n{i - 1}" if i > 1 else "base"
        text += f'[[beam]]\nname = "b{i}"\nnodes = ["{below}", "n{i}"]\nE = {young}\npoisson = 0.2\nelements = {draw.choice([1, 1, 2])}\n'
        text += "".join(f"{name} = {inertia * draw.uniform(0.5, 2):.6g}\n" for name in ("I_y", "I_z", "J"))
        if draw.random() < 0.75:
            text += f"A = {area:.6g}\n"
            text += f'mass = "consistent"\ndensity = {0.1 * mass / area / 4:.4g}\n' if draw.random() < 0.4 else ""
            text += f'theory = "timoshenko"\nshear_area = {area / 2:.6g}\n' if draw.random() < 0.3 else ""
    return text


def floors(draw, positions, mass):
    """Rigid floors whose centre is up to a metre beside the axis, or masses of nodes."""
    text = ""
    for i, (x, y, z) in enumerate(positions[1:], 1):
        if draw.random() < 0.5:
            centre = [round(x + draw.uniform(-1, 1), 3), round(y + draw.uniform(-1, 1), 3), z]
            text += f'[[rigid]]\nnode = "n{i}"\nname = "floor{i}"\nmass = {mass:.6g}\ninertias = {[3 * mass, 4 * mass, 6 * mass]}\ncentre = {centre}\n'
        else:
            text += f'[[mass]]\nnode = "n{i}"\nmass = {mass:.6g}\n' + (f"inertia = {2 * mass:.6g}\n" if draw.random() < 0.7 else "")
    return text


def equipment(draw, top, mass):
    """A mass on three springs beside the top, with 2 % of damping."""
    light, frequency = mass * draw.uniform(0.002, 0.05), draw.uniform(2, 15)
    stiffness = (2 * math.pi * frequency) ** 2 * light
    text = f'[[mass]]\nnode = "eq"\nmass = {light:.6g}\n[[support]]\nnode = "eq"\nfixed = ["rx", "ry", "rz"]\n'
    for name, direction in (("x", [1, 0, 0]), ("y", [0, 1, 0]), ("z", [0, 0, 1])):
        ends = f'nodes = ["{top}", "eq"]\ndirection = {direction}\n'
        text += f'[[spring]]\nname = "s{name}"\n{ends}stiffness = {stiffness:.6g}\n'
        text += f'[[dashpot]]\nname = "d{name}"\n{ends}damping = {0.04 * math.sqrt(stiffness * light):.6g}\n'
    return text


def raft(draw, width, length, mass):
    """Method, the raft on its joint and what that is in a few words: springs and SDM with and without friction, constraints without."""
    stiffness = 10 ** draw.uniform(7, 11)
    kind = draw.choice(["springs"] * 4 + ["sdm", "lagrange"])
    friction = kind != "lagrange" and draw.random() < 0.7
    points, across = (3, 3) if kind == "lagrange" else (draw.choice([4, 6, 10]), draw.choice([4, 6, 8]))
    inertias = [round(mass * square / 12, 3) for square in (length**2, width**2, length**2 + width**2)]
    text = f'[[rigid]]\nname = "raft"\nnode = "base"\nmass = {mass:.6g}\ninertias = {inertias}\n'
    text += f'[[interface]]\nname = "soil"\n[interface.footing]\nbody = "base"\nwidth = {width:.4g}\nlength = {length:.4g}\npoints = {points}\n'
    text += f'points_across = {across}\nrule = "{draw.choice(["nodal", "midpoint"])}"\nazimuth = {draw.choice([0, 0, 0.3])}\n'
    if kind == "lagrange":
        text += f"[interface.footing.bed]\nstiffness = {stiffness:.4g}\nmass = {draw.uniform(20, 500):.4g}\n"
        text += '[interface.law]\ntype = "unilateral"\n'
    else:
        text += f'[interface.law]\ntype = "{kind}"\nK_n = {stiffness:.4g}\n'
        text += f"F_u = {10 ** draw.uniform(2, 4):.4g}\nG_f = {max(0.1, 1.5e8 / stiffness):.4g}\nF_c = -1e3\n" if kind == "sdm" else ""
        shear = f'"coulomb"\nfriction = {draw.uniform(0.3, 0.8):.3f}\nK_t = {0.7 * stiffness:.4g}' if friction else '"none"'
        text += f"tangential = {shear}\n"
    if not friction:
        text += '[[support]]\nnode = "base"\nfixed = ["ux", "uy", "rz"]\n'
    return 'method = "lagrange"\n' if kind == "lagrange" else "", text, f"{kind} {stiffness:.1e} Pa/m{' with friction' if friction else ''}"


def structure(number):
    """The text of a case with the words STEP and EVERY, and what it is in a few words."""
    draw = random.Random(f"S{number}")
    storeys = draw.randint(1, 3)
    positions = [(0, 0, 0)]
    for _ in range(storeys):
        positions.append((round(draw.uniform(-0.6, 0.6), 3), round(draw.uniform(-0.6, 0.6), 3), round(positions[-1][2] + draw.uniform(3, 5), 3)))
    width = positions[-1][2] * draw.uniform(0.3, 0.8) + 0.5
    length = width * draw.uniform(0.6, 1.5)
    mass, frequency = 10 ** draw.uniform(4, 5.5), draw.uniform(1.5, 8)
    nodes = "".join(f"n{i} = {list(place)}\n" for i, place in enumerate(positions) if i)
    text = beams(draw, positions, mass, frequency) + floors(draw, positions, mass)
    if draw.random() < 0.4:
        x, y, z = positions[-1]
        nodes += f"eq = {[x + 1, y, z + 0.5]}\n"
        text += equipment(draw, f"n{storeys}", mass)
    method, joint, what = raft(draw, width, length, mass * draw.uniform(0.3, 1.2))
    text += joint + "[gravity]\nacceleration = [0, 0, -9.81]\n"
    text += '[[record]]\nname = "quake"\nfile = "quake.dat"\nstep = 0.02\nunit = "g"\n'
    scale = draw.uniform(0.4, 1.7)
    for name, direction, amplitude in (
        ("x", [1, 0, 0], scale),
        ("y", [0, 1, 0], scale * draw.uniform(-1, 1)),
        ("z", [0, 0, 1], scale * draw.choice([0, 0.4, 0.7])),
    ):
        if amplitude:
            text += f'[[ground_acceleration]]\nname = "{name}"\ndirection = {direction}\namplitude = {amplitude:.4g}\nfunction = "quake"\n'
    damping = draw.choice([0, 0.02, 0.05])
    if damping:
        second = f", {{ frequency = {10 * frequency:.4g}, ratio = {damping} }}" if draw.random() < 0.5 else ""
        text += f"[damping]\nrayleigh = [{{ frequency = {frequency:.4g}, ratio = {damping} }}{second}]\n"
    text += '[[stage]]\ntype = "static"\n[[stage]]\ntype = "dynamic"\nduration = 5\nstep = STEP\n'
    text += "[output]\nframes = 0\nevery = EVERY\nenergies = false\n"
    return f'{method}title = "building {number}"\nbonded = false\n[nodes]\nbase = [0, 0, 0]\n{nodes}{text}', f"{what}, damping {damping}, {storeys} storeys"
