"""Signals, full disks, targets that cannot take results, and hostile input."""

import csv
import pty
import resource
import shutil
import signal
import time

from support import *

LONG = BASE.replace("duration = 0.5", "duration = 20000") + "[output]\nevery = 1000\n"
SPRINGS = '[[variant]]\nname = "{}"\nlaw = {{ type = "springs", K_n = {} }}\n'


def some_seconds():
    """The case of a run that comes to its end after a second or two."""
    return LONG.replace("20000", "400" if sanitized() else "2000")


class RobustTest(CliTest):
    def start(self, *words, **options):
        return subprocess.Popen([program(), *map(str, words)], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)

    def ended_by(self, number, *words, after=0.5, **options):
        """Standard error of a command that a signal ends in order."""
        process = self.start(*words, **options)
        deadline = time.monotonic() + 60
        while not list(self.folder.glob("*.part-*")) and time.monotonic() < deadline:  # from here on signals are caught
            time.sleep(0.01)
        time.sleep(after)
        process.send_signal(number)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 128 + number, out + err)
        return err

    def names(self):
        return sorted(path.name for path in self.folder.iterdir())


class Signals(RobustTest):
    def test_every_signal_keeps_the_results(self):
        self.write(LONG)
        for name in ("SIGTERM", "SIGHUP", "SIGQUIT", "SIGXFSZ"):
            err = self.ended_by(getattr(signal, name), "run", "case.toml", "-o", name)
            self.assertIn(f"interrupted ({name}) at t =", err)
            (run,) = self.summary(name)["runs"]
            self.assertEqual(run["status"], "interrupted")
            self.assertGreater(run["end_time"], 0)
            self.assertTrue((self.folder / name / "report.html").is_file())
        self.assertEqual(self.names(), ["SIGHUP", "SIGQUIT", "SIGTERM", "SIGXFSZ", "case.toml"])

    def test_nohup_goes_on(self):
        self.write(some_seconds())
        process = self.start("run", "case.toml", "-o", "r", "-q", preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        while not list(self.folder.glob("r.part-*")):
            time.sleep(0.01)
        process.send_signal(signal.SIGHUP)
        process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0)
        self.assertEqual(self.summary("r")["runs"][0]["status"], "completed")

    def test_folders_of_killed_processes(self):
        self.write(BASE)
        killed = self.start("run", self.write(LONG, "long.toml").name, "-o", "r")
        while not list(self.folder.glob("r.part-*")):
            time.sleep(0.01)
        killed.kill()
        killed.communicate()
        gone = f"r.part-{killed.pid}"
        self.assertIn(gone, self.names())  # empty: removed by the next run
        (self.folder / f"{gone}-2").mkdir()
        (self.folder / f"{gone}-2" / "histories.csv").write_text("time [s]\n")  # not empty: mentioned
        (self.folder / f"r.part-{os.getpid()}").mkdir()  # of a process that lives
        (self.folder / "r.part-time").mkdir()  # of no process
        done = self.uplift("run", "case.toml", "-o", "r")
        self.assertIn(f"note: r.part-{killed.pid}-2/ holds the files of a command that was killed", done.stderr)
        self.assertEqual(set(self.names()), {"case.toml", "long.toml", "r", f"{gone}-2", f"r.part-{os.getpid()}", "r.part-time"})

    def test_a_killed_process_leaves_the_histories_so_far(self):
        killed = self.start("run", self.write(LONG, "long.toml").name, "-o", "r")
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            time.sleep(0.1)
            if [file for file in self.folder.glob("r.part-*/histories.csv") if file.read_text().count("\n") > 20]:
                break
        killed.kill()
        killed.communicate()
        (left,) = self.folder.glob("r.part-*/histories.csv")
        rows = left.read_text().splitlines()
        self.assertGreater(len(rows), 20)
        self.write(LONG.replace("20000", "20"))  # the same rows, to the last digit, as those of a run that ends
        self.uplift("run", "case.toml", "-o", "short")
        self.assertEqual(rows[:20], (self.folder / "short" / "histories.csv").read_text().splitlines()[:20])

    def test_interrupted_comparison_does_not_agree(self):
        self.write(LONG.replace("20000", "200").replace("bonded = false\n", "bonded = false\nenergy = { created_limit = 1e6 }\n")
                   + '[[variant]]\nname = "quick"\nstep = 0.05\n[[variant]]\nname = "long"\nstep = 1e-5\n')
        self.ended_by(signal.SIGTERM, "compare", "case.toml", "-o", "r", after=1.0)
        runs = self.summary("r")["runs"]
        self.assertEqual([run["status"] for run in runs], ["completed", "interrupted"])
        self.assertEqual([run["agreement"]["result"] for run in runs], ["agrees", "-"])

    def test_interrupted_trust_says_no_bands(self):
        self.write(some_seconds())
        ours, theirs = pty.openpty()  # progress is drawn at once on a terminal
        process = subprocess.Popen([program(), "trust", "case.toml", "-o", "r"], cwd=self.folder, stdout=subprocess.PIPE, stderr=theirs, text=True,
                                   env={**os.environ, "TERM": "xterm"})
        os.close(theirs)
        while b"trust:" not in os.read(ours, 1000):  # the run of the case is over
            pass
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=120)
        os.close(ours)
        self.assertEqual(process.returncode, 130, out)
        trust = json.loads((self.folder / "r" / "trust.json").read_text())
        self.assertFalse(trust["complete"])
        counted = [run["counts"] for run in trust["runs"]]
        if any(counted):
            self.assertIn(f"Over {sum(counted)} of {len(counted)} changed choices", out)
        else:
            self.assertEqual(trust["bands"], [])
            self.assertIn(f"No bands: none of the {len(counted)} runs with a changed choice was completed.", out)


