"""
Taxels anywhere
===============

An array need not be a grid. A ``Layout`` places taxels with positions, normals and areas: a honeycomb, a fingertip, or
the taxels of a CSV file (:func:`haptic_glance.read_layout`).
"""

import matplotlib.pyplot as plt
import numpy as np
import trimesh

from haptic_glance import Layer, Mesh, layout_forces, sensor_axes
from haptic_glance.touch import Layout

PITCH = 0.002  # metres between neighbours
rows, columns = np.mgrid[-6:7, -6:7]
places = np.stack([columns + rows % 2 / 2, rows * np.sqrt(3) / 2], axis=-1).reshape(-1, 2) * PITCH
places = places[np.hypot(*places.T) < 0.011]
count = len(places)
honeycomb = Layout(
    positions=np.column_stack([places, np.zeros(count)]),
    normals=np.tile([0, 0, -1], (count, 1)),  # towards the object
    areas=np.full(count, np.sqrt(3) / 2 * PITCH**2),
)

ring = trimesh.creation.torus(0.009, 0.002)  # metres
mesh = Mesh(ring.vertices, ring.faces)
felt = layout_forces(mesh, [[0, 0, 0.002]], sensor_axes([[0, 0, 1.0]]), Layer(), honeycomb, load=2.0)[0]

plt.figure(figsize=(5, 4.2), layout="constrained")
plt.scatter(*(1000 * places.T), c=1000 * felt, s=260, marker="h", cmap="magma")
plt.colorbar(label="mN per taxel")
plt.title(f"a ring under {count} taxels, {felt.sum():.2f} N", fontsize=10)
plt.xlabel("mm")
plt.gca().set_aspect("equal")
plt.show()
