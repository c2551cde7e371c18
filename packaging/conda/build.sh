#!/usr/bin/env bash
# Called by conda-build: program, library and Python package for the baseline processor of conda-forge.
set -euo pipefail
cmake -S . -B build/conda -G Ninja ${CMAKE_ARGS:-} -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$PREFIX" -DUPLIFT_ARCH=x86-64 -DUPLIFT_SHARED_BLAS=ON
cmake --build build/conda
cmake --install build/conda
cp -r python/uplift "$SP_DIR/uplift"
