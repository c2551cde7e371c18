"""The kernels of OpenBLAS, which chooses them by the model number of the processor when it is loaded: for a processor that is newer than the
library it takes those of 2004, which multiply matrices at a quarter of the speed. Here they follow from the instructions of the processor:
which ones OpenBLAS would choose by itself is known only when it is loaded, and then it is too late. For processors that OpenBLAS 0.3.21
knows these are its own kernels of double precision."""

import contextlib
import os
from typing import Dict, Iterator, Optional

CHOICE = "OPENBLAS_CORETYPE"


def kernels_for(processors: str) -> Optional[str]:
    """The name of the kernels for the first processor of a text like /proc/cpuinfo; None: those that OpenBLAS chooses."""
    found: Dict[str, str] = {}
    for line in processors.splitlines():
        key, _, value = line.partition(":")
        found.setdefault(key.strip(), value.strip())
    flags = set(found.get("flags", "").split())
    if flags >= {"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"}:
        return "SkylakeX"
    if flags >= {"avx2", "fma"}:
        return "Zen" if found.get("vendor_id") == "AuthenticAMD" else "Haswell"
    return None


@contextlib.contextmanager
def chosen_by_instructions() -> Iterator[None]:
    """While OpenBLAS is loaded. A choice that the user has made is kept; a library that is loaded already keeps its kernels."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as file:
            kernels = kernels_for(file.read(8192))  # the first processor
    except OSError:
        kernels = None
    if kernels is None or CHOICE in os.environ:
        yield
        return
    os.environ[CHOICE] = kernels
    try:
        yield
    finally:
        del os.environ[CHOICE]
