"""Installs the program and the library, and builds an outside project against both trees: test_install.py PROGRAM."""

import json
import os
import pathlib
import re
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

    def test_examples_in_cpp(self):
        made = pathlib.Path(self.folder.name) / "cpp"
        run("cmake", "-S", ROOT / "examples/cpp", "-B", made, f"-Duplift_DIR={BUILD}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wpedantic -Werror")
        run("cmake", "--build", made)
        eccentricity, uplifted = (float(each) for each in re.findall(r"up to ([\d.]+)", run(made / "1_own_law")))
        # a pressure that falls linearly over the contact c has the eccentricity 1 - 2 c/3; this joint hardens and leans more on its edge
        self.assertGreater(uplifted, 0.5)
        self.assertGreater(eccentricity, 1 - 2 * (1 - uplifted) / 3)
        self.assertLess(eccentricity, 1)
        document, closed_form = run(made / "2_interface_problem").split("closed form: ")
        lagrange = json.loads(document)["methods"][-1]
        self.assertEqual(lagrange["method"], "lagrange")
        force, *openings = (float(each) for each in re.findall(r"[-+.e\d]*\d", closed_form.replace("openings 0,", "")))
        self.assertAlmostEqual(lagrange["force"][0] / force, 1, places=5)
        for found, expected in zip(lagrange["opening"][1:], openings, strict=True):
            self.assertAlmostEqual(found / expected, 1, places=5)
        self.assertRegex(run(made / "3_marching_loop", ROOT / "examples/05_bridge_pier"), r"lifts off at 1\.5\d\d s\nit is closed again")

    def test_blocks_of_the_guide(self):
        page = (ROOT / "docs/guide/library.md").read_text()
        flags = [f"-I{self.prefix}/include", f"{BUILD}/libuplift.so", f"-Wl,-rpath,{BUILD}", "-Wall", "-Werror", "-pthread"]
        for language, compiler, head in (("c", ["gcc", "-std=c99"], "#include <stdio.h>\n#include <uplift.h>\n"),
                                         ("cpp", ["g++", "-std=c++17"], "#include <iostream>\n#include <uplift.hpp>\n")):
            blocks = re.findall(rf"^```{language}\n(.*?)^```", page, re.M | re.S)
            self.assertEqual(len(blocks), 1)
            source = pathlib.Path(self.folder.name) / f"block.{language}"
            source.write_text(head + "int main() {\n" + blocks[0] + "return 0;\n}\n")
            run(*compiler, source, *flags, "-o", source.with_suffix(""))
            out = run(source.with_suffix(""), cwd=ROOT)
            if language == "cpp":
                self.assertIn("underside.moment [N m]", out)

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