class Targets(RobustTest):
    def refused_target(self, target, why):
        process = self.uplift("run", self.write(LONG).name, "-o", target, expect=2, timeout=20)  # the run itself takes longer
        self.assertIn(why, process.stderr)
        self.assertLess(len(process.stderr), 600)

    def test_targets_are_checked_before_the_run(self):
        (self.folder / "link").symlink_to("nowhere/at/all")
        self.refused_target("link", "found a symbolic link to nowhere/at/all, which does not exist")
        self.refused_target("n" * 250, "expected a folder that can be made for the results, found File name too long")
        self.refused_target("/proc", "found a mount point")
        self.refused_target("case.toml", "expected a folder for the results, found a file")
        self.assertEqual(self.names(), ["case.toml", "link"])

    def test_a_link_passes_results_to_its_target(self):
        (self.folder / "disk").mkdir()
        (self.folder / "link").symlink_to("disk")
        self.write(BASE)
        for _ in range(2):
            self.uplift("run", "case.toml", "-o", "link", "-q")
        self.assertTrue((self.folder / "link").is_symlink())
        self.assertTrue((self.folder / "disk" / "summary.json").is_file())
        self.assertTrue((self.folder / "disk.1" / "summary.json").is_file())

    def test_long_name_of_a_variant(self):
        text = BASE + SPRINGS.format("v" * 65, "2e8")
        line = line_of(text, '"vvvv')
        self.refused(text, f"{{file}}:{line}: variant[0].name: expected a name of at most 64 characters (it names files; `label` may be longer), "
                     "found 65 characters", command="compare")


