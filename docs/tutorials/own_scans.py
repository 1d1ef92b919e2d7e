"""
Your own scans, from look to touch
==================================

A scan is rarely clean: it has noise, it lies in any place and scale, and its file does not say which axis points up.
This tutorial makes such a scan of the sample mesh, so that it runs everywhere. Put the path of your own file in its
place.

Needs ``pip install 'haptic-glance[pictures]'``; runs without a network.
"""

import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from haptic_glance import (
    Layer,
    detect,
    load,
    metro,
    normalise,
    press_forces,
    press_many,
    saliency,
    sensor_axes,
    sensor_normals,
    simplify,
    write_any,
)
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.mesh_pictures import look

folder = Path(tempfile.mkdtemp())
clean = load(sample())
noise = 0.0005 * clean.diagonal * np.random.default_rng(0).standard_normal((len(clean.vertices), 1))
scanned = replace(clean, vertices=clean.vertices + noise * clean.vertex_normals)
write_any(folder / "scan.stl", scanned)

# %%
# Read and look
# -------------
#
# ``load`` reads STL, OBJ, PLY, OFF, GLB, glTF and point clouds. An STL repeats each vertex at every face; equal ones
# are merged. Where a file does not say which axis points up, the shape decides and ``load`` warns; here ``up`` sets the
# axis. A look takes about a second.

mesh = load(folder / "scan.stl", up="y")
detection = detect(mesh, count=10)
print(mesh)
first = detection.points[:3].tolist()
print(f"{detection.strong} places pass the method's own threshold; the first three are vertices {first}")

plt.figure(figsize=(4.6, 4.4), layout="constrained")
plt.imshow(look(normalise(mesh), detection.saliency, detection.points)[90:530, 60:560])
plt.axis("off")
plt.show()

# %%
# Fewer faces, finer where people look
# ------------------------------------
#
# The mean error is a share of the diagonal of the bounding box. With weights it falls where the saliency is high and
# rises elsewhere.

weights = saliency(mesh)
for faces in (4000, 2000, 1000):
    small = simplify(mesh, faces, weights=weights)
    print(f"{len(small.faces):5,} faces, mean error {100 * metro(mesh, small)['mean']:.3f} % of the diagonal")

# %%
# Touch the salient places
# ------------------------
#
# An array of 16 x 16 cells is pressed at each. Lengths are shares of the object's diameter: a pitch of 0.01
# is a hundredth of the object.

unit = normalise(mesh)
images = press_many(unit, detection.points[:8], cells=(16, 16), pitch=0.01)

fig, axes = plt.subplots(2, 4, figsize=(8, 4.2), layout="constrained")
for rank, (axis, image) in enumerate(zip(axes.flat, images, strict=True), start=1):
    axis.imshow(image, cmap="gray", vmin=0, vmax=1)
    axis.set_title(f"touch {rank}", fontsize=10)
    axis.set_xticks([])
    axis.set_yticks([])
plt.show()

# %%
# Touch in newtons
# ----------------
#
# Forces need real lengths. Say this animal is a toy of 20 cm: one unit is 0.2 m. A layer of foam lies over the array,
# and the array is pressed 1 mm deep.

METRES = 0.2
places = detection.points[:8]
axes_of_array = sensor_axes(sensor_normals(unit, places))
layer = Layer(thickness=0.004, modulus=1e5)
felt = press_forces(
    unit, unit.vertices[places], axes_of_array, layer, (16, 16), 0.002 / METRES, depth=0.001, unit=METRES
)
print("load at a depth of 1 mm, newtons:", felt.sum(axis=(1, 2)).round(2))

# %%
# On the command line
# -------------------
#
# The same without Python, for one file or a whole folder:
#
# .. code-block:: sh
#
#    haptic-glance saliency scan.stl --up y --out look.ply --points points.csv --picture look.png
#    haptic-glance simplify scan.stl --up y --levels 50%,25%,10% --out levels
#    haptic-glance touch scan.stl --up y --cells 16 16 --out imprints
#    haptic-glance gallery scans --up y
