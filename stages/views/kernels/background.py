"""The colour around the object."""

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)


@kernel
def background_colour(rgb: np.ndarray, mask: np.ndarray) -> tuple[np.ndarray, bool]:
    """((3,) u1 the first colour of rgb (h, w, 3) u1 off the mask (h, w), whether all pixels there have it).

    Black when the mask covers the image.
    """
    colour, found = np.zeros(3, dtype=np.uint8), False
    for i in range(mask.shape[0]):
        for j in range(mask.shape[1]):
            if mask[i, j]:
                continue
            for k in range(3):
                if not found:
                    colour[k] = rgb[i, j, k]
                elif rgb[i, j, k] != colour[k]:
                    return colour, False
            found = True
    return colour, True