class FullDisk(RobustTest):
    def run_with_files_up_to(self, size):
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
        return self.uplift("run", "case.toml", "-o", "r", expect=None, preexec_fn=limit)

    def test_what_was_written_is_kept(self):
        self.write(BASE)
        done = self.run_with_files_up_to(200_000)  # the report is larger
        self.assertEqual(done.returncode, 128 + signal.SIGXFSZ)
        self.assertIn("error: r/report.html: cannot write the file: File too large", done.stderr)
        (kept,) = self.folder.glob("r.part-*")
        self.assertIn(f"the results are not complete; the files that were written are in {kept.name}/", done.stderr)
        self.assertEqual(sorted(path.name for path in kept.iterdir()), ["case.resolved.toml", "histories.csv", "load_steps.csv", "summary.json"])
        self.assertEqual(self.summary(kept.name)["runs"][0]["status"], "completed")
        rows = (kept / "histories.csv").read_text().splitlines()
        self.assertEqual(len(rows), 1 + 501)  # the head, the beginning and 500 steps
        self.assertFalse((self.folder / "r").exists())

    def test_fields_that_cannot_be_written(self):
        box = ('[mesh.soil_box]\nsoil = { width = 20, size = 2, layers = [{ thickness = 4, size = 2 }] }\nblock = { width = 4, height = 4, size = 1 }\n'
               + "".join(f'[[solid]]\ngroup = "{group}"\nE = 1e9\npoisson = 0.3\ndensity = 2000\n' for group in ("soil_1", "block"))
               + '[[support]]\ngroup = "soil_bottom"\nfixed = ["ux", "uy"]\n[[interface]]\nname = "base"\n'
               'surface = { group = "interface", lower = ["soil_1"] }\nlaw = { type = "springs", K_n = 1e9, K_t = 1e9, tangential = "bonded" }\n'
               '[gravity]\nacceleration = [0, -9.81]\n[[stage]]\ntype = "static"\n[[stage]]\ntype = "dynamic"\nduration = 0.1\nstep = 1e-3\n')
        for form in ("vtu", "xdmf"):
            with self.subTest(form=form):
                self.write(f'title = "test"\nbonded = false\n{box}[output.fields]\nformat = "{form}"\nevery = 5\n')
                done = self.run_with_files_up_to(5000)
                self.assertEqual(done.returncode, 128 + signal.SIGXFSZ, done.stderr)
                self.assertIn("error: r/fields/", done.stderr)
                (kept,) = self.folder.glob("r.part-*")
                self.assertIn("histories.csv", [path.name for path in kept.iterdir()])
                shutil.rmtree(kept)

    def test_earlier_results_stay(self):
        self.write(BASE)
        self.uplift("run", "case.toml", "-o", "r", "-q")
        before = (self.folder / "r" / "summary.json").read_text()
        self.run_with_files_up_to(1000)
        self.assertEqual((self.folder / "r" / "summary.json").read_text(), before)

    def test_standard_output(self):
        self.write(BASE)
        with open("/dev/full", "w") as full:
            for words in (["check", "case.toml"], ["schema"], ["describe"], ["describe", "law", "sdm"], ["--help"], ["completion"],
                          ["modes", "case.toml"], ["run", "case.toml", "--json", "-o", "r"]):
                done = subprocess.run([program(), *words], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, text=True)
                self.assertEqual(done.returncode, 4, words)
                self.assertEqual(done.stderr.splitlines()[-1], "error: cannot write to standard output: No space left on device")
        self.assertEqual(self.summary("r")["runs"][0]["status"], "completed")

    def test_standard_error(self):
        self.write(BASE)
        with open("/dev/full", "w") as full:
            done = subprocess.run([program(), "run", "case.toml", "-o", "r"], cwd=self.folder, stderr=full, stdout=subprocess.PIPE)
        self.assertEqual(done.returncode, 0)


class Names(RobustTest):
    HISTORY = '[[output.history]]\nnode = "top"\nquantity = "vx"\nname = {}\n'

    def test_columns_keep_their_place(self):
        self.write(BASE + self.HISTORY.format(repr('moment, "top"')))
        self.uplift("run", "case.toml", "-o", "r", "-q")
        with open(self.folder / "r" / "histories.csv", newline="") as file:
            head, *rows = csv.reader(file)
        self.assertIn('moment, "top" [m/s]', head)
        self.assertEqual({len(row) for row in rows}, {len(head)})
        given, automatic = (head.index(name) for name in ('moment, "top" [m/s]', "top.vx [m/s]"))
        self.assertTrue(all(row[given] == row[automatic] for row in rows))

    def test_refused_names(self):
        for name, why in (('"=cmd"', "that does not begin with '=', '+', '-' or '@' (tables would take it for a formula), found \"=cmd\""),
                          ('"@x"', "that does not begin with '=', '+', '-' or '@' (tables would take it for a formula), found \"@x\""),
                          ('"a\\nb"', 'without control characters, found "a\\nb"'), ('" "', ", found blanks"), ('""', ", found an empty text"),
                          ('"' + "n" * 201 + '"', "of at most 200 bytes, found 201 bytes")):
            text = BASE + self.HISTORY.format(name)
            line = len(text.splitlines())
            with self.subTest(name=name):
                self.refused(text, f"{{file}}:{line}: output.history[0].name: expected a name for the column{'' if why[0] == ',' else ' '}{why}")
        text = BASE + self.HISTORY.format('"time"')
        self.refused(text, f'{{file}}:{len(text.splitlines())}: output.history[0].name: expected a name other than that of the first column, found "time"')
        text = BASE + self.HISTORY.format('"top.ux"')
        self.refused(text, f"{{file}}:{len(text.splitlines())}: output.history[0].name: expected a name that no other column has, found \"top.ux\", "
                     "which is there automatically")

    def test_long_texts_are_shortened(self):
        long = "c" * 20000
        for text in (BASE + long + " = 1\n", BASE.replace('node = "top"\nmass', f'node = "{long}"\nmass'), BASE.replace('"column"', f'"{long}"')):
            self.write(text)
            self.assertLess(len(self.uplift("check", "case.toml", expect=2).stderr), 600)
        self.write(BASE)
        for words in ((long,), ("check", long), ("check", "case.toml", "--" + long), ("run", "case.toml", "-o", long)):
            self.assertLess(len(self.uplift(*words, expect=2).stderr), 700)


