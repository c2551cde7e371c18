# The two commands of the README, and what developers need. `make help` lists them.
.DEFAULT_GOAL := help
.PHONY: help run test mpi test-mpi docs bench build build-tests wheel deb web format check-format layers tidy asan clean

help:              ## this list
	@grep -E '^[a-z-]+: .*##|^[a-z-]+:  *##' Makefile | sed -E 's/^([a-z-]+):.*## */  make \1\t/' | expand -t 22

run: build         ## install what is missing, build, run the paper's oscillator with every method, say where the report is
	build/release/uplift compare examples/01_oscillator/case.toml

test: build-tests  ## the same set-up, then build and run every test
	ctest --test-dir build/release --output-on-failure -j 2

mpi:               ## uplift-mpi for several processes, with PETSc, MUMPS and Open MPI: docs/guide/several_processes.md
	@scripts/setup.sh mpi
	cmake --preset release -DUPLIFT_MPI=ON
	cmake --build build/release --target uplift uplift-mpi bench_weak

test-mpi: mpi      ## tests of uplift-mpi on 1, 2 and 4 ranks
	@scripts/setup.sh test-mpi
	cmake --preset release -DUPLIFT_MPI=ON
	cmake --build build/release --target test_mpi
	python3 -B tests/mpi/test_mpi.py build/release/uplift

docs: build        ## the documentation as a site that opens from disk: build/docs/site/index.html
	@scripts/setup.sh docs
	python3 scripts/make_docs.py build/release/uplift --record build/release/verification --build

build:
	@scripts/setup.sh run
	@test -f build/release/build.ninja || cmake --preset release
	cmake --build build/release

build-tests:
	@scripts/setup.sh test
	cmake --preset release -DUPLIFT_TESTS=ON
	cmake --build build/release

bench:             ## benchmarks: kernels, steps, whole process; figures and limits in docs/performance.md
	@scripts/setup.sh develop
	cmake --preset release -DUPLIFT_BENCH=ON
	cmake --build build/release
	build/release/bench/bench_kernels
	build/release/bench/bench_soil_block
	build/release/bench/bench_soil_block space
	bench/whole_process.py build/release/uplift

wheel:             ## Python wheel for every x86-64 processor: build/packages/*.whl
	scripts/setup.sh packages
	scripts/build_portable.sh build/portable
	scripts/make_wheel.py build/portable build/packages

deb:               ## Debian packages of the tracked files, checked by lintian: build/packages/*.deb
	scripts/setup.sh deb
	scripts/build_portable.sh build/portable mpi
	scripts/make_deb.sh build/portable build/packages

web:               ## rebuild the report page (developers of the page only)
	cd web && npm ci && npm run check && npm run build

format:            ## clang-format all sources
	git ls-files 'src/*.h' 'src/*.cpp' 'tests/*.cpp' 'tests/*.h' 'bench/*.cpp' 'fuzz/*.cpp' 'fuzz/*.h' | tr '\n' '\0' | xargs -0 clang-format-14 -i

check-format:
	git ls-files 'src/*.h' 'src/*.cpp' 'tests/*.cpp' 'tests/*.h' 'bench/*.cpp' 'fuzz/*.cpp' 'fuzz/*.h' | tr '\n' '\0' | xargs -0 clang-format-14 --dry-run --Werror

layers:            ## the order of the layers
	python3 scripts/check_layers.py

tidy:              ## clang-tidy on what the project exists for: laws, interfaces, contact, the condensed step
	scripts/tidy.sh

asan:              ## the tests but the long ones, those of verification, of the documentation and of the examples under AddressSanitizer and UndefinedBehaviorSanitizer
	cmake --preset asan
	cmake --build build/asan
	ctest --test-dir build/asan --output-on-failure -j 2 -LE long

clean:             ## remove build and out
	rm -rf build out
