"""The cheapest sequence of levels of one object over the frames: within the tolerance, no pop, no flicker."""

import numpy as np

BROKEN = 1e9  # what one whole tolerance too much costs, in faces: no saving is worth a visible error


def cheapest(faces, errors, steps, tolerance, hold=1):
    """(f,) which level to show in each frame, the fewest faces in all.

    faces (f, l): what each level costs in each frame. errors (f, l): on the screen. steps (f, l, l): how far the
    picture jumps in frame f from one level to another. hold: frames that a level stays at least, so that an object near
    a threshold does not flicker (hysteresis; the first and the last stay may be shorter). An error or a step above the
    tolerance is taken only where every other sequence has more of it; an infinite error never, if there is any other.
    Exact, by dynamic programming over (level, frames since the last switch).
    """
    frames, count = errors.shape
    cost = faces + _penalty(errors, tolerance)
    jump = _penalty(steps, tolerance)
    none = np.arange(count)
    jump[:, none, none] = np.inf  # staying is no switch
    best = np.full((hold, count), np.inf)
    best[-1] = cost[0]
    came = np.zeros((frames, count), dtype=np.int64)  # the level before a switch
    aged = np.zeros((frames, count), dtype=bool)  # in the oldest state: it was that old before
    for frame in range(1, frames):
        switched = best[-1][:, None] + jump[frame]
        came[frame] = switched.argmin(axis=0)
        new = np.empty_like(best)
        if hold == 1:
            aged[frame] = best[0] <= switched.min(axis=0)
            new[0] = np.minimum(best[0], switched.min(axis=0))
        else:
            new[0], new[1:] = switched.min(axis=0), best[:-1]
            aged[frame] = best[-1] <= new[-1]
            new[-1] = np.minimum(new[-1], best[-1])
        best = new + cost[frame]
    return _trace(best, came, aged, hold)


def _penalty(values, tolerance):
    return BROKEN * np.maximum(values / tolerance - 1, 0)


def _trace(best, came, aged, hold):
    """The levels, from the last frame back."""
    age, level = np.unravel_index(best.argmin(), best.shape)
    levels = []
    for frame in range(len(came) - 1, -1, -1):
        levels.append(level)
        if age == hold - 1 and aged[frame, level]:
            continue
        if age == 0:
            level, age = came[frame, level], hold - 1
        else:
            age -= 1
    return np.array(levels[::-1], dtype=np.int64)


def share(levels, faces, errors, limit):
    """(o,) levels that cost no more than `limit` faces together: coarsened where it hurts least.

    levels (o,): what each object would have; faces, errors: a list of (l_o,) an object, finest first. Again and again
    the object takes its next coarser level whose error is then the least, so that the worst error is the least that the
    limit allows where errors grow from level to level; of equal ones, that which saves the most faces.
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
