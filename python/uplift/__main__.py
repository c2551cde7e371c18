"""`python3 -m uplift`: the program."""

import os
import pathlib
import shutil
import sys


def program() -> str:
    """Path of the program: of this package, of the build folder, or on the PATH."""
    here = pathlib.Path(__file__).resolve().parent
    for path in (here / "bin" / "uplift", here.parents[1] / "build" / "release" / "uplift"):
        if os.access(path, os.X_OK):
            return str(path)
    found = shutil.which("uplift")
    if found is None:
        sys.exit("uplift: the program was not found; put it on the PATH")
    return found


def main() -> None:
    """Replaces this process by the program."""
    path = program()
    os.execv(path, [path, *sys.argv[1:]])


if __name__ == "__main__":
    main()
