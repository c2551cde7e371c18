"""The bridge pier in Python, built without a file: how the largest base moment depends on the stiffness of the soil.

    PYTHONPATH=python python3 examples/05_bridge_pier/example.py [FIGURE.png]
"""

import sys

import uplift as up


def pier(K_n):
    """The pier of case.toml on soil of this stiffness [MPa/m]."""
    case = up.Case("Bridge pier that rocks")
    case.node("deck", 0, 17)
    case.node("cap", 0, 16)
    case.node("base", 0, 1)
    case.beam("column", ["base", "cap"], E="30 GPa", poisson=0.2, A="3.8 m2", I="0.7 m4", elements=4)
    case.beam("head", ["cap", "deck"], E="30 GPa", A="10 m2", I="8 m4")
    case.mass("deck", mass="600 t", inertia="6000 t m2")
    case.rigid("footing", "base", mass="245 t", inertia="1080 t m2")
    law = up.springs(K_n=f"{K_n} MPa/m", c="0.4 MPa s/m", K_t="60 MPa/m", tangential="coulomb", friction=0.6)
    case.footing("underside", body="base", width="7 m", thickness="7 m", points=41, offset=[0, "-1 m"], law=law)
    case.gravity()
    case.function("pulse", up.functions.ricker(frequency="0.8 Hz", delay="2 s"))
    case.ground_acceleration([1, 0], name="earthquake", amplitude="4 m/s2", function="pulse")
    case.damping(rayleigh=[("0.8 Hz", 0.03), ("10 Hz", 0.03)])
    case.static()
    case.dynamic("12 s", step="2 ms", p_delta=True)
    case.history("deck", "ax")
    return case


runs = {K_n: pier(K_n).run() for K_n in (40, 80, 160)}
for K_n, run in runs.items():
    moment = run.verdict.bases["underside"]["max_moment"]
    print(f"K_n = {K_n} MPa/m: uplift {run.verdict.uplift:.0%}, base moment {moment / 1e6:.2f} MN m, bonded {moment.bonded / 1e6:.2f} MN m")

if len(sys.argv) > 1:
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(6, 5))
    for K_n, run in runs.items():
        axes.plot(1e3 * run["underside.rotation"], run["underside.moment"] / 1e6, linewidth=0.8, label=f"{K_n} MPa/m")
    axes.set(xlabel="rotation [mrad]", ylabel="moment [MN m]")
    axes.legend()
    figure.savefig(sys.argv[1])
