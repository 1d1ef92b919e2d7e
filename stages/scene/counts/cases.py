"""Test cases for models of the fewest faces, and the common power law by which one mesh is extrapolated.

A case is a measured point of a curve, whose right count is therefore known.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from haptic_glance.base.rng import rng

from .models import DISTANCES, FLOOR, FOCAL, Curve

HALF = 0.5  # share of the object's own faces: from there on a mesh is fine


@dataclass(frozen=True, eq=False)
class Case:
    """One test case: the face count for an error at a distance.

    curve: all measurements; given: those that a model may use, never the right count. needed: the right count. error
    over the diagonal, distance in diagonals, tolerance in pixels; points: dict combination -> number.
    """

    curve: Curve
    known: Curve
    needed: int
    error: float
    distance: float
    points: dict[str, int]

    @property
    def tolerance(self) -> float:
        """Pixels that the error covers at the distance."""
        return self.error * FOCAL / self.distance


def between(curves: Sequence[Curve], seed: int) -> list[Case]:
    """Cases at all measured counts but the lowest of each curve, the other counts given: none needs extrapolation.

    The lowest is left out, since a lookup without it has nothing below the right count.
    """
    cases = []
    for curve, points in _with_points(curves):
        for place in range(1, len(curve)):
            given_curve = curve.only(np.arange(len(curve)) != place)
            cases.append(_case(curve, given_curve, curve.errors[place], points, seed))
    return _above_floor(cases)


def beyond(curves: Sequence[Curve], seed: int, fine: bool) -> list[Case]:
    """Cases outside the given range. fine: counts of half of the object's faces or more, with only lower ones given.

    Not fine: the other way round. Curves on one side alone have none.
    """
    cases = []
    for curve, points in _with_points(curves):
        outside = side(curve, fine)
        given_curve = curve.only(~outside)
        if given_curve is not None:
            cases += [_case(curve, given_curve, error, points, seed) for error in curve.errors[outside]]
    return _above_floor(cases)


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


def _case(curve, known, error, points, seed):
    needed_faces = curve.faces[curve.errors <= error][0]
    draw = rng(seed, f"{curve.object} {curve.method} {needed_faces}")
    distance = float(np.exp(draw.uniform(np.log(DISTANCES[0]), np.log(DISTANCES[-1]))))
    return Case(curve, known, int(needed_faces), float(error), distance, points)


def _above_floor(cases):
    return [case for case in cases if case.error > FLOOR]


def _with_points(curves):
    """(curve, dict combination -> number of points of the same object) of each curve."""
    points = {}
    for curve in curves:
        points.setdefault(curve.object, {})[curve.method] = curve.points
    return [(curve, points[curve.object]) for curve in curves]


def power_law(curves: Sequence[Curve]) -> float:
    """x of faces ~ error ** -x, the same for all objects: least squares of the logarithms about the mean of each curve.

    Errors below FLOOR are left out. Raises ValueError where no curve has two points of unequal error.
    """
    covariance, variance = 0.0, 0.0
    for curve in curves:
        above_floor = curve.errors > FLOOR
        if above_floor.any():
            errors, faces = np.log(curve.errors[above_floor]), np.log(curve.faces[above_floor])
            covariance += ((errors - errors.mean()) * (faces - faces.mean())).sum()
            variance += ((errors - errors.mean()) ** 2).sum()
    if variance == 0:
        raise ValueError(f"a power law needs a curve with two points above an error of {FLOOR:g}")
    return float(-covariance / variance)
