"""
A worn sensor
=============

A real array has an elastic skin that blurs, noise, cells that saturate and cells that are dead. ``Skin`` adds these
faults to ideal imprints, one at a time or together.
"""

import matplotlib.pyplot as plt

from haptic_glance import find_points, load, normalise, press_many
from haptic_glance.gallery.demo import sample
from haptic_glance.mesh import rotate_to_z_up
from haptic_glance.touch import Skin

mesh = normalise(rotate_to_z_up(load(sample())))
images = press_many(mesh, find_points(mesh, count=1), cells=(32, 32), pitch=0.005)
skins = {
    "ideal": Skin(),
    "blur of 1.5 cells": Skin(blur=1.5),
    "noise of 5 %": Skin(noise=0.05),
    "saturates at 60 %": Skin(saturation=0.6),
    "5 % of the cells dead": Skin(dead=0.05),
    "all of these": Skin(blur=1.5, noise=0.05, saturation=0.6, dead=0.05),
}

fig, axes = plt.subplots(2, 3, figsize=(7.5, 5.4), layout="constrained")
for axis, (title, skin) in zip(axes.flat, skins.items(), strict=True):
    axis.imshow(skin(images)[0], cmap="gray", vmin=0, vmax=1)
    axis.set_title(title, fontsize=10)
    axis.set_xticks([])
    axis.set_yticks([])
plt.show()
