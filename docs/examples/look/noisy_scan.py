"""
Points found again under noise
==============================

A scanner moves every vertex a little. Repeatability is the share of points that are found again within 2 % of the
diagonal. :doc:`/concepts/stability` has the same on many objects, with intervals.

Needs a clone and ``pip install '.[pipeline]'``.
"""

import matplotlib.pyplot as plt
import numpy as np

from haptic_glance import find_points, load, normalise
from haptic_glance.disturb.objects import PERTURBATIONS
from haptic_glance.gallery.demo import sample
from haptic_glance.mesh import rotate_to_z_up
from stages.stability.repeatability import TOLERANCE, repeatability

COUNT, SEVERITIES = 30, [0.0005, 0.001, 0.0025, 0.005]

mesh = normalise(rotate_to_z_up(load(sample())))

for method in ["glance", "harris"]:
    before = mesh.vertices[find_points(mesh, method, COUNT)]
    again = []
    for severity in SEVERITIES:
        noisy = PERTURBATIONS["noise"].apply(mesh, severity, np.random.default_rng(0))
        points = noisy.original_positions[find_points(noisy.mesh, method, COUNT)]
        again.append(repeatability(before, points, TOLERANCE * mesh.diagonal))
    plt.plot(100 * np.array(SEVERITIES), again, marker="o", label=method)

plt.xlabel("noise, % of the diagonal")
plt.ylabel(f"share of {COUNT} points found again")
plt.ylim(0, 1)
plt.legend()
plt.show()
