#!/usr/bin/env bash
# Fuzzes the readers of files: scripts/fuzz.sh SECONDS [TARGET...]; see fuzz/README.md. Needs clang with its runtime (Debian: clang, libclang-rt-14-dev).
set -euo pipefail
cd "$(dirname "$0")/.."
seconds="${1:?usage: scripts/fuzz.sh SECONDS [gmsh|med|toml|json|record|problem...]}"
shift
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=(gmsh med toml json record problem)
clang="${CLANG:-$(command -v clang++-14 || echo clang++)}"
command -v ccache >/dev/null && clang="ccache $clang"

read -ra hdf5 <<<"$(pkg-config --cflags --libs hdf5-serial)"
flags=(-std=c++20 -g1 -O1 -fsanitize=address,undefined -fno-sanitize-recover=all -DUPLIFT_VERSION='"fuzz"' -Isrc -Ifuzz -isystem /usr/include/eigen3)
base=(src/uplift/base/{error,text,file}.cpp)
mesh=("${base[@]}" src/uplift/mesh/{cells,mesh,jacobian,cell_shapes,cell_quadrature}.cpp src/uplift/math/{shapes,quadrature}.cpp src/uplift/io/mesh/draft.cpp)
declared=("${base[@]}" src/uplift/base/{declare,units,check,format,values}.cpp)
sources() {
  case "$1" in
    gmsh) printf '%s\n' "${mesh[@]}" src/uplift/io/mesh/gmsh*.cpp ;;
    med) printf '%s\n' "${mesh[@]}" src/uplift/io/hdf5/{hdf5,child}.cpp src/uplift/io/mesh/med{,_message,_file}.cpp ;;
    toml) printf '%s\n' "${base[@]}" src/uplift/io/text/toml.cpp ;;
    record) printf '%s\n' "${base[@]}" src/uplift/base/sha256.cpp src/uplift/motion/{motion,record_check}.cpp src/uplift/motion/formats/{read,column_reader,record_text,at2,columns,cosmos,csmip,esm,knet,smc}.cpp ;;
    json) printf '%s\n' "${base[@]}" src/uplift/io/text/json_reader.cpp ;;
    problem) printf '%s\n' "${declared[@]}" src/uplift/math/{quadrature,product_kernels}.cpp src/uplift/contact/{jumps,problem,problem_file,law_force}.cpp src/uplift/laws/*.cpp ;;
    *) echo "fuzz.sh: expected gmsh, med, toml, json, record or problem, found \"$1\"" >&2; exit 2 ;;
  esac
}

out=build/fuzz
mkdir -p "$out/objects"
object() { echo "$out/objects/$(tr / _ <<<"${1%.cpp}").o"; }
of_target() { sources "$1"; echo "fuzz/$1_fuzz.cpp"; }

# each source once, whatever the number of targets that contain it, as many at a time as there are cores
for target in "${targets[@]}"; do of_target "$target"; done | sort -u | while read -r source; do
  printf '%s\0%s\0' "$source" "$(object "$source")"
done | xargs -0 -n 2 -P "$(nproc)" bash -c '"${@:1:$#-2}" -c "${@: -2:1}" -o "${@: -1}"' _ \
  $clang "${flags[@]}" "${hdf5[@]}" -Wno-unused-command-line-argument -fsanitize=fuzzer-no-link
for target in "${targets[@]}"; do
  objects=()
  while read -r source; do objects+=("$(object "$source")"); done < <(of_target "$target")
  $clang "${flags[@]}" -fsanitize=fuzzer "${objects[@]}" -o "$out/${target}_fuzz" -lfmt -ludunits2 "${hdf5[@]}"
done

fuzz() {
  local target="$1" work="$out/corpus_$1" log="$out/$1.log" limit=512 patience=20
  mkdir -p "$work"
  [ "$target" = med ] && limit=0 patience=60  # see the operator new of med_fuzz.cpp; a process that does not come to an end
  if ! "$out/${target}_fuzz" -max_total_time="$seconds" -rss_limit_mb=2048 -malloc_limit_mb="$limit" -timeout="$patience" -max_len=65536 -print_final_stats=1 \
    -artifact_prefix="$out/${target}_" "$work" "fuzz/corpus/$target" >"$log" 2>&1; then
    tail -n 60 "$log" >&2
    echo "FAILED: $target; the input is in $out" >&2
    return 1
  fi
  echo "== $target: $seconds s"
  grep -E "^(#[0-9]+.*DONE|stat::number_of_executed_units|stat::average_exec|stat::peak_rss)" "$log"
}

# all at the same time: each has its time, whatever the number of cores
jobs=()
for target in "${targets[@]}"; do
  fuzz "$target" &
  jobs+=($!)
done
for job in "${jobs[@]}"; do wait "$job"; done
