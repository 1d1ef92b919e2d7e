"""The questions that the models are asked: measured points of curves, whose right answer is therefore known."""

from dataclasses import dataclass

import numpy as np

from stages.kit.rng import rng

from .curves import Curve
from .distance import focal_length
from .models import DISTANCES, FLOOR

HALF = 0.5  # share of the object's own faces: from there on a mesh counts as fine


@dataclass(frozen=True, eq=False)
class Case:
    """One question: for this error, at this distance, how many faces?

    curve: all that was measured; known: what a model may know of it, never the answer. needed: the right count.
    error over the diagonal, distance in diagonals, tolerance in pixels; points: dict combination -> number.
    """

    curve: Curve
    known: Curve
    needed: int
    error: float
    distance: float
    points: dict

    @property
    def tolerance(self):
        """Pixels that the error covers at the distance."""
        return self.error * focal_length() / self.distance


def between(curves, seed):
    """Cases at the measured counts but the fewest of each curve, with the other counts known: no one must extrapolate.

    The fewest is left out, since a lookup that does not know it has nothing below the answer.
    """
    found = []
    for curve, points in _with_points(curves):
        for place in range(1, len(curve)):
            known = curve.only(np.arange(len(curve)) != place)
            found.append(_case(curve, known, curve.errors[place], points, seed))
    return _above_floor(found)


def beyond(curves, seed, fine):
    """Cases outside the known range: fine asks for half of the object's faces or more when only fewer were measured.

    Not fine: the other way round. Curves that lie on one side alone have none.
    """
    found = []
    for curve, points in _with_points(curves):
        asked = side(curve, fine)
        known = curve.only(~asked)
        if known is not None:
            found += [_case(curve, known, error, points, seed) for error in curve.errors[asked]]
    return _above_floor(found)


def flat(curves, seed, error):
    """Cases on objects of flat sides, whose every measured mesh is exact: at any error their coarsest one would do."""
    exact = [(curve, points) for curve, points in _with_points(curves) if (curve.errors <= FLOOR).all()]
    return [_case(curve, curve, error, points, seed) for curve, points in exact]


def teaches(curve):
    """True where a curve has two points above rounding: below, there is no slope to learn and no case to ask."""
    return int((curve.errors > FLOOR).sum()) > 1


def side(curve, fine):
    """(k,) boolean: the points of a curve with half of the object's faces or more, or those with fewer."""
    return (curve.faces >= HALF * curve.initial_faces) == fine


def _case(curve, known, error, points, seed):
    needed = curve.faces[curve.errors <= error][0]
    draw = rng(seed, f"{curve.object} {curve.method} {needed}")
    distance = float(np.exp(draw.uniform(np.log(DISTANCES[0]), np.log(DISTANCES[-1]))))
    return Case(curve, known, int(needed), float(error), distance, points)


def _above_floor(cases):
    return [case for case in cases if case.error > FLOOR]


def _with_points(curves):
    """(curve, dict combination -> number of points of the same object) of each curve."""
    points = {}
    for curve in curves:
        points.setdefault(curve.object, {})[curve.method] = curve.points
    return [(curve, points[curve.object]) for curve in curves]
