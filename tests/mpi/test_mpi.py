"""uplift-mpi on 1, 2 and 4 ranks beside the program `uplift`. Its programs lie beside that one."""

import os
import shutil
import signal
import sys
import tempfile
import time

sys.path.insert(0, str(__import__("pathlib").Path(__file__).resolve().parents[1] / "cli"))
from support import *  # noqa: E402
from test_study_queues import Slurm, wait_until  # noqa: E402
import random_cases  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
ITERATIVE = "-ksp_type cg -pc_type jacobi"


def with_solver(text, options=""):
    """The case with PETSc; keys of no table come first."""
    return f'solver = {{ type = "petsc", options = "{options}" }}\n' + text


def soil(duration):
    """Example 02, a building on a mesh of soil, for a shorter time."""
    text = (ROOT / "examples/02_building_on_soil/case.toml").read_text()
    assert text.count('duration = "3 s"') == 1
    return text.replace('duration = "3 s"', f'duration = "{duration} s"')


RAFT = """\
title = "raft on soil"
bonded = false
[mesh.soil_box.soil]
width = 16
length = 14
size = 2
[[mesh.soil_box.soil.layers]]
thickness = 2
size = 1
[[mesh.soil_box.soil.layers]]
thickness = 4
size = 2
[mesh.soil_box.raft]
width = 8
length = 6
height = 1
size = 1
[mesh.soil_box.block]
width = 4
length = 4
height = 8
size = 2
[[solid]]
group = "soil_1"
shear_wave_speed = 250
poisson = 0.3
density = 1900
[[solid]]
group = "soil_2"
shear_wave_speed = 400
poisson = 0.3
density = 2000
[[solid]]
group = "raft"
E = "30 GPa"
poisson = 0.2
density = 2500
[[solid]]
group = "block"
E = "5 GPa"
poisson = 0.2
density = 1000
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy", "uz"]
[[support]]
group = "soil_left"
fixed = ["ux"]
[[support]]
group = "soil_right"
fixed = ["ux"]
[[support]]
group = "soil_front"
fixed = ["uy"]
[[support]]
group = "soil_back"
fixed = ["uy"]
[[interface]]
name = "underside"
surface = { group = "interface", lower = ["soil_1"] }
law = { type = "springs", K_n = 2e10, K_t = 1e10, tangential = "coulomb", friction = 0.7 }
[gravity]
acceleration = [0, 0, -9.81]
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.2 }
[[ground_acceleration]]
name = "earthquake"
direction = [0.86, 0.37, -0.35]
amplitude = 26
function = "pulse"
[damping]
rayleigh = [{ frequency = 1, ratio = 0.04 }, { frequency = 8, ratio = 0.04 }]
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.3
step = "4 ms"
"""


