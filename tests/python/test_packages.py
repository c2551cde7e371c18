"""Packages: the level of processor that is chosen, the wheel, the recipe for conda. test_packages.py PROGRAM LIBRARY."""

import base64
import csv
import hashlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM, LIBRARY = (pathlib.Path(path).resolve() for path in (sys.argv.pop(1), sys.argv.pop(1)))
LEVELS = ["x86-64", "x86-64-v3", "x86-64-v4"]


def output(*words, **options):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))}: {done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def best_level():
    """The highest level for which the dynamic linker looks for libraries; /proc/cpuinfo of a virtual machine may lack flags."""
    searched = re.findall(r"^\s+(x86-64-v\d) \(supported, searched\)", output("/lib64/ld-linux-x86-64.so.2", "--help"), re.M)
    return next(level for level in reversed(LEVELS) if level in searched + LEVELS[:1])


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder_ = tempfile.TemporaryDirectory(prefix="uplift test ")
        self.folder = pathlib.Path(self.folder_.name)
        self.addCleanup(self.folder_.cleanup)

    def portable(self, name):
        """A folder as scripts/build_portable.sh makes it, with the library of this build for every level and programs that name theirs."""
        usr = self.folder / name / "root" / "usr"
        (usr / "bin").mkdir(parents=True)
        output("cc", "-O2", "-o", usr / "bin" / "uplift", ROOT / "packaging" / "launcher.c")
        version = output(PROGRAM, "--version").strip()
        for level in LEVELS:
            program = usr / "libexec" / "uplift" / level / "uplift"
            program.parent.mkdir(parents=True)
            text = f'#include <stdio.h>\nint main(int n, char** w) {{ puts(n > 2 ? "{level}" : "{version}"); return n > 2 ? w[2][0] - 48 : 0; }}\n'
            output("cc", "-x", "c", "-", "-o", program, input=text)
            library = usr / "lib" / ("" if level == "x86-64" else f"glibc-hwcaps/{level}") / "libuplift.so.0"
            library.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(LIBRARY, library)
        return usr.parent.parent


class Launcher(Folder):
    def test_best_level_arguments_and_exit_code(self):
        launcher = self.portable("portable") / "root" / "usr" / "bin" / "uplift"
        done = subprocess.run([launcher, "run", "7"], capture_output=True, text=True)
        self.assertEqual((done.stdout.strip(), done.returncode), (best_level(), 7))

    def test_through_a_link(self):
        link = self.folder / "link"
        link.symlink_to(self.portable("portable") / "root" / "usr" / "bin" / "uplift")
        self.assertEqual(output(link, "run", "0").strip(), best_level())

    def test_program_of_its_own_name(self):
        usr = self.portable("portable") / "root" / "usr"
        for path in [usr / "bin" / "uplift", *(usr / "libexec").rglob("uplift/*/uplift")]:
            path.rename(path.with_name("uplift-mpi"))
        self.assertEqual(output(usr / "bin" / "uplift-mpi", "run", "0").strip(), best_level())

    def test_missing_program(self):
        root = self.portable("portable") / "root" / "usr"
        shutil.rmtree(root / "libexec")
        done = subprocess.run([root / "bin" / "uplift"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"libexec/uplift/{best_level()}/uplift: No such file", done.stderr)


class Wheel(Folder):
    def make(self, name, umask=0o022):
        made = output(sys.executable, ROOT / "scripts" / "make_wheel.py", self.portable(name), self.folder / f"dist {name}", umask=umask)
        return pathlib.Path(made.strip())

    def test_contents_repetition_and_use(self):
        wheel = self.make("first")
        self.assertRegex(wheel.name, r"^uplift-[0-9.]+-py3-none-manylinux_2_\d+_x86_64\.whl$")
        self.assertEqual(wheel.read_bytes(), self.make("second", umask=0o077).read_bytes())
        with zipfile.ZipFile(wheel) as archive:
            self.check_record(archive)
            archive.extractall(self.folder / "site")
            for entry in archive.infolist():
                os.chmod(self.folder / "site" / entry.filename, entry.external_attr >> 16)
        self.check_use(self.folder / "site")

    def check_record(self, archive):
        """Names, hashes and sizes of all files (PEP 427), and the files that have to be there."""
        names = set(archive.namelist())
        record = next(name for name in names if name.endswith("dist-info/RECORD"))
        rows = {row[0]: row[1:] for row in csv.reader(io.StringIO(archive.read(record).decode()))}
        self.assertEqual(set(rows), names)
        for name, (digest, size) in rows.items():
            if name != record:
                data = archive.read(name)
                expected = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
                self.assertEqual((digest, int(size)), ("sha256=" + expected, len(data)), name)
        python = {"uplift/" + path.name for path in (ROOT / "python" / "uplift").iterdir() if path.is_file()}
        ours = {"uplift/bin/uplift", "uplift/lib/libuplift.so", "uplift/lib/libuplift.so.0"}
        ours |= {f"uplift/libexec/uplift/{level}/uplift" for level in LEVELS}
        ours |= {f"uplift/lib/glibc-hwcaps/{level}/libuplift.so.0" for level in LEVELS[1:]}
        self.assertLessEqual(python | ours, names)
        others = [name for name in names - python - ours if "dist-info" not in name]
        self.assertTrue(all(re.fullmatch(r"uplift/lib/lib[^/]+\.so[.0-9]*", name) for name in others), others)
        self.assertTrue(any("libopenblas" in name for name in others))
        self.assertFalse([name for name in others if re.search(r"/lib(c|m|stdc\+\+)\.so", name)])

    def check_use(self, site):
        environment = {"PYTHONPATH": str(site), "PATH": "/usr/bin:/bin"}
        loaded = output(sys.executable, "-c", "import uplift._library as l; l.library().uplift_version(); print(open('/proc/self/maps').read())",
                        env=environment)
        folder = "" if best_level() == "x86-64" else f"glibc-hwcaps/{best_level()}/"
        maps = {line.split(None, 5)[5] for line in loaded.splitlines() if "libuplift.so.0" in line or "libopenblas" in line}
        self.assertIn(str(site / "uplift" / "lib" / f"{folder}libuplift.so.0"), maps)
        self.assertTrue(all(path.startswith(str(site)) for path in maps), maps)
        self.assertEqual(output(sys.executable, "-m", "uplift", "run", "0", env=environment).strip(), best_level())


class Conda(unittest.TestCase):
    def test_recipe_is_yaml_with_the_version_of_the_project(self):
        text = (ROOT / "packaging" / "conda" / "meta.yaml").read_text()
        recipe = yaml.safe_load(re.sub(r'\{\{ compiler\("(\w+)"\) \}\}', r"\1-compiler", text))
        self.assertEqual(recipe["package"]["version"], output(PROGRAM, "--version").strip())
        for section in ("source", "build", "requirements", "test", "about"):
            self.assertIn(section, recipe)
        self.assertTrue((ROOT / recipe["build"]["script"].split()[1]).exists())


class Debian(unittest.TestCase):
    def test_changelog_has_the_version_of_the_project(self):
        first = (ROOT / "packaging" / "debian" / "changelog").read_text().splitlines()[0]
        self.assertEqual(re.match(r"uplift \(([^)-]+)\)", first).group(1), output(PROGRAM, "--version").strip())


unittest.main()
