"""The Python blocks of docs/guide/python.md run, in their order: python3 tests/python/test_guide.py PROGRAM LIBRARY."""

import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
os.environ["UPLIFT_LIBRARY"] = os.path.abspath(sys.argv[2])
sys.path.insert(0, str(ROOT / "python"))
os.chdir(ROOT)

text = (ROOT / "docs/guide/python.md").read_text()
names = {}
found = list(re.finditer(r"^```python\n(.*?)^```$", text, re.M | re.S))
assert len(found) >= 6, "blocks are missing"
for block in found:
    line = text.count("\n", 0, block.start()) + 1
    exec(compile("\n" * line + block.group(1), "docs/guide/python.md", "exec"), names)
