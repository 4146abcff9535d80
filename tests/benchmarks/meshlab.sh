#!/bin/sh
# The plugin in MeshLab's engine: what it costs beside the core, and how long it is silent.
# Usage: tests/benchmarks/meshlab.sh, in the source folder, after .ci/setup meshlab.
plugin=$PWD/build/meshlab/meshlab/2025.07-double/filter_symsurf.so
LD_LIBRARY_PATH=$(dirname "$(find build/venv/lib -name libmeshlab-common.so)")
build/venv/bin/python tests/benchmarks/meshlab_overhead.py "$plugin"
export LD_LIBRARY_PATH
for run in 'plane 1000000' 'auto 20000' 'sphere 20000' 'sphere_thesis 500' 'separation 20000' \
  'separation_normals 20000' 'normals_only 20000' 'fixed_direction 20000' 'perpendicular 20000' \
  'cylinder 20000' 'quadric 20000'; do
  # shellcheck disable=SC2086
  build/meshlab/meshlab/meshlab_cancel "$plugin" $run
done
