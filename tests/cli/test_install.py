"""Installs the program and the library, and builds an outside project against both trees: test_install.py PROGRAM."""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(sys.argv.pop(1)).resolve()
BUILD = PROGRAM.parent


def run(*words, **options):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))}: {done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


class Install(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.prefix = pathlib.Path(self.folder.name) / "prefix"
        run("cmake", "--install", BUILD, "--prefix", self.prefix)

    def tearDown(self):
        self.folder.cleanup()

    def build_outside(self, uplift_dir):
        made = pathlib.Path(self.folder.name) / "made"
        run("cmake", "-S", ROOT / "examples/c", "-B", made, f"-Duplift_DIR={uplift_dir}")
        run("cmake", "--build", made)
        out = run(made / "pier", ROOT / "examples/05_bridge_pier")
        self.assertIn("largest underside.moment: 2.613e+07 N m", out)

    def test_project_against_the_installed_tree(self):
        self.build_outside(next(self.prefix.rglob("uplift-config.cmake")).parent)

    def test_project_against_the_build_tree(self):
        self.build_outside(BUILD)

    def test_pkg_config(self):
        pc = next(self.prefix.rglob("uplift.pc")).parent
        environment = {**os.environ, "PKG_CONFIG_PATH": str(pc)}
        libraries = run("pkg-config", "--variable=libdir", "uplift", env=environment).strip()
        self.assertTrue((pathlib.Path(libraries) / "libuplift.so").exists(), libraries)
        version = run("pkg-config", "--modversion", "uplift", env=environment)
        self.assertEqual(version.strip(), run(PROGRAM, "--version").strip())

    def test_installed_program(self):
        self.assertEqual(run(self.prefix / "bin/uplift", "--version"), run(PROGRAM, "--version"))


if "\nUPLIFT_SANITIZE:STRING=\n" in (BUILD / "CMakeCache.txt").read_text():  # a library with a sanitizer is not for other programs
    unittest.main()
