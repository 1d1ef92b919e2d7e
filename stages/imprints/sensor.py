"""The sensors of the stage: the array of distances in its two contacts, and the older one of contours (T4.2.3.1)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from .contact import CONTACTS
from .distances import check_array, distances
from .frame import touchable
from .press import normalise
from .quasi_tangent import DEPTH, contour_imprints, spans_plane
from .surface import Surface

CONTOURS = "contours"
SENSORS = (*CONTACTS, CONTOURS)


@dataclass(frozen=True)
class Touched:
    """What a sensor feels at k vertices.

    can: (k,) boolean, where it can touch, t times. depths: (t, rows, cols) f4 in units. images: the same in 0..1, 0
    pressed first. reach: the depth of a cell with no surface in range.
    """

    can: np.ndarray
    depths: np.ndarray
    images: np.ndarray
    reach: float


def misfit(cells: Sequence[int], pitch: float) -> str:
    """What is wrong with an array that is longer than the object, of diameter 1; else ""."""
    length = max(cells) * pitch
    wrong = f"the array is {length:g} units long, the object 1: most cells will miss it; take fewer or a smaller pitch"
    return wrong if length > 1 else ""


def touch(surface: Surface, vertices: ArrayLike, cells: tuple[int, int], pitch: float, sensor: str) -> Touched:
    """What a sensor of SENSORS feels at vertices (k,): `press`, or `contour_imprints` of the sensor of T4.2.3.1."""
    mesh, (_, _, reach) = surface.mesh, check_array(cells, pitch)
    vertices = np.asarray(vertices)
    if sensor == CONTOURS:
        can = spans_plane(mesh, vertices)
        images, reach = contour_imprints(surface, vertices[can], cells, pitch), DEPTH * max(cells) * pitch
        return Touched(can, images * reach, images, reach)
    can = touchable(mesh, vertices)
    depths = distances(surface, vertices[can], cells, pitch, contact=sensor)
    return Touched(can, depths, normalise(depths, pitch), reach)
