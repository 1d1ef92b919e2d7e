"""The cheapest sequence of levels of one object over the frames: within the tolerance, without popping or flicker."""

from collections.abc import Sequence

import numpy as np

VIOLATION_COST = 1e9  # in faces, of an error of twice the tolerance: no saving is worth a visible error


def cheapest(faces: np.ndarray, errors: np.ndarray, jumps: np.ndarray, tolerance: float, hold: int = 1) -> np.ndarray:
    """(f,) the level to show in each frame, with the fewest faces in total.

    faces (f, l): cost of each level in each frame. errors (f, l): on the screen. jumps (f, l, l): how far the picture
    jumps in frame f from one level to another. hold: the least number of frames that a level stays, so that an object
    near a threshold does not flicker (hysteresis; the first and the last level may stay shorter). An error or a jump
    above the tolerance is accepted only where every other sequence has more of it; an infinite error never, if there is
    any other. Exact, by dynamic programming over (level, frames since the last switch).
    """
    frames, count = errors.shape
    cost = faces + _penalty(errors, tolerance)
    jump = _penalty(jumps, tolerance)
    same = np.arange(count)
    jump[:, same, same] = np.inf  # staying is not a switch
    best = np.full((hold, count), np.inf)
    best[-1] = cost[0]
    previous = np.zeros((frames, count), dtype=np.int64)  # the level before a switch
    aged = np.zeros((frames, count), dtype=bool)  # in the oldest state: it was that old before
    for frame in range(1, frames):
        switched = best[-1][:, None] + jump[frame]
        previous[frame] = switched.argmin(axis=0)
        new = np.empty_like(best)
        if hold == 1:
            aged[frame] = best[0] <= switched.min(axis=0)
            new[0] = np.minimum(best[0], switched.min(axis=0))
        else:
            new[0], new[1:] = switched.min(axis=0), best[:-1]
            aged[frame] = best[-1] <= new[-1]
            new[-1] = np.minimum(new[-1], best[-1])
        best = new + cost[frame]
    return _trace(best, previous, aged, hold)


def _penalty(values, tolerance):
    return VIOLATION_COST * np.maximum(values / tolerance - 1, 0)


def _trace(best, previous, aged, hold):
    """The levels, from the last frame back."""
    age, level = np.unravel_index(best.argmin(), best.shape)
    levels = []
    for frame in range(len(previous) - 1, -1, -1):
        levels.append(level)
        if age == hold - 1 and aged[frame, level]:
            continue
        if age == 0:
            level, age = previous[frame, level], hold - 1
        else:
            age -= 1
    return np.array(levels[::-1], dtype=np.int64)


def share_limit(
    levels: Sequence[int] | np.ndarray, faces: Sequence[np.ndarray], errors: Sequence[np.ndarray], limit: int
) -> np.ndarray:
    """(o,) levels with at most `limit` faces together, coarsened where the error grows least.

    levels (o,): those of each object without the limit; faces, errors: one (l_o,) per object, finest first. Repeatedly
    that object takes its next coarser level whose error is then the smallest; of equal ones, that which saves the most
    faces. Where errors grow from level to level, the worst error is thus the smallest that the limit allows.
    """
    levels = np.array(levels)
    total = sum(counts[level] for counts, level in zip(faces, levels, strict=True))
    while total > limit:
        prices = [_price(counts, error, level) for counts, error, level in zip(faces, errors, levels, strict=True)]
        chosen = prices.index(min(prices))
        if not np.isfinite(prices[chosen][0]):
            break
        total += faces[chosen][levels[chosen] + 1] - faces[chosen][levels[chosen]]
        levels[chosen] += 1
    return levels


def _price(faces, errors, level):
    """(error, minus the faces saved) of the next coarser level; infinite where there is none."""
    if level + 1 >= len(faces):
        return np.inf, 0
    return errors[level + 1], faces[level + 1] - faces[level]
