"""
Several methods side by side
============================

All methods share one signature: a name of ``haptic_glance.METHODS``. Each has its own idea of what stands out.
"""

import textwrap

import matplotlib.pyplot as plt

from haptic_glance import METHODS, load, saliency, simplify
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.mesh_pictures import look

SHOWN = {
    "glance": "glance: learned from gaze",
    "itti": "itti: intensity, orientation, colour",
    "thesis_ssim": "thesis_ssim: nine weighted channels",
    "mesh_saliency": "mesh_saliency: Lee 2005",
    "heat_kernel": "heat_kernel: Sun 2009",
    "height": "height: what is up",
}

mesh = simplify(load(sample()), 4000)  # two of these methods take long on large meshes
print(f"{len(METHODS)} methods:\n" + textwrap.fill(", ".join(METHODS), 90))

fig, axes = plt.subplots(2, 3, figsize=(9, 5.6), layout="constrained")
for axis, (method, title) in zip(axes.flat, SHOWN.items(), strict=True):
    axis.imshow(look(mesh, saliency(mesh, method), [])[90:530, 60:560])
    axis.set_title(title, fontsize=10)
    axis.axis("off")
plt.show()
