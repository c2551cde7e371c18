"""Numbers of the program against solutions written here from the sources, for shapes and frames drawn at random (standard library only)."""
import csv
import random
import re
from math import cos, pi, sin, sqrt

from support import CliTest, main


def pais_kausel(b, l, g, nu, d, f, rho):
    """Static and dynamic stiffness {z, x, y, rx, ry, t} [N/m, N m/rad] of a rigid rectangle 2l x 2b, l >= b [m], x along the long side, at the depth d [m]
    and the frequency f [Hz]. Source: NIST GCR 12-917-21 (2012), tables 2-2a and 2-2b, after Pais & Kausel (1988)."""
    r, depth = l / b, d / b
    a2 = (6.283185307179586 * f * b / sqrt(g / rho)) ** 2
    surface = {
        "z": g * b / (1 - nu) * (3.1 * r**0.75 + 1.6), "y": g * b / (2 - nu) * (6.8 * r**0.65 + 0.8 * r + 1.6),
        "x": g * b / (2 - nu) * (6.8 * r**0.65 + 2.4), "rx": g * b**3 / (1 - nu) * (3.2 * r + 0.8),
        "ry": g * b**3 / (1 - nu) * (3.73 * r**2.4 + 0.27), "t": g * b**3 * (4.25 * r**2.45 + 4.06)}
    swaying = 1 + (0.33 + 1.34 / (1 + r)) * depth**0.8
    embedded = {
        "z": 1 + (0.25 + 0.25 / r) * depth**0.8, "x": swaying, "y": swaying, "rx": 1 + depth + 1.6 / (0.35 + r) * depth**2,
        "ry": 1 + depth + 1.6 / (0.35 + r**4) * depth**2, "t": 1 + (1.3 + 1.32 / r) * depth**0.9}
    dynamic = {
        "z": 1 - (0.4 + 0.2 / r) * a2 / (10 / (1 + 3 * (r - 1)) + a2), "x": 1, "y": 1,
        "rx": 1 - (0.55 + 0.01 * sqrt(r - 1)) * a2 / (2.4 - 0.4 / r**3 + a2), "ry": 1 - 0.55 * a2 / (0.6 + 1.4 / r**3 + a2),
        "t": 1 - (0.33 - 0.03 * sqrt(r - 1)) * a2 / (0.8 / (1 + 0.33 * (r - 1)) + a2)}
    return {key: surface[key] * embedded[key] * dynamic[key] for key in surface}


def gazetas(b, l, g, nu, d, wall):
    """The same after Gazetas (1991), with walls in contact over the height `wall` [m] (NIST GCR 12-917-21, tables 2-2a and 2-2b)."""
    q, sides, middle = b / l, 4 * wall * (b + l), d - wall / 2
    i_x, i_y = 4 * l * b**3 / 3, 4 * b * l**3 / 3
    k_y = 2 * g * l / (2 - nu) * (2 + 2.5 * q**0.85)
    swaying = lambda area: (1 + 0.15 * sqrt(d / b)) * (1 + 0.52 * (middle * sides / area) ** 0.4)
    return {
        "z": 2 * g * l / (1 - nu) * (0.73 + 1.54 * q**0.75) * (1 + d / (21 * b) * (1 + 1.3 * q)) * (1 + 0.2 * (sides / (4 * b * l)) ** (2 / 3)),
        "y": k_y * swaying(b * l * l), "x": (k_y - 0.2 * g * l / (0.75 - nu) * (1 - q)) * swaying(l * b * b),
        "rx": g / (1 - nu) * i_x**0.75 * q**-0.25 * (2.4 + 0.5 * q) * (1 + 1.26 * wall / b * (1 + wall / b * (wall / d) ** -0.2 * sqrt(q))),
        "ry": 3 * g / (1 - nu) * i_y**0.75 * q**-0.15 * (1 + 0.92 * (wall / l) ** 0.6 * (1.5 + (wall / l) ** 1.9 * (wall / d) ** -0.6)),
        "t": g * (i_x + i_y) ** 0.75 * (4 + 11 * (1 - q) ** 10) * (1 + 1.4 * (1 + q) * (wall / b) ** 0.9)}


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = sqrt(sum(value * value for value in a))
    return [value / length for value in a]


