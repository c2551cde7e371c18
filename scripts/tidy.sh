#!/usr/bin/env bash
# clang-tidy (.clang-tidy) on what the project exists for: laws, interfaces, contact, the step. Most of its time goes into the headers of Eigen,
# so the sources of a folder are looked at together, each time as one file that includes them.
set -euo pipefail
cd "$(dirname "$0")/.."
work=build/tidy
rm -rf "$work"
mkdir -p "$work"
while read -r source; do
  folder="$(dirname "${source#src/uplift/}")"
  echo "#include \"${source#src/}\"  // NOLINT(bugprone-suspicious-include)" >>"$work/$(tr / _ <<<"$folder").cpp"
done < <(git ls-files 'src/uplift/laws/*.cpp' 'src/uplift/interface/*.cpp' 'src/uplift/contact/*.cpp' 'src/uplift/dynamics/*.cpp')
# the largest first
find "$work" -name '*.cpp' -printf '%s %p\0' | sort -zrn | cut -zd' ' -f2 | xargs -0 -n 1 -P "$(nproc)" sh -c '
  clang-tidy-14 --quiet "$1" -- -std=c++20 -Isrc -isystem /usr/include/eigen3 -isystem /usr/include/suitesparse -fopenmp-simd -march=native -DUPLIFT_VERSION="\"tidy\""' sh
