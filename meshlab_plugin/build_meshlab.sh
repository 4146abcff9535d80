#!/usr/bin/env bash
# Builds MeshLab itself, unpatched, with float numbers and the few of its plugins that opening a
# mesh and selecting in it take, to see this plugin in the real window. About 7 minutes of one core.
#
#   build_meshlab.sh SOURCE DESTINATION      SOURCE as SYMSURF_MESHLAB_SOURCE=all get_headers.sh
#
# The program is then DESTINATION/src/distrib/meshlab.
set -euo pipefail

source=${1:?MeshLab\'s source tree}
destination=${2:?where to build}

cmake -S "$source" -B "$destination" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  '-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG' -DMESHLAB_BUILD_MINI=ON \
  '-DMESHLAB_PLUGINS=meshlabplugins/io_base;meshlabplugins/decorate_base;meshlabplugins/filter_select'
cmake --build "$destination"
# A mini build leaves plugins out unless they are named.
cmake --build "$destination" --target io_base decorate_base filter_select
