"""
The fewest faces for a tolerance
================================

How many faces does an object need? State the mean error that you can bear, and the count is found by measuring.
"""

import matplotlib.pyplot as plt

from haptic_glance import load, normalise, saliency, simplify
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.measures import fewest_faces
from haptic_glance.lod.mesh_pictures import draw
from haptic_glance.mesh import rotate_to_z_up

mesh = normalise(rotate_to_z_up(load(sample())))
weights = saliency(mesh)

fig, axes = plt.subplots(1, 3, figsize=(10, 3.7), layout="constrained")
for axis, tolerance in zip(axes, [0.0002, 0.001, 0.004], strict=True):  # shares of the diagonal
    smallest = fewest_faces(mesh, lambda faces: simplify(mesh, faces, weights=weights), 50, tolerance)
    axis.imshow(draw(smallest, wires=True)[90:530, 60:560])
    axis.set_title(f"{100 * tolerance:g} %: {len(smallest.faces):,} faces", fontsize=10)
    axis.axis("off")
plt.show()