def product(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def solved(a, b):
    """Solution of a x = b by elimination with pivots."""
    n, rows = len(b), [row[:] + [value] for row, value in zip(a, b)]
    for i in range(n):
        best = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best] = rows[best], rows[i]
        for k in range(i + 1, n):
            factor = rows[k][i] / rows[i][i]
            if factor:
                rows[k] = [x - factor * y for x, y in zip(rows[k], rows[i])]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (rows[i][n] - sum(rows[i][k] * x[k] for k in range(i + 1, n))) / rows[i][i]
    return x


def beam(start, end, young, nu, area, i_y, i_z, j, up):
    """Stiffness in local axes, rotation into them (12 x 12) and length of an Euler-Bernoulli beam; z lies in the plane of the beam and `up`."""
    x = [b - a for a, b in zip(start, end)]
    length = sqrt(sum(value * value for value in x))
    x = unit(x)
    y = unit(cross(up, x))
    axes = [x, y, cross(x, y)]
    turn = [[axes[i % 3][k % 3] if i // 3 == k // 3 else 0.0 for k in range(12)] for i in range(12)]
    local = [[0.0] * 12 for _ in range(12)]

    def put(places, block):
        for i, row in zip(places, block):
            for k, value in zip(places, row):
                local[i][k] += value

    pair = lambda k: [[k, -k], [-k, k]]
    put((0, 6), pair(young * area / length))
    put((3, 9), pair(young / (2 * (1 + nu)) * j / length))
    for places, inertia, s in (((1, 5, 7, 11), i_z, length), ((2, 4, 8, 10), i_y, -length)):
        k = young * inertia / length**3
        put(places, [[12 * k, 6 * s * k, -12 * k, 6 * s * k], [6 * s * k, 4 * s * s * k, -6 * s * k, 2 * s * s * k],
                     [-12 * k, -6 * s * k, 12 * k, -6 * s * k], [6 * s * k, 2 * s * s * k, -6 * s * k, 4 * s * s * k]])
    return local, turn, length


def bar(k, shape):
    """A bar of one element with consistent mass that hangs on the node "top", which is held but for its motion along the bar: 10 m long, 0.01 m2
    of section, stiffness k [N/m]. The table [[motion]] comes next."""
    return f"""title = "bar"
bonded = false
[nodes]
top = [0, 10]
end = [0, 0]
[[beam]]
name = "bar"
nodes = ["end", "top"]
E = {k * 10 / 0.01}
A = 0.01
I = 1e-6
mass = "consistent"
density = 7850
[[support]]
node = "end"
fixed = ["ux", "rz"]
[[support]]
node = "top"
fixed = ["ux", "rz"]
[output]
frames = 0
[[output.history]]
name = "u"
node = "end"
quantity = "uy"
[[function]]
name = "motion"
shape = {shape}
[[motion]]
node = "top"
direction = "uy"
function = "motion"
"""


class Independent(CliTest):
    def test_stiffness_of_the_ground_after_the_published_formulas(self):
        draw = random.Random(11)
        for i in range(16):
            width, length, g = draw.uniform(3, 20), draw.uniform(3, 20), draw.uniform(2e7, 4e8)
            nu, depth = draw.uniform(0.1, 0.45), draw.uniform(0.2, 5)
            b, l = sorted((width / 2, length / 2))
            words = [f"width={width}", f"length={length}", f"G={g}", f"poisson={nu}", f"embedment={depth}", "density=1900"]
            if i % 2:
                wall = draw.uniform(0.3, 1) * depth
                words += ["formulas=gazetas", f"sidewall={wall}"]
                expected = gazetas(b, l, g, nu, depth, wall)
            else:
                frequency = draw.uniform(0.5, 8)
                words += [f"frequency={frequency}"]
                expected = pais_kausel(b, l, g, nu, depth, frequency, 1900)
            found = {key: float(value) for key, value in re.findall(r'(K_\w+) = "([\d.e+-]+)', self.uplift("soil", *words).stdout)}
            names = {"K_v": "z", "K_h": "x", "K_h2": "y", "K_r": "ry", "K_r2": "rx", "K_t": "t"}
            if width < length:
                names |= {"K_h": "y", "K_h2": "x", "K_r": "rx", "K_r2": "ry"}
            for key, motion in names.items():
                self.assertAlmostEqual(found[key] / expected[motion], 1, delta=2e-8, msg=f"{key} {words}")

    def test_skew_frame_in_space(self):
        """A leaning mast of unequal members with an arm, turned sections, forces and moments at three nodes: motions and section forces."""
        draw = random.Random(4)
        young, nu = 3e10, 0.2
        nodes = [[0.0, 0.0, 0.0]]
        for _ in range(4):
            nodes.append([a + b for a, b in zip(nodes[-1], (draw.uniform(-2, 2), draw.uniform(-2, 2), draw.uniform(2, 5)))])
        nodes.append([a + b for a, b in zip(nodes[2], (draw.uniform(3, 5), draw.uniform(-3, 3), draw.uniform(-1, 1)))])
        n = 6 * len(nodes)
        stiffness, force, members = [[0.0] * n for _ in range(n)], [0.0] * n, []
        text = ['title = "frame"', "bonded = false", "[nodes]"] + [f"n{i} = {node}" for i, node in enumerate(nodes)]
        for e, (a, b) in enumerate(((0, 1), (1, 2), (2, 3), (3, 4), (2, 5))):
            area, i_y, i_z, j = draw.uniform(0.5, 3), *(draw.uniform(0.05, 0.5) for _ in range(3))
            up = [draw.gauss(0, 1) for _ in range(3)]
            local, turn, length = beam(nodes[a], nodes[b], young, nu, area, i_y, i_z, j, up)
            places = [*range(6 * a, 6 * a + 6), *range(6 * b, 6 * b + 6)]
            for i, row in zip(places, product([list(c) for c in zip(*turn)], product(local, turn))):
                for k, value in zip(places, row):
                    stiffness[i][k] += value
            members.append((local, turn, length, places))
            text += ["[[beam]]", f'name = "b{e}"', f'nodes = ["n{a}", "n{b}"]', f"E = {young}", f"poisson = {nu}", f"A = {area}", f"I_y = {i_y}",
                     f"I_z = {i_z}", f"J = {j}", f"up = {up}", f"elements = {1 + e % 3}"]
        for node in (3, 4, 5):
            loads = [draw.gauss(0, 1e5) for _ in range(6)]
            force[6 * node:6 * node + 6] = loads
            text += ["[[load]]", f'node = "n{node}"', f"force = {loads[:3]}", f"moments = {loads[3:]}"]
        moved = [0.0] * 6 + solved([row[6:] for row in stiffness[6:]], force[6:])
        expected = {}
        text += ["[[mass]]", 'node = "n4"', "mass = 1e3", "inertia = 1e2", "[[support]]", 'node = "n0"',
                 'fixed = ["ux", "uy", "uz", "rx", "ry", "rz"]', "[[stage]]", 'type = "static"', "steps = 1", "[output]", "frames = 0"]
        for node in (3, 4, 5):
            for k, quantity in enumerate(("ux", "uy", "uz", "rx", "ry", "rz")):
                expected[f"n{node}{quantity}"] = moved[6 * node + k]
                text += ["[[output.history]]", f'name = "n{node}{quantity}"', f'node = "n{node}"', f'quantity = "{quantity}"']
        for e, (local, turn, length, places) in enumerate(members):
            at = 0.37 * length
            f = [row[0] for row in product(local, product(turn, [[moved[i]] for i in places]))]
            section = (-f[0], -f[1], -f[2], -f[3], -f[4] - f[2] * at, -f[5] + f[1] * at)
            for quantity, value in zip(("axial", "shear_y", "shear_z", "torsion", "moment_y", "moment_z"), section):
                expected[f"b{e}{quantity}"] = value
                text += ["[[output.history]]", f'name = "b{e}{quantity}"', f'beam = "b{e}"', f"position = {at}", f'quantity = "{quantity}"']
        self.write("\n".join(text) + "\n")
        self.uplift("run", "case.toml", "-o", "r")
        with open(self.folder / "r" / "histories.csv") as file:
            rows = list(csv.reader(file))
        found = {name.split(" [")[0]: float(value) for name, value in zip(rows[0], rows[-1])}
        for prefix, size in (("n", max(map(abs, moved))), ("b", max(abs(v) for k, v in expected.items() if k[0] == "b"))):
            for key, value in expected.items():
                if key[0] == prefix:
                    self.assertAlmostEqual(found[key] / size, value / size, delta=1e-8, msg=key)

    def test_bar_on_a_support_that_moves_by_a_table(self):
        """A bar of one element with consistent mass hangs on a support with the motion d = a sin^3(w t), given by its points every 2 ms. Its free
        end has m/3 u'' + k u = k d - m/6 d'': half of what drives it here is inertia. The reference has the derivatives of d in closed form."""
        step, last, amplitude, omega = 2e-3, 1.0, 0.01, 2 * pi * 3
        mass, k = 7850 * 0.01 * 10, 2e7
        times = [i * step for i in range(round(last / step) + 1)]
        values = [amplitude * sin(omega * t) ** 3 for t in times]
        self.write(bar(k, f'{{ type = "table", times = {times}, values = {values} }}')
                   + f'[[stage]]\ntype = "dynamic"\nduration = {last}\nstep = {step / 10}\n')
        self.uplift("run", "case.toml", "-o", "r")
        with open(self.folder / "r" / "histories.csv") as file:
            rows = list(csv.reader(file))
        column = [name.split(" [")[0] for name in rows[0]].index("u")
        found = [float(row[column]) for row in rows[1:]]

        def acceleration(t, u):
            s, c = sin(omega * t), cos(omega * t)
            return (k * (amplitude * s**3 - u) - mass / 6 * amplitude * omega**2 * (6 * s * c * c - 3 * s**3)) / (mass / 3)

        u, v, h, expected = 0.0, 0.0, step / 10, [0.0]
        for i in range(len(found) - 1):  # Runge, Kutta & Nystroem, fourth order
            t = i * h
            a1 = acceleration(t, u)
            a2 = acceleration(t + h / 2, u + h / 2 * v + h * h / 8 * a1)
            a3 = acceleration(t + h, u + h * v + h * h / 2 * a2)
            u, v = u + h * v + h * h / 6 * (a1 + 2 * a2), v + h / 6 * (a1 + 4 * a2 + a3)
            expected.append(u)
        largest = max(map(abs, expected))
        self.assertLess(max(abs(a - b) for a, b in zip(found, expected)), 2e-3 * largest)

    def test_bar_on_a_support_that_starts_and_stops_at_once(self):
        """The bar of one element, m/3 u'' + k u = k d - m/6 d'': where the velocity of the support jumps by c, that of the free end jumps by
        -c/2. Ramps and half waves in closed form, the ramp also as a table, between the steps of the run too."""
        step, amplitude, mass, k = 2e-4, 0.01, 7850 * 0.01 * 10, 2e7
        omega = sqrt(3 * k / mass)
        for begin, length, coarse in ((0.05, 0.12, False), (0.05007, 0.11955, False), (0.05, 0.12, True)):
            stages = ((0.05, 10 * step), (0.2, step)) if coarse else ((0.25, step),)
            wave, speed = pi / length, amplitude / length

            def after(t, u, v, rest):
                return rest + (u - rest) * cos(omega * t) + v / omega * sin(omega * t)

            def ramp(t):
                """Displacement and velocity of the free end, from the beginning of the ramp to its end."""
                b = -1.5 * speed / omega
                return speed * t + b * sin(omega * t), speed + b * omega * cos(omega * t)

            def half_wave(t):
                p = amplitude * (omega**2 + wave**2 / 2) / (omega**2 - wave**2)
                b = -wave * (p + amplitude / 2) / omega
                return p * sin(wave * t) + b * sin(omega * t), p * wave * cos(wave * t) + b * omega * cos(omega * t)

            for shape, during, jump, rest in (
                    (f'{{ type = "ramp", start = {begin}, duration = {length} }}', ramp, speed / 2, amplitude),
                    (f'{{ type = "table", times = [{begin}, {begin + length}], values = [0, 1] }}', ramp, speed / 2, amplitude),
                    (f'{{ type = "half_sine", start = {begin}, duration = {length} }}', half_wave, -amplitude * wave / 2, 0)):
                with self.subTest(shape=shape, coarse=coarse):
                    self.write(bar(k, shape) + f"amplitude = {amplitude}\n" + "".join(
                        f'[[stage]]\ntype = "dynamic"\nduration = {duration}\nstep = {each}\n' for duration, each in stages))
                    told = self.uplift("check", "case.toml").stdout
                    self.assertNotIn("do not follow the load", told)
                    self.uplift("run", "case.toml", "-o", "r", "--no-step-check")
                    with open(self.folder / "r" / "histories.csv") as file:
                        rows = list(csv.reader(file))
                    column = [name.split(" [")[0] for name in rows[0]].index("u")
                    u, v = during(length)
                    largest = error = 0.0
                    for row in rows[1:]:
                        t = float(row[0]) - begin
                        expected = 0 if t < 0 else during(t)[0] if t < length else after(t - length, u, v + jump, rest)
                        largest, error = max(largest, abs(expected)), max(error, abs(float(row[column]) - expected))
                    self.assertLess(error, 0.01 * largest)

    def test_sliding_under_a_pressure_that_oscillates(self):
        """A block slides while it bounces on its joint without lifting off: against Verlet's method with Coulomb's law at the end of every one of
        its short steps. The error falls with the step, with energy_decay faster."""
        mass, gravity, mu, settled, share, speed, drive = 1e5, 9.81, 0.5, 1e-4, 0.7, 0.2, 0.5 * 9.81 + 0.3
        k_n = mass * gravity / settled
        k_t, bounce = 0.7 * k_n, share * gravity / sqrt(gravity / settled)

        def distance(step, scheme):
            self.write(f"""\
title = "block"
bonded = false
[nodes]
base = [0, 0]
[[rigid]]
name = "block"
node = "base"
mass = {mass}
inertia = 1e5
[[support]]
node = "base"
fixed = ["rz"]
[[interface]]
name = "underside"
[interface.footing]
body = "base"
width = 4
points = 5
rule = "midpoint"
[interface.law]
type = "springs"
K_n = {k_n / 4}
K_t = {k_t / 4}
tangential = "coulomb"
friction = {mu}
[gravity]
acceleration = [0, {-gravity}]
[[initial]]
node = "base"
velocity = [{speed}, {bounce}]
[[function]]
name = "constant"
shape = {{ type = "table", times = [0.0, 2.0], values = [1.0, 1.0] }}
[[ground_acceleration]]
direction = [1, 0]
amplitude = {-drive}
function = "constant"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = {step}
scheme = "{scheme}"
[output]
frames = 0
[[output.history]]
name = "u"
node = "base"
quantity = "ux"
""")
            self.uplift("run", "case.toml", "-o", scheme + str(step))
            with open(self.folder / (scheme + str(step)) / "histories.csv") as file:
                rows = list(csv.reader(file))
            return float(rows[-1][[name.split(" [")[0] for name in rows[0]].index("u")])

        h, x, y, v_x, v_y, slip, shear, pressure = 2e-5, 0.0, -settled, speed, bounce, 0.0, 0.0, mass * gravity
        for _ in range(round(1 / h)):
            v_x += h / 2 * (drive - shear / mass)
            v_y += h / 2 * (pressure / mass - gravity)
            x, y = x + h * v_x, y + h * v_y
            pressure = -k_n * y
            self.assertGreater(pressure, 0)
            shear = max(-mu * pressure, min(mu * pressure, k_t * (x - slip)))
            slip = x - shear / k_t
            v_x += h / 2 * (drive - shear / mass)
            v_y += h / 2 * (pressure / mass - gravity)
        plain = [distance(step, "average_acceleration") / x - 1 for step in (1e-3, 5e-4)]
        filtered = [distance(step, "energy_decay") / x - 1 for step in (1e-3, 5e-4)]
        self.assertLess(abs(plain[0]), 9e-3)
        self.assertLess(abs(plain[1]), 0.6 * abs(plain[0]))
        self.assertLess(abs(2 * plain[1] - plain[0]), 1e-3)
        self.assertLess(abs(filtered[0]), 2e-3)
        self.assertLess(abs(filtered[1]), 0.3 * abs(filtered[0]))


if __name__ == "__main__":
    main()
