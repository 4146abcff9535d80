# make setup | demo | test | bench: each sets up what it needs first, and only what is missing.
.PHONY: setup demo test bench

setup:
	@.ci/setup python tests

demo:
	@.ci/setup python
	@build/venv/bin/symsurf demo --output build/demo

test:
	@.ci/setup tests
	@.ci/suites

bench:
	@.ci/setup benchmarks
	@cmake --build build/benchmarks --target bench
