"""
Touch until sure
================

Four shapes are known by touch. One of them is touched in the dark, place by place, until the belief in one of them is
95 %. The belief is calibrated on touches that were held out.
"""

import matplotlib.pyplot as plt
import numpy as np
import trimesh

from haptic_glance import Mesh, normalise, press_many
from haptic_glance.know import Trial, explore, features, split_touches, stop

TOUCHES, CONFIDENCE = 60, 0.95
shapes = {
    "ball": trimesh.creation.icosphere(4),
    "egg": trimesh.creation.icosphere(4).apply_scale([1, 1, 1.5]),
    "box": trimesh.creation.box().subdivide_to_size(0.1),
    "ring": trimesh.creation.torus(1, 0.4),
}

rng = np.random.default_rng(0)
meshes = [normalise(Mesh(shape.vertices, shape.faces)) for shape in shapes.values()]
touched = [rng.choice(len(mesh.vertices), TOUCHES, replace=False) for mesh in meshes]
imprints = np.concatenate([press_many(mesh, ids) for mesh, ids in zip(meshes, touched, strict=True)])
places = np.concatenate([mesh.vertices[ids] for mesh, ids in zip(meshes, touched, strict=True)])
truth = np.repeat(np.arange(4), TOUCHES)

samples = features(imprints)
samples = (samples - samples.mean(axis=0)) / (samples.std(axis=0) + 1e-9)
samples = (samples @ np.linalg.svd(samples, full_matrices=False)[2][:12].T) / np.sqrt(12)
train, test = split_touches(truth, places, "random", 0.16, rng)
trial = Trial(samples, places, truth, train, test, "imprint", "random", 0.16, rng)
beliefs = explore("gain", trial.observed, trial.predicted, trial.probabilities, trial.calibration, 10, rng)
touches, _, correct = stop(beliefs, trial.truth, CONFIDENCE)

fig, axes = plt.subplots(1, 4, figsize=(10, 2.8), sharey=True, layout="constrained")
for k, (axis, name) in enumerate(zip(axes, shapes, strict=True)):
    axis.plot(range(1, 11), np.exp(beliefs[k]), label=list(shapes))
    axis.axvline(touches[k], color="0.7", ls=":")
    axis.set_title(f"{name}: {'right' if correct[k] else 'wrong'} after {touches[k]}", fontsize=10)
    axis.set_xlabel("touches")
axes[0].set_ylabel("belief")
axes[-1].legend(fontsize=8)
plt.show()
