"""Studies and statements of reliability whose processes are killed or interrupted: nothing that was told is lost, nothing counts twice, and the results
are those of a study that nobody disturbed. The tests wait for what they disturb, never for a time."""

import random
import signal
import time

from study_cases import *

LOCKSTEP = STRIPES.replace("[0.2, 0.5, 1.0]", "[0.3, 0.6]").replace('"../m3.csv", "../m4.csv"', "").replace('"1 mm"', '"0.1 mm"')
ROCKING = BASE.replace("bonded = false", "bonded = true").replace("duration = 0.5", "duration = 20") + "[output]\nevery = 100\n"
WALL = re.compile(r'"wall_seconds": [-+.e0-9]+')


def until(condition, process):
    """Waits for a condition; false where the process ends before."""
    while process.poll() is None:
        if condition():
            return True
        time.sleep(0.001)
    return condition()


def children(process):
    return [int(each) for each in subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True).stdout.split()]


def computing(worker):
    """Seconds of the processor that a process has used; 0 where it is gone."""
    try:
        return sum(map(int, pathlib.Path(f"/proc/{worker}/stat").read_text().rsplit(")", 1)[1].split()[11:13])) / os.sysconf("SC_CLK_TCK")
    except OSError:
        return 0


class Disturbed(StudyTest):
    def start(self, *words):
        """Without the check for leaks of the address sanitizer: at its end it has a child of its own, and waits for ever where that one is killed."""
        options = os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"
        process = subprocess.Popen([program(), *words], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   env={**os.environ, "ASAN_OPTIONS": options})
        self.addCleanup(process.kill)
        return process

    def lines(self, folder):
        """Whole lines of all parts."""
        return [line for part in sorted((self.folder / folder / "parts").glob("*.jsonl")) for line in part.read_text().splitlines(keepends=True) if line.endswith("\n")]

    def ids(self, folder):
        return [json.loads(line)["id"] for line in self.lines(folder)]


