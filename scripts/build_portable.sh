#!/usr/bin/env bash
# Builds the program and the library for packages, once for each level of the x86-64 architecture, and installs them in FOLDER/root:
#   usr/bin/uplift                              launcher (packaging/launcher.c)
#   usr/libexec/uplift/LEVEL/uplift             program
#   usr/lib/.../libuplift.so.0                  library for every processor; in glibc-hwcaps/LEVEL/ those that the dynamic loader prefers
#   usr/include/uplift.h, CMake and pkg-config files
# With the word "mpi" also uplift-mpi, in the same way as the program.
# Usage: scripts/build_portable.sh FOLDER [mpi]. Paths are below usr because the paths of Debian depend on it.
set -euo pipefail
source=$(cd "$(dirname "$0")/.." && pwd)
programs=(uplift)
mpi=OFF
[ "${2:-}" != mpi ] || { mpi=ON; programs+=(uplift-mpi); }
mkdir -p "$1"
folder=$(cd "$1" && pwd)
root="$folder/root"
rm -rf "$root"

for level in x86-64 x86-64-v3 x86-64-v4; do
  cmake -S "$source" -B "$folder/$level" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_SKIP_RPATH=ON \
    -DUPLIFT_ARCH="$level" -DUPLIFT_SHARED_BLAS=ON -DUPLIFT_MPI=$mpi -DCMAKE_EXE_LINKER_FLAGS="-Wl,-z,now" -DCMAKE_SHARED_LINKER_FLAGS="-Wl,-z,now"
  cmake --build "$folder/$level"
done

DESTDIR="$root" cmake --install "$folder/x86-64" --strip
library=$(dirname "$(find "$root/usr/lib" -name libuplift.so.0)")
for level in x86-64 x86-64-v3 x86-64-v4; do
  for program in "${programs[@]}"; do install -D --strip "$folder/$level/$program" "$root/usr/libexec/uplift/$level/$program"; done
  [ "$level" = x86-64 ] && continue
  file=$(basename "$(readlink -f "$folder/$level/libuplift.so")")
  install -D -m 644 --strip "$folder/$level/$file" "$library/glibc-hwcaps/$level/$file"
  ln -s "$file" "$library/glibc-hwcaps/$level/libuplift.so.0"
done
for program in "${programs[@]}"; do cc -O2 -Wall -Wextra -Wl,-z,now -s -o "$root/usr/bin/$program" "$source/packaging/launcher.c"; done
