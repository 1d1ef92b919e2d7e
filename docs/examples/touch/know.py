"""
Known by a look and touches
===========================

A folder of objects is learned, beside six basic shapes. One of them stands turned by an unknown angle, and a board
hides more than half of it. The look alone guesses wrong. The hand then touches where the candidates differ.
"""

import matplotlib.pyplot as plt

from haptic_glance import Viewpoint, render
from haptic_glance.gallery.demo import sample
from haptic_glance.know import known_objects, learn, primitives, stand, touch_until_known

meshes, left_out = known_objects(sample().parent)  # or a folder of yours: Path("scans")
library, camera = learn(meshes | primitives()), Viewpoint(azimuth=0, elevation=35)
there = stand(meshes["dromedary"], turn=120)
picture = render(there, camera).rgb
picture[:, picture.shape[1] * 2 // 5 :] = 128  # a board; hidden= would tell of it
beliefs = [library.look(picture, camera)]
beliefs += [step.belief for step in touch_until_known(beliefs[0], there)]
print(f"known as {beliefs[-1].known!r} after {len(beliefs) - 1} touches, turned by {beliefs[-1].pose.turn:.0f} degrees")

bars = plt.subplots(1, len(beliefs), figsize=(8, 2.6), sharey=True, layout="constrained", squeeze=False)[1][0]
for touches, (axis, belief) in enumerate(zip(bars, beliefs, strict=True)):
    axis.barh(library.names, [belief.probabilities[name] for name in library.names])
    axis.set(title=f"after {touches} touches" if touches else "after the look", xlabel="belief", xlim=(0, 1))
plt.show()