class MpiTest(CliTest):
    def command(self, ranks, *words, name="uplift-mpi"):
        return ["mpirun", "--oversubscribe", "--quiet", "--mca", "mpi_yield_when_idle", "1", "-n", str(ranks), str(pathlib.Path(program()).parent / name), *map(str, words)]

    def mpi(self, ranks, *words, expect=0, name="uplift-mpi"):
        done = subprocess.run(self.command(ranks, *words, name=name), cwd=self.folder, capture_output=True, text=True, timeout=300, env=ENVIRONMENT)
        if expect is not None:
            self.assertEqual(done.returncode, expect, f"{words} on {ranks} ranks\n--- output\n{done.stdout}\n--- errors\n{done.stderr}")
        return done

    def start(self, ranks, *words, out):
        """The job and the processes of its ranks, in their order, once the first file of the results is there."""
        command = self.command(ranks, *words, "-o", out)
        job = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)
        self.addCleanup(job.kill)
        self.wait_for(f"{out}.part-*/*")
        children = [int(child) for child in pathlib.Path(f"/proc/{job.pid}/task/{job.pid}/children").read_text().split()]
        self.assertEqual(len(children), ranks)
        return job, sorted(children)

    def wait_for(self, pattern):
        deadline = time.monotonic() + 60
        while not list(self.folder.rglob(pattern)):
            self.assertLess(time.monotonic(), deadline, pattern)
            time.sleep(0.05)

    def ended(self, job):
        """Exit code and standard error of a job."""
        _, err = job.communicate(timeout=60)
        return job.returncode, err

    def assert_same(self, serial, parallel):
        """Peaks, energies and numbers of the verdict within 1e-8; peaks below a hundredth of the largest one of their unit within 1e-8 of that
        hundredth: solutions by iterations, and openings with a reach, are as exact as 1e-12 of their largest and 1e-10 of the
        change in a step. Energies are compared with the largest one: the residual is round-off."""
        for one, other in zip(serial["runs"], parallel["runs"], strict=True):
            self.assertEqual((one["status"], one["steps"], one["retries"]), (other["status"], other["steps"], other["retries"]))
            largest = {}
            for peak in one["peaks"].values():
                largest[peak["unit"]] = max(largest.get(peak["unit"], 0), abs(peak["value"]))
            for name, peak in one["peaks"].items():
                size, most = abs(peak["value"]), largest[peak["unit"]]
                scale = most if peak["unit"] == "J" else max(size, 1e-2 * most)
                self.assertLessEqual(abs(other["peaks"][name]["value"] - peak["value"]), 1e-8 * scale, name)
            for name, energy in one["final_energy"].items():
                if isinstance(energy, float):
                    self.assertLessEqual(abs(other["final_energy"][name] - energy), 1e-8 * one["energy_scale"], name)
        for key in ("level", "headline", "consequence"):
            self.assertEqual(serial["verdict"][key], parallel["verdict"][key])
        for name, number in serial["verdict"]["numbers"].items():
            if isinstance(number, dict) and abs(number.get("value") or 0) > 1e-9:
                self.assertLessEqual(abs(parallel["verdict"]["numbers"][name]["value"] / number["value"] - 1), 1e-8, name)


class Results(MpiTest):
    def compare(self, text, *words, ranks=(1, 2, 4)):
        self.write(text)
        self.uplift("run", "case.toml", "-q", "-o", "serial", *words)
        serial = self.summary("serial")
        for options, counts in (("", ranks), (ITERATIVE, ranks[-2:-1])):
            self.write(with_solver(text, options), "petsc.toml")
            for count in counts:
                folder = f"{count}{options[:9]}".replace(" ", "")
                self.mpi(count, "run", "petsc.toml", "-q", "-o", folder, *words)
                with self.subTest(ranks=count, options=options):
                    self.assert_same(serial, self.summary(folder))
        return serial

    def test_mesh_of_soil(self):
        self.assertEqual(self.compare(soil(0.6), "--no-step-check")["runs"][0]["status"], "completed")

    def test_stiff_structure_as_a_block_of_the_preconditioner(self):
        self.write(RAFT.replace("duration = 0.3", "duration = 0.04").replace('"5 GPa"', '"30 GPa"').replace('[[stage]]\ntype = "static"\n', ""))
        self.uplift("run", "case.toml", "-q", "-o", "serial", "--no-step-check")
        serial = self.summary("serial")
        self.write(f'solver = {{ type = "petsc", options = "{ITERATIVE}", reach = 2 }}\n' + (self.folder / "case.toml").read_text(), "petsc.toml")
        for ranks in (1, 2):
            done = self.mpi(ranks, "run", "petsc.toml", "-o", f"{ranks}", "--no-step-check")
            with self.subTest(ranks=ranks):
                parallel = self.summary(f"{ranks}")
                self.assert_same(serial, parallel)
                (said,) = (line for line in done.stdout.splitlines() if line.startswith("solver: "))
                self.assertRegex(said, r"^solver: \d+ unknowns of stiff parts are factorised as one block")
                self.assertIn(said, parallel["runs"][0]["notes"])

    def test_springs_on_few_unknowns(self):
        self.compare(BASE, ranks=(2, 4))


