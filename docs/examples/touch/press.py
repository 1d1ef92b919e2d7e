"""
What a pressure array feels
===========================

:func:`haptic_glance.press` puts a flat array of cells on the surface at a vertex. 0 is the cell of first contact and 1
the cell farthest from the surface: dark is pressed.
"""

import matplotlib.pyplot as plt
import numpy as np

from haptic_glance import detect, load, normalise, press_many
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.mesh_pictures import look
from haptic_glance.mesh import rotate_to_z_up

mesh = normalise(rotate_to_z_up(load(sample())))
detection = detect(mesh, count=6)
images = press_many(mesh, detection.points, cells=(16, 16), pitch=0.01)

fig = plt.figure(figsize=(9, 4.2), layout="constrained")
left, right = fig.subfigures(1, 2, width_ratios=[1, 1.3])
axis = left.subplots()
axis.imshow(look(mesh, detection.saliency, detection.points)[90:530, 60:560])
axis.axis("off")
for rank, (axis, image) in enumerate(zip(np.ravel(right.subplots(2, 3)), images, strict=True), start=1):
    axis.imshow(image, cmap="gray", vmin=0, vmax=1)
    axis.set_title(f"touch {rank}", fontsize=10)
    axis.set_xticks([])
    axis.set_yticks([])
plt.show()
