"""Hypotheses that move, where position or size are unknown: drawn, drawn anew where they are likely, and refined.

A particle filter with resampling and Metropolis moves (Gilks and Berzuini, Following a moving target, 2001).
"""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.special import logsumexp

from haptic_glance.base.rng import rng

from .hypotheses import Hypotheses
from .planner import draw

if TYPE_CHECKING:
    from .library import Library

FIRST, KEPT = 30_000, 4_000  # hypotheses before the first touch at least, and after they are drawn anew
SCARCE = 0.25  # of the hypotheses: effectively fewer are drawn anew
MOVES = (1.0, 0.3)  # sizes of the moves after that, in turn
ANGLE, SHARE = 6.0, 0.3  # degrees of a move's rotation; shares of the tolerances
Evidence = Callable[["Library", Hypotheses, Any], np.ndarray]


def first_particles(library: "Library") -> Hypotheses:
    """Each object in each pose of the grid, some times, each time with a shift and a size within the tolerances."""
    grid = library.hypotheses
    ids = np.tile(np.arange(len(grid)), max(1, -(-FIRST // len(grid))))
    random, some = rng(0, f"particles {len(ids)}"), grid[ids]
    shifts = library.position * random.uniform(-1, 1, (len(ids), 3))
    sizes = 1 + library.size * random.uniform(-1, 1, len(ids))
    return Hypotheses(some.objects, some.poses, some.rotations, shifts, sizes)


def refined(
    library: "Library", hypotheses: Hypotheses, log_weights: np.ndarray, touches: Sequence, evidence: Evidence
) -> tuple[Hypotheses, np.ndarray]:
    """(Hypotheses, log weights (h,)) that are drawn anew and moved, if few of them have nearly all of the weight.

    The sum of the weights stays. evidence(library, hypotheses, touch): the weighted log likelihood of a touch.
    """
    total = logsumexp(log_weights)
    weights = np.exp(log_weights - total)
    if 1 / (weights**2).sum() > SCARCE * min(len(weights), KEPT):
        return hypotheses, log_weights
    random = rng(len(touches), "moves")
    ids, shares = draw(weights, KEPT, random)
    here = hypotheses[np.repeat(ids, np.rint(shares * KEPT).astype(int))]
    felt = sum(evidence(library, here, touch) for touch in touches)
    for size in MOVES:
        there = _moved(library, here, size, random)
        inside = (np.abs(there.shifts) <= library.position).all(axis=1) & (np.abs(there.sizes - 1) <= library.size)
        moved = np.full(len(here), -np.inf)
        ids = np.flatnonzero(inside)
        moved[ids] = sum(evidence(library, there[ids], touch) for touch in touches)
        taken = np.log(random.random(len(here))) < moved - felt
        here, felt = _chosen(here, there, taken), np.where(taken, moved, felt)
    return here, np.full(len(here), total - np.log(len(here)))


def _moved(library, here, size, random):
    """Each hypothesis a random step away, of the object that it is."""
    count = len(here)
    turns = np.radians(ANGLE) * size * random.normal(size=(count, 3)) * library.freedom
    steps = Rotation.from_rotvec(turns).as_matrix()
    shifts = here.shifts + SHARE * size * library.position * random.normal(size=(count, 3))
    sizes = here.sizes + SHARE * size * library.size * random.normal(size=count)
    return Hypotheses(here.objects, here.poses, steps @ here.rotations, shifts, sizes)


def _chosen(here, there, taken):
    """The second where `taken`, else the first."""
    return Hypotheses(
        here.objects, here.poses, np.where(taken[:, None, None], there.rotations, here.rotations),
        np.where(taken[:, None], there.shifts, here.shifts), np.where(taken, there.sizes, here.sizes),
    )  # fmt: skip
