"""
Where people look
=================

:func:`haptic_glance.saliency` predicts, for each vertex, how much it attracts the gaze. The model behind it was learned
from human gaze. It needs to know which axis points up. A GLB stores the axis; for other files the shape decides between
y and z, and ``up="y"`` sets the axis.
"""

import matplotlib.pyplot as plt

from haptic_glance import detect, load
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.mesh_pictures import look

mesh = load(sample())
detection = detect(mesh, count=10)  # saliency and points from one look
print(mesh, detection.saliency.min().round(3), detection.saliency.max().round(3))

# %%
# Yellow attracts most. The numbers are the ranks of the points on this side.

plt.figure(figsize=(5, 5), layout="constrained")
plt.imshow(look(mesh, detection.saliency, detection.points))
plt.axis("off")
plt.show()
