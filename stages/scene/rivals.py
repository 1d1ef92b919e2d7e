"""Other ways to choose the levels of a scene: all faces, the usual share by distance, a model's count."""

import numpy as np

from .levels import Plan

HALVINGS = 14  # of the span of the one factor that is tuned: the tuned value is then within one in a thousand
SPAN = (1e-3, 1e3)


def full(frames):
    """The Plan that shows every object with all its faces."""
    return Plan(np.zeros(frames.shape, dtype=np.int64), tuple((level,) for level in frames.full), frames)


def uniform(frames, ladders, reach, by_size=False):
    """The usual practice: every object cut to the same share, chosen by its distance alone, whatever its shape.

    ladders: the levels of each object, the very ones that a budget chooses from. All faces up to the distance `reach`,
    in metres, half of them at twice that, a quarter at four times, and so on, by the nearest level: an error on the
    surface grows about as faces fall, and shrinks on the screen as the distance grows. by_size: distances in lengths of
    the object, so that it goes by the size on the screen, as game engines do.
    """
    distance = frames.distance
    if by_size:
        distance = distance / [placed.size for placed in frames.scene.objects]
    return by_counts(frames, ladders, np.minimum(reach / distance, 1) * [ladder[0].faces for ladder in ladders])


def by_counts(frames, ladders, counts):
    """The Plan of the levels that lie nearest, in ratio, to the wanted face counts (frames, objects)."""
    faces = [np.log([level.faces for level in ladder]) for ladder in ladders]
    nearest = [np.abs(np.log(column)[:, None] - own).argmin(axis=1)
               for own, column in zip(faces, counts.T, strict=True)]  # fmt: skip
    return Plan(np.stack(nearest, axis=1), ladders, frames)


def equal(plan, limit):
    """The Plan with `limit` faces shared equally in each frame that has more: the same count for all objects in view.

    Each takes its finest level of no more than that count, the largest with which the frame holds the limit.
    """
    levels = plan.levels.copy()
    for frame in np.flatnonzero(plan.faces.sum(axis=1) > limit):
        seen = np.flatnonzero(plan.frames.in_view[frame])
        ladders = [[level.faces for level in plan.ladders[item]] for item in seen]
        for count in sorted({count for counts in ladders for count in counts}, reverse=True):
            chosen = [next((k for k, n in enumerate(counts) if n <= count), len(counts) - 1) for counts in ladders]
            if sum(counts[k] for counts, k in zip(ladders, chosen, strict=True)) <= limit:
                levels[frame, seen] = chosen
                break
    return Plan(levels, plan.ladders, plan.frames)


def tune(plan_of, measure, wanted):
    """The Plan of `plan_of(factor)` whose `measure` is closest to `wanted` from above: no more faces than at equality.

    Larger factors must give coarser plans. Where even the coarsest has less error, that one.
    """
    low, high = np.log(SPAN)
    coarse = plan_of(np.exp(high))
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        plan = plan_of(np.exp(middle))
        if measure(plan) >= wanted:
            high, coarse = middle, plan
        else:
            low = middle
    return coarse


def tune_below(plan_of, measure, most):
    """As `tune`, the coarsest Plan found whose `measure` is at most `most`."""
    low, high = np.log(SPAN)
    fine = plan_of(np.exp(low))
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        plan = plan_of(np.exp(middle))
        if measure(plan) <= most:
            low, fine = middle, plan
        else:
            high = middle
    return fine
