"""Rows by which the thesis explains the weights of an object: the gain of each channel, and the shape (T3.2.3)."""

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.look.weights.convexity import convexity
from haptic_glance.look.weights.svm import balanced_rows, information_gains
from haptic_glance.mesh.mesh import Mesh
from stages.engine.run import Rows

GAIN = "information_gain"
AREAS = {"image": "image_", "object": ""}  # area that the pixels were drawn from -> prefix of their arrays


def gain_rows(name: str, record: dict[str, np.ndarray], seed: int) -> Rows:
    """The information gain in bits of each channel about the pixels of an object, classes balanced (T3.2.3)."""
    rows = []
    for area, prefix in AREAS.items():
        pixels, labels = record[f"{prefix}pixels"], record[f"{prefix}labels"]
        if not 0 < labels.sum() < len(labels):
            continue
        drawn = balanced_rows(labels, rng(seed, "svm"), len(labels))
        gains = dict(zip(record["channels"], information_gains(pixels[drawn], labels[drawn]), strict=True))
        shared = {"item": name, "method": "svm", "area": area, "training": "one_per_object", "metric": GAIN}
        rows += [shared | {"channel": str(channel), "value": gain} for channel, gain in gains.items()]
    return rows


ROUNDING = 1e-9  # of the diagonal


def shape_rows(name: str, mesh: Mesh) -> Rows:
    """Measures of shape by which the thesis explains the gains of channels: convexity and the extremes (T3.2.3).

    `extremes` is the distance of the farthest vertex from the centre of mass of the surface over the mean distance,
    `distances_deviation` the deviation of the distances over their mean. Both distances are those of the middles of
    faces. A mesh with one face has neither of the two, since its one middle is the centre.
    """
    areas, middles = mesh.face_areas, mesh.vertices[mesh.faces].mean(axis=1)
    centre = np.average(middles, axis=0, weights=areas)
    distances = np.linalg.norm(middles - centre, axis=1)
    mean = np.average(distances, weights=areas)
    corners = mesh.vertices[np.unique(mesh.faces[areas > 0])]
    values = {"convexity": convexity(mesh)}
    if mean > ROUNDING * mesh.diagonal:
        values["extremes"] = np.linalg.norm(corners - centre, axis=1).max() / mean
        values["distances_deviation"] = np.sqrt(np.average((distances - mean) ** 2, weights=areas)) / mean
    return [{"item": name, "metric": metric, "value": float(value)} for metric, value in values.items()]
