"""Successive halving with several aims: which choices of a round are asked about again, with more objects and splits.

Optuna prunes no study of several objectives, so what goes on is chosen here: the choices that no other dominates come
first, and of those alike the ones that stand farthest from the others (Deb and others, NSGA-II, 2002).
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Literal, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from haptic_glance.know.split import Split
from stages.kit.run import Rows

from .known import Effort

Key = TypeVar("Key")

RUNGS = {  # each asks a third of the choices of the one before
    "wide": Effort(shapes=12, sixes=2, regions=3, folds=3),
    "narrow": Effort(shapes=18, sixes=6, regions=4, folds=6),
    "last": Effort(shapes=20, sixes=10, regions=6, folds=12),
}
SHARE = 3  # one in so many goes on
CONFIRMATION = RUNGS["last"]
# Of what `aims` gives.
DIRECTIONS: Sequence[Literal["maximize", "minimize"]] = ("maximize", "maximize", "minimize", "minimize", "minimize")
WITHIN = 0.02  # accuracy that the smallest choice may lack of the best one's


def aims(rows: Rows) -> list[float]:
    """Accuracy on unseen regions and on unseen objects, seconds to know one object, faces of its model, touches.

    Means over the objects. Accuracy 0 where no split could be drawn: what cannot be asked about is no good.
    """
    found = [_mean([row["value"] for row in rows if row["split"] == split]) for split in (Split.REGIONS, Split.OBJECTS)]
    return [*found, *(_mean([row[key] for row in rows]) for key in ("seconds", "faces", "touches"))]


def losses(rows: Iterable[Rows]) -> np.ndarray:
    """(k, 5) the `aims` of the rows of k choices, each with less as the better."""
    signs = np.array([-1 if direction == "maximize" else 1 for direction in DIRECTIONS])
    return signs * np.array([aims(own) for own in rows])


def smallest_of(rows: Mapping[Key, Rows]) -> Key:
    """The choice of the fewest seconds whose accuracy, the mean of both kinds, is WITHIN that of the best one."""
    found = {choice: aims(own) for choice, own in rows.items()}
    score = {choice: (regions + objects) / 2 for choice, (regions, objects, *_) in found.items()}
    near: list[Any] = [choice for choice in found if score[choice] >= max(score.values()) - WITHIN]
    return min(near, key=lambda choice: (found[choice][2:], choice))


def _mean(values):
    numbers = [value for value in values if value is not None and value == value]
    return float(np.mean(numbers)) if numbers else 0.0


def ranks(losses: ArrayLike) -> np.ndarray:
    """(k,) i8: 0 for the choices that no other dominates, 1 for those that only these do, and so on.

    losses (k, aims), less is better. One choice dominates another that is nowhere better and somewhere worse.
    """
    losses = np.asarray(losses, dtype=np.float64)
    no_worse = (losses[:, None] <= losses[None]).all(axis=2)
    dominates = np.logical_and(no_worse, (losses[:, None] < losses[None]).any(axis=2))
    found = np.full(len(losses), -1)
    for rank in range(len(losses)):
        left = found < 0
        found[left & ~dominates[left].any(axis=0)] = rank
    return found


def crowding(losses: ArrayLike) -> np.ndarray:
    """(k,) how far each choice stands from its neighbours, summed over the aims; inf at the ends of an aim."""
    losses = np.asarray(losses, dtype=np.float64)
    found = np.zeros(len(losses))
    for column in losses.T:
        order = np.argsort(column, kind="stable")
        span = np.ptp(column)
        if span == 0:
            continue
        found[order[[0, -1]]] = np.inf
        found[order[1:-1]] += (column[order[2:]] - column[order[:-2]]) / span
    return found


def best_share(losses: ArrayLike) -> np.ndarray:
    """Ids of one in SHARE of the choices (at least one), rising: by rank, of equals the least crowded first."""
    losses = np.asarray(losses, dtype=np.float64)
    rank = ranks(losses)
    apart = np.zeros(len(losses))
    for one in np.unique(rank):
        apart[rank == one] = crowding(losses[rank == one])
    order = np.lexsort((-apart, rank))
    return np.sort(order[: max(1, len(losses) // SHARE)])