class Studies(Disturbed):
    def test_killed_processes_lose_nothing(self):
        plan = IDA.replace("1 mm", "2 mm") + '[[limit]]\nname = "drift"\nquantity = "max_drift"\nlimit = 0.005\n'
        self.write(CASE.replace("duration = 1\n", "duration = 10\n"))
        self.uplift("study", "run", self.study(plan, "whole.study"), "-q", "-j", "1")
        expected = self.evaluated("whole.study")
        name, lines, draw = self.study(plan), set(), random.Random(7)
        for attempt in range(12):
            process = self.start("study", "run", name, "-q")
            time.sleep(draw.uniform(0.05, 0.4))
            workers = children(process)
            victim = process.pid if attempt % 2 or not workers else draw.choice(workers)
            try:
                os.kill(victim, signal.SIGKILL)
            except ProcessLookupError:
                pass
            if victim != process.pid:
                time.sleep(0.1)
                process.send_signal(signal.SIGTERM)
            process.communicate(timeout=300)
            now = {line for part in (self.folder / name / "parts").glob("*.jsonl") for line in part.read_text().splitlines()}
            self.assertTrue(lines <= now)
            lines = now
        for _ in range(50):  # workers of a killed coordinator may hold on for a moment
            done = self.uplift("study", "run", name, "-q", expect=None)
            if done.returncode == 0:
                break
            time.sleep(0.1)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.evaluated(name), expected)

    def test_an_interrupted_group_is_dropped(self):
        """Runs that march in lockstep have no result before they end: those of a group whose process ends are computed again."""
        self.write(LARGE)
        self.uplift("study", "run", self.study(LOCKSTEP, "whole.study"), "-q", "-j", "1")
        expected = self.evaluated("whole.study")
        name = self.study(LOCKSTEP)
        for disturb in ("coordinator", "worker", "in order"):
            with self.subTest(disturb=disturb):
                process = self.start("study", "run", name, "-q", "-j", "1")
                until(lambda: any(computing(worker) > 0.05 for worker in children(process)), process)
                before = set(self.lines(name))
                if disturb == "in order":
                    process.send_signal(signal.SIGTERM)
                elif victims := [process.pid] if disturb == "coordinator" else children(process):
                    os.kill(victims[0], signal.SIGKILL)
                    if disturb == "worker":
                        until(lambda: victims[0] not in children(process), process)
                        process.send_signal(signal.SIGTERM)
                process.communicate(timeout=300)
                self.assertTrue(before <= set(self.lines(name)))
        self.finish(name)
        self.assertEqual(self.evaluated(name), expected)
        self.assertEqual(len(self.ids(name)), len(set(self.ids(name))))

    def test_a_killed_study_with_a_reduced_model_is_begun_again(self):
        """Records of a reduced model are marched one after another: a process that is killed has lost the one that it was at."""
        case = CASE.replace("duration = 1\n", "duration = 5\n")
        self.write(case)
        self.uplift("reduce", "case.toml", "--size", "3", "--quiet", "-o", "case.rom")
        self.write('reduced_model = "case.rom"\n' + case)
        plan = STRIPES.replace("[0.2, 0.5, 1.0]", "[0.2, 0.3, 0.4, 0.5]")
        self.uplift("study", "run", self.study(plan, "whole.study"), "-q", "-j", "1")
        expected, ids = self.evaluated("whole.study"), self.ids("whole.study")
        name = self.study(plan)
        for disturb in ("coordinator", "worker"):
            with self.subTest(disturb=disturb):
                process = self.start("study", "run", name, "-q", "-j", "1")
                told = len(self.lines(name))
                self.assertTrue(until(lambda: len(self.lines(name)) > told + 1, process))
                before = set(self.lines(name))
                if disturb == "coordinator":
                    os.kill(process.pid, signal.SIGKILL)
                else:  # the coordinator is stopped meanwhile: it would let another worker go on
                    os.kill(process.pid, signal.SIGSTOP)
                    for worker in children(process):
                        os.kill(worker, signal.SIGKILL)
                    process.send_signal(signal.SIGTERM)
                    process.send_signal(signal.SIGCONT)
                process.communicate(timeout=300)
                self.assertTrue(before <= set(self.lines(name)))
                self.assertLess(len(self.ids(name)), len(ids))  # it was killed in the middle
        self.finish(name)
        self.assertEqual(self.evaluated(name), expected)
        self.assertEqual(sorted(self.ids(name)), sorted(ids))

    def finish(self, name):
        """Computes what is missing. Workers of a killed coordinator may hold its lock for a moment."""
        for _ in range(500):
            done = self.uplift("study", "run", name, "-q", expect=None)
            if done.returncode == 0:
                return
            time.sleep(0.02)
        self.fail(done.stderr)

    def test_killed_at_random_instants(self):
        """The coordinator or one of its workers, after a random number of results: a part of a second each, so that the suite stays quick."""
        plan = STRIPES.replace("[0.2, 0.5, 1.0]", str([round(0.2 + 0.05 * k, 2) for k in range(25)]))
        self.uplift("study", "run", self.study(plan, "whole.study"), "-q")
        expected = self.evaluated("whole.study")
        name, draw, told = self.study(plan), random.Random(11), set()
        for _ in range(12):
            process = self.start("study", "run", name, "-q", "-j", "2")
            wanted = len(self.lines(name)) + draw.randrange(1, 8)
            until(lambda: len(self.lines(name)) >= wanted, process)
            told |= set(self.lines(name))
            victims = [process.pid] if draw.random() < 0.5 else children(process)
            if process.poll() is None and victims:
                try:
                    os.kill(draw.choice(victims), signal.SIGKILL)
                except ProcessLookupError:
                    pass
                process.send_signal(signal.SIGTERM)
            process.communicate(timeout=300)
            self.assertTrue(told <= set(self.lines(name)))
        self.finish(name)
        self.assertEqual(self.evaluated(name), expected)
        self.assertEqual(len(set(self.ids(name))), 100)
        self.assertEqual(json.loads(self.uplift("study", "status", name, "--json").stdout)["runs"], 100)


