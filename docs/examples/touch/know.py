"""
Known by touch alone
====================

A folder of objects is learned by touch, beside six basic shapes. One of them is then touched in the dark where the
belief gains most, until it is known.
"""

import matplotlib.pyplot as plt
import numpy as np

from haptic_glance import Surface
from haptic_glance.gallery.demo import sample
from haptic_glance.know import Exploration, known_objects, learn, primitives

meshes, left_out = known_objects(sample().parent)  # or a folder of yours: Path("scans")
meshes |= primitives()
library = learn(meshes, placed=False, turned=True)  # nothing is known of the pose
exploration = Exploration(library, Surface(meshes["dromedary"]), np.random.default_rng(0))
print(f"known as {exploration.finish()!r} after {len(exploration.images)} touches")

plt.plot([[belief.probabilities[name] for name in library.names] for belief in exploration.beliefs])
plt.legend(library.names)
plt.xlabel("touches")
plt.ylabel("belief")
plt.show()
