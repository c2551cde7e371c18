"""`python3 -m uplift`: the program."""

import os
import sys

from ._program import program


def main() -> None:
    """Replaces this process by the program."""
    try:
        path = program()
    except FileNotFoundError as error:
        sys.exit(str(error))
    os.execv(path, [path, *sys.argv[1:]])


if __name__ == "__main__":
    main()
