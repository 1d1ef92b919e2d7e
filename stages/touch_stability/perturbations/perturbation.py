"""The types of a perturbation of touch."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..touches import Touches


@dataclass(frozen=True)
class PerturbedTouches:
    """Disturbed touches: images (k, rows, cols) in 0..1; positions (k, 3) as the robot measures them, or None if
    they are those of the undisturbed touches.
    """

    images: np.ndarray
    positions: np.ndarray | None = None


@dataclass(frozen=True)
class Perturbation:
    """One difference between training and test touches.

    unit: of the severity; unharmed: the severity that changes nothing. apply(touches, severity, draw) gives
    PerturbedTouches; None if the number of training touches changes and not the touches. in_training: the disturbed
    touches are for training and the clean ones for testing. random_draws: the perturbation is random, so that several
    draws are made. moves_positions: the positions change, so that it is also tested with positions as features (T4.2.4,
    table 4.5).
    """

    unit: str
    unharmed: float
    apply: Callable[[Touches, float, int], PerturbedTouches] | None
    in_training: bool = False
    random_draws: bool = False
    moves_positions: bool = False


def check_range(severity: float, low: float, high: float, what: str) -> None:
    """Raises ValueError unless low <= severity <= high."""
    if not low <= severity <= high:
        raise ValueError(f"{what} must lie in {low:g}..{high:g}, got {severity:g}")
