"""The upright plane in which a surface is most symmetric: people look along it."""

import numpy as np

from .samples import Samples

STEP = 7.5  # degrees between two planes that are tried
MIRRORED = 500  # about as many of the points are mirrored
TOLERANCE = 0.02  # mean distance of the mirrored points from the surface at which a plane fits 1 / e
NARROW = 0.05  # distance from the plane at which its effect has fallen to 1 / e


def symmetry(samples: Samples) -> tuple[np.ndarray, np.ndarray]:
    """(distance from the mirror plane, nearness to it) of each point, each (s,), both 0 without a symmetry.

    The planes go through the z axis of the points' mean. Both are multiplied by how much better the best one fits than
    the median, so that a body of revolution, which has no plane of its own, has 0.
    """
    angles = np.radians(np.arange(0, 180, STEP))
    normals = np.stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))], axis=1)
    few, centre = samples.points[:: max(len(samples.points) // MIRRORED, 1)], samples.points.mean(axis=0)
    heights = (few - centre) @ normals.T  # (few, planes)
    mirrored = few[None] - 2 * heights.T[:, :, None] * normals[:, None]
    errors = samples.tree.query(mirrored)[0].mean(axis=1)
    best = int(errors.argmin())
    fits = np.exp(-((errors / TOLERANCE) ** 2))
    score = fits[best] - np.median(fits)
    away = np.abs((samples.points - centre) @ normals[best])
    return score * away, score * np.exp(-((away / NARROW) ** 2))
