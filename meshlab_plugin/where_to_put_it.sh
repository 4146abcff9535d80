#!/bin/sh
# Says which of the built plugins goes where.
for plugin in build/meshlab*/meshlab/*/filter_symsurf.so; do
  host=$(basename "$(dirname "$plugin")")
  echo "for MeshLab ${host%-*} with ${host#*-} numbers: $PWD/$plugin"
done
cat <<'TEXT'

pymeshlab has double numbers:
  import pymeshlab
  pymeshlab.load_plugin("<the double file above>")
  mesh_set = pymeshlab.MeshSet()
  mesh_set.load_new_mesh("shape.ply")
  print(mesh_set.apply_filter("compute_mirror_auto"))

MeshLab: Help > About plugins > Load Plugins, and choose the file; or copy it to the plugins folder
of MeshLab. Of the official builds those with "d" behind the version have double numbers, the others
float, as has Debian's MeshLab from Debian 13 on (2022.02: SYMSURF_MESHLAB_VERSION=2022.02 make
meshlab). Debian 12's own MeshLab, 2020.09, cannot load the plugin.
The filters are then under Filters > Quality Measure and Computations and Filters > Point Set.
TEXT
