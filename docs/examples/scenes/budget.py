"""
The faces that a scene needs
============================

A camera flies past three objects. :func:`haptic_glance.budget` finds, for each object in each frame, the level with the
fewest faces that keeps every rendered frame within a tolerance in pixels.
"""

import matplotlib.pyplot as plt

from haptic_glance import Placed, Scene, budget, fly, load, saliency, simplify
from haptic_glance.gallery.demo import sample
from haptic_glance.mesh import rotate_to_z_up

mesh = simplify(rotate_to_z_up(load(sample())), 3000)
scene = Scene(
    objects=tuple(Placed("dromedary", (x, y, 0.0), turn, 2.0) for x, y, turn in [(0, 0, 30), (3, 4, 200), (-4, 9, 90)]),
    cameras=tuple(fly([[-3, -8, 2], [2, -4, 1.6]], [[0, 3, 1], [0, 3, 1]], frames=6, angle=50, size=(240, 400))),
    tolerance=1.0,  # pixels
)
plan = budget({"dromedary": mesh}, scene, {"dromedary": {"weights": saliency(mesh)}})
print(f"{plan.faces.sum(axis=1).mean():.0f} faces per frame instead of {3 * len(mesh.faces):,}")
print(f"largest error of a frame: {plan.errors.max():.2f} pixels")

fig, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
left.stackplot(range(6), plan.faces.T, labels=["near", "behind", "far"])
left.set_xlabel("frame")
left.set_ylabel("faces")
left.legend(loc="upper left")
right.plot(plan.errors, marker="o")
right.axhline(scene.tolerance, color="0.6", ls="--", label="tolerance")
right.set_xlabel("frame")
right.set_ylabel("error, pixels")
right.set_ylim(0)
right.legend()
plt.show()
