#!/usr/bin/env python3
"""How far the forces of random rocking structures still depend on the step that `uplift check` suggests.

    python3 bench/random_steps.py build/release/uplift --set oscillators --count 100

The sets are oscillators and sticks in the plane and buildings in space. A structure of the set and number given is always the same. It
runs at the suggested step h, with its companion, and at h/8; where the forces differ by more than 3 %, it runs at h/8 once more under
ground motion that is stronger by a ten thousandth. Where this alone moves the forces by more than 3 %, the structure is called sensitive: no
step settles what the ground motion, which nobody knows to that precision, does not. The results are one line for each structure and the
counts of docs/guide/choosing_the_joint_and_the_step.md. `--step-factor 2` takes twice the suggested step."""
import argparse
import concurrent.futures
import functools
import json
import math
import pathlib
import random
import re
import shutil
import subprocess
import tempfile

import random_buildings

RECORD = pathlib.Path(__file__).resolve().parents[1] / "tests" / "data" / "records" / "elcentro_akchopra.dat"
FORCES = ("max_moment", "max_shear", "max_compression", "max_toe_pressure")
ACCEPTED = 0.03
STRONGER = 1 + 1e-4
SETS = {"oscillators": "A", "sticks": "B", "buildings": "S"}  # names of the first measurement: they seed the numbers
GRAVITY = 9.81


def joint(draw, width, depth):
    """Method, [[interface]] and whether friction holds the base: springs, SDM or constraints, K_n over four decades."""
    stiffness = 10 ** draw.uniform(7, 11)
    kind = draw.choice(["springs"] * 4 + ["sdm"] * 2 + ["lagrange"])
    points = draw.choice([11, 21, 41])
    rule = draw.choice(["nodal", "midpoint"])
    if kind == "lagrange":
        points = draw.choice([5, 11])
    friction = kind == "springs" and draw.random() < 0.5
    footing = f'body = "base"\nwidth = {width:.4g}\nthickness = {depth:.4g}\npoints = {points}\nrule = "{rule}"\n'
    if kind == "lagrange":
        bed = ""
        if draw.random() < 0.6:
            bed = f"[interface.footing.bed]\nstiffness = {stiffness:.4g}\nmass = {draw.uniform(20, 500):.4g}\n"
        law = 'type = "unilateral"\n'
    elif kind == "sdm":
        strength = 10 ** draw.uniform(2, 4)
        bed = ""
        law = f'type = "sdm"\nK_n = {stiffness:.4g}\nF_u = {strength:.4g}\nG_f = {max(0.1, 1.5e8 / stiffness):.4g}\nF_c = -1e3\n'
    else:
        bed = ""
        law = f'type = "springs"\nK_n = {stiffness:.4g}\n'
        if draw.random() < 0.3:
            law += f"c = {draw.uniform(0.2, 1) * 1e6 * min(1, stiffness / 1e8):.4g}\n"
    if kind != "lagrange":
        shear = f'"coulomb"\nfriction = {draw.uniform(0.3, 0.8):.3f}\nK_t = {0.7 * stiffness:.4g}' if friction else '"none"'
        law += f"tangential = {shear}\n"
    method = 'method = "lagrange"\n' if kind == "lagrange" else ""
    text = f'[[interface]]\nname = "soil"\n[interface.footing]\n{footing}{bed}[interface.law]\n{law}'
    return method, text, friction, f"{kind} {stiffness:.1e} Pa/m"


def motion(draw, pulse, scale, vertical):
    """Functions and ground accelerations, and the duration [s]."""
    if pulse:
        frequency = draw.uniform(0.5, 4)
        ricker = f'{{ type = "ricker", frequency = {frequency:.3g}, delay = {1.2 / frequency:.3g} }}'
        shape = draw.choice([ricker, f'{{ type = "half_sine", duration = {0.5 / frequency:.3g} }}'])
        text, duration = f'[[function]]\nname = "quake"\nshape = {shape}\n', 4 + 1.2 / frequency
    else:
        text, duration = '[[record]]\nname = "quake"\nfile = "quake.dat"\nstep = 0.02\nunit = "g"\n', 8
    for name, direction, amplitude in (("x", [1, 0], scale), ("y", [0, 1], vertical)):
        if amplitude:
            text += f'[[ground_acceleration]]\nname = "{name}"\ndirection = {direction}\namplitude = {amplitude:.4g}\nfunction = "quake"\n'
    return text, duration