class RandomCases(MpiTest):
    seeds = (0, 1, 2, 3, 5)

    def test_like_the_program_for_one_process(self):
        for seed in self.seeds:
            text, solver = random_cases.case(seed)
            self.write(text)
            self.uplift("run", "case.toml", "-q", "-o", "serial", "--no-step-check", expect=None)
            serial = self.summary("serial")
            self.write(solver + text, "petsc.toml")
            for ranks in (1, 2, 4):
                self.mpi(ranks, "run", "petsc.toml", "-q", "-o", f"{ranks}", "--no-step-check", expect=None)
                with self.subTest(seed=seed, ranks=ranks, solver=solver):
                    self.assert_same(serial, self.summary(f"{ranks}"))
                    if ranks == 4:
                        print(f"random case {seed}: {text.splitlines()[0]}, {solver.strip()}, {serial['runs'][0]['status']}", flush=True)
                shutil.rmtree(self.folder / f"{ranks}")
            shutil.rmtree(self.folder / "serial")


class Reach(MpiTest):
    """A stiff raft on soil in space that lifts off almost everywhere."""

    def test_any_reach_gives_the_step_of_the_whole_flexibility(self):
        self.write(RAFT)
        self.uplift("run", "case.toml", "-q", "-o", "serial")
        serial = self.summary("serial")
        run = serial["runs"][0]
        self.assertGreater(run["max_uplifted_ratio"]["value"], 0.8)
        solves = {}
        shorter = RAFT.replace("duration = 0.3", "duration = 0.1")
        for reach in (0, 2, 4):
            self.write(f'solver = {{ type = "petsc", reach = {reach} }}\n' + RAFT, "petsc.toml")
            self.mpi(2, "run", "petsc.toml", "-q", "-o", f"reach {reach}")
            with self.subTest(reach=reach):
                parallel = self.summary(f"reach {reach}")
                self.assert_same(serial, parallel)
                solves[reach] = parallel["runs"][0]["back_solves"]
        # those that the flexibility takes are the same for any duration
        self.write('solver = { type = "petsc", reach = 2 }\n' + shorter, "shorter.toml")
        self.mpi(2, "run", "shorter.toml", "-q", "-o", "shorter")
        before = self.summary("shorter")["runs"][0]
        in_steps, steps = solves[2] - before["back_solves"], run["steps"] - before["steps"]
        print(f"reach 2 m: {in_steps} solves in {steps} steps, {solves[2] - in_steps} in those before and for the flexibility")
        self.assertLessEqual(in_steps - steps, 8 * steps, "beside the one of a step without interfaces")

    def test_openings_of_round_off(self):
        """A building without weight that falls with its soil: until the wave from below arrives, nothing opens but by the round-off of
        motions that are a million times larger."""
        text = RAFT[:RAFT.index("[gravity]")] + RAFT[RAFT.index("[[function]]"):]
        text = text.replace('[[stage]]\ntype = "static"\n', "").replace("duration = 0.3", "duration = 0.008")
        for given, far in (("width = 16\nlength = 14\n", "width = 48\nlength = 48\n"),
                           ("thickness = 2\nsize = 1", "thickness = 16\nsize = 2"),
                           ("thickness = 4\n", "thickness = 32\n"),
                           ("width = 8\nlength = 6\nheight = 1\nsize = 1", "width = 2\nlength = 2\nheight = 2\nsize = 2"),
                           ("width = 4\nlength = 4\nheight = 8\n", "width = 2\nlength = 2\nheight = 4\n")):
            self.assertIn(given, text)
            text = text.replace(given, far)
        self.write(text)
        self.uplift("run", "case.toml", "-q", "-o", "serial", "--no-step-check")
        self.write('solver = { type = "petsc", reach = 4 }\n' + text, "petsc.toml")
        self.mpi(2, "run", "petsc.toml", "-q", "-o", "reach", "--no-step-check")
        serial, run = self.summary("serial")["runs"][0], self.summary("reach")["runs"][0]
        self.assertLess(serial["peaks"]["underside.max_opening"]["value"], 1e-6 * abs(serial["peaks"]["top.uz"]["value"]))
        self.assertEqual((run["steps"], run["retries"], run["factorisations"]), (serial["steps"], 0, 1))
        for name in ("top.ux", "top.uy", "top.uz", "energy.kinetic", "energy.strain"):
            self.assertAlmostEqual(run["peaks"][name]["value"] / serial["peaks"][name]["value"], 1, delta=1e-8, msg=name)

    def test_motions_that_are_light_beside_what_the_weight_closes(self):
        for seed in (3, 4):
            text, _ = random_cases.case(seed)
            self.write(text)
            self.uplift("run", "case.toml", "-q", "-o", f"serial {seed}", "--no-step-check")
            self.write('solver = { type = "petsc", reach = 2 }\n' + text, "petsc.toml")
            self.mpi(2, "run", "petsc.toml", "-q", "-o", f"reach {seed}", "--no-step-check")
            with self.subTest(seed=seed):
                self.assert_same(self.summary(f"serial {seed}"), self.summary(f"reach {seed}"))


