"""
Points with inhibition of return
================================

Attention visits the highest place first. That place is then inhibited, fading outwards, and the next one wins. A larger
radius keeps points apart; a smaller one lets them gather where the saliency is high.
"""

import matplotlib.pyplot as plt

from haptic_glance import find_points, load, saliency
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.mesh_pictures import look

mesh = load(sample())
values = saliency(mesh)

fig, axes = plt.subplots(1, 3, figsize=(9, 3.4), layout="constrained")
for axis, radius in zip(axes, [0.02, 0.058, 0.15], strict=True):
    points = find_points(mesh, count=12, radius=radius)
    axis.imshow(look(mesh, values, points)[90:530, 60:560])
    axis.set_title(f"radius {radius:g} of the diameter", fontsize=10)
    axis.axis("off")
plt.show()
