"""Few views that see much: a branch and bound search, bounded by Lagrangian relaxation."""

import numpy as np

from haptic_glance.base.jit import kernel_of

kernel = kernel_of(__file__, fastmath=True)

STEPS = 25  # of the prices at a node, which start from its parent's
AIM = 0.01  # of the points: how far below the need a step of the prices aims; a longer step needs fewer nodes
MARGIN = 0.1  # points: the bound is worked out in single precision
NOTHING = np.zeros(0, dtype=np.int64)


@kernel
def find_cover(seen: np.ndarray, counts: np.ndarray, need: float, most: int, nodes: int) -> np.ndarray:
    """At most `most` views that see `need` points together, as rows of seen; none where no views do.

    seen (v, k) f4, 1 where view v sees the points of kind k, else 0; counts (k,) f4: the points of a kind. nodes: the
    search gives up after so many.

    Every point has a price of at most one, which each view that sees it earns. The r best-earning views, and what the
    prices of all points fall short of one, bound what any r views see. The bound falls when points that none of
    the best views sees become dearer and points that several see become cheaper (Fisher, The Lagrangian relaxation
    method for solving integer programming problems, Management Science 27(1), 1981).
    """
    views, total = len(seen), counts.sum()
    waiting = [(np.zeros(views, dtype=np.int8), counts.copy())]  # of each view: 1 taken, -1 left out; prices
    for _ in range(nodes):
        if not len(waiting):
            break
        state, prices = waiting.pop()
        taken, free = np.flatnonzero(state == 1), np.flatnonzero(state == 0)
        more = min(most - len(taken), len(free))
        unseen = counts * (1 - _times(seen, taken).clip(0, 1))
        best, bound = free[:0], 0.0
        for _ in range(STEPS):
            # For one view more, its gain is the bound.
            prices = np.minimum(prices, unseen) if more > 1 else unseen
            earned = np.array([_product(seen[v], prices) for v in free])
            order = np.argsort(-earned)[:more]
            best, bound = free[order], total - prices.sum() + earned[order].sum()
            surplus = _times(seen, best) - 1
            if total - _product(unseen, (surplus < 0).astype(np.float32)) >= need:
                return np.concatenate((taken, best))
            if bound < need - MARGIN or more < 2:
                break
            step = np.float32((bound - need + AIM * total) / max(_product(unseen, surplus * surplus), np.float32(1)))
            prices = np.maximum(prices - step * unseen * surplus, np.float32(0))
        if bound >= need - MARGIN and more > 1:
            for choice in (-1, 1):
                child = state.copy()
                child[best[0]] = choice
                waiting.append((child, prices))
    return NOTHING


@kernel
def _times(seen, views):
    """(k,) f4: how many of the views see each kind of points."""
    times = np.zeros(seen.shape[1], dtype=np.float32)
    for v in views:
        times += seen[v]
    return times


@kernel
def _product(a, b):
    total = np.float32(0)
    for k in range(len(a)):
        total += a[k] * b[k]
    return total
