# A thin face on the CMake presets. Every target sets up what it needs: on a bare Debian 12, `make demo` is enough.
SELVAGE := build/release/cli/selvage
DEMO    := demo

.PHONY: help setup build program demo test readers pages asan tsan clang aarch64 coverage docs same-bits fuzz libfuzzer afl mutants names agreement cluster bench micro instructions format tidy clean

help:  ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:[^#]*## /\t/' | expand -t 12

setup:  ## install the Debian packages that are missing
	@cmake/setup packages.txt

build: setup  ## build everything, optimised, in build/release
	cmake --preset release --log-level=WARNING
	cmake --build --preset release

program: setup  ## build the program alone, optimised
	cmake --preset release --log-level=WARNING
	cmake --build --preset release --target selvage

demo: program  ## simulate a curtain over a moving ball, check every frame and step exactly, draw it
	rm -rf $(DEMO)
	$(SELVAGE) sim sim/scenes/demo.toml -o $(DEMO)/curtain --record steps
	$(SELVAGE) render $(DEMO)/curtain -o $(DEMO)/sheet.png
	$(SELVAGE) verify $(DEMO)/curtain --json $(DEMO)/report.json --html $(DEMO)/report.html
	$(SELVAGE) view $(DEMO)/curtain -o $(DEMO)/curtain.html
	@echo "The report is $(DEMO)/report.html, the picture is $(DEMO)/sheet.png, $(DEMO)/curtain.html plays in a browser."

test: build  ## run all tests
	ctest --preset release

readers: build  ## open what Selvage writes with NumPy, VTK and Blender
	@cmake/setup packages-readers.txt
	ctest --preset release -R 'ForeignReaders|NumPy'

pages: build  ## open the pages of verify, view and fuzz --plugin in Chromium
	@cmake/setup packages-browser.txt
	ctest --preset release -R Pages.InABrowser

# Whole and from an empty compiler cache, three quarters of an hour to compile at -O1 and as long to test on a slow machine:
# the short form is CI's. At -Og five sources compiled in 0.55 to 0.72 of that time, and the kernel's tests took 1.02.
ASAN := $(if $(QUICK),asan-short,asan-ubsan)
asan: setup  ## run the tests under AddressSanitizer and UndefinedBehaviorSanitizer; QUICK=1: those of kernel, files, step, corpus
	cmake --preset asan-ubsan --log-level=WARNING
	cmake --build --preset $(ASAN)
	ctest --preset $(ASAN)

tsan: setup  ## run the tests under ThreadSanitizer, with oneTBB built for it
	@cmake/setup packages-tsan.txt
	cmake/tsan_tbb build/tsan-tbb
	cmake --preset tsan --log-level=WARNING
	cmake --build --preset tsan
	ctest --preset tsan

clang: setup  ## build and test with clang++: the same bits are asserted
	@cmake/setup packages-clang.txt
	cmake --preset clang --log-level=WARNING
	cmake --build --preset clang
	ctest --preset clang

aarch64: setup  ## build for AArch64 and run the short tests under QEMU: the same bits are asserted
	@cmake/setup packages-aarch64.txt
	cmake/aarch64_sysroot build/aarch64-sysroot
	cmake --preset aarch64 --log-level=WARNING
	cmake --build --preset aarch64
	ctest --preset aarch64

coverage: setup  ## every line and branch of the kernel is tested, but for those that docs/measurements/coverage.md excuses
	@cmake/setup packages-clang.txt
	cmake --preset coverage --log-level=WARNING
	cmake --build --preset coverage --target kernel_tests
	cmake -DSOURCE=. -DBUILD=build/coverage -P cmake/coverage.cmake

fuzz: build  ## a minute of fuzzing against the exact checker
	rm -rf build/artifacts
	$(SELVAGE) fuzz --time 60s --artifacts build/artifacts

FUZZ_SECONDS := 10
FUZZ_TARGETS :=
libfuzzer: setup  ## coverage-guided fuzzing of every parser, of queries and of steps; FUZZ_SECONDS=600 for ten minutes each
	@cmake/setup packages-clang.txt
	cmake --preset libfuzzer --log-level=WARNING
	cmake --build --preset libfuzzer
	fuzz/harness/campaign libfuzzer $(FUZZ_SECONDS) $(FUZZ_TARGETS)

afl: setup  ## the same with AFL++
	@cmake/setup packages-clang.txt
	@cmake/setup packages-afl.txt
	cmake --preset afl --log-level=WARNING
	cmake --build --preset afl
	fuzz/harness/campaign afl $(FUZZ_SECONDS) $(FUZZ_TARGETS)

mutants: build  ## plant over a hundred defects, one at a time: a property must find each of them (docs/measurements/mutants.md)
	cmake --build --preset release --target selvage_mutants
	build/release/tests/mutants/selvage_mutants tests/mutants/lists --classes 1000 \
	  --json build/mutants.json --markdown build/mutants.md

names: setup  ## compile each folder as one unit: names that two of its sources keep to themselves clash
	cmake --preset release -B build/names -D CMAKE_UNITY_BUILD_BATCH_SIZE=0 -D CMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
	  -D CMAKE_CXX_FLAGS_RELEASE=-O0 --log-level=WARNING
	cmake --build build/names --parallel 2 -- -k 0

docs:  ## the reference of the kernel's public API, in build/docs/html
	@cmake/setup packages-docs.txt
	cmake -DSOURCE=. -DOUTPUT=build/docs -P cmake/docs.cmake

SAME_BITS_FLAGS := -O0 -O2 -O3 "-O2 -march=native" "-O2 -funsafe-math-optimizations"
same-bits: setup  ## one hash of all answers for two compilers and their flags, every SIMD target and 1 to 8 threads
	@cmake/setup packages-clang.txt
	legs=$$(for c in g++ clang++-14; do for f in $(SAME_BITS_FLAGS); do printf '%s %s;' $$c "$$f"; done; done); \
	  cmake -DSOURCE=. -DWORK=build/same_bits "-DLEGS=$$legs" -P tests/house/same_bits.cmake

agreement: build  ## the two exact deciders of motions, ten million times: an hour on one core
	build/release/tests/verify/agreement_campaign 1000 59 2000 > build/agreement.jsonl

cluster: build  ## the manual's Slurm script on a Slurm of this machine, with a node killed in the middle (as root)
	@cmake/setup packages-cluster.txt
	rm -rf build/cluster && mkdir -p build/cluster
	$(SELVAGE) sim sim/scenes/demo.toml -o build/cluster/run --frames 5 --record steps
	cd build/cluster && ../../tests/cluster/slurm_kill ../../$(SELVAGE) run --second-opinion-all

BENCH_RESULTS := $(if $(QUICK),build/bench,bench/results)
BENCH_PAGE    := $(if $(QUICK),build/bench/speed-against-error.md,docs/measurements/speed-against-error.md)
bench: build  ## speed against error: bench/results and docs/measurements/speed-against-error.md; QUICK=1: two minutes, into build/bench
	@cmake/setup packages-bench.txt
	cmake --preset release --log-level=WARNING
	cmake --build --preset release --target selvage_micro selvage_instructions
	bench/report/run.py --build build/release --results $(BENCH_RESULTS) --page $(BENCH_PAGE) $(if $(QUICK),--quick)

micro: setup  ## Google Benchmark of the smallest pieces of work, beside the textbook method
	@cmake/setup packages-bench.txt
	cmake --preset release --log-level=WARNING
	cmake --build --preset release --target selvage_micro
	build/release/bench/selvage_micro

instructions: setup  ## instructions of three workloads against those in bench/results; WRITE=1 keeps the new ones
	@cmake/setup packages-bench.txt
	cmake --preset release --log-level=WARNING
	cmake --build --preset release --target selvage_instructions
	bench/report/instructions.py build/release/bench/selvage_instructions bench/results/instructions.json $(if $(WRITE),--write)

format:  ## rewrite the sources in the house style
	@cmake/setup packages-clang.txt
	git ls-files '*.h' '*.cpp' | xargs clang-format-14 -i

tidy: setup  ## clang-tidy over every source
	@cmake/setup packages-clang.txt
	cmake --preset dev -B build/tidy --log-level=WARNING
	git ls-files '*.cpp' | grep -v -e ^tests -e ^examples | xargs -P 2 -n 1 clang-tidy-14 --quiet -p build/tidy

clean:  ## remove everything that was built
	rm -rf build $(DEMO)
