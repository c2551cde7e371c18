"""Runs that were interrupted or killed go on from their checkpoints, to the same files byte for byte."""

import shutil
import signal
import struct
import time

from support import *
from test_fields import ROCKING

KEPT = BASE.replace("bonded = false\n", "").replace("duration = 0.5", "duration = {}") + '[output]\nevery = 100\ncheckpoint = "0.02 s"\n'
TIMES = re.compile(r'("(?:wall_seconds|step_seconds|created|command)": )("[^"]*"|[-+.e0-9]+)')


def duration():
    """Duration of the motion in KEPT [s]: a run takes about half a second, with sanitizers too, so that a signal meets it before its end."""
    return 30 if sanitized() else 400


def kept():
    """A case whose run takes long enough for a signal and writes checkpoints."""
    return KEPT.replace("duration = {}", f"duration = {duration()}")


class Resume(CliTest):
    def files(self, folder):
        """Names and contents of all results; times that computations took and the command are left out."""
        return {path.name: TIMES.sub(r"\1", path.read_text()) for path in (self.folder / folder).iterdir() if path.is_file() and path.name != "report.html"}

    def ended(self, number, after, *words, verb="run", checkpoint="*.ckp", by=None):
        """What a run says that gets a signal some time after its first checkpoint."""
        process = subprocess.Popen([by or program(), verb, *words], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while not list(self.folder.glob("r.part-*/checkpoint/" + checkpoint)) and process.poll() is None:
            time.sleep(0.002)
        time.sleep(after)
        process.send_signal(number)
        _, err = process.communicate(timeout=120)
        self.assertIn(process.returncode, (-number, 128 + number), err)
        return err

    def test_killed_and_interrupted_runs_end_with_the_same_files(self):
        self.write(kept())
        self.uplift("run", "case.toml", "-o", "straight")
        expected = self.files("straight")
        for number, after in ((signal.SIGKILL, 0), (signal.SIGTERM, 0.02), (signal.SIGKILL, 0.05)):
            with self.subTest(number=number, after=after):
                err = self.ended(number, after, "case.toml", "-o", "r")
                if number == signal.SIGTERM:
                    self.assertIn("uplift resume r goes on from there", err)
                    self.assertLess(self.summary("r")["runs"][0]["end_time"], duration())
                self.uplift("resume", "r")
                made = self.files("r")
                self.assertEqual(sorted(made), sorted(expected))
                self.assertEqual([name for name in made if made[name] != expected[name]], [])
                for path in self.folder.glob("r*"):
                    shutil.rmtree(path)

    def fields(self, folder):
        """Names and bytes of the field files."""
        return {path.relative_to(self.folder / folder).as_posix(): path.read_bytes() for path in (self.folder / folder / "fields").rglob("*") if path.is_file()}

    def assert_resumed(self, folder, expected, number):
        """The field files of an interrupted run are other ones; those of the resumed run are the expected ones, to the last byte."""
        if number != signal.SIGKILL:
            self.assertNotEqual(self.fields(folder), expected)
        self.uplift("resume", folder, "-q")
        made = self.fields(folder)
        self.assertEqual(sorted(made), sorted(expected))
        self.assertEqual([name for name in made if made[name] != expected[name]], [])
        self.assertFalse((self.folder / folder / "checkpoint").exists())
        for path in self.folder.glob("r*"):
            shutil.rmtree(path)

    def test_fields_are_those_of_a_run_without_interruption(self):
        for format in ("vtu", "xdmf"):
            self.write(ROCKING.replace("duration = 0.5", "duration = 4") + f"""\
[output]
checkpoint = "0.02 s"
[output.fields]
format = "{format}"
events = true
every = 150
""")
            self.uplift("run", "case.toml", "-o", "straight", "-q")
            expected = self.fields("straight")
            self.assertGreater(len(b"".join(expected.values())), 10000)
            for number, after in ((signal.SIGKILL, 0), (signal.SIGTERM, 0)):
                with self.subTest(format=format, number=number):
                    self.ended(number, after, "case.toml", "-o", "r", checkpoint="as_in_the_case.ckp")
                    self.assert_resumed("r", expected, number)

    def test_a_comparison_goes_on(self):
        self.write(ROCKING.replace("duration = 0.5", "duration = 10") + """\
[[variant]]
name = "softer"
law = { type = "springs", K_n = 1e9, K_t = 1e9, tangential = "bonded" }
[[variant]]
name = "stiffer"
law = { type = "springs", K_n = 1e10, K_t = 1e10, tangential = "bonded" }
[output]
checkpoint = "0.02 s"
[output.fields]
format = "xdmf"
every = 150
variants = true
""")
        self.uplift("compare", "case.toml", "-o", "straight", "-q")
        expected, files = self.fields("straight"), self.files("straight")
        for number in (signal.SIGKILL, signal.SIGTERM):
            with self.subTest(number=number):  # in the second run: the first one is complete
                self.ended(number, 0, "case.toml", "-o", "r", verb="compare", checkpoint="*stiffer.ckp")
                self.uplift("resume", "r", "-o", "resumed", "-q")
                made = self.files("resumed")
                self.assertEqual(sorted(made), sorted(files))
                self.assertEqual([name for name in made if made[name] != files[name]], [])
                self.assertEqual(self.histories("resumed"), self.histories("straight"))
                shutil.rmtree(self.folder / "resumed")
                self.assert_resumed("r", expected, number)

    def histories(self, folder):
        return {path.name: path.read_bytes() for path in (self.folder / folder / "histories").iterdir()}

    def test_damaged_frames_are_not_used(self):
        self.write(ROCKING.replace("duration = 0.5", "duration = 10") + '[output]\ncheckpoint = "0.02 s"\n[output.fields]\nformat = "vtu"\nevery = 150\n')
        self.uplift("run", "case.toml", "-o", "straight", "-q")
        expected = self.fields("straight")
        self.ended(signal.SIGKILL, 0, "case.toml", "-o", "r", checkpoint="as_in_the_case.ckp")
        (path,) = self.folder.glob("r.part-*/checkpoint/as_in_the_case.frames")
        content = bytearray(path.read_bytes())
        content[len(content) // 3] ^= 1
        path.write_bytes(content)
        done = self.uplift("resume", "r")
        self.assertIn("an earlier checkpoint or the beginning is taken instead", done.stderr)
        self.assertEqual(self.fields("r"), expected)

    def test_a_damaged_checkpoint_is_not_used(self):
        self.write(kept())
        self.uplift("run", "case.toml", "-o", "straight")
        self.ended(signal.SIGKILL, 0, "case.toml", "-o", "r", checkpoint="*.before.ckp")  # the second: the first one is kept
        (folder,) = self.folder.glob("r.part-*/checkpoint")
        for path in folder.glob("*.ckp"):
            if ".before" not in path.name:
                content = bytearray(path.read_bytes())
                content[len(content) // 2] ^= 1
                path.write_bytes(content)
        done = self.uplift("resume", "r", "--out", "r2")
        self.assertIn("damaged", done.stderr)
        self.assertTrue((self.folder / "r2/histories.csv").read_text() == (self.folder / "straight/histories.csv").read_text())
        for path in folder.glob("*.ckp"):
            path.write_bytes(path.read_bytes()[:100])
        self.assertIn("expected a checkpoint that is whole", self.uplift("resume", "r", expect=2).stderr)

    def changed(self, name, old, new):
        """A copy of the program with other bytes in one place."""
        content = pathlib.Path(program()).read_bytes()
        place = content.index(old)
        path = self.folder / name
        path.write_bytes(content[:place] + new + content[place + len(new):])
        path.chmod(0o755)
        return path

    def resumed_by(self, other, expect):
        done = subprocess.run([other, "resume", "r", "-o", "resumed", "-q"], cwd=self.folder, capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, expect, done.stderr)
        if expect:
            self.assertIn("expected the program that wrote the checkpoint, found another one", done.stderr)
        else:
            self.assertEqual(self.files("resumed"), self.files("straight"))

    def test_a_copy_of_the_program_goes_on_and_another_program_does_not(self):
        self.write(kept())
        self.uplift("run", "case.toml", "-o", "straight")
        name = b"GNU\0"
        note = struct.pack("<III", len(name), 20, 3) + name  # NT_GNU_BUILD_ID with a SHA-1, elf.h
        of_other_type = struct.pack("<III", len(name), 20, 99) + name
        self.ended(signal.SIGKILL, 0, "case.toml", "-o", "r")
        self.resumed_by(shutil.copy(program(), self.folder / "copy"), 0)
        self.resumed_by(self.changed("relinked", note, note + b"id"), 2)
        without = self.changed("without", note, of_other_type)
        self.resumed_by(without, 2)
        for path in self.folder.glob("r.*"):
            shutil.rmtree(path)
        if sanitized():  # 200 MB, read by a slow program
            return
        # without a build id the whole file counts
        self.ended(signal.SIGKILL, 0, "case.toml", "-o", "r", by=without)
        self.resumed_by(shutil.copy(without, self.folder / "copy"), 0)
        content = bytearray(without.read_bytes())
        content[-1] ^= 1
        without.unlink()
        without.write_bytes(content)
        without.chmod(0o755)
        self.resumed_by(without, 2)

    def test_a_changed_case_is_refused(self):
        self.write(kept())
        self.ended(signal.SIGTERM, 0, "case.toml", "-o", "r")
        self.write(kept().replace("mass = 24317", "mass = 24318"))
        self.assertIn("expected the case as it was, found `mass = 24318", self.uplift("resume", "r", expect=2).stderr)
        self.write(kept())
        self.uplift("resume", "r", "-q")
        self.assertIn("found results that are complete", self.uplift("resume", "r", expect=2).stderr)
        self.assertIn("found no checkpoint", self.uplift("resume", "nowhere", expect=2).stderr)


if __name__ == "__main__":
    main()