class Solver(MpiTest):
    def test_unit_tests_and_iterations(self):
        counts = []
        for ranks in (1, 2, 4):
            done = self.mpi(ranks, name="test_mpi")
            counts.append([int(number) for number in re.findall(r"^(?:conjugate gradients|stiff block, \w+): (\d+) iterations", done.stdout, re.M)])
            self.assertEqual(len(counts[-1]), 3, done.stdout)
        for of_ranks in zip(*counts):
            self.assertLessEqual(max(of_ranks), 1.1 * min(of_ranks), counts)

    def test_weak_scaling_table(self):
        lines = self.mpi(2, 5000, name="bench_weak").stdout.splitlines()
        self.assertEqual([line.split()[:2] for line in lines[1:]], [["1", "cells"], ["1", "entries"], ["2", "cells"], ["2", "entries"]])
        cells_of_one, one, cells_of_two, two = ([float(word.rstrip("%")) for word in line.split()[2:]] for line in lines[1:])
        self.assertEqual(two[0], 2 * one[0])  # unknowns
        self.assertLessEqual(abs(two[5] / one[5] - 1), 0.2)  # iterations: the wave crosses a few cubes in a step, not the block
        for cells, entries in ((cells_of_one, one), (cells_of_two, two)):  # the same matrix but for round-off
            self.assertLessEqual(abs(cells[5] - entries[5]), 1)


class Queue(MpiTest):
    def test_batch_script_of_the_guide_on_one_node(self):
        guide = (ROOT / "docs/guide/several_processes.md").read_text()
        script = re.search(r"^```text\n(#!/bin/bash\n.*?)^```", guide, re.M | re.S).group(1)
        for cluster, here in (("--nodes=2", "--nodes=1"), ("--ntasks-per-node=16", "--ntasks-per-node=2"), ("uplift-mpi run", "--oversubscribe uplift-mpi run")):
            self.assertEqual(script.count(cluster), 1, cluster)
            script = script.replace(cluster, here)
        self.write(script + "mpirun --oversubscribe bench_weak 5000 > table\n", "job.sh")
        self.write(with_solver(BASE), "tower/case.toml")
        self.write(BASE, "serial/case.toml")
        folder = pathlib.Path(tempfile.mkdtemp(prefix="slurm-"))  # its configuration takes no space in a path
        self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
        slurm = Slurm(folder)
        self.addCleanup(slurm.end)
        slurm.environment.update(ENVIRONMENT | {"SLURM_CONF": slurm.environment["SLURM_CONF"], "PATH": f"{pathlib.Path(program()).parent}:{os.environ['PATH']}"})
        job = slurm.said("sbatch", "--parsable", "job.sh", cwd=self.folder)
        wait_until(lambda: slurm.said("squeue", "-h") == "", slurm.log)
        said = (self.folder / f"slurm-{job}.out").read_text()
        self.assertIn("JobState=COMPLETED", slurm.said("scontrol", "show", "job", job), said)
        self.uplift("run", "serial", "-q", "-o", "out/serial")
        self.assert_same(self.summary("out/serial"), self.summary("out/tower"))
        self.assertEqual([line.split()[0] for line in (self.folder / "table").read_text().splitlines()], ["ranks", "1", "1", "2", "2"])


