"""The array pressed on a mesh, and at the same places of the whole object, with its seconds."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.spatial import KDTree

from haptic_glance.base.timing import Stopwatch
from haptic_glance.know import features
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.touch import Surface, press_many, touchable

from .space import Choice, settings_of


def press_both(
    mesh: Mesh, whole: Mesh, points: np.ndarray, choice: Choice, before: Sequence[float]
) -> dict[str, np.ndarray]:
    """Arrays of the touches at vertices (k,) of a mesh, and at the nearest vertices of the whole one.

    before: the seconds that it took to come so far, which those of pressing follow.
    """
    sensor = settings_of(choice).imprints
    cells = sensor.cells[0], sensor.cells[1]
    with Stopwatch() as once:
        surface = Surface(replace(whole))
        near = whole.used[KDTree(whole.vertices[whole.used]).query(mesh.vertices[points])[1]]
        can = touchable(surface.mesh, near)
    rank = np.flatnonzero(can & touchable(mesh, points))
    with Stopwatch() as each:
        asked = features(press_many(surface, near[rank], cells, sensor.pitch, contact=sensor.contact))
    learned = asked
    if mesh is not whole:
        learned = features(press_many(Surface(mesh), points[rank], cells, sensor.pitch, contact=sensor.contact))
    seconds = np.array([*before, once.seconds, each.seconds / max(len(rank), 1)])
    return {"learned": learned, "asked": asked, "places": mesh.vertices[points[rank]], "rank": rank,
            "faces": np.array(len(mesh.faces)), "seconds": seconds}  # fmt: skip
