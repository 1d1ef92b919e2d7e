"""
Add a saliency method and see it judged
=======================================

A method needs one function: from a mesh to a value at each vertex. This tutorial writes one, gives it a name, and
judges it in two ways: by marks on one mesh, and by how well its points come back under noise. The verdict that counts
is human gaze on many meshes; the last section says how to get it.

Needs a clone and ``pip install '.[pipeline]'``; runs without a network. For the commands of the last section, get the
gaze data beforehand: ``conf/data/gaze.yaml`` says where.
"""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from scipy.spatial import KDTree

from haptic_glance import METHODS, find_points, load, normalise, saliency, simplify
from haptic_glance.disturb.objects import PERTURBATIONS
from haptic_glance.gallery.demo import sample
from haptic_glance.lod.mesh_pictures import look
from haptic_glance.look.agreement import GroundTruth, agreement
from haptic_glance.look.points.detectors import SurfaceDetector
from haptic_glance.mesh import rotate_to_z_up
from haptic_glance.mesh.mesh import Mesh
from stages.stability.repeatability import TOLERANCE, repeatability


def thin_parts(mesh: Mesh) -> np.ndarray:
    """(n,) f8, at least 0: how little surface lies within a tenth of the diameter."""
    tree = KDTree(mesh.vertices)
    near = tree.query_ball_point(mesh.vertices, 0.1)
    return np.array([1 / mesh.vertex_areas[ids].sum() for ids in near])


# %%
# Give it a name
# --------------
#
# In a clone, the function and its name stand in ``haptic_glance/look/points/detectors.py``; CONTRIBUTING.md has the
# recipe. Here we add it to the registry of this process. Every function that takes a method knows it from now on.

METHODS["thin_parts"] = SurfaceDetector(thin_parts)
mesh = normalise(rotate_to_z_up(simplify(load(sample()), 4000)))

fig, axes = plt.subplots(1, 2, figsize=(7, 3.4), layout="constrained")
for axis, method in zip(axes, ["thin_parts", "glance"], strict=True):
    axis.imshow(look(mesh, saliency(mesh, method), find_points(mesh, method, 6))[90:530, 60:560])
    axis.set_title(method, fontsize=10)
    axis.axis("off")
plt.show()

# %%
# Judge it by marks
# -----------------
#
# ``haptic-glance studio vase.stl --mark FOLDER`` lets you mark what matters on a mesh of yours. Here three places are
# marked by their coordinates: the muzzle, an ear, and the tip of the tail. NSS is the mean of the standardised
# saliency at the marks (0 is chance); AUC is how often a mark beats a random place (0.5 is chance).

marked = [mesh.vertices[:, 0].argmax(), mesh.vertices[:, 2].argmax(), mesh.vertices[:, 0].argmin()]
amounts = np.bincount(marked, minlength=len(mesh.vertices)).astype(float)
away = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices[None, marked], axis=2)
truth = GroundTruth(amounts, np.exp(-((away / 0.05) ** 2) / 2).sum(axis=1), mesh.vertex_areas)

for method in ["thin_parts", "glance", "itti", "mesh_saliency"]:
    scores = agreement(saliency(mesh, method), truth)
    print(f"{method:14} NSS {scores['nss']:5.2f}   AUC {scores['auc']:.2f}")

# %%
# Three chosen marks on one mesh prove nothing, but show the way of judging.
#
# Judge it by what survives
# -------------------------

for method in ["thin_parts", "glance"]:
    before = mesh.vertices[find_points(mesh, method, 20)]
    noisy = PERTURBATIONS["noise"].apply(mesh, 0.0025, np.random.default_rng(0))
    after = noisy.original_positions[find_points(noisy.mesh, method, 20)]
    print(f"{method:14} finds {repeatability(before, after, TOLERANCE * mesh.diagonal):.0%} of its points again")

# %%
# Judge it by people
# ------------------
#
# The gaze of 32 people on 19 meshes decides. One command evaluates the function in your file on these meshes, and lists
# it beside all other methods, with five metrics, their intervals and the interval of its lead. :doc:`/judging` has the
# splits, and the way to judge a method that learns:
#
# .. code-block:: sh
#
#    python -m stages.bench my_method.py:thin_parts --gaze gaze.zip
#
# With the name in the registry, and in ``salient_points.methods`` of the settings, the experiment ``attention``
# measures it in the pipeline, and the gate and the report take it up:
#
# .. code-block:: sh
#
#    python -m stages.compose experiment=attention 'salient_points.methods=[glance,itti,thin_parts]' && dvc repro
#
# The chart shows the rows of the other methods; ``human`` is the truth itself. A bar is a 95 % interval over
# the meshes.

rows = pd.read_csv(sample().parents[1] / "reports/tables/attention_gaze.csv")
rows = rows[(rows["metric"] == "nss") & ~rows["has_seen"].astype(bool)].sort_values("mean").tail(14)
plt.figure(figsize=(7, 4.2), layout="constrained")
plt.errorbar(rows["mean"], rows["method"], xerr=[rows["mean"] - rows["low"], rows["high"] - rows["mean"]], fmt="o")
plt.axvline(0, color="0.7")
plt.xlabel("NSS on meshes that the method has not seen")
plt.show()

del METHODS["thin_parts"]  # all pages are built in one process
