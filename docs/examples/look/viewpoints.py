"""
How much a few views show
=========================

Which viewpoints see an object's surface? A greedy choice adds, one by one, the candidate that shows most new surface; a
few of 62 candidates are enough. The twelve viewpoints of the thesis see about as much.
"""

import matplotlib.pyplot as plt

from haptic_glance import load, normalise, render
from haptic_glance.gallery.demo import sample
from haptic_glance.look.views import TWELVE, cumulative_coverage, greedy_views
from haptic_glance.mesh import rotate_to_z_up

mesh = normalise(rotate_to_z_up(load(sample())))
best, shares = greedy_views(mesh, 12)

fig = plt.figure(figsize=(9, 5.4), layout="constrained")
top, bottom = fig.subfigures(2, 1, height_ratios=[1, 1.3])
for axis, viewpoint in zip(top.subplots(1, 4), best, strict=False):
    axis.imshow(render(mesh, viewpoint, (300, 300), renderer="raster").rgb)
    axis.set_title(viewpoint.name, fontsize=9)
    axis.axis("off")
axis = bottom.subplots()
axis.plot(range(1, len(shares) + 1), 100 * shares, marker="o", label="chosen one by one")
axis.plot(range(1, 13), 100 * cumulative_coverage(mesh, TWELVE), marker="s", label="the thesis's twelve, as listed")
axis.set_xlabel("views")
axis.set_ylabel("visible surface seen, %")
axis.legend()
plt.show()