class Report(RobustTest):
    def test_title_cannot_leave_its_script(self):
        title = "<!--<script></script>"
        self.write(BASE.replace('"test"', f'"{title}"'))
        self.uplift("run", "case.toml", "-o", "r", "-q")
        self.assertEqual(report_of(self.folder / "r")["summary"]["title"], title)
        self.assertNotIn("<!--<script", (self.folder / "r" / "report.html").read_text())  # the data is in base64, which has no "<"


class Inputs(RobustTest):
    def test_only_regular_files(self):
        os.mkfifo(self.folder / "pipe")
        for words in (("check",), ("motion",), ("replay",)):
            for file in ("pipe", "/dev/zero"):
                done = self.uplift(*words, file, expect=2, timeout=20)
                self.assertEqual(done.stderr.strip(), f"error: {file}: expected a regular file, found a pipe, a device or a socket (write its content to a file first)")
        self.write(BASE + '[[record]]\nname = "quake"\nfile = "pipe"\n')
        self.assertIn('record[0].file: expected a file, found "pipe"', self.uplift("check", "case.toml", expect=2, timeout=20).stderr)
        self.write(BASE + '[mesh]\nfile = "pipe"\n')
        self.uplift("check", "case.toml", expect=2, timeout=20)

    def test_size_limit_of_files(self):
        record = self.folder / "quake.csv"
        with open(record, "w") as file:
            file.truncate(101_000_000)
        done = self.uplift("motion", "quake.csv", expect=2)
        self.assertEqual(done.stderr.strip(), "error: quake.csv: expected a file of at most 100 MB (the environment variable UPLIFT_MAX_FILE_MB raises "
                         "this limit), found 101 MB")
        self.write(BASE)
        self.assertIn("of at most 0 bytes", self.uplift("check", "case.toml", expect=2, env={**os.environ, "UPLIFT_MAX_FILE_MB": "0"}).stderr)
        with open(self.folder / "case.toml", "a") as file:
            file.write("#" + " " * 1_000_000 + "\n")
        self.uplift("check", "case.toml", env={**os.environ, "UPLIFT_MAX_FILE_MB": "2"})

    def test_magnitudes(self):
        for before, after, path, why in (
                ("top = [0, 5]", "top = [0, 1e300]", "nodes.top[1]", "a length of at most 1e+10 m, found 1e+300 m"),
                ("base = [0, 0]", "base = [-2e10, 0]", "nodes.base[0]", "a length of at most 1e+10 m, found -20000000000 m"),
                ("mass = 24317", "mass = 1e31", "mass[0].mass", "a mass of at most 1e+30 kg, found 1e+31 kg"),
                ("step = 1e-3", "step = 1e-300", "stage[1].step", "a time of at least 1e-30 s, found 1e-300 s")):
            text = BASE.replace(before, after)
            self.refused(text, f"{{file}}:{line_of(text, after)}: {path}: expected {why}")

    def test_motions_stay_finite(self):
        record = self.folder / "a.csv"
        record.write_text("time [s],a [m/s2]\n" + "".join(f"{0.01 * i:.2f},{(-1) ** i}\n" for i in range(200)))
        for words, why in ((["a.csv", "--damping", "nan"], "damping ratios from 0 to 0.99, found nan"),
                           (["a.csv", "--step", "1e-300"], "a time step from 1e-07 s to 1e+06 s, found 1e-300 s"),
                           (["a.csv", "--process", "scale factor=1e308"], "a number of at most 1e+30, found 1e+308"),
                           (["a.csv", "--process", "scale factor=1e20"], "values of a ground motion, at most 1e+06 m/s2, found 1e+20 m/s2"),
                           (["--generate", "rg_1_60", "pga=1e300"], "an acceleration of at most 1e+30 m/s2, found 1e+300 m/s2")):
            self.assertIn("expected " + why, self.uplift("motion", *words, expect=2).stderr)
        text = BASE + '[[record]]\nname = "quake"\nfile = "a.csv"\nprocess = [{ do = { type = "scale", factor = 1e20 } }]\n'
        self.write(text)
        self.assertIn("values of a ground motion, at most 1e+06 m/s2", self.uplift("check", "case.toml", expect=2).stderr)

    def test_stored_problem_with_an_infinite_area(self):
        problem = json.loads((pathlib.Path(__file__).parent / "stored_problem.json").read_text())
        problem["blocks"][0]["area"][0] = "inf"
        self.write(json.dumps(problem), "problem.json")
        self.assertIn("blocks[0].area: expected finite areas > 0, found inf", self.uplift("replay", "problem.json", expect=2).stderr)

    def test_soil_box_is_counted_first(self):
        box = ('[mesh.soil_box]\nsoil = {{ width = 60, length = 60, size = 10, layers = [{{ thickness = {}, size = {} }}] }}\n'
               'raft = {{ width = 10, length = 10, height = 1, size = 1 }}\n')
        few = lambda: resource.setrlimit(resource.RLIMIT_AS, (2_000_000_000, 2_000_000_000))
        if self.cannot_be_limited():
            return
        for thickness, size, why in ((1e10, 10, "sizes that make at most 50 million elements, found a grid of at least "),
                                     (1e4, 1, "elements, whose matrices fit into memory, found a grid of ")):
            self.write(BASE + box.format(thickness, size))
            self.assertIn(why, self.uplift("check", "case.toml", expect=2, timeout=20, preexec_fn=few).stderr)

    def test_histories_that_do_not_fit(self):
        self.write(BASE.replace("duration = 0.5", "duration = 1e9"))  # 1e12 steps
        err = self.uplift("run", "case.toml", expect=2, timeout=20).stderr
        self.assertIn("output.every: expected histories that fit into the ", err)
        self.assertIn(" for 1e+12 steps (a larger step, a shorter duration or a larger `every` takes less)", err)
        self.write(BASE)
        told = json.loads(self.uplift("check", "case.toml", "--json").stdout)["histories"]
        self.uplift("run", "case.toml", "-o", "r", "-q")
        lines = (self.folder / "r" / "histories.csv").read_text().splitlines()
        self.assertEqual((told["rows"], told["columns"]), (len(lines) - 1, len(lines[0].split(","))))
        # time, table and 72 bytes a step for one interface: its forces, and a tenth of its poses
        self.assertAlmostEqual(told["memory_bytes"] / (8 * told["rows"] * told["columns"] + 500 * (8 + 64 + 5.6)), 1, places=2)
        size = (self.folder / "r" / "histories.csv").stat().st_size
        self.assertLess(abs(told["disk_bytes"] / size - 1), 0.25)

    def test_threads_of_blas(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (150_000_000, 150_000_000))
        if not self.cannot_be_limited():
            self.uplift("--version", timeout=20, preexec_fn=limit, env={**os.environ, "OPENBLAS_NUM_THREADS": "2"})
        self.write(LONG)
        process = self.start("run", "case.toml", "-o", "r", "-q", "--no-step-check", env={**os.environ, "OPENBLAS_NUM_THREADS": "2"})
        while not list(self.folder.glob("r.part-*")):
            time.sleep(0.01)
        time.sleep(0.3)
        threads = len(os.listdir(f"/proc/{process.pid}/task"))
        process.terminate()
        process.communicate(timeout=60)
        self.assertEqual(threads, 1)


