"""
Make a table of mirror vertices
===============================

Which vertex of a mesh mirrors which: for weights of a rig, morph targets, landmarks or labels.
"""

import numpy as np
import shapes

import symsurf

mesh = shapes.head(4)
found = symsurf.detect(mesh, method="plane")
pairs = symsurf.correspondences(mesh, found)
pairs.plot("pairs.png", camera=(0, -1, 0.35))

# %%
# ``index`` has the mirror vertex of each vertex, -1 where there is none; on the mirror it is the
# vertex itself.

print(pairs.index[:10])
print(f"{100 * pairs.statistics['paired_share']:.0f} % have one")
print(np.count_nonzero(pairs.index == np.arange(len(pairs.index))), "are their own")

# %%
# Weights that were painted on one side, on both:

weights = np.clip(mesh.points[:, 0], 0, None)
both = np.maximum(weights, weights[pairs.index])
print(weights.sum(), both.sum())

# %%
# The table as a file, one row per vertex. On a mesh whose sides have different vertices, ``face`` and
# ``weights`` say where on the surface the mirror point lies.

pairs.save("pairs.csv")
with open("pairs.csv") as table:
    print(*[next(table) for _ in range(4)], sep="")
