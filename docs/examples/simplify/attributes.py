"""
Colours in the error
====================

Flat surfaces can be painted. By shape alone a square needs two triangles, and its picture smears. With ``attributes``
the colours have a weight in the error, and edges of the picture keep their vertices.
"""

import matplotlib.pyplot as plt
import numpy as np
import trimesh
from matplotlib.collections import PolyCollection

from haptic_glance import Mesh, simplify
from haptic_glance.lod import colour_error

square = trimesh.creation.box((1, 1, 0.02))
for _ in range(5):
    square = square.subdivide()
inside = np.hypot(square.vertices[:, 0], square.vertices[:, 1]) < 0.3
painted = Mesh(
    square.vertices, square.faces, np.where(inside[:, None], [200, 40, 30], [240, 235, 220]).astype(np.uint8)
)

made = {
    f"{len(painted.faces):,} faces": painted,
    "500, by shape alone": simplify(painted, 500),
    "500, colours weigh 0.1": simplify(painted, 500, attributes={"colors": 0.1}),
}
fig, axes = plt.subplots(1, 3, figsize=(9, 3.3), layout="constrained")
for axis, (title, mesh) in zip(axes, made.items(), strict=True):
    top = mesh.face_normals[:, 2] > 0.5
    colours = mesh.colors[mesh.faces[top]].mean(axis=1) / 255
    corners = mesh.vertices[mesh.faces[top], :2]
    axis.add_collection(PolyCollection(corners, facecolors=colours, edgecolors="#88888855", linewidths=0.3))
    axis.set(xlim=(-0.5, 0.5), ylim=(-0.5, 0.5))
    axis.set_title(f"{title}\ncolour error {colour_error(painted, mesh):.1f} of 255", fontsize=10)
    axis.set_aspect("equal")
    axis.axis("off")
plt.show()
