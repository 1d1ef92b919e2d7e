"""What a perturbation of touch is."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Felt:
    """Disturbed touches: images (k, rows, cols) in 0..1; positions (k, 3) where the robot takes them to be.

    None for the positions of the undisturbed touches.
    """

    images: np.ndarray
    positions: np.ndarray | None = None


@dataclass(frozen=True)
class Perturbation:
    """One thing that may differ between the touches that are known and those to be recognised.

    unit: of the severity; unharmed: the severity that changes nothing. disturb(touches, severity, draw) -> Felt; None
    where not the touches change but how many are known. learned: the disturbed touches are the known ones, and the
    clean ones are to be recognised. drawn: it is a matter of luck, so that several draws are made. moves: the
    positions change, so that it is also measured where they are features (T4.2.4, table 4.5).
    """

    unit: str
    unharmed: float
    disturb: Callable | None
    learned: bool = False
    drawn: bool = False
    moves: bool = False


def in_range(severity, low, high, what):
    """Raises ValueError unless low <= severity <= high."""
    if not low <= severity <= high:
        raise ValueError(f"{what} must lie in {low:g}..{high:g}, got {severity:g}")
