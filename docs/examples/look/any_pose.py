"""
A look in any pose
==================

The default method must know which axis points up. For objects in any pose, use ``glance_any_pose``: its result hardly
changes when the mesh is turned. On upright objects it predicts gaze worse than the default.
"""

import matplotlib.pyplot as plt
import numpy as np
from trimesh.transformations import rotation_matrix

from haptic_glance import Mesh, load, normalise, saliency
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.mesh_pictures import look
from haptic_glance.mesh import rotate_to_z_up

upright = normalise(rotate_to_z_up(load(sample())))
turn = rotation_matrix(np.radians(70), [1, 0.3, 0])[:3, :3]
tilted = Mesh(upright.vertices @ turn.T, upright.faces)

fig, axes = plt.subplots(2, 2, figsize=(7, 6.2), layout="constrained")
for row, method in zip(axes, ["glance", "glance_any_pose"], strict=True):
    standing, lying = saliency(upright, method), saliency(tilted, method)
    same = np.corrcoef(standing, lying)[0, 1]
    for axis, mesh, values, word in zip(row, [upright, tilted], [standing, lying], ["upright", "tilted"], strict=True):
        axis.imshow(look(mesh, values, [])[90:530, 60:560])
        axis.set_title(f"{method}, {word}", fontsize=10)
        axis.axis("off")
    print(f"{method:16} correlation of both maps: {same:.2f}")
plt.show()
