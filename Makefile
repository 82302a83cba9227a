# SPDX-License-Identifier: Apache-2.0
# CI runs these targets (.ci/run). Each installs what it needs.

.PHONY: build setup demo live python wheels reference test lint numerics sanitize fuzz coverage check-all bench profile docs bare package package-test release site campaigns clean

build: setup
	cmake --preset release
	cmake --build --preset release --target dermis_cli

setup:
	scripts/setup build

demo: build
	scripts/demo

live: build
	scripts/live

# build/release/python, for PYTHONPATH; "pip install ." makes a wheel of it.
python: setup
	scripts/setup python
	cmake --preset release
	cmake --build --preset release --target dermis_python

# A wheel for each architecture, with its libraries inside, and the sources, in build/wheels.
wheels: setup
	scripts/setup python
	scripts/setup wheels
	scripts/wheels.py

# What is published, in build/release_files, tried where nothing is installed. As root.
release: wheels package site
	scripts/setup test
	scripts/setup bare
	scripts/release

test: setup
	scripts/setup test
	scripts/setup browser
	cmake --preset release
	cmake --build --preset release
	ctest --preset release
	-@grep -h -A1 ': Skipped$$' build/release/Testing/Temporary/LastTest.log

# What the tree of the sanitizers takes from the release.
numerics: setup
	cmake --preset release
	cmake --build --preset numerics

sanitize: numerics
	scripts/setup test
	scripts/setup browser
	scripts/setup fuzz
	cmake --preset asan
	cmake --build --preset asan
	ctest --preset asan

lint: setup
	scripts/setup test
	scripts/setup lint
	cmake --preset lint
	cmake --build --preset lint
	scripts/lint

fuzz: numerics
	scripts/setup fuzz
	scripts/fuzz

# What the fuzzers and the tests reach of the rooms that read bytes.
coverage: numerics
	scripts/setup test
	scripts/setup fuzz
	scripts/fuzz_coverage

check-all:
	.ci/all

bench: setup
	scripts/setup test
	scripts/setup bench
	cmake --preset release -D DERMIS_BUILD_BENCHMARKS=ON
	cmake --build --preset release
	scripts/bench

# Where the time of a frame goes.
profile: setup
	scripts/setup test
	scripts/setup profile
	cmake --preset release -D DERMIS_BUILD_BENCHMARKS=ON
	cmake --build --preset release --target pipeline_benchmark contacts_benchmark live_benchmark
	scripts/profile

# What the help says, as documents.
reference: build
	cp -r build/release/share/doc/dermis/. docs

docs: setup
	/usr/bin/python3 scripts/check_docs.py
	/usr/bin/python3 scripts/sentences.py >/dev/null
	/usr/bin/python3 scripts/sentences.py --comments

package: setup
	scripts/setup package
	scripts/setup wheels
	scripts/package
	scripts/package arm64

# The README's first command where nothing is installed. .ci/all does all of them, as root too.
bare: setup
	scripts/setup bare
	scripts/bare_machine --as robin 'make demo'

# As root: it makes a bare Debian in build/package/debian.
package-test: package
	/usr/bin/python3 tests/command_line/reference_test.py build/release/bin/dermis
	scripts/package_test

site: setup
	scripts/setup test
	scripts/setup site
	scripts/setup browser
	$(MAKE) build
	scripts/site

# The same work on many recordings, by Ray, GNU parallel and Slurm (docs/campaigns.md).
campaigns: python build
	scripts/setup campaigns
	cmp -s tests/live/fleet/requirements.txt build/campaigns/requirements.txt || { \
	  /usr/bin/python3 -m venv --clear build/campaigns && \
	  build/campaigns/bin/pip install --quiet --requirement tests/live/fleet/requirements.txt && \
	  cp tests/live/fleet/requirements.txt build/campaigns; }
	PYTHONPATH=$(CURDIR)/build/release/python build/campaigns/bin/python tests/live/fleet/campaigns_test.py build/release/bin/dermis

clean:
	rm -rf build demo
