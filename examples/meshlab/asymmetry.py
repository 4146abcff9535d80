"""Maps the asymmetry of a shape in MeshLab's engine.

python asymmetry.py filter_symsurf.so face.ply
"""

import sys

import pymeshlab

pymeshlab.load_plugin(sys.argv[1])
mesh_set = pymeshlab.MeshSet()
mesh_set.load_new_mesh(sys.argv[2])

found = mesh_set.apply_filter("compute_mirror_plane")
print("found", found["found"], "score", round(found["score"], 2))
print("normal", found["normal"].round(3))

asymmetry = mesh_set.apply_filter("compute_mirror_asymmetry")  # over the mirror just found
print("rms", round(asymmetry["rms"], 2), "maximum", round(asymmetry["maximum"], 2))

quality = mesh_set.current_mesh().vertex_scalar_array()
print(
    "of",
    len(quality),
    "vertices the quality goes from",
    quality.min().round(2),
    "to",
    quality.max().round(2),
)
mesh_set.save_current_mesh("coloured.ply")
