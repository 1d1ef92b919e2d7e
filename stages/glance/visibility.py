"""From how many directions each point is seen, and how much it faces them."""

import numpy as np

from stages.kit.directions import directions

from .samples import Samples

DIRECTIONS = 40
SIDE = 0.5  # |z| of a direction from the side: 30 degrees above or below the horizon
PIXEL = 1.6  # side of a pixel in units of the spacing, so that the points leave no holes
SLACK = 2.5  # of the spacing: what is nearer than this is the slope of the same surface, on slopes more


def visibility(samples: Samples) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(share of directions that see a point, how much it faces those from the side, from above, from below), each (s,).

    A depth picture of the points is drawn from each direction, without a mesh.
    """
    eyes = directions(DIRECTIONS)
    facing = np.stack([_facing(samples, eye) for eye in eyes])
    side, above, below = np.abs(eyes[:, 2]) < SIDE, eyes[:, 2] > SIDE, eyes[:, 2] < -SIDE
    return ((facing > 0).mean(axis=0), *(facing[part].mean(axis=0) for part in (side, above, below)))


def _facing(samples, eye):
    """(s,) the cosine between normal and direction where the point is seen, else 0."""
    aside = np.array([0.0, 0.0, 1.0]) if abs(eye[2]) < 0.99 else np.array([1.0, 0.0, 0.0])
    right = np.cross(eye, aside)
    right /= np.linalg.norm(right)
    x, y, near = (samples.points @ np.stack([right, np.cross(eye, right), eye], axis=1)).T
    width = max(int(1 / (PIXEL * samples.spacing)), 1)
    column, row = (((one + 0.5) * width).astype(np.int64).clip(0, width - 1) for one in (x, y))
    depth = np.full((width + 2, width + 2), -np.inf)
    np.maximum.at(depth, (row + 1, column + 1), near)
    around = np.max([depth[i : i + width, j : j + width] for i in range(3) for j in range(3)], axis=0)
    cosine = samples.normals @ eye
    slack = SLACK * samples.spacing / cosine.clip(0.05)
    return np.where((near > around[row, column] - slack) & (cosine > 0), cosine, 0.0)
