#!/usr/bin/env bash
# Builds MeshLab itself, unpatched, with float numbers and the few of its plugins that opening a
# mesh and selecting in it take, to see this plugin in the real window. About 3 minutes of one core.
#
#   build_meshlab.sh SOURCE DESTINATION      SOURCE as SYMSURF_MESHLAB_SOURCE=all get_headers.sh
#
# The program is then DESTINATION/src/distrib/meshlab.
set -euo pipefail

source=${1:?MeshLab\'s source tree}
destination=${2:?where to build}
batches=$(realpath "$(dirname "$0")/build_in_batches.cmake")
plugins=(io_base decorate_base filter_select)

# Its window is driven, not its filters: what counts is how fast it compiles. GCC looks for garbage
# as late as for our own sources.
cmake -S "$source" -B "$destination" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  '-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DNDEBUG --param=ggc-min-heapsize=262144' \
  "-DCMAKE_PROJECT_MeshLab_INCLUDE=$batches" \
  -DMESHLAB_BUILD_MINI=ON "-DMESHLAB_PLUGINS=$(printf 'meshlabplugins/%s;' "${plugins[@]}")"
cmake --build "$destination" --target meshlab "${plugins[@]}"
