"""
Sizes of the sensor
===================

You choose the number of cells and their distance. :doc:`/concepts/sensor` measures which array is enough for a task.
This example shows the imprints of several arrays at one place.
"""

import matplotlib.pyplot as plt

from haptic_glance import find_points, load, normalise, press
from haptic_glance.gallery.demo import sample
from haptic_glance.mesh import rotate_to_z_up

mesh = normalise(rotate_to_z_up(load(sample())))
place = find_points(mesh, count=1)[0]

fig, axes = plt.subplots(2, 4, figsize=(9, 4.8), layout="constrained")
for row, width in zip(axes, [0.16, 0.32], strict=True):  # of the object's diameter
    for axis, cells in zip(row, [8, 16, 32, 64], strict=True):
        axis.imshow(press(mesh, place, (cells, cells), pitch=width / cells), cmap="gray", vmin=0, vmax=1)
        axis.set_title(f"{cells} x {cells}, {width / cells:g} apart", fontsize=9)
        axis.set_xticks([])
        axis.set_yticks([])
plt.show()
