"""
Where the error is
==================

:func:`haptic_glance.lod.vertex_errors` gives the distance of every vertex to the other surface. The example draws these
distances as colours.
"""

import matplotlib.pyplot as plt

from haptic_glance import load, normalise, saliency, simplify
from haptic_glance.gallery.demo import sample
from haptic_glance.lod import vertex_errors
from haptic_glance.lod.mesh_pictures import coloured, draw
from haptic_glance.mesh import rotate_to_z_up

mesh = normalise(rotate_to_z_up(load(sample())))
plain = vertex_errors(simplify(mesh, 600), mesh)
soft = vertex_errors(simplify(mesh, 600, weights=saliency(mesh)), mesh)

fig, axes = plt.subplots(1, 2, figsize=(8, 4), layout="constrained")
for axis, errors, title in zip(axes, [plain, soft], ["by shape alone", "weighed by saliency"], strict=True):
    print(f"{title:20} mean {100 * errors.mean():.3f} %, largest {100 * errors.max():.2f} % of the diameter")
    axis.imshow(draw(coloured(mesh, errors))[90:530, 60:560])
    axis.set_title(f"600 faces, {title}", fontsize=10)
    axis.axis("off")
plt.show()
