"""Makes dromedary.glb, the mesh that `haptic-glance demo` looks at: `python samples/make.py` (needs [pipeline]).

A dromedary, since the thesis touches one: parts of a signed distance field, blended, polygonised and simplified. In
metres, with y up, and looking along z, as glTF has it.
"""

from pathlib import Path

import numpy as np
from skimage.measure import marching_cubes

from haptic_glance import simplify
from haptic_glance.lod import write_any
from haptic_glance.mesh import Mesh

OUT = Path(__file__).with_name("dromedary.glb")
CELL = 0.011  # metres between two samples of the field
FACES = 9000
COAT, DARK = (196, 160, 112), (58, 42, 34)
# Parts: (blend, [x, y, z, radius] of each joint), in metres; the blend rounds where a part joins those before it.
BODY = [
    (0.0, [[0, 1.16, -0.42, 0.27], [0, 1.14, 0.30, 0.28]]),  # trunk
    (0.20, [[0, 1.36, -0.12, 0.22], [0, 1.54, -0.13, 0.14]]),  # hump
    (0.16, [[0, 1.10, 0.42, 0.20], [0, 1.00, 0.78, 0.125], [0, 1.30, 1.02, 0.10], [0, 1.74, 1.10, 0.085]]),  # neck
    (0.06, [[0, 1.80, 1.12, 0.115], [0, 1.76, 1.36, 0.075], [0, 1.72, 1.46, 0.068]]),  # head, muzzle
    (0.02, [[0, 1.695, 1.44, 0.05], [0, 1.665, 1.49, 0.042]]),  # lower lip
    (0.05, [[0, 1.22, -0.68, 0.05], [0, 0.98, -0.79, 0.026], [0, 0.76, -0.80, 0.022], [0, 0.68, -0.80, 0.036]]),  # tail
]  # fmt: skip
LEFT = [  # mirrored for the right side
    (0.1, [[0.15, 1.02, 0.36, 0.125], [0.16, 0.62, 0.37, 0.062], [0.16, 0.3, 0.36, 0.045], [0.16, 0.09, 0.37, 0.047]]),
    (0.1, [[0.15, 1.06, -0.48, 0.17], [0.17, 0.66, -0.42, 0.08], [0.17, 0.36, -0.58, 0.05], [0.17, 0.09, -0.55, 0.05]]),
    (0.03, [[0.16, 0.045, 0.40, 0.066], [0.16, 0.040, 0.46, 0.046]]),  # feet
    (0.03, [[0.17, 0.045, -0.52, 0.066], [0.17, 0.040, -0.46, 0.046]]),
    (0.02, [[0.075, 1.88, 1.07, 0.032], [0.135, 1.95, 1.04, 0.026], [0.15, 1.99, 1.045, 0.012]]),  # ear
    (0.015, [[0.088, 1.835, 1.20, 0.030], [0.09, 1.835, 1.205, 0.030]]),  # eye
]  # fmt: skip
NOSTRIL = [0.035, 1.745, 1.525, 0.018]
EYE = LEFT[-1][1][0]


def field(points: np.ndarray) -> np.ndarray:
    """(n,) signed distance of points (n, 3) to the animal, negative inside; exact outside the blends."""
    distances = np.full(len(points), np.inf)
    mirrored = np.column_stack([np.abs(points[:, 0]), points[:, 1:]])
    for parts, at in ((BODY, points), (LEFT, mirrored)):
        for blend, joints in parts:
            bones = zip(np.array(joints)[:-1], np.array(joints)[1:], strict=True)
            distances = blended(distances, np.min([cone(at, *ends) for ends in bones], axis=0), blend)
    ground = 0.012 - points[:, 1]  # flat soles
    nostril = NOSTRIL[3] - np.linalg.norm(mirrored - NOSTRIL[:3], axis=1)
    return np.maximum(np.maximum(distances, ground), nostril)


def cone(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """(n,) distance of points to a bone [x, y, z, radius], whose radius changes from start to end."""
    axis = end[:3] - start[:3]
    share = np.clip((points - start[:3]) @ axis / (axis @ axis), 0, 1)
    away = np.linalg.norm(points - start[:3] - share[:, None] * axis, axis=1)
    return away - (start[3] + share * (end[3] - start[3]))


def blended(first: np.ndarray, second: np.ndarray, width: float) -> np.ndarray:
    """The smaller of two distances, rounded where they differ by less than the width (Quilez, smooth minimum)."""
    if width == 0:
        return np.minimum(first, second)
    overlap = np.clip(1 - np.abs(first - second) / width, 0, None)
    return np.minimum(first, second) - overlap**2 * width / 4


def dromedary() -> Mesh:
    """The Mesh: closed, one piece, FACES faces, dark eyes and soles."""
    low, high = np.array([-0.5, -0.06, -0.95]), np.array([0.5, 2.12, 1.62])
    shape = np.ceil((high - low) / CELL).astype(int)
    grid = low + CELL * np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1)
    values = np.concatenate([field(slab.reshape(-1, 3)) for slab in grid]).reshape(shape)
    vertices, faces, _, _ = marching_cubes(values, 0.0, spacing=(CELL,) * 3)
    fine = Mesh(vertices + low, faces, up="y")
    small = simplify(fine, FACES)
    return Mesh(small.vertices, small.faces, colours(small.vertices), up="y")


def colours(vertices: np.ndarray) -> np.ndarray:
    """(n, 3) u1: the coat, darker at the eyes, the feet, and the end of the tail."""
    x, y, z = vertices.T
    eye = np.linalg.norm(np.stack([np.abs(x), y, z], axis=1) - EYE[:3], axis=1) < 1.35 * EYE[3]
    dark = eye | (y < 0.09) | ((z < -0.7) & (y < 0.78))
    return np.where(dark[:, None], DARK, COAT).astype(np.uint8)


if __name__ == "__main__":
    write_any(OUT, dromedary())