class Trust(Disturbed):
    def setUp(self):
        CliTest.setUp(self)
        self.write(ROCKING)

    def answer(self, folder="r"):
        return WALL.sub('"wall_seconds": 0', (self.folder / folder / "trust.json").read_text())

    def straight(self):
        self.uplift("trust", "case.toml", "-o", "straight", "-q")
        return self.answer("straight")

    def test_begun_again_it_computes_what_is_missing(self):
        expected = self.straight()
        all_runs = len(json.loads(expected)["runs"])
        self.assertEqual(len(self.ids("straight.trust")), all_runs)
        for number in (signal.SIGKILL, signal.SIGINT):
            with self.subTest(number=number):
                process = self.start("trust", "case.toml", "-o", "r", "-q")
                until(lambda: self.lines("r.trust"), process)
                before = self.lines("r.trust")
                process.send_signal(number)
                process.communicate(timeout=300)
                if process.returncode == 130:
                    self.assertFalse(json.loads(self.answer())["complete"])
                self.assertTrue(set(before) <= set(self.lines("r.trust")))
                self.again("r")
                self.assertEqual(self.answer(), expected)
                self.assertEqual(len(self.ids("r.trust")), all_runs)
                self.assertEqual(len(set(self.ids("r.trust"))), all_runs)
                for path in self.folder.glob("r*"):
                    subprocess.run(["rm", "-r", path], check=True)

    def again(self, name):
        for _ in range(500):  # workers of a killed command may hold its lock for a moment
            done = self.uplift("trust", "case.toml", "-o", name, "-q", expect=None)
            if done.returncode == 0:
                return done
            time.sleep(0.02)
        self.fail(done.stderr)

    def test_damaged_lines_are_computed_again(self):
        expected = self.straight()
        (part,) = (self.folder / "straight.trust/parts").glob("*.jsonl")
        lines = part.read_bytes().splitlines(keepends=True)
        changed = bytearray(lines[1])
        changed[len(changed) // 2] ^= 1
        part.write_bytes(b"".join([lines[0], bytes(changed), *lines[2:]])[:-40])
        done = self.again("straight")
        self.assertIn("damaged lines of the parts, whose runs count as not computed: 1", done.stderr)
        self.assertEqual(self.answer("straight"), expected)
        (fresh,) = (path for path in part.parent.glob("*.jsonl") if path != part)
        self.assertEqual(len(fresh.read_text().splitlines()), 2)

    def test_a_repetition_that_failed_keeps_its_case_and_its_problem(self):
        """Two iterations reach no tolerance of 1e-9 where points open, and the step is not halved."""
        self.write(BASE.replace('[[stage]]\ntype = "dynamic"', '[method]\ntype = "newton"\nmost_iterations = 2\ntolerance = 1e-9\n[[stage]]\ntype = "dynamic"\nhalvings = 0'))
        self.uplift("trust", "case.toml", "-o", "r", expect=3)
        failed = [run for run in json.loads((self.folder / "r/trust.json").read_text())["runs"] if run["status"] == "failed"]
        kept = sorted((self.folder / "r.trust/runs").iterdir())
        self.assertGreater(len(failed), 0)
        self.assertEqual(len(kept), len(failed))
        reasons = []
        for folder in kept:
            self.assertIn("did not converge in 2 iterations", self.uplift("replay", folder / "problem.json", expect=None).stdout)
            reasons.append(self.uplift("run", folder / "case.resolved.toml", "-o", "again", "--no-step-check", expect=3).stderr)
        for run in failed:
            self.assertTrue(any(run["reason"] in said for said in reasons), run["reason"])

    def test_a_complete_one_is_not_computed_again(self):
        expected = self.straight()
        parts = {path: path.read_bytes() for path in (self.folder / "straight.trust/parts").iterdir()}
        self.again("straight")
        self.assertEqual(self.answer("straight"), expected)
        self.assertEqual({path: path.read_bytes() for path in (self.folder / "straight.trust/parts").iterdir()}, parts)
        self.write(ROCKING + "[trust]\ninterior = 1\n")  # two more stiffnesses
        self.again("straight")
        self.assertEqual(len(self.ids("straight.trust")), len(json.loads(expected)["runs"]) + 2)
        self.assertIn("Between the case and each end of the stiffness one value was computed too.", self.summary("straight")["verdict"]["consequence"])


if __name__ == "__main__":
    main()
