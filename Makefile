# make setup | demo | wheel | wheels | vtk-wheel | docs | paraview | meshlab | meshlab-gui | test | test-full | test-hosts |
# lint | tidy | sanitize | fuzz | bench | accuracy | ablation | compare: each sets up what it needs first, and only what is
# missing.
.PHONY: setup demo wheel wheels vtk-wheel docs paraview meshlab meshlab-gui test test-full test-hosts lint tidy sanitize \
  fuzz bench bench-meshlab accuracy ablation compare

# Of make test and make test-full; SUITES="core python" asks for some.
SUITES = lint core python vtk paraview meshlab wheel docs slicer blender

setup:
	@.ci/setup cached python $(SUITES:%=suite_%)

demo:
	@.ci/setup demo
	@build/venv/bin/symsurf demo --output build/demo

# A wheel for this machine's Python and for Linux of its C library's age, and the source distribution.
wheel:
	@.ci/setup wheel
	@ls -sh build/dist/*

# Wheels for Python 3.10 to 3.14, each installed and run; SYSTEMS="linux-x86_64 linux-arm64 windows-x86_64
# macosx-arm64 macosx-x86_64" asks for those of other systems too, which run where `.ci/setup foreign` was.
wheels: SYSTEMS = linux-x86_64
wheels:
	@SYMSURF_WHEELS="$(SYSTEMS)" .ci/setup wheels python_tests
	@build/venv/bin/python -m pytest tests/wheel
	@ls -sh build/wheels/dist/*.whl

# The VTK filters as a wheel for PyVista's build of VTK, and its test: needs Python 3.12 or later.
vtk-wheel:
	@.ci/setup vtk_wheel
	@! [ -d build/vtk-wheel/dist ] || build/vtk-python/bin/python -m pytest tests/wheel/test_vtk_wheel.py
	@! [ -d build/vtk-wheel/dist ] || ls -sh build/vtk-wheel/dist/*

# The documentation site; every example in it runs.
docs:
	@.ci/setup docs
	@.ci/docs
	@echo "The site: $(CURDIR)/build/docs/index.html"

paraview:
	@.ci/setup paraview
	@echo "The plugin: $$(ls -d $(CURDIR)/build/paraview/lib/paraview-*/plugins/SymsurfPlugin)/SymsurfPlugin.so"
	@echo "In ParaView: Tools > Manage Plugins > Load New; in pvpython: LoadPlugin(\"...\", remote=False, ns=globals())"
	@echo "Loaded at every start: PV_PLUGIN_PATH=$$(ls -d $(CURDIR)/build/paraview/lib/paraview-*/plugins/SymsurfPlugin) paraview"

test:
	@.ci/setup cached $(SUITES:%=suite_%)
	@.ci/suites $(SUITES)

# The same with all that there is to draw and with what is seldom broken: tables of the thesis, damaged parts, windows,
# VTK 9.1 and 9.7. It takes about twice as long.
test-full: export SYMSURF_SEEDS = 8
test-full: test

# What `make test` leaves aside where it is not installed: Blender's and Slicer's Pythons, Open3D, ITK and more, some
# 4 GB of packages.
test-hosts:
	@.ci/setup python_tests wheel blender slicer objects
	@build/venv/bin/python -m pytest tests/blender tests/slicer tests/python/test_objects.py

# Format, style and types, in seconds; `make test` runs it too.
lint:
	@.ci/setup lint
	@.ci/lint

# What clang-tidy finds in the core, by the checks of .clang-tidy.
tidy:
	@.ci/setup tidy
	@run-clang-tidy-16 -quiet -p build/tidy

# The core's tests under AddressSanitizer and UndefinedBehaviorSanitizer, those with threads under
# ThreadSanitizer.
sanitize:
	@.ci/setup sanitize
	@.ci/sanitize

# Every fuzz target for so many seconds: make fuzz SECONDS=600.
fuzz: SECONDS = 60
fuzz:
	@.ci/setup fuzz
	@.ci/fuzz $(SECONDS)

bench:
	@.ci/setup benchmarks paraview python python_tests compare
	@cmake --build build/benchmarks --target bench
	@tests/benchmarks/vtk/run.sh
	@build/venv/bin/python tests/benchmarks/batch.py
	@build/venv/bin/python tests/benchmarks/chunks.py --powers 6 7 --workers 7
	@cd tests && ../build/compare/bin/python -m benchmarks.compare.speed

# A quarter of an hour on two cores; OPTIONS=--all runs five times as many trials, OPTIONS="--cases
# fixed --seeds 2" asks for less, OPTIONS=--help tells what there is.
accuracy:
	@.ci/setup accuracy
	@cd tests && ../build/venv/bin/python -m accuracy $(OPTIONS)

# What each mechanism of the core is worth, the table of docs/developer/ablation.md: builds a copy of the core in
# which it can be switched off; OPTIONS="--mechanisms sphere" measures less.
ablation:
	@.ci/setup accuracy
	@cd tests && ../build/venv/bin/python -m ablation $(OPTIONS)

# symsurf's planes beside those of others that the registries have, on the same points: a quarter of
# an hour; OPTIONS="--seeds 1" asks for less.
compare:
	@.ci/setup compare
	@cd tests && ../build/compare/bin/python -m benchmarks.compare $(OPTIONS)

meshlab:
	@.ci/setup meshlab
	@meshlab_plugin/where_to_put_it.sh

# Sees the plugin in MeshLab's own window, which it builds; leaves build/meshlab-gui/pictures.
meshlab-gui:
	@.ci/setup meshlab_gui pytest
	@SYMSURF_SEEDS=8 build/venv/bin/python -m pytest tests/meshlab

# What MeshLab costs, how long it takes to cancel, and its own plane detector beside ours.
bench-meshlab:
	@.ci/setup meshlab
	@cmake --build build/meshlab --target meshlab_plane_detector meshlab_cancel
	@build/meshlab/meshlab/meshlab_plane_detector
	@tests/benchmarks/meshlab.sh
