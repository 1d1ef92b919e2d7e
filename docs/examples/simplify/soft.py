"""
Fewer faces, finer where people look
====================================

With ``weights`` the error of a collapse counts more where the saliency is high. The faces that are left gather there;
nothing is frozen.
"""

import matplotlib.pyplot as plt

from haptic_glance import load, saliency, simplify
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.mesh_pictures import coloured, draw
from haptic_glance.mesh import normalise, rotate_to_z_up

mesh = normalise(rotate_to_z_up(load(sample())))
weights = saliency(mesh)
shown = {
    f"{len(mesh.faces):,} faces": (mesh, weights),
    "1,200, by shape alone": (plain := simplify(mesh, 1200), saliency(plain)),
    "1,200, weighed by saliency": (soft := simplify(mesh, 1200, weights=weights), saliency(soft)),
}

fig, axes = plt.subplots(2, 3, figsize=(9, 5.6), height_ratios=[4, 3], layout="constrained")
for (whole, head), (title, (simplified, values)) in zip(axes.T, shown.items(), strict=True):
    image = draw(coloured(simplified, values), wires=True)
    whole.imshow(image[90:530, 60:560])
    whole.set_title(title, fontsize=10)
    head.imshow(image[150:300, 370:570])
    whole.axis("off")
    head.axis("off")
plt.show()
