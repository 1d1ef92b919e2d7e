"""
Neighbourhoods kept unchanged
=============================

The thesis freezes the faces around each salient point (T3.1.3). The kept faces survive bit for bit, and the other faces
take all of the error: the whole surface has a higher error than plain simplification with as many faces. We advise
weights instead; :doc:`/concepts/simplification` has the measurements.
"""

import matplotlib.pyplot as plt
import numpy as np

from haptic_glance import find_points, load, metro, normalise, saliency, simplify
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.mesh_pictures import draw
from haptic_glance.mesh import rotate_to_z_up

mesh = normalise(rotate_to_z_up(load(sample())))
points = find_points(mesh, count=8)
made = {
    "plain": simplify(mesh, 1200),
    "weighed by saliency": simplify(mesh, 1200, weights=saliency(mesh)),
    "eight points kept, three rings": simplify(mesh, 1200, keep=points, rings=3),
}

fig, axes = plt.subplots(2, 3, figsize=(9, 5.6), height_ratios=[4, 3], layout="constrained")
for (whole, head), (title, simplified) in zip(axes.T, made.items(), strict=True):
    survived = (simplified.vertices[:, None] == mesh.vertices[points]).all(axis=2).any(axis=0)
    error = 100 * metro(mesh, simplified)["mean"]
    print(f"{title:31} mean error {error:.4f} %, {int(np.sum(survived))} of 8 points survive")
    image = draw(simplified, wires=True)
    whole.imshow(image[90:530, 60:560])
    whole.set_title(title, fontsize=10)
    head.imshow(image[150:300, 370:570])
    whole.axis("off")
    head.axis("off")
plt.show()