class Energy(RobustTest):
    def test_lost_energy_is_a_warning(self):
        for step, warned in (("2e-2", True), ("1e-3", False)):
            self.write(BASE.replace('type = "dynamic"', 'type = "dynamic"\nscheme = { type = "generalised_alpha", rho = 0 }').replace("1e-3", step))
            err = self.uplift("run", "case.toml", "-o", "r").stderr
            (run,) = self.summary("r")["runs"]
            self.assertEqual(run["energy_lost"]["value"] > 0.05 * run["energy_scale"], warned)
            self.assertEqual("warning: the time scheme lost " in err, warned)


class Places(RobustTest):
    def test_messages_have_a_place(self):
        bare = BASE[:BASE.index("[[stage]]")]
        self.refused(bare, "{file}: expected at least one [[stage]], found none")
        loose = BASE[:BASE.index("[[rigid]]")] + BASE[BASE.index("[[load]]"):]
        top = next(number for number, line in enumerate(loose.splitlines(), 1) if line.startswith("top ="))
        self.refused(loose, f'{{file}}:{top}: expected a structure that its supports hold, found a mechanism: "top", "base" can move '
                     "along (1, 0) without resistance; hold it by a [[support]] or a [[spring]]")
        sweep = BASE.replace('type = "dynamic"', 'type = "dynamic"\nscheme = { type = "generalised_alpha", rho = 0.8 }') + (
            SPRINGS.format("a", "2e8") + '[compare.stiffness_sweep]\nlaw = { type = "springs", K_n = 2e8 }\nratios = [1]\n')
        self.refused(sweep, f"{{file}}:{len(sweep.splitlines()) - 1}: compare.stiffness_sweep: expected stages with the average acceleration: the sweep "
                     'compares both tractions, found "generalised_alpha"', command="compare")

    def test_amplitude_of_a_motion(self):
        free = BASE.replace('fixed = ["ux"]\n', "fixed = []\n")
        motion = '[[motion]]\nnode = "base"\ndirection = "{}"\namplitude = {}\nfunction = "pulse"\n'
        peaks = []
        for amplitude in ("0.002", '"2 mm"', '"0.2 cm"'):
            self.write(free + motion.format("ux", amplitude))
            self.uplift("run", "case.toml", "-o", "r", "-q")
            (run,) = self.summary("r")["runs"]
            peaks.append(run["peaks"]["base.ux"]["value"])
        self.assertEqual(peaks, [2e-3] * 3)  # the largest value of the half sine is 1
        text = free + motion.format("ux", '"2 mrad"')
        self.refused(text, f"{{file}}:{line_of(text, 'mrad')}: motion[0].amplitude: expected a length [m], found \"2 mrad\" (an angle)")


