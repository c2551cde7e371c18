#!/usr/bin/env python3
"""Makes a wheel of the Python package with the library, the program and the libraries that they need: make_wheel.py PORTABLE FOLDER.

PORTABLE is the folder that scripts/build_portable.sh has filled. One wheel serves every Python from 3.9 on (ctypes) and every x86-64
processor. It needs the C library of this system or a newer one, which its name says. The same inputs give the same bytes. Needs patchelf.

    uplift/bin/uplift                                launcher
    uplift/libexec/uplift/LEVEL/uplift               program for a level of processors
    uplift/lib/libuplift.so                          what Python loads: an empty library that needs the next one
    uplift/lib/[glibc-hwcaps/LEVEL/]libuplift.so.0   library; the dynamic loader chooses the level where a library is needed by name
    uplift/lib/...                                   the libraries of others
"""
import base64
import hashlib
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
# on every Linux, or tied to the C library or to the driver
OF_THE_SYSTEM = re.compile(r"^(linux-vdso|ld-linux|lib(c|m|dl|pthread|rt|stdc\+\+|gcc_s)\.so)")


def output(*words):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True).stdout


def needed_libraries(binaries):
    """Files of the shared libraries that the binaries need beyond those of every system, by name."""
    found = {}
    for binary in binaries:
        for name, path in re.findall(r"^\s*(\S+) => (/\S+)", output("ldd", binary), re.M):
            if not OF_THE_SYSTEM.match(name):
                found[name] = path
    return found


def record_line(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def set_search_path(binary, libraries):
    """Lets the binary find the shared libraries of the wheel, wherever the wheel is installed."""
    binary.chmod(0o755)
    output("patchelf", "--set-rpath", "$ORIGIN/" + os.path.relpath(libraries, binary.parent), binary)


def add_binaries(root, package):
    """Copies program and library for every level of processors, and the libraries that they need."""
    libraries = package / "lib"
    shutil.copytree(root / "bin", package / "bin")
    shutil.copytree(root / "libexec", package / "libexec")
    installed = next(root.rglob("libuplift.so.0")).parent
    for path in installed.rglob("libuplift.so.0"):
        copy = libraries / path.relative_to(installed)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, copy)
    ours = [*(package / "libexec").rglob("uplift/*/uplift"), *libraries.rglob("libuplift.so.0")]
    for name, path in needed_libraries(ours).items():
        shutil.copy(path, libraries / name)
        output("strip", "--strip-unneeded", libraries / name)
        set_search_path(libraries / name, libraries)
    for binary in ours:
        set_search_path(binary, libraries)
    output("cc", "-shared", "-nostdlib", "-s", "-Wl,--no-as-needed,-soname,libuplift.so", "-Wl,-rpath,$ORIGIN", "-o", libraries / "libuplift.so",
           libraries / "libuplift.so.0")


def main():
    root, target = pathlib.Path(sys.argv[1]) / "root" / "usr", pathlib.Path(sys.argv[2])
    version = output(root / "bin" / "uplift", "--version").strip()
    tag = "py3-none-manylinux_{}_{}_{}".format(*platform.libc_ver()[1].split(".")[:2], platform.machine())
    with tempfile.TemporaryDirectory() as folder:
        package = pathlib.Path(folder) / "uplift"
        shutil.copytree(ROOT / "python" / "uplift", package, ignore=shutil.ignore_patterns("__pycache__"))
        add_binaries(root, package)
        info = pathlib.Path(folder) / f"uplift-{version}.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(
            f"Metadata-Version: 2.1\nName: uplift\nVersion: {version}\nSummary: Uplift of foundations in earthquakes and its consequences\n"
            "Requires-Python: >=3.9\nRequires-Dist: numpy\nLicense: GPL-2.0-or-later (binaries); BSD-3-Clause (sources)\n")
        (info / "WHEEL").write_text(f"Wheel-Version: 1.0\nGenerator: make_wheel\nRoot-Is-Purelib: false\nTag: {tag}\n")
        (info / "entry_points.txt").write_text("[console_scripts]\nuplift = uplift.__main__:main\n")
        target.mkdir(parents=True, exist_ok=True)
        wheel = target / f"uplift-{version}-{tag}.whl"
        working = wheel.with_suffix(f".part-{os.getpid()}")
        files = sorted(path for path in pathlib.Path(folder).rglob("*") if path.is_file())
        record = "".join(record_line(path.relative_to(folder).as_posix(), path.read_bytes()) for path in files)
        (info / "RECORD").write_text(record + f"{info.name}/RECORD,,\n")
        with zipfile.ZipFile(working, "w", zipfile.ZIP_DEFLATED) as archive:
            for path in [*files, info / "RECORD"]:
                entry = zipfile.ZipInfo(path.relative_to(folder).as_posix(), (1980, 1, 1, 0, 0, 0))
                entry.compress_type = zipfile.ZIP_DEFLATED
                # pip keeps what is executable; the rest of the mode is the umask of whoever builds
                entry.external_attr = (0o100755 if path.stat().st_mode & 0o100 else 0o100644) << 16
                archive.writestr(entry, path.read_bytes())
        working.replace(wheel)
    print(wheel)


main()
