"""
The nine channels of a view
===========================

The thesis looks at pictures of an object. Each of nine channels measures how much each pixel of a picture stands out.
The weighted average of the channels is the saliency map of the picture (T eq. 3.9).
"""

import matplotlib.pyplot as plt

from haptic_glance import Viewpoint, conspicuity, load, normalise, render
from haptic_glance.gallery.demo import sample
from haptic_glance.mesh import rotate_to_z_up

mesh = normalise(rotate_to_z_up(load(sample())))
view = render(mesh, Viewpoint(azimuth=305, elevation=22), renderer="raster")
maps = conspicuity(mesh, view)

fig, axes = plt.subplots(2, 5, figsize=(10, 3.6), layout="constrained")
for axis, (name, image) in zip(axes.flat, {"the view": view.rgb, **maps}.items(), strict=True):
    height, width = image.shape[:2]
    axis.imshow(image[:, width // 6 : -width // 6])
    axis.set_title(name, fontsize=10)
    axis.axis("off")
plt.show()
