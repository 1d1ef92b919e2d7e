"""Rivals of our plan: all faces, the usual share by distance, and a model's counts; tuned to an equal error."""

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
    nearest = [np.abs(np.log(column)[:, None] - log_faces).argmin(axis=1)
               for log_faces, column in zip(faces, counts.T, strict=True)]  # fmt: skip
    return Plan(np.stack(nearest, axis=1), chains, frames)


def tune(
    plan_of: Callable[[float], Plan], measure: Callable[[Plan], float], target: float, below: bool = False
) -> Plan:
    """The Plan of `plan_of(factor)` whose `measure` is closest to `target` from above: no more faces than at equality.

    Larger factors must give coarser plans. The coarsest Plan is returned where even it has less error. below: return
    the coarsest Plan found whose `measure` is at most `target`.
    """
    valid_end, other_end = np.log(SPAN) if below else np.log(SPAN)[::-1]
    best = plan_of(float(np.exp(valid_end)))
    for _ in range(HALVINGS):
        middle = (valid_end + other_end) / 2
        plan = plan_of(float(np.exp(middle)))
        if measure(plan) <= target if below else measure(plan) >= target:
            valid_end, best = middle, plan
        else:
            other_end = middle
    return best
