"""Depths as bytes that compress well, and back."""

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)


@kernel
def fold_depth(depth: np.ndarray, inside: np.ndarray, behind: float, step: float) -> np.ndarray:
    """(4, h * w) u1: the mixed second differences of a depth map in steps, near zero on a smooth surface.

    depth (h, w) f4; inside (h, w) boolean: the pixels that count; behind: the depth that the others get. The sign of a
    difference is in the lowest bit. Low bytes come first, so that high bytes are mostly zero.
    """
    height, width = depth.shape
    planes = np.empty((4, height * width), dtype=np.uint8)
    above = np.zeros(width + 1, dtype=np.int64)
    row = np.zeros(width + 1, dtype=np.int64)
    for i in range(height):
        for j in range(width):
            row[j + 1] = int(np.rint((depth[i, j] - behind) / step)) if inside[i, j] else 0
            bend = row[j + 1] - row[j] - above[j + 1] + above[j]
            folded = 2 * bend if bend >= 0 else -2 * bend - 1
            for byte in range(4):
                planes[byte, i * width + j] = folded >> (8 * byte) & 255
        above, row = row, above
    return planes


@kernel
def unfold_depth(planes: np.ndarray, inside: np.ndarray, behind: float, step: float, depth: np.ndarray) -> None:
    """Writes the depths that fold_depth folded to the pixels inside of depth (h, w) f4."""
    height, width = depth.shape
    above = np.zeros(width, dtype=np.int64)
    for i in range(height):
        risen = 0
        for j in range(width):
            folded = 0
            for byte in range(4):
                folded |= int(planes[byte, i * width + j]) << (8 * byte)
            risen += -(folded >> 1) - 1 if folded & 1 else folded >> 1
            above[j] += risen
            if inside[i, j]:
                depth[i, j] = behind + above[j] * step