class YieldingSoil(CliTest):
    """Example 02 on soil that yields under its earthquake: hardly a step is halved."""

    def test_steps_of_an_earthquake(self):
        example = pathlib.Path(__file__).resolve().parents[2] / "examples" / "02_building_on_soil"
        for file in example.iterdir():
            if file.is_file():
                shutil.copy(file, self.folder)
        text = (example / "case.toml").read_text()
        for law in ('friction_angle = "25 deg", dilatancy_angle = "5 deg"', 'friction_angle = 0, fit = "plane_strain"'):  # the latter: a symmetric tangent
            law = f'law = {{ type = "drucker_prager", cohesion = "20 kPa", {law} }}'
            changed = text.replace('[[solid]]\ngroup = "soil_1"\n', f'[[solid]]\ngroup = "soil_1"\n{law}\n', 1)
            self.assertIn(law, changed)
            self.write("bonded = false\n" + re.sub("^duration = .*$", 'duration = "1.1 s"', changed, flags=re.M))
            self.uplift("run", "case.toml", "-o", "out", "--no-step-check")
            run = self.summary("out")["runs"][0]
            self.assertEqual(run["status"], "completed", law)
            self.assertLessEqual(run["retries"], 2, law)
            self.assertLess(run["energy_created_share"], 1e-10)
            shutil.rmtree(self.folder / "out")


if __name__ == "__main__":
    main()
