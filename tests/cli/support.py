"""Runs the program as a user does. The path of the binary is the first argument of the test program."""

import base64
import functools
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import zlib

_program = ""


def program():
    """Path of the program under test."""
    return _program


@functools.cache
def sanitized():
    """Whether the program was compiled with the address sanitizer, which answers to its own option: it is some twenty times slower."""
    answer = subprocess.run([program(), "--version"], capture_output=True, text=True, env={**os.environ, "ASAN_OPTIONS": "help=1"})
    return "AddressSanitizer" in answer.stderr


# A case that is in order: a mass on an inextensible cantilever whose footing may lift off. Tests change single lines of it.
BASE = """\
title = "test"
bonded = false
[nodes]
top = [0, 5]
base = [0, 0]
[[beam]]
name = "column"
nodes = ["base", "top"]
E = 2e10
I = 0.2
[[mass]]
node = "top"
mass = 24317
[[rigid]]
name = "footing"
node = "base"
mass = 1e4
inertia = 7500
[[support]]
node = "base"
fixed = ["ux"]
[[interface]]
name = "soil"
[interface.footing]
body = "base"
width = 3
points = 11
[interface.law]
type = "springs"
K_n = 2e8
[[load]]
name = "dead"
node = "top"
force = [0, -1e6]
[[function]]
name = "pulse"
shape = { type = "half_sine", duration = 0.1 }
[[load]]
name = "pulse"
node = "top"
force = [3e5, 0]
function = "pulse"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 0.5
step = 1e-3
"""


def shaken(record):
    """BASE on the ground that a record moves for a second, in place of the pulse."""
    return BASE[: BASE.index("[[function]]")] + f"""\
[[record]]
name = "quake"
file = "{record}"
[[ground_acceleration]]
direction = [1, 0]
function = "quake"
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = 1e-3
"""


def line_of(text, part):
    """Number of the line that holds `part`."""
    for number, line in enumerate(text.splitlines(), 1):
        if part in line:
            return number
    raise AssertionError(f"{part!r} is not in the case")


class CliTest(unittest.TestCase):
    """A folder of its own for every test."""

    def setUp(self):
        self.folder_ = tempfile.TemporaryDirectory(prefix="uplift test ")  # with a space on purpose
        self.folder = pathlib.Path(self.folder_.name)
        self.addCleanup(self.folder_.cleanup)

    def write(self, text, name="case.toml"):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def uplift(self, *words, expect=0, timeout=300, **options):
        done = subprocess.run([program(), *map(str, words)], cwd=self.folder, capture_output=True, text=True, timeout=timeout, **options)
        if expect is not None:
            self.assertEqual(done.returncode, expect, f"{words}\n--- output\n{done.stdout}\n--- errors\n{done.stderr}")
        return done

    def cannot_be_limited(self):
        """The address sanitizer needs more address space than any limit leaves."""
        return sanitized()

    def refused(self, text, message, *, command="check"):
        """The case is refused with exit code 2 and exactly this message ("{file}" stands for the path of the case)."""
        path = self.write(text)
        done = self.uplift(command, path.name, expect=2)
        self.assertEqual(done.stderr.strip(), "error: " + message.replace("{file}", path.name))
        self.assertEqual(done.stdout, "")

    def summary(self, folder):
        """summary.json, which has nothing but what its schema states."""
        text = (self.folder / folder / "summary.json").read_text()
        self.assertNotRegex(text, r"\b(nan|inf)\b")
        summary = json.loads(text)
        self.assert_valid(summary, "motion" if "intensities" in summary else "results")
        return summary

    def assert_page_has(self, summary, report):
        """The page makes its tables and captions of the summary (web/test/document_checks.mjs), which it has without what it does not show."""
        def reduced(entries, *left_out):
            return [{key: value for key, value in entry.items() if key not in left_out} for entry in entries]

        verdict = summary["verdict"]
        without = {**summary, "runs": reduced(summary["runs"], "peaks", "equilibrium"), "verdict": {**verdict, "interfaces": reduced(verdict["interfaces"], "over_time")}}
        self.assertEqual(report["summary"], without)

    def assert_valid(self, document, schema):
        """`uplift schema NAME` accepts the document."""
        self.assertEqual(list(violations(document, schema_of(schema), schema_of(schema))), [])


@functools.cache
def schema_of(document):
    """`uplift schema DOCUMENT`."""
    return json.loads(subprocess.run([program(), "schema", document], capture_output=True, text=True, check=True).stdout)


TYPES = {"string": str, "integer": int, "number": (int, float), "boolean": bool, "null": type(None), "array": list, "object": dict}


def is_a(value, kind):
    return isinstance(value, TYPES[kind]) and (kind == "boolean" or not isinstance(value, bool))


def violations(value, schema, root, path="$"):
    """Where a document does not follow a schema: the keywords that the schemas of results use."""
    unknown = set(schema) - {"$schema", "$defs", "title", "description", "unit", "type", "const", "enum", "properties", "required", "additionalProperties", "items", "$ref"}
    if unknown:
        yield f"{path}: the schema has keywords that are not checked: {unknown}"
    if "$ref" in schema:
        yield from violations(value, root["$defs"][schema["$ref"].removeprefix("#/$defs/")], root, path)
    kinds = schema.get("type", [])
    if kinds and not any(is_a(value, kind) for kind in ([kinds] if isinstance(kinds, str) else kinds)):
        yield f"{path}: {value!r} is not of type {kinds}"
    if "const" in schema and value != schema["const"] or "enum" in schema and value not in schema["enum"]:
        yield f"{path}: {value!r} is not {schema.get('const', schema.get('enum'))!r}"
    if isinstance(value, dict):
        for key in set(schema.get("required", [])) - set(value):
            yield f"{path}: {key} is missing"
        for key, inner in value.items():
            rule = schema.get("properties", {}).get(key, schema.get("additionalProperties", True))
            if rule is False:
                yield f"{path}: {key} is not in the schema"
            elif rule is not True:
                yield from violations(inner, rule, root, f"{path}.{key}")
    if isinstance(value, list) and "items" in schema:
        for number, inner in enumerate(value):
            yield from violations(inner, schema["items"], root, f"{path}[{number}]")


def report_of(folder):
    """The data of a report page: zlib, then base64, in a script element."""
    page = (folder / "report.html").read_text()
    packed = re.search(r'<script id="uplift-data" type="application/json">(.*?)</script>', page, re.S).group(1)
    return json.loads(zlib.decompress(base64.b64decode(packed)))


def take_program():
    """Takes the path of the program from the command line."""
    global _program
    if len(sys.argv) < 2 or not os.access(sys.argv[1], os.X_OK):
        sys.exit("usage: TEST PROGRAM [arguments]")
    _program = os.path.abspath(sys.argv.pop(1))


def main():
    take_program()
    unittest.main(module="__main__", verbosity=2)


__all__ = ["BASE", "program", "CliTest", "json", "line_of", "main", "pathlib", "re", "report_of", "sanitized", "schema_of", "subprocess", "os", "violations", "shaken", "take_program"]
