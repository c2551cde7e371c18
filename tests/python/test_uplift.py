"""The Python package on the library: python3 tests/python/test_uplift.py PROGRAM LIBRARY. Needs NumPy."""

import ctypes
import gc
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.path.abspath(sys.argv.pop(1))
os.environ["UPLIFT_LIBRARY"] = os.path.abspath(sys.argv.pop(1))
sys.path.insert(0, str(ROOT / "python"))

import numpy as np  # noqa: E402

import uplift as up  # noqa: E402

K, SHEAR = 80e6, 60e6  # Pa/m


def pier(law, duration="6 s"):
    """The bridge pier of example 05 with another law."""
    case = up.Case("pier")
    case.node("deck", 0, 17)
    case.node("base", 0, 1)
    case.beam("column", ["base", "deck"], E="30 GPa", A="3.8 m2", I="0.7 m4")
    case.mass("deck", mass="600 t", inertia="6000 t m2")
    case.rigid("footing", "base", mass="245 t", inertia="1080 t m2")
    case.footing("underside", body="base", width="7 m", thickness="7 m", points=41, offset=[0, -1], law=law)
    case.function("pulse", up.functions.ricker(frequency="0.8 Hz", delay="2 s"))
    case.ground_acceleration([1, 0], amplitude="4 m/s2", function="pulse")
    case.gravity()
    case.damping(rayleigh=[(0.8, 0.03), (10, 0.03)])
    case.static()
    case.dynamic(duration, step="2 ms")
    return case


def soil():
    return up.springs(K_n=K, K_t=SHEAR, tangential="bonded")