def structure(name, number):
    """The text of a case with the words STEP and EVERY, and what it is in a few words."""
    draw = random.Random(f"{SETS[name]}{number}")
    single = name == "oscillators"
    storeys = 1 if single else draw.randint(2, 6)
    height = draw.uniform(4, 12) if single else storeys * draw.uniform(3, 4.5)
    slender = draw.uniform(0.25, 0.6)
    width = 2 * height * slender if single else height * draw.uniform(0.4, 0.9)
    depth = draw.choice([1, width])
    mass = 10 ** draw.uniform(4, 5.5) * (1 if single else 4)
    frequency = 10 ** draw.uniform(0, 1.1) if single else draw.uniform(1, 6)
    footing = mass * draw.uniform(0.15, 0.6)
    storey = height / storeys
    young = 3e10
    inertia = (2 * math.pi * frequency) ** 2 * mass * (1 if single else 0.3) * height**3 / (3 * young)
    method, interface, friction, what = joint(draw, width, depth)
    damping = draw.choice([0, 0.02, 0.05])
    area = f"A = {12 * inertia / (0.3 * height) ** 2:.4g}\n" if draw.random() < 0.7 else ""
    text = f'{method}title = "{name} {number}"\nbonded = false\n[nodes]\nbase = [0, 0]\n'
    text += "".join(f"n{i} = [0, {i * storey:.4g}]\n" for i in range(1, storeys + 1))
    for i in range(storeys):
        below = f"n{i}" if i else "base"
        text += f'[[beam]]\nname = "b{i}"\nnodes = ["{below}", "n{i + 1}"]\nE = {young}\nI = {inertia:.6g}\n{area}'
        text += f'[[mass]]\nnode = "n{i + 1}"\nmass = {mass / storeys:.6g}\n'
        text += f"inertia = {mass / storeys * storey * storey / 12:.4g}\n" if draw.random() < 0.5 else ""
    text += f'[[rigid]]\nname = "footing"\nnode = "base"\nmass = {footing:.6g}\ninertia = {footing * width**2 / 12:.6g}\n'
    if not friction:
        text += '[[support]]\nnode = "base"\nfixed = ["ux"]\n'
    text += f"{interface}[gravity]\nacceleration = [0, {-GRAVITY}]\n"
    pulse = single and draw.choice(["pulse", "quake"]) == "pulse"
    if single:
        scale, vertical = (GRAVITY * slender * draw.uniform(0.8, 3) if pulse else draw.uniform(0.3, 1.5)), 0
    else:
        scale = draw.uniform(0.3, 1.6)
        vertical = draw.choice([0, 0.5, 1]) * scale * 0.6
    ground, duration = motion(draw, pulse, scale, vertical)
    text += ground
    if damping:
        second = f", {{ frequency = {10 * frequency:.4g}, ratio = {damping} }}" if draw.random() < 0.5 else ""
        text += f"[damping]\nrayleigh = [{{ frequency = {frequency:.4g}, ratio = {damping} }}{second}]\n"
    text += f'[[stage]]\ntype = "static"\n[[stage]]\ntype = "dynamic"\nduration = {duration:.4g}\nstep = STEP\n'
    text += "[output]\nframes = 0\nevery = EVERY\nenergies = false\n"
    return text, f"{what}, damping {damping}, {'pulse' if pulse else 'El Centro'}"


def stronger(text):
    """The same case under slightly stronger ground motion."""
    return re.sub(r"(?<=^amplitude = )\S+", lambda found: f"{float(found.group()) * STRONGER:.9g}", text, flags=re.M)


def shorter(text, most):
    """The same case with a dynamic stage of at most so many seconds."""
    return re.sub(r"(?<=^duration = )\S+", lambda found: f"{min(float(found.group()), most):.6g}", text, flags=re.M)


def write(folder, text, step):
    every = max(1, round(2e-3 / step))
    (folder / "case.toml").write_text(text.replace("STEP", f"{step:.12g}").replace("EVERY", str(every)))


def run(program, folder, text, step, companion=False):
    """How the run ended, its forces, and whether its companion calls it converged."""
    write(folder, text, step)
    command = [program, "run", folder, "--out", folder / "out", "--quiet"] + ([] if companion else ["--no-step-check"])
    shutil.rmtree(folder / "out", ignore_errors=True)
    subprocess.run(command, capture_output=True)
    summary = json.loads((folder / "out" / "summary.json").read_text())
    numbers = summary["verdict"]["interfaces"][0]["numbers"]
    converged = summary["verdict"]["step_check"]["result"] == "converged"
    return summary["runs"][0]["status"], [numbers[name]["value"] if name in numbers else 0 for name in FORCES], converged


def difference(first, second):
    """The largest relative difference of a force; 1 where one run ends in another way than the other."""
    if first[0] != second[0]:
        return 1
    return max(abs(a - b) / max(abs(a), abs(b), 1e-300) for a, b in zip(first[1], second[1]))


def examine(program, name, factor, duration, number):
    text, what = random_buildings.structure(number) if name == "buildings" else structure(name, number)
    text = shorter(text, duration)
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        shutil.copy(RECORD, folder / "quake.dat")
        write(folder, text, 1e-3)
        checked = subprocess.run([program, "check", folder, "--json"], capture_output=True, text=True, check=True)
        step = factor * json.loads(checked.stdout)["suggested_step"]
        first, eighth = run(program, folder, text, step, True), run(program, folder, text, step / 8)
        off = difference(first, eighth)
        sensitive = off > ACCEPTED and difference(eighth, run(program, folder, stronger(text), step / 8)) > ACCEPTED
    return number, what, step, off, sensitive, first[2]


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("program", type=pathlib.Path)
    options.add_argument("--set", choices=SETS, default="oscillators")
    options.add_argument("--first", type=int, default=0)
    options.add_argument("--count", type=int, default=100)
    options.add_argument("--step-factor", type=float, default=1)
    options.add_argument("--duration", type=float, default=math.inf, help="of the dynamic stages at most [s]")
    options.add_argument("--jobs", type=int, default=2)
    given = options.parse_args()
    work = functools.partial(examine, given.program.resolve(), given.set, given.step_factor, given.duration)
    counts = dict.fromkeys(("within 3 %", "within 3 %, not converged", "off, not converged", "off, converged", "sensitive"), 0)
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        for number, what, step, off, sensitive, converged in pool.map(work, range(given.first, given.first + given.count)):
            said = "converged" if converged else "not converged"
            print(f"{number:4} {1e3 * step:6g} ms {100 * off:5.1f} %{' sensitive' if sensitive else ''}, {said}: {what}", flush=True)
            counts["within 3 %"] += off <= ACCEPTED
            counts["sensitive"] += sensitive
            key = ("within 3 %, " if off <= ACCEPTED else "off, ") + said
            counts[key] = counts.get(key, 0) + 1
    print(", ".join(f"{key}: {value}" for key, value in counts.items()))


main()
