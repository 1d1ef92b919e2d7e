"""
Following a contour
===================

A finger follows the section of an object by a plane. It feels an imprint at each of 25 places (the cutaneous cue) and
knows where it is and how it is turned (the kinesthetic cue); T4.4.5.
"""

import matplotlib.pyplot as plt
import numpy as np

from haptic_glance import find_points, follow, load, normalise
from haptic_glance.gallery.demo import sample
from haptic_glance.mesh import rotate_to_z_up

mesh = normalise(rotate_to_z_up(load(sample())))
first, second = mesh.vertices[find_points(mesh, count=6)][[0, 3]]
plane = np.array([np.zeros(3), first, second])  # the object's centre and two points
felt = follow(mesh, plane, frames=25, cells=(32, 32))
print(f"one of {felt.loops} curves, {felt.length:.2f} diameters long")

fig = plt.figure(figsize=(9, 4.4), layout="constrained")
left, right = fig.subfigures(1, 2, width_ratios=[1, 1.3])
axis = left.subplots(subplot_kw={"projection": "3d"})
axis.scatter(*mesh.vertices[::3].T, s=0.3, c="0.7")
axis.scatter(*felt.positions.T, c=np.arange(25), s=18, depthshade=False)
axis.quiver(*felt.positions.T, *(0.1 * felt.normals.T), color="0.3", lw=0.8)
axis.set_aspect("equal")
axis.view_init(15, -60)
axis.axis("off")
for axis, image in zip(np.ravel(right.subplots(5, 5)), felt.images, strict=True):
    axis.imshow(image, cmap="gray", vmin=0, vmax=1)
    axis.axis("off")
plt.show()