class Cases(unittest.TestCase):
    def test_a_loaded_case_gives_its_file_back(self):
        for example in sorted((ROOT / "examples").glob("0*")):
            self.assertEqual(up.load(example).to_toml(), (example / "case.toml").read_text())

    def test_a_case_survives_the_tour_through_toml(self):
        for example in sorted((ROOT / "examples").glob("0*")):
            case = up.load(example)
            resolved = case.resolved()
            case.document  # from now on the text is written by the package
            self.assertEqual(case.resolved(), resolved, example.name)

    def test_a_resolved_case_can_be_built(self):
        for file in sorted((ROOT / "examples").glob("0*/**/*.toml")):
            if "[[stage]]" not in file.read_text():
                continue
            resolved = up.load(file).resolved()
            again = up.parse(resolved, str(file))
            self.assertEqual(again.resolved(), resolved, str(file))
            again.check()

    def test_what_is_refused_has_its_place(self):
        case = pier(soil())
        case.document["beam"][0]["E"] = "30 GPaa"
        with self.assertRaises(up.InputError) as caught:
            case.check()
        line = case.to_toml().splitlines()[caught.exception.line - 1]
        self.assertTrue(line.startswith("E = "), line)
        self.assertEqual(line[caught.exception.column - 1:], '"30 GPaa"')
        self.assertEqual(caught.exception.path, "beam[0].E")
        self.assertIn('did you mean "GPa"', str(caught.exception))
        with self.assertRaises(up.InputError) as caught:
            up.parse("title = \nx", "t.toml")
        self.assertEqual(caught.exception.line, 1)
        with self.assertRaises(up.InputError):
            up.load(ROOT / "no_such_case")
        with self.assertRaises(TypeError):
            pier(object()).to_toml()

    def test_texts_with_a_zero_are_refused(self):
        with self.assertRaisesRegex(up.InputError, "zero character"):
            up.parse('title = "x"\n\0garbage = =')

    def test_relative_files_stay_with_their_folder(self):
        case = up.parse('title = "x"\n[[record]]\nname = "r"\nfile = "r.AT2"\n', str(ROOT / "examples" / "case.toml"))
        with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(ValueError, "relative"):
            case.save(folder + "/case.toml")

    def test_numbers_of_more_digits_than_python_has(self):
        long = np.linspace(0, 1, 3, dtype=np.longdouble)
        self.assertEqual(up.parse(pier(up.springs(K_n=long[1])).to_toml()).document["interface"][0]["law"]["K_n"], 0.5)
        case = pier(soil())
        case.function("table", up.functions.table(times=long, values=long))
        self.assertEqual(up.parse(case.to_toml()).document["function"][-1]["shape"]["times"], [0, 0.5, 1])
        with self.assertRaisesRegex(TypeError, "cannot contain"):
            pier(up.springs(K_n=np.clongdouble(1j))).to_toml()

    def test_cases_do_not_share_their_parts(self):
        law = soil()
        first, second = pier(law), pier(law)
        first.document["interface"][0]["law"]["K_n"] = 1.0
        self.assertEqual(second.document["interface"][0]["law"]["K_n"], K)

    def test_texts_with_every_character_survive(self):
        title = "".join(chr(code) for code in list(range(1, 300)) + [0x1F30A]) + '"""\\'
        case = up.Case(title)
        self.assertEqual(up.parse(case.to_toml())._document["title"], title)

    def test_saved_cases_are_complete(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "case.toml"
            pier(soil()).save(path)
            self.assertEqual(os.listdir(folder), ["case.toml"])
            checked = subprocess.run([PROGRAM, "check", str(path), "--json"], capture_output=True, text=True, check=True)
            mine = pier(soil()).check()
            self.assertEqual(json.loads(checked.stdout)["unknowns"], mine["unknowns"])
            self.assertEqual(json.loads(checked.stdout)["suggested_step"], mine["suggested_step"])

    def test_generated_modules_are_up_to_date(self):
        subprocess.run([sys.executable, str(ROOT / "scripts" / "make_python.py"), PROGRAM, "--check"], check=True)


def same_kernels():
    """The environment of a program with the kernels of the OpenBLAS that NumPy has loaded here, before uplift could choose."""
    blas = ctypes.CDLL("libopenblas.so.0")
    blas.openblas_get_corename.restype = ctypes.c_char_p
    return {**os.environ, "OPENBLAS_CORETYPE": blas.openblas_get_corename().decode()}


class Runs(unittest.TestCase):
    def test_results_are_those_of_the_program_bit_for_bit(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out"
            subprocess.run([PROGRAM, "run", str(ROOT / "examples/05_bridge_pier"), "-q", "-o", str(out)], check=True, env=same_kernels())
            run = up.load(ROOT / "examples/05_bridge_pier").run()
            run.write(pathlib.Path(folder) / "mine")
            self.assertEqual((out / "histories.csv").read_bytes(), (pathlib.Path(folder) / "mine" / "histories.csv").read_bytes())
            theirs, mine = json.loads((out / "summary.json").read_text()), run.summary
            self.assertEqual(theirs["verdict"]["interfaces"], mine["verdict"]["interfaces"])
            self.assertEqual(theirs["verdict"]["numbers"], mine["verdict"]["numbers"])

    def test_fields_stand_in_a_folder_of_results(self):
        case = up.load(ROOT / "examples/02_building_on_soil")
        case.document["stage"][-1]["duration"] = "0.1 s"
        case.document["output"]["fields"] = {"every": 25}
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "out"
            for earlier in ([], ["out.1"]):  # again: what is there is moved aside
                run = case.run(step_check=False, fields=out)
                self.assertEqual(sorted(each.name for each in pathlib.Path(folder).iterdir()), ["out", *earlier])
                self.assertTrue((out / "fields" / "run.pvd").is_file())
                run.write(out)  # it is there already
                self.assertTrue((out / "fields" / "run.pvd").is_file())
            run.write(pathlib.Path(folder) / "mine")
            self.assertEqual(sorted(each.name for each in out.iterdir()), sorted(["fields", *os.listdir(folder + "/mine")]))
            self.assertEqual((out / "histories.csv").read_bytes(), (pathlib.Path(folder) / "mine" / "histories.csv").read_bytes())
            with self.assertRaisesRegex(up.InputError, "found an empty name"):
                run.write("")

    def test_histories_are_views_that_keep_the_results(self):
        moment = pier(soil()).run(step_check=False)["underside.moment"]
        self.assertFalse(moment.flags.owndata)
        with self.assertRaises(ValueError):
            moment[0] = 1
        self.assertGreater(abs(moment).max(), 1e6)  # the results would be gone if the view did not hold them

    def test_verdict_and_energies(self):
        run = pier(soil()).run()
        base = run.verdict.bases["underside"]
        self.assertEqual(base["max_moment"].unit, "N m")
        self.assertAlmostEqual(run.verdict.uplift, float(run["underside.uplifted_ratio"].max()), delta=1e-12)
        self.assertTrue(run.verdict.converged)
        self.assertLess(abs(run.energy.residual), 1e-9 * run.energy.scale)
        self.assertIsNotNone(base["max_moment"].bonded)
        self.assertIn("report", run._repr_html_())
        with self.assertRaisesRegex(KeyError, "did you mean 'underside.moment'"):
            run["underside.momnt"]
        with self.assertRaisesRegex(KeyError, "no floor"):
            run.floor("roof")

    def test_floor_at_a_node_that_was_not_asked_for(self):
        case = pier(soil())
        run = case.run(step_check=False)
        case.ground_acceleration([0, 1], amplitude="4 m/s2", function="pulse")  # what is changed later does not belong to the run
        floor = run.floor("deck")
        asked = pier(soil())
        asked.floor_spectrum("top", "deck", direction=[1, 0])
        expected = asked.run(step_check=False).floor("top")
        self.assertEqual(floor.step, 0.002)
        self.assertTrue(np.array_equal(floor.acceleration, expected.acceleration))
        self.assertIs(run.floor("deck"), floor)

    def test_a_coarse_step_is_not_converged(self):
        case = pier(soil(), duration="2 s")
        case.dynamic("1 s", step="50 ms")
        verdict = case.run().verdict
        self.assertIs(verdict.converged, False, verdict.headline)
        self.assertIn("not converged", verdict.headline)

    def test_motions_take_the_place_of_the_loads(self):
        case = pier(soil())
        record = ROOT / "tests/data/records/tone_peer_new.AT2"
        run = case.run(up.motion(record, pga="0.1 g_n"), step_check=False)
        self.assertNotIn("record", case._document)
        self.assertEqual([each["file"] for each in run.summary["motions"]], [str(record)])

    def test_compare(self):
        compared = up.load(ROOT / "examples/05_bridge_pier").compare("springs")
        self.assertEqual([run.name for run in compared.runs], ["springs", "bonded"])
        self.assertEqual(compared["springs"].time[0], 0)
        self.assertEqual(compared.table[0]["status"], "completed")
        with self.assertRaisesRegex(ValueError, "unknown variant"):
            up.load(ROOT / "examples/05_bridge_pier").compare("sprngs")

    def test_an_interface_problem_alone(self):
        # a mass point on a unilateral support: force = gap / F where it would penetrate
        problem = {"format": "uplift interface problem 1", "factor": [[1e-4]], "free_opening": [-2e-3],
                   "blocks": [{"name": "a", "points": 1, "components": 1, "area": [1], "behaviour": {"type": "unilateral"}}]}
        answer, = up.solve_problem(problem, "lagrange")
        self.assertTrue(answer.converged)
        self.assertAlmostEqual(answer.force[0] / (-2e-3 / 1e-8), 1, places=12)
        self.assertEqual([each.method for each in up.solve_problem(problem)], ["newton", "penalty", "augmented_lagrangian", "lagrange"])
        with self.assertRaisesRegex(up.InputError, "lagrange"):
            up.solve_problem(problem, "lagrnge")
        for damaged in ("", "{", "[]", '{"format": 3}', json.dumps({**problem, "factor": []}), json.dumps({**problem, "blocks": []})):
            with self.assertRaises(up.InputError):
                up.solve_problem(damaged)

    def test_formulations_are_compared_by_name(self):
        law = up.springs(K_n=K, K_t=SHEAR, friction=0.7)
        compared = pier(law, "4 s").compare("springs", "lagrange", "sdm", half={"step": "1 ms"}, soft=up.springs(K_n=K / 10, K_t=SHEAR))
        self.assertEqual([run.name for run in compared.runs][:3], ["springs", "lagrange", "sdm"])
        rows = {row["name"]: row for row in compared.table}
        self.assertLess({"half", "soft", "bonded"}, set(rows))
        for name in ("sdm", "half"):  # the same joint in another formulation, and with another step
            self.assertAlmostEqual(rows[name]["max_base_moment"] / rows["springs"]["max_base_moment"], 1, delta=0.03)
        # where it may lift off, the force cannot lie outside the footing: at every instant |M| <= |N| B/2, which the bonded one exceeds
        lies = {run.name: (abs(run["underside.moment"]) <= abs(run["underside.axial"]) * 3.5 * (1 + 1e-9)).all() for run in compared.runs}
        self.assertEqual(lies, {"springs": True, "lagrange": True, "sdm": True, "half": True, "soft": True, "bonded": False})
        with self.assertRaisesRegex(ValueError, "needs"):
            pier({"type": "coulomb", "friction": 0.7}, "4 s").compare("sdm")
        with self.assertRaisesRegex(ValueError, "coefficient of friction"):
            pier(up.springs(K_n=K, tangential="bonded"), "4 s").compare("lagrange")

    def test_a_foundation_on_one_element(self):
        """Uplift alone dissipates nothing; yielding limits the moment to the capacity (docs/theory/macro_element.md)."""
        def case(**strength):
            made = up.Case("foundation")
            made.node("base", 0, 0), made.node("top", 0, 10)
            made.mass("top", mass="100 t")
            made.beam("column", ["base", "top"], E="30 GPa", A=1, I=0.2)
            made.rigid("footing", "base", mass="30 t", inertia="60 t m2")
            made.gravity()
            made.damping(rayleigh=[(1, 0.02), (10, 0.02)])
            made.function("pulse", shape=up.functions.half_sine(duration=0.4))
            made.ground_acceleration(function="pulse", amplitude="4 m/s2")
            made.static(), made.dynamic("1 s", step="2 ms")
            made.foundation("ground", body="base", width="6 m",
                            model=up.foundations.macro_element(shape_number=6, K_v="600 MN/m", K_h="300 MN/m", K_r="1.8 GN m/rad", **strength))
            return made
        elastic, yielding = case().run(), case(V_s="3 MN").run()
        self.assertGreater(elastic.verdict.uplift, 0.2)
        self.assertEqual(elastic.energy.interface_dissipated, 0)
        self.assertGreater(yielding.energy.interface_dissipated, 0)
        # capacity of the base with its weight, M <= N B/2 (1 - N/V), is what yielding leaves of the moment; N swings about the weight
        weight = 130e3 * 9.80665
        self.assertLess(abs(yielding["ground.moment"]).max(), 1.1 * weight * 3 * (1 - weight / 3e6))
        self.assertGreater(abs(elastic["ground.moment"]).max(), 1.1 * weight * 3 * (1 - weight / 3e6))

    def test_a_cut_carries_the_weight_above_it(self):
        """A raft of 2.6 m x 0.8 m x 3 m with its edges inside cells, on a plane inside a row: N = rho g V."""
        case = up.Case("cut")
        case.mesh(soil_box={"soil": {"width": "10 m", "size": "0.5 m", "layers": [{"thickness": "4 m"}]}})
        case.solid("soil_1", E="50 MPa", poisson=0.3, density=1900, thickness="3 m")
        case.solid("raft", E="30 GPa", poisson=0.2, density=2500, thickness="3 m")
        case.support(group="soil_bottom", fixed=["ux", "uy"])
        case.gravity(0, -10)
        case.cut("base", through=["soil_1"], level="-1.2 m", upper="raft", x=["-1.2 m", "1.4 m"], height="0.8 m",
                 law=up.springs(K_n="1 GPa/m", K_t="1 GPa/m", tangential="coulomb", friction=0.5))
        case.static()
        weight = 2500 * 10 * 2.6 * 0.8 * 3
        self.assertAlmostEqual(case.run()["base.axial"][-1], -weight, delta=1e-9 * weight)

    def test_every_kind_of_interface_has_a_method(self):
        told = subprocess.check_output([PROGRAM, "describe", "section", "interface"], text=True)
        kinds = re.search("exactly one of (.+) says where", told)[1].replace(" and ", ", ").split(", ")
        self.assertIn("cut", kinds)
        for kind in kinds:
            self.assertTrue(callable(getattr(up.Case, kind, None)), kind)

    def test_directions_follow_the_space_of_the_case(self):
        case = up.Case("a mass on a column")
        case.gravity()  # before the nodes are known
        case.node("base", 0, 0, 0)
        case.node("top", 0, 0, 5)
        case.beam("column", ["base", "top"], E="30 GPa", A="1 m2", I_y="0.1 m4", I_z="0.1 m4", J="0.1 m4", poisson=0.2)
        case.mass("top", mass="10 t")
        case.support("base", ["ux", "uy", "uz", "rx", "ry", "rz"])
        case.history("top", "uz", name="sag")
        case.static()
        run = case.run(step_check=False)
        self.assertAlmostEqual(run["sag"][-1] / (-1e4 * 9.81 * 5 / 30e9), 1, places=6)

    def test_floor_spectrum_of_a_harmonic_motion(self):
        # resonance of an undamped oscillator with sin(w t): x = (sin wt - wt cos wt)/(2 w^2), largest near the end of n periods
        frequency, periods, step = 2.0, 5, 1e-3
        w = 2 * np.pi * frequency
        t = np.arange(0, periods / frequency + step / 2, step)
        at, value = up.psa(np.sin(w * t), step, damping=0.0, frequencies=[frequency])
        self.assertEqual(at[0], frequency)
        exact = np.max(np.abs(np.sin(w * t) - w * t * np.cos(w * t))) / 2
        self.assertAlmostEqual(value[0], exact, delta=2e-5 * exact)
        with self.assertRaises(up.InputError):
            up.psa([np.nan, 1], step)
        with self.assertRaisesRegex(ValueError, r"one dimension, found an array of the shape \(10, 2\)"):
            up.psa(np.ones((10, 2)), step)
        # a suddenly constant acceleration: x = a (1 - cos wt)/w^2, largest between the points, where no step of the record falls
        step, fast = 0.01, np.linspace(3.1, 47.3, 23)
        _, value = up.psa(np.ones(100), step, damping=0.0, frequencies=fast)
        np.testing.assert_allclose(value, 2, rtol=1e-4)

    def test_a_step_function_ends_the_run(self):
        run = pier(soil()).run(step=lambda step: step.opening.max() < 1e-6, step_check=False)  # a NumPy truth value
        self.assertEqual(run.status, "interrupted")
        self.assertLess(run.time[-1], 3)

    def test_trust_has_its_bands(self):
        case = pier(soil(), "0.5 s")
        self.assertIn("bands", case.trust().bands)
        run = case.run(step_check=False)
        with self.assertRaises(up.InputError):
            up._results.Trust(run._handle).bands

    def test_numbers_of_the_verdict_can_be_copied_and_used(self):
        import copy
        import pickle

        moment = pier(soil(), "1 s").run(step_check=False).verdict.bases["underside"]["max_moment"]
        for made in (copy.deepcopy(moment), pickle.loads(pickle.dumps(moment))):
            self.assertEqual((float(made), made.unit, made.bonded), (float(moment), moment.unit, moment.bonded))
        case = up.Case("x")
        case.mass("a", mass=moment)
        case.mass("b", mass=np.float64(0.1))
        self.assertEqual([each["mass"] for each in up.parse(case.to_toml())._document["mass"]], [float(moment), 0.1])

    def test_a_thread_that_nobody_waits_for_does_not_abort_the_interpreter(self):
        code = ("import sys, threading, time; sys.argv = ['x', sys.argv[1], sys.argv[2]]\nimport uplift as up\ncase = up.parse(open(sys.argv[1]).read())\n"
                "threading.Thread(target=lambda: case.run(progress=False, step_check=False), daemon=True).start()\ntime.sleep(0.3)")
        with tempfile.TemporaryDirectory() as folder:
            pier(soil(), "4000 s").save(folder + "/case.toml")
            done = subprocess.run([sys.executable, "-c", code, folder + "/case.toml", ""], env={**os.environ, "PYTHONPATH": str(ROOT / "python")})
        self.assertEqual(done.returncode, 0)

    def test_ctrl_c_keeps_the_results(self):
        case = pier(soil(), "4000 s")
        timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        run = case.run(step_check=False, progress=False)
        timer.join()
        self.assertEqual(run.status, "interrupted")
        self.assertGreater(run.time[-1], 1.0)

    def test_what_a_step_function_raises_reaches_the_caller(self):
        def fail(step):
            raise ZeroDivisionError("mine")

        with self.assertRaisesRegex(ZeroDivisionError, "mine"):
            pier(soil()).run(step=fail)

    def test_a_march_is_the_run(self):
        whole = pier(soil()).run(step_check=False)
        openings = []
        with up.march(pier(soil())) as march:
            for step in march:
                if step.stage == 1:
                    openings.append((step.time, step.opening[-1]))
        self.assertEqual(len(openings), len(whole.time))
        self.assertEqual([time for time, _ in openings], list(whole.time))
        np.testing.assert_array_equal(march.results["deck.ux"], whole["deck.ux"])

    def test_a_march_can_be_left(self):
        march = up.march(pier(soil()))
        for step in march:
            if step.time > 1:
                break
        self.assertEqual(march.results.status, "interrupted")
        self.assertLess(march.results.time[-1], 1.01)

    def test_marches_that_are_left_end(self):
        before = threading.active_count()
        for _ in range(10):
            march = up.march(pier(soil()))
            next(march)
            del march
        deadline = time.monotonic() + 20
        while threading.active_count() > before and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertEqual(threading.active_count(), before)

    def test_two_threads_give_what_one_gives(self):
        alone = pier(soil()).run(step_check=False)["deck.ux"].copy()
        made = []
        threads = [threading.Thread(target=lambda: made.append(pier(soil()).run(step_check=False, progress=False))) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for run in made:
            np.testing.assert_array_equal(run["deck.ux"], alone)

    def test_memory_does_not_grow(self):
        case = pier(soil(), "0.2 s")

        def resident():
            return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE")

        for _ in range(100):
            case.run(step_check=False, progress=False)
        before = resident()
        for _ in range(400):
            case.run(step_check=False, progress=False)
        self.assertLess(resident() - before, 1e6)


class Laws(unittest.TestCase):
    @staticmethod
    def tensionless(start, end, memory, step):
        """Springs that push and do not pull, elastic in shear: what `springs` with bonded shear is."""
        shear, normal = end
        traction = np.stack([SHEAR * shear, K * np.minimum(normal, 0)])
        slope = np.stack([np.full_like(shear, SHEAR), np.where(normal < 0, K, 0.0)])
        return traction, slope, memory, 0.5 * SHEAR * shear**2 + 0.5 * K * np.minimum(normal, 0) ** 2

    def test_a_law_in_python_is_the_same_law(self):
        theirs = pier(soil(), "4 s").run(step_check=False)
        mine = pier(up.law(self.tensionless, K_n=K, K_t=SHEAR), "4 s").run(step_check=False)
        self.assertGreater(theirs.verdict.uplift, 0.3)
        for name in ("deck.ux", "underside.moment", "underside.shear", "underside.uplifted_ratio"):
            # where a point closes within a step, the discrete gradient corrects along the increment, shear included, and the law of the
            # library averages each component: a difference of the order of the step squared in few steps
            self.assertLess(abs(theirs[name] - mine[name]).max() / abs(theirs[name]).max(), 5e-4, name)
        self.assertLess(abs(mine.energy.residual), 1e-9 * mine.energy.scale)

    def test_a_law_that_holds_tension_gapes_as_its_own_kind(self):
        """A softening joint of one's own, without stiffness in shear, beside the joint of the library with the same equations."""
        strength, energy = 2e5, 900.0  # Pa, J/m2
        first, last = strength / K, 2 * energy / strength  # m: openings at which it begins to soften, and at which nothing is left

        def softening(start, end, memory, step):
            opening = end[-1]
            largest = np.maximum(np.maximum(memory[0], opening), 0)
            left = np.clip(strength * (last - largest) / (last - first), 0, None)
            intact = largest <= first
            secant = np.where(intact, K, left / np.where(intact, 1, largest))
            grows = ~intact & (opening >= memory[0])
            traction, slope = np.zeros_like(end), np.zeros_like(end)
            traction[-1] = np.where(opening < 0, K, secant) * opening
            slope[-1] = np.where(opening < 0, K, np.where(grows, np.where(largest < last, -strength / (last - first), 0), secant))
            spent = np.where(intact, 0, energy - left**2 * (last - first) / (2 * strength) - left * largest / 2)
            return traction, slope, largest[None], 0.5 * traction[-1] * opening, spent

        def run(law):
            case = pier(law, "4 s")
            case.spring(["base"], direction=[1, 0], stiffness="3 GN/m")  # the joint has no shear
            case.document["stage"][-1]["traction"] = "end"
            return case.run(step_check=False)

        theirs = run(up.laws.bilinear(K_n=K, F_u=strength, G_f=energy, tangential="none"))
        mine = run(up.law(softening, K_n=K, memory=1))
        self.assertEqual(mine.status, "completed")
        self.assertGreater(theirs.verdict.uplift, 0.2)
        for name in ("deck.ux", "underside.moment", "underside.max_opening", "underside.uplifted_ratio"):
            self.assertLess(abs(theirs[name] - mine[name]).max(), 1e-8 * abs(theirs[name]).max(), name)
        for name in ("deck.ux", "underside.moment"):  # the bonded joint without shear too
            self.assertLess(abs(theirs.bonded[name] - mine.bonded[name]).max(), 1e-8 * abs(theirs.bonded[name]).max(), name)

    def test_memory_and_dissipation(self):
        """Springs that lose their stiffness with the largest opening: the ledger closes, and what is lost is in it."""
        critical = 5e-3  # m

        def softening(start, end, memory, step):
            shear, normal = end
            # damage follows the largest opening; the energy of the closed joint does not depend on it
            largest = np.maximum(memory[0], np.maximum(normal, 0))
            stiffness = 1e6 / (1 + largest / critical) ** 2
            pull = np.maximum(normal, 0)
            virgin = 1e6 * critical**2 * (np.log1p(largest / critical) + 1 / (1 + largest / critical) - 1)
            stored = 0.5 * stiffness * pull**2 + 0.5 * K * np.minimum(normal, 0) ** 2 + 0.5 * SHEAR * shear**2
            dissipated = virgin - 0.5 * stiffness * largest**2
            traction = np.stack([SHEAR * shear, np.where(normal > 0, stiffness * normal, K * normal)])
            growing = (normal > memory[0]) & (normal > 0)
            slope_n = np.where(normal < 0, K, np.where(growing, 1e6 * (1 - normal / critical) / (1 + largest / critical) ** 3, stiffness))
            return traction, np.stack([np.full_like(shear, SHEAR), slope_n]), largest[None], stored, dissipated

        run = pier(up.law(softening, K_n=K, K_t=SHEAR, memory=1), "4 s").run(step_check=False)
        self.assertEqual(run.status, "completed")
        self.assertLess(abs(run.energy.residual), 1e-9 * run.energy.scale)
        lost = run["energy.interface_dissipated"]
        self.assertGreater(lost[-1], 0)
        self.assertGreaterEqual(np.diff(lost).min(), -1e-9 * lost[-1])

    def test_a_law_that_raises_fails_the_run(self):
        def bad(start, end, memory, step):
            raise RuntimeError("mine")

        with self.assertRaisesRegex(RuntimeError, "mine"):
            pier(up.law(bad, K_n=K, K_t=SHEAR)).run(step_check=False)

    def test_a_law_of_the_wrong_shape_is_told(self):
        def bad(start, end, memory, step):
            return end[1], np.ones_like(end[1]), memory, end[1] * 0

        with self.assertRaisesRegex(ValueError, r"a traction of the shape \(41,\), expected \(2, 41\)"):
            pier(up.law(bad, K_n=K, K_t=SHEAR)).run(step_check=False)

    def test_a_law_that_returns_too_few_values_is_told(self):
        with self.assertRaisesRegex(ValueError, r"returned 2 values, expected \(traction, slope, memory, stored\)"):
            pier(up.law(lambda start, end, memory, step: (end, end), K_n=K, K_t=SHEAR)).run(step_check=False)
        with self.assertRaisesRegex(TypeError, "returned NoneType, expected"):
            pier(up.law(lambda start, end, memory, step: None, K_n=K, K_t=SHEAR)).run(step_check=False)

    def test_a_second_node_of_one_name_is_refused(self):
        case = up.Case("nodes")
        case.node("top", 0, 5)
        with self.assertRaisesRegex(ValueError, r"a node 'top' already, at \[0, 5\]"):
            case.node("top", 0, 6)
        self.assertEqual(case.document["nodes"], {"top": [0, 5]})

    def test_a_motion_of_another_type_is_refused(self):
        with self.assertRaisesRegex(TypeError, r"a motion is made by uplift.motion\(...\), found str"):
            pier(soil()).run("record.txt")
        with self.assertRaisesRegex(TypeError, r"for an array: case.function\(name, up.functions.table"):
            up.motion(np.zeros(10), step=0.01)

    def test_a_law_may_keep_and_change_what_it_is_given(self):
        kept = []

        def in_place(start, end, memory, step):
            kept.append((end, end.copy()))
            answer = self.tensionless(start, end.copy(), memory, step)
            start[...] = 7
            return answer

        run = pier(up.law(in_place, K_n=K, K_t=SHEAR), "1 s").run(step_check=False)
        same = pier(up.law(self.tensionless, K_n=K, K_t=SHEAR), "1 s").run(step_check=False)
        np.testing.assert_array_equal(run["deck.ux"], same["deck.ux"])
        self.assertTrue(all(np.array_equal(mine, copy) for mine, copy in kept))

    def test_results_outlive_the_case_of_their_law(self):
        run = pier(up.law(self.tensionless, K_n=K, K_t=SHEAR), "1 s").run(step_check=False)
        gc.collect()
        self.assertIn("<html", run.report)

    def test_two_laws_of_one_name_are_refused(self):
        case = pier(up.law(self.tensionless, K_n=K, name="a"))
        with self.assertRaisesRegex(ValueError, "another law of the name 'a'"):
            case.variant("v", law=up.law(self.tensionless, K_n=K, name="a"))

    def test_the_program_refuses_such_a_law(self):
        with tempfile.TemporaryDirectory() as folder:
            case = pathlib.Path(folder) / "case.toml"
            pier(up.law(self.tensionless, K_n=K, K_t=SHEAR, name="mine")).save(case)
            done = subprocess.run([PROGRAM, "run", str(case), "-q", "-o", folder + "/out"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 2)
            self.assertIn('"mine"', done.stderr)


class Package(unittest.TestCase):
    def test_import_needs_no_numpy_and_no_library(self):
        code = "import sys; import uplift; sys.exit('numpy' in sys.modules or uplift._library._loaded is not None)"
        subprocess.run([sys.executable, "-c", code], check=True, env={**os.environ, "PYTHONPATH": str(ROOT / "python")})

    def test_the_module_is_the_program(self):
        done = subprocess.run([sys.executable, "-m", "uplift", "--version"], capture_output=True, text=True, check=True,
                              env={**os.environ, "PYTHONPATH": str(ROOT / "python"), "PATH": os.path.dirname(PROGRAM) + ":" + os.environ["PATH"]})
        self.assertEqual(done.stdout.strip(), up.version())

    def test_help_says_units_and_ranges(self):
        self.assertIn("normal stiffness in compression [Pa/m], > 0 Pa/m", up.springs.__doc__)
        self.assertIn("width of the footing [m], > 0 m", up.Case.footing.__doc__)


unittest.main()
