"""Test cases for the models: measured points of curves, whose right count is therefore known."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from haptic_glance.base.rng import rng

from .curves import Curve
from .distance import focal_length
from .models import DISTANCES, FLOOR

HALF = 0.5  # share of the object's own faces: from there on a mesh is fine


@dataclass(frozen=True, eq=False)
class Case:
    """One test case: the face count for an error at a distance.

    curve: all measurements; given: those that a model may use, never the right count. needed: the right count. error
    over the diagonal, distance in diagonals, tolerance in pixels; points: dict combination -> number.
    """

    curve: Curve
    given: Curve
    needed: int
    error: float
    distance: float
    points: dict[str, int]

    @property
    def tolerance(self) -> float:
        """Pixels that the error covers at the distance."""
        return self.error * focal_length() / self.distance


def between(curves: Sequence[Curve], seed: int) -> list[Case]:
    """Cases at all measured counts but the lowest of each curve, the other counts given: none needs extrapolation.

    The lowest is left out, since a lookup without it has nothing below the right count.
    """
    found = []
    for curve, points in _with_points(curves):
        for place in range(1, len(curve)):
            given = curve.only(np.arange(len(curve)) != place)
            found.append(_case(curve, given, curve.errors[place], points, seed))
    return _above_floor(found)


def beyond(curves: Sequence[Curve], seed: int, fine: bool) -> list[Case]:
    """Cases outside the given range. fine: counts of half of the object's faces or more, with only lower ones given.

    Not fine: the other way round. Curves on one side alone have none.
    """
    found = []
    for curve, points in _with_points(curves):
        asked = side(curve, fine)
        given = curve.only(~asked)
        if given is not None:
            found += [_case(curve, given, error, points, seed) for error in curve.errors[asked]]
    return _above_floor(found)


def flat(curves: Sequence[Curve], seed: int, error: float) -> list[Case]:
    """Cases on objects with flat sides, whose measured meshes are all exact: the coarsest one is enough."""
    exact = [(curve, points) for curve, points in _with_points(curves) if (curve.errors <= FLOOR).all()]
    return [_case(curve, curve, error, points, seed) for curve, points in exact]


def is_informative(curve: Curve) -> bool:
    """Whether a curve has two points above rounding error: otherwise it has no slope to learn, and no case."""
    return int((curve.errors > FLOOR).sum()) > 1


def side(curve: Curve, fine: bool) -> np.ndarray:
    """(k,) boolean: the points of a curve with half of the object's faces or more, or those with fewer."""
    return (curve.faces >= HALF * curve.initial_faces) == fine


def _case(curve, given, error, points, seed):
    needed = curve.faces[curve.errors <= error][0]
    draw = rng(seed, f"{curve.object} {curve.method} {needed}")
    distance = float(np.exp(draw.uniform(np.log(DISTANCES[0]), np.log(DISTANCES[-1]))))
    return Case(curve, given, int(needed), float(error), distance, points)


def _above_floor(cases):
    return [case for case in cases if case.error > FLOOR]


def _with_points(curves):
    """(curve, dict combination -> number of points of the same object) of each curve."""
    points = {}
    for curve in curves:
        points.setdefault(curve.object, {})[curve.method] = curve.points
    return [(curve, points[curve.object]) for curve in curves]
