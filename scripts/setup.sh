#!/usr/bin/env bash
# Installs the Debian packages that are missing and nothing else: no network when all are there. Usage: scripts/setup.sh [run|test|mpi|test-mpi|docs|packages|deb|develop]
set -euo pipefail

run="g++ cmake ninja-build pkg-config libeigen3-dev libsuitesparse-dev libopenblas-dev libspectra-dev libtomlplusplus-dev
  nlohmann-json3-dev libudunits2-dev libhdf5-dev zlib1g-dev libsqlite3-dev libcli11-dev libfmt-dev"
test="libgtest-dev librapidcheck-dev python3 python3-jsonschema python3-numpy python3-pandas python3-matplotlib python3-yaml mypy patchelf
  parallel slurmctld slurmd slurm-client munge"
mpi="libpetsc-real-dev libptscotch-dev libopenmpi-dev openmpi-bin"
docs="python3 mkdocs mkdocs-material libjs-katex fonts-katex"
packages="python3 patchelf"
deb="python3 dpkg-dev debhelper dh-python help2man lintian"
develop="libbenchmark-dev clang-14 libclang-rt-14-dev clang-format-14 clang-tidy-14 ccache nodejs npm chromium ca-certificates"

case "${1:-run}" in
  run) wanted="$run" ;;
  test) wanted="$run $test" ;;
  mpi) wanted="$run $mpi" ;;
  test-mpi) wanted="$run $mpi libgtest-dev python3 slurmctld slurmd slurm-client munge" ;;
  docs) wanted="$run $docs" ;;
  packages) wanted="$run $packages" ;;
  deb) wanted="$run $mpi $deb" ;;
  develop) wanted="$run $test $develop" ;;
  *) echo "setup.sh: expected run, test, mpi, test-mpi, docs, packages, deb or develop, found \"$1\"" >&2; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null; then
  echo "setup.sh: this is not a Debian system; needed: $wanted" >&2
  exit 0
fi

# A tool that is already here by other means (another node, another g++) counts as installed.
have() {
  dpkg-query -W -f '${Status}' "$1" 2>/dev/null | grep -q 'ok installed' && return 0
  case "$1" in
    nodejs) command -v node >/dev/null ;;
    npm) command -v npm >/dev/null ;;
    python3) command -v python3 >/dev/null ;;
    mypy) command -v mypy >/dev/null ;;
    python3-jsonschema) python3 -c 'import jsonschema' 2>/dev/null ;;
    *) return 1 ;;
  esac
}

missing=()
for package in $wanted; do have "$package" || missing+=("$package"); done
[ ${#missing[@]} -eq 0 ] && exit 0

echo "Installing: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "setup.sh: not root and no sudo; please install: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "${missing[@]}"
