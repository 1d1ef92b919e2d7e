"""
Sizes of the sensor
===================

Number of cells and their distance are free. Which array is enough for a task is a question for measurements
(:doc:`/concepts/sensor`); here is what each feels at one place.
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
