#!/bin/sh
# What the VTK layer costs, how long an abort waits, and what several processes gain.
# Usage: tests/benchmarks/vtk/run.sh [BUILD], in the source folder, after .ci/setup paraview.
build=${1:-build/paraview}
cmake --build "$build" --target symsurf_vtk_benchmark
"$build/bin/symsurf_vtk_benchmark"
PYTHONPATH=$(ls -d "$build"/lib/python3*/site-packages)
export PYTHONPATH OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
for how in slabs turns; do
  for processes in 1 2 3; do
    mpiexec --oversubscribe -n "$processes" pvbatch --symmetric \
      tests/benchmarks/vtk/parallel.py 1000000 "$how"
  done
done
