"""
A point cloud
=============

A scanner gives points, not faces. :func:`haptic_glance.surface_of` makes a surface of them. Narrow gaps are closed, as
at the cut legs here; wide gaps stay open. ``load`` does the same with PLY, XYZ, PTS, PCD and LAS files, and with
``.depth`` files, which name a depth image.

Needs ``pip install 'haptic-glance[pipeline]'``.
"""

import matplotlib.pyplot as plt
import numpy as np

from haptic_glance import Cloud, detect, load, normalise, surface_of
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.mesh_pictures import look
from haptic_glance.mesh import rotate_to_z_up

whole = normalise(rotate_to_z_up(load(sample())))
rng = np.random.default_rng(0)
faces = rng.choice(len(whole.faces), 12_000, p=whole.face_areas / whole.face_areas.sum())
corners = rng.dirichlet([1, 1, 1], len(faces))
points = np.einsum("kc,kcd->kd", corners, whole.vertices[whole.faces[faces]])
points = points[points[:, 2] > -0.3]  # the feet were out of sight

mesh = surface_of(Cloud(points))
detection = detect(mesh, count=8)
print(f"{len(points):,} points became {mesh}")

fig = plt.figure(figsize=(8, 4), layout="constrained")
left = fig.add_subplot(1, 2, 1, projection="3d")
left.scatter(*points[::4].T, s=1, c=points[::4, 2])
left.view_init(22, 305 - 360)
left.set_aspect("equal")
left.axis("off")
right = fig.add_subplot(1, 2, 2)
right.imshow(look(mesh, detection.saliency, detection.points)[90:530, 60:560])
right.axis("off")
plt.show()
