"""The program `uplift`: where it is, and how the package starts it."""

from __future__ import annotations

import os
import pathlib
import re
import shutil
import subprocess

from ._library import InputError, OutputError, UpliftError

BAD_INPUT, OUTPUT_ERROR = 2, 4  # exit codes


def program() -> str:
    """Path of the program: UPLIFT_PROGRAM, of this package, of the build folder, or on the PATH. Raises FileNotFoundError."""
    here = pathlib.Path(__file__).resolve().parent
    named = os.environ.get("UPLIFT_PROGRAM")
    for path in ([pathlib.Path(named)] if named else []) + [here / "bin" / "uplift", here.parents[1] / "build" / "release" / "uplift"]:
        if os.access(path, os.X_OK):
            return str(path)
    found = shutil.which("uplift")
    if found is None:
        raise FileNotFoundError("uplift: the program was not found; put it on the PATH")
    return found


def error_of(code: int, said: str) -> Exception:
    """The exception for what a command that failed has printed: "error: FILE:LINE: KEY: expected ..."."""
    lines = [line for line in said.splitlines() if line.startswith(("error: ", "internal error: "))]
    message = lines[-1].split("error: ", 1)[1] if lines else said.strip() or f"the program ended with the code {code}"
    if code == OUTPUT_ERROR:
        return OutputError(message)
    if code != BAD_INPUT:
        return UpliftError(message)
    where = re.match(r"(.+?)(?::(\d+))?: (?:([A-Za-z_][\w.\[\]-]*): )?expected ", message)
    if where is None:
        return InputError(message)
    return InputError(message, where[1], int(where[2] or 0), 0, where[3] or "")


def output_of(*words: str) -> str:
    """What a command prints. Raises InputError, OutputError, or UpliftError for its failure."""
    done = subprocess.run([program(), *words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8")
    if done.returncode != 0:
        raise error_of(done.returncode, done.stderr)
    return done.stdout

