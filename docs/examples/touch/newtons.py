"""
Forces in newtons
=================

With an elastic layer of known thickness and modulus over the array, a load in newtons gives a force on each cell. A
sphere on a thin layer is a case whose answer is known: the load grows with the square of the depth (Johnson 1985).
"""

import matplotlib.pyplot as plt
import numpy as np
import trimesh

from haptic_glance import Layer, Mesh, Surface, press_forces, sensor_axes

RADIUS, PITCH = 0.02, 0.001  # metres
ball = trimesh.creation.icosphere(5, radius=RADIUS)
surface = Surface(Mesh(ball.vertices, ball.faces))
layer = Layer(thickness=0.002, modulus=2e5)
top, axes = [[0, 0, RADIUS]], sensor_axes([[0, 0, 1.0]])

depths = np.linspace(0.0002, 0.0018, 9)
loads = [press_forces(surface, top, axes, layer, (32, 32), PITCH / 2, depth=depth).sum() for depth in depths]

fig, (left, right) = plt.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
felt = press_forces(surface, top, axes, layer, (16, 16), PITCH, load=5.0)[0]
shown = left.imshow(1000 * felt, cmap="magma")
left.set_title(f"{felt.sum():.2f} N on {int((felt > 0).sum())} cells of 1 mm", fontsize=10)
fig.colorbar(shown, ax=left, label="mN per cell")
right.plot(1000 * depths, np.pi * RADIUS * layer.stiffness * depths**2, label=r"$\pi R d^2 k$", color="0.6", lw=5)
right.plot(1000 * depths, loads, "o", label="array of 0.5 mm cells")
right.set_xlabel("depth, mm")
right.set_ylabel("load, N")
right.legend()
plt.show()
