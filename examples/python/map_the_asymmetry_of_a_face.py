"""
Map the asymmetry of a face scan
================================

A scan of a face in millimetres, one cheek of which is swollen: how much, and where?
"""

import shapes

import symsurf

face = shapes.face_scan()  # or the name of a file, a mesh, (n, 3) points
found = symsurf.detect(face, method="plane")
print(found.verdict, found.mirror)

# %%
# The asymmetry of a point is how far it is from where the other side says it should be. Red lies too
# far in, blue too far out; the swelling shows on both sides, as nobody can tell from one scan which of
# them is ill.

asymmetry = symsurf.asymmetry(face, found)
asymmetry.plot("asymmetry.png", camera=(0.4, -1, 0.2))

# %%
# The figures that go into a table, in millimetres:

for name in ("rms", "p95", "maximum"):
    print(f"{name:8} {asymmetry.statistics[name]:.2f}")
print(f"{100 * asymmetry.statistics['matched_share']:.0f} % of the points have a counterpart")

# %%
# ``asymmetry.save("face.ply")`` writes the scan with these arrays, one number or vector a point;
# ``.csv`` and ``.npy`` hold the arrays alone, ``.vtp`` is for ParaView.

print(", ".join(asymmetry.arrays))
