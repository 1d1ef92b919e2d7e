"""The planes of the sections: pairs of points, drawn without replacement (T4.4.6)."""

import numpy as np


def draw_pairs(points: np.ndarray, count: int, generator: np.random.Generator) -> np.ndarray:
    """(k, 2) up to `count` distinct pairs of distinct vertex ids, in random order, or all pairs if there are fewer.

    No pair occurs twice. The order within a pair is random too, since a contour begins at the first. points (n,):
    vertex ids; repeated ones count as one.
    """
    points = np.unique(points)
    total = len(points) * (len(points) - 1) // 2
    chosen = generator.choice(total, size=min(count, total), replace=False) if total else np.zeros(0, dtype=np.int64)
    # Pair number i is (low, high), low < high: the pairs of `high` begin at high (high - 1) / 2.
    high = ((1 + np.sqrt(8.0 * chosen + 1)) / 2).astype(np.int64)
    high -= high * (high - 1) // 2 > chosen  # the root of a large number may be rounded up
    high += high * (high + 1) // 2 <= chosen  # or down
    pairs = np.stack([chosen - high * (high - 1) // 2, high], axis=1)
    turned = generator.random(len(pairs)) < 0.5
    pairs[turned] = pairs[turned, ::-1]
    return points[pairs]
