"""From how many directions each point is seen, and how much it faces them; compiled by numba."""

import math

import numpy as np

from stages.kit.jit import kernel_of

from .samples import Samples

kernel = kernel_of(__file__)
HEIGHTS, AROUND = 7, 16  # rings of directions, and directions in a ring
SIDE = 0.5  # |z| of a direction from the side: 30 degrees above or below the horizon
PIXEL = 1.4  # side of a pixel in units of the spacing, so that the points leave no holes
NEAR, FAR = 1.8, 2.6  # of the spacing, more on slopes: what is less far behind is the same surface, else it is hidden
STEEP = 0.05  # cosine at which a slope counts as no steeper


def visibility(samples: Samples) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(share of directions that see a point, how much it faces those from the side, from above, from below), each (s,).

    A depth picture of the points is drawn from each direction, without a mesh. The directions belong to the object's
    own axes and lie alike on both sides of its upright planes.
    """
    eyes = _directions()
    right = np.cross(eyes, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    pictures = np.stack([right, np.cross(eyes, right), eyes], axis=1) @ samples.axes
    group = np.digitize(eyes[:, 2], [-SIDE, SIDE])
    places = (samples.points - samples.middle) / samples.spacing
    found = _seen(places, samples.normals, pictures, group)
    found[:3] /= np.bincount(group)[:, None]
    below, side, above, seen = found
    return seen / len(eyes), side, above, below


def _directions():
    """(HEIGHTS * AROUND, 3) unit vectors: rings with equal shares of the sphere, every other one turned half a step."""
    height, k = np.meshgrid(1 - (2 * np.arange(HEIGHTS) + 1) / HEIGHTS, np.arange(AROUND), indexing="ij")
    turn = 2 * np.pi / AROUND * (k + np.arange(HEIGHTS)[:, None] % 2 / 2)
    across = np.sqrt(1 - height**2)
    return np.stack([np.cos(turn) * across, np.sin(turn) * across, height], axis=2).reshape(-1, 3)


@kernel
def _seen(places, normals, pictures, group):
    """(4, s) sums of the cosine between normal and direction where it sees the point, and the number that see it.

    The sums are over the directions of each of three groups; pictures (d, 3, 3) look along their third row.
    """
    count, farthest = len(places), 0.0
    for i in range(count):
        farthest = max(farthest, places[i, 0] ** 2 + places[i, 1] ** 2 + places[i, 2] ** 2)
    half = int(math.sqrt(farthest) / PIXEL) + 2
    depth = np.empty((2 * half + 1, 2 * half + 1))
    pixels, near, found = np.empty((count, 2), dtype=np.int64), np.empty(count), np.zeros((4, count))
    for d in range(len(pictures)):
        p = pictures[d]
        depth[:] = -np.inf
        for i in range(count):
            x, y, z = places[i, 0], places[i, 1], places[i, 2]
            for k in range(2):
                pixels[i, k] = half + math.floor((p[k, 0] * x + p[k, 1] * y + p[k, 2] * z) / PIXEL + 0.5)
            near[i] = p[2, 0] * x + p[2, 1] * y + p[2, 2] * z
            row, column = pixels[i, 0], pixels[i, 1]
            depth[row, column] = max(depth[row, column], near[i])
        for i in range(count):
            cosine = p[2, 0] * normals[i, 0] + p[2, 1] * normals[i, 1] + p[2, 2] * normals[i, 2]
            if cosine > 0:
                front = near[i]
                for row in range(pixels[i, 0] - 1, pixels[i, 0] + 2):
                    for column in range(pixels[i, 1] - 1, pixels[i, 1] + 2):
                        front = max(front, depth[row, column])
                shown = (FAR - (front - near[i]) * max(cosine, STEEP)) / (FAR - NEAR)
                shown = min(max(shown, 0.0), 1.0)
                found[group[d], i] += shown * cosine
                found[3, i] += shown
    return found
