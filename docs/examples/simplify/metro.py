"""
Distance of two surfaces
========================

:func:`haptic_glance.metro` measures the mean, the root mean square and the largest distance of two surfaces in both
directions, as Metro does (Cignoni 1998), in shares of the diagonal. The largest is an estimate of the Hausdorff
distance. A polyhedron inscribed in a sphere is a case whose answer is known.
"""

import matplotlib.pyplot as plt
import numpy as np
import trimesh

from haptic_glance import Mesh, metro

ball = trimesh.creation.icosphere(6)
fine = Mesh(ball.vertices, ball.faces)

counts, errors = [], []
for level in range(1, 5):
    coarse = trimesh.creation.icosphere(level)
    counts.append(len(coarse.faces))
    errors.append(metro(fine, Mesh(coarse.vertices, coarse.faces)))
    sagitta = (1 - np.linalg.norm(coarse.triangles_center, axis=1).min()) / fine.diagonal
    print(f"{counts[-1]:6,} faces: largest {errors[-1]['max']:.6f}, sagitta of the largest face {sagitta:.6f}")

for name in ("mean", "rms", "max"):
    plt.loglog(counts, [error[name] for error in errors], marker="o", label=name)
plt.xlabel("faces")
plt.ylabel("distance, share of the diagonal")
plt.legend()
plt.show()
