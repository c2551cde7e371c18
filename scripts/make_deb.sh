#!/usr/bin/env bash
# Builds the Debian packages from the tracked files and checks them with lintian: scripts/make_deb.sh PORTABLE FOLDER.
# PORTABLE is the folder of scripts/build_portable.sh, FOLDER gets the packages. The same inputs give the same bytes.
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p "$1" "$2"
portable=$(cd "$1" && pwd)
target=$(cd "$2" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

mkdir "$work/uplift"
git ls-files -z | tar --null -T - -c | tar -x -C "$work/uplift"
cp -r packaging/debian "$work/uplift/debian"
cd "$work/uplift"
UPLIFT_PORTABLE="$portable" dpkg-buildpackage -b -uc -us
lintian --fail-on error,warning "$work"/uplift_*.changes
cp "$work"/*.deb "$target"
