"""
A robot that looks and touches
==============================

A robot has a camera above a table and a pressure array on its hand. It knows a few objects by their meshes, and one of
them stands on the table. The robot looks once. It then touches where the candidates differ, until it is sure.

The class ``Robot`` below stands for your driver. Here it sees and touches a simulated mesh, so that the tutorial runs
everywhere. Put the calls of your own robot in the place of its two methods.

Needs ``pip install 'haptic-glance[pictures]'``; runs without a network.
"""

from dataclasses import replace

import matplotlib.pyplot as plt
import numpy as np

from haptic_glance import Mesh, Viewpoint, render
from haptic_glance.know import PressureArray, learn, primitives, stand, touch_until_known

# %%
# Units: the objects and the array
# --------------------------------
#
# Meshes and array share one unit, here metres. The objects keep their sizes, as those of a folder do with
# ``known_objects(folder, sized=True)``. Here basic shapes become toys of a known length.

METRES = {"ball": 0.07, "box": 0.16, "capsule": 0.15, "cone": 0.14, "cylinder": 0.12, "torus": 0.13}
meshes = {name: replace(mesh, vertices=mesh.vertices * METRES[name]) for name, mesh in primitives().items()}

# %%
# ``pitch`` is the distance between neighbouring cells. ``depth`` is how far below the first contact a cell still
# feels the surface. The two kinds of noise are standard deviations: measure them on your own array.

ARRAY = PressureArray((8, 8), pitch=0.004, depth=0.01, travel_noise=0.001, relief_noise=0.0005)
library = learn(meshes, pose="turned", sensor=ARRAY)
print(f"a picture spans {library.span:.3f} m from its top to its bottom")

# %%
# Frames
# ------
#
# The origin is the centre of the object's bounding box, and z points up. Give all positions relative to this point. An
# object that stands on the table has its origin at half of its height.
#
# ``Viewpoint`` says from where the camera looks at the origin. Its azimuth counts from the x axis towards the y axis,
# its elevation from the horizon, both in degrees. The rows of a picture span ``library.span``, so crop the picture of
# your camera to this. The background must be dark, and the camera far enough away that near parts look hardly larger.

CAMERA = Viewpoint(azimuth=-90, elevation=40)

# %%
# The driver
# ----------
#
# ``picture`` returns bytes. ``touch`` moves the array from an origin along a direction until it meets something. ``up``
# is what is upwards on the array, so that the imprint is not turned. ``touch`` returns how far the hand moved, and an
# imprint: how far the surface lies below each cell.


class Robot:
    """A camera and a hand; in this simulation they see and touch a mesh."""

    def __init__(self, there: Mesh, seed: int = 0) -> None:
        self.there, self.random = there, np.random.default_rng(seed)

    def picture(self) -> np.ndarray:
        """(h, w, 3) bytes: what the camera sees, of which a shelf hides the upper part."""
        scaled = replace(self.there, vertices=self.there.vertices / library.diameter)  # render draws diameters
        rgb = render(scaled, CAMERA, size=(240, 240)).rgb
        rgb[:150] = 128
        return rgb

    def touch(self, origin: np.ndarray, direction: np.ndarray, up: np.ndarray) -> tuple[float, np.ndarray]:
        """(travel, imprint (8, 8)) in metres; the travel is inf where the hand meets nothing."""
        return library.approach(origin, direction, up).feel(self.there, self.random)


def reachable(origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(k,) which lines the hand can follow: not from below, and not from behind the object."""
    return (directions[:, 2] <= 0) & (directions[:, 1] >= 0)


# %%
# Look, then touch until sure
# ---------------------------
#
# ``look`` returns the belief after the picture; with ``hidden=`` a mask tells it where the shelf is. ``next_touch``
# returns the reachable line after which the name is expected to be least uncertain. ``after`` takes what the hand
# measured. ``known`` is empty until a name has a probability of 95 %.

robot = Robot(stand(meshes["cylinder"], turn=25))
picture = robot.picture()
beliefs = [library.look(picture, CAMERA)]
while not beliefs[-1].known and len(beliefs) <= 10:
    line = beliefs[-1].next_touch(reachable)
    felt = robot.touch(line.origin, line.direction, line.axes[1])
    beliefs.append(beliefs[-1].after(line, *felt))
print(f"{beliefs[-1].known} after {len(beliefs) - 1} touches; probabilities after the look:")
print({name: round(value, 2) for name, value in beliefs[0].probabilities.items()})

left, right = plt.subplots(1, 2, figsize=(7, 3), layout="constrained")[1]
left.imshow(picture)
left.axis("off")
right.plot([[belief.probabilities[name] for name in library.names] for belief in beliefs], "o-")
right.legend(library.names, fontsize=8)
right.set(xlabel="touches", ylabel="belief", xticks=range(len(beliefs)))
plt.show()

# %%
# A line of the robot's own
# -------------------------
#
# Some hands can follow few lines only. ``approach`` makes a line of your own, here straight down onto the middle. The
# belief after it follows from the same two measurements.

belief = library.belief()
down = library.approach(origin=(0, 0, 0.15), direction=(0, 0, -1), up=(0, 1, 0))
belief = belief.after(down, *robot.touch(down.origin, down.direction, down.axes[1]))
print({name: round(value, 2) for name, value in belief.probabilities.items()})

# %%
# Place and size within tolerances
# --------------------------------
#
# A camera or a person places the origin only roughly. ``position`` is how far the centre may be off along each axis.
# ``size`` is the share by which the object may be larger or smaller than its mesh. The belief then also estimates
# both, which takes some more time.

roughly = learn({name: meshes[name] for name in ("ball", "cone", "cylinder")}, sensor=ARRAY, position=0.02, size=0.1)
there = stand(meshes["cone"], turn=60, shift=(0.015, -0.01, 0))
for step in touch_until_known(roughly.belief(), there, reachable=reachable):
    belief = step.belief
shift = (1000 * belief.pose.shift).round().astype(int).tolist()
print(f"{belief.known}, {shift} mm beside the origin, {100 * belief.pose.size:.0f} % of the mesh's size")

# %%
# None of these
# -------------
#
# ``unknown=True`` adds an answer of its own for objects that were never learned. It needs objects of known size at a
# known place.

library = learn({name: meshes[name] for name in meshes if name != "torus"}, sensor=ARRAY, unknown=True)
for step in touch_until_known(library.belief(), stand(meshes["torus"]), reachable=reachable):
    belief = step.belief
print({name: round(value, 2) for name, value in belief.probabilities.items()})
