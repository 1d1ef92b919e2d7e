"""Values at places, distributed over a grid."""

import numpy as np

from stages.kit.jit import kernel_of

kernel = kernel_of(__file__)


@kernel
def splat(places: np.ndarray, values: np.ndarray, shape: tuple[int, int, int]) -> np.ndarray:
    """(d, a, b, c) f8 sums of values (s, d) over the eight grid points nearest to each of places (s, 3), by nearness.

    places are in steps of the grid; all of these grid points must lie in its shape (a, b, c).
    """
    field = np.zeros((values.shape[1], *shape))
    for i in range(len(places)):
        x, y, z = np.floor(places[i]).astype(np.int64)
        for a in range(2):
            for b in range(2):
                for c in range(2):
                    near = abs(1 - a - (places[i, 0] - x))
                    near *= abs(1 - b - (places[i, 1] - y))
                    near *= abs(1 - c - (places[i, 2] - z))
                    for column in range(values.shape[1]):
                        field[column, x + a, y + b, z + c] += near * values[i, column]
    return field