class Check(MpiTest):
    def test_tells_what_the_other_ranks_take(self):
        self.write(with_solver(RAFT))
        memory = json.loads(self.mpi(2, "check", "case.toml", "--json").stdout)["memory"]
        self.assertGreater(memory["other_ranks_bytes"], 0)
        self.assertLess(memory["other_ranks_bytes"], memory["bytes"])  # rank 0 holds the model besides its rows


class Refused(MpiTest):
    def test_by_the_program_for_one_process(self):
        self.write(with_solver(BASE))
        done = self.uplift("check", "case.toml", expect=2)
        self.assertEqual(done.stderr.count("\n"), 1)
        self.assertTrue(done.stderr.startswith('error: case.toml:1: solver: expected "cholmod", "eigen" or "dense"'))
        self.assertIn("needs the program uplift-mpi", done.stderr)

    def test_options(self):
        for options, why in (("-ksp_typ cg", "no part of the solver that they choose reads -ksp_typ"), ("-ksp_type foo", "Unable to find requested KSP type foo"),
                             ("ksp_type cg", 'found "ksp_type cg"'), ("-ksp_type gmres", "would not notice a matrix that is not positive definite"),
                             ("-ksp_type cg -ksp_rtol abc", "Input string abc has no numeric value"), ("-ksp_type cg -ksp_max_it 2", "did not converge in 2 iterations")):
            self.write(with_solver(BASE, options))
            done = self.mpi(2, "run", "case.toml", expect=2)
            errors = [line for line in done.stderr.splitlines() if line.startswith("error")]
            self.assertEqual(len(errors), 1, done.stderr)
            self.assertTrue(errors[0].startswith("error: case.toml:1: solver.options: expected options with which PETSc solves a matrix"), errors)
            self.assertIn(why, errors[0])
            self.assertNotIn("PETSC ERROR", done.stderr)
            self.assertEqual([path.name for path in self.folder.rglob("*") if path.is_file()], ["case.toml"])

    def test_bad_input_ends_all_ranks_with_the_code_of_the_program(self):
        self.write("nonsense")
        serial, parallel = self.uplift("run", "case.toml", expect=2), self.mpi(2, "run", "case.toml", expect=2)
        self.assertIn(serial.stderr.strip(), parallel.stderr)
        self.assertIn("studies", self.mpi(2, "study", "run", "x", expect=2).stderr)


class Ended(MpiTest):
    LONG = with_solver(BASE.replace("duration = 0.5", "duration = 20000") + '[output]\nevery = 1000\ncheckpoint = "1 s"\n')

    def test_a_rank_that_dies_ends_the_job_and_its_checkpoint_is_whole(self):
        self.write(self.LONG)
        for rank in (0, 1):
            job, ranks = self.start(2, "run", "case.toml", out=f"r{rank}")
            self.wait_for(f"r{rank}.part-*/**/*.ckp")
            begin = time.monotonic()
            os.kill(ranks[rank], signal.SIGKILL)
            self.assertNotEqual(self.ended(job)[0], 0)
            self.assertLessEqual(time.monotonic() - begin, 10)
            job, ranks = self.start(2, "resume", f"r{rank}", out=f"again{rank}")
            os.kill(ranks[0], signal.SIGTERM)
            code, err = self.ended(job)
            self.assertEqual(code, 128 + signal.SIGTERM, err)
            self.assertNotIn("is taken instead", err)  # which a damaged checkpoint leads to

    def test_sigterm_of_rank_0_keeps_the_results(self):
        self.write(self.LONG)
        job, ranks = self.start(2, "run", "case.toml", out="r")
        os.kill(ranks[1], signal.SIGTERM)  # the others leave it to rank 0
        time.sleep(1)
        self.assertIsNone(job.poll())
        os.kill(ranks[0], signal.SIGTERM)
        code, err = self.ended(job)
        self.assertEqual(code, 128 + signal.SIGTERM, err)
        self.assertEqual(self.summary("r")["runs"][0]["status"], "interrupted")


if __name__ == "__main__":
    main()
