"""Other methods to choose the levels of a scene: all faces, the usual share by distance, a model's count."""

from collections.abc import Callable, Sequence

import numpy as np

from haptic_glance.lod.scene.chain import Level
from haptic_glance.lod.scene.frames import Frames, Plan

HALVINGS = 14  # of the span of the tuned factor, which is then known to 0.1 %
SPAN = (1e-3, 1e3)


def full(frames: Frames) -> Plan:
    """The Plan with all faces of every object."""
    return Plan(np.zeros(frames.shape, dtype=np.int64), tuple((level,) for level in frames.full), frames)


def uniform(frames: Frames, chains: Sequence[Sequence[Level]], full_detail: float, by_size: bool = False) -> Plan:
    """The usual practice: every object reduced to the same share of faces, chosen by its distance alone.

    chains: the levels of each object, the same from which a budget chooses. All faces up to the distance `full_detail`,
    in metres, half of them at twice that, a quarter at four times, and so on, by the nearest level: the error on the
    surface is about inversely proportional to the faces, and on the screen to the distance. by_size: distances in
    lengths of the object, so that the size on the screen decides, as in game engines.
    """
    distance = frames.distance
    if by_size:
        distance = distance / [placed.size for placed in frames.scene.objects]
    return by_counts(frames, chains, np.minimum(full_detail / distance, 1) * [chain[0].faces for chain in chains])


def by_counts(frames: Frames, chains: Sequence[Sequence[Level]], counts: np.ndarray) -> Plan:
    """The Plan of the levels nearest, in ratio, to the face counts (frames, objects)."""
    faces = [np.log([level.faces for level in chain]) for chain in chains]
    nearest = [np.abs(np.log(column)[:, None] - own).argmin(axis=1)
               for own, column in zip(faces, counts.T, strict=True)]  # fmt: skip
    return Plan(np.stack(nearest, axis=1), chains, frames)


def equal(plan: Plan, limit: int) -> Plan:
    """The Plan with the same count for all objects in view in each frame that has more than `limit` faces.

    Each takes its finest level of at most that count, the largest with which the frame is within the limit.
    """
    levels = plan.levels.copy()
    for frame in np.flatnonzero(plan.faces.sum(axis=1) > limit):
        visible = np.flatnonzero(plan.frames.in_view[frame])
        chains = [[level.faces for level in plan.chains[item]] for item in visible.tolist()]
        for count in sorted({count for counts in chains for count in counts}, reverse=True):
            chosen = [next((k for k, n in enumerate(counts) if n <= count), len(counts) - 1) for counts in chains]
            if sum(counts[k] for counts, k in zip(chains, chosen, strict=True)) <= limit:
                levels[frame, visible] = chosen
                break
    return Plan(levels, plan.chains, plan.frames)


def tune(plan_of: Callable[[float], Plan], measure: Callable[[Plan], float], target: float) -> Plan:
    """The Plan of `plan_of(factor)` whose `measure` is closest to `target` from above: no more faces than at equality.

    Larger factors must give coarser plans. Where even the coarsest has less error, that one.
    """
    low, high = np.log(SPAN)
    coarse = plan_of(float(np.exp(high)))
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        plan = plan_of(float(np.exp(middle)))
        if measure(plan) >= target:
            high, coarse = middle, plan
        else:
            low = middle
    return coarse


def tune_below(plan_of: Callable[[float], Plan], measure: Callable[[Plan], float], limit: float) -> Plan:
    """As `tune`: the coarsest Plan found whose `measure` is at most `limit`."""
    low, high = np.log(SPAN)
    fine = plan_of(float(np.exp(low)))
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        plan = plan_of(float(np.exp(middle)))
        if measure(plan) <= limit:
            low, fine = middle, plan
        else:
            high = middle
    return fine
