"""From the surface of the mesh to the view: what lies under every second pixel of the object."""

from dataclasses import dataclass

import numpy as np

from stages.kit.camera import pixel_rays
from stages.kit.rays import barycentric

from .background import fill
from .memo import once
from .operators import COMMON, centre_surround, normalise, pyramid
from .picture import picture

FLOOR = 0.02  # of the values' range: flatter is noise of the mesh
SCALE = 1  # centre-surround begins at scale 2; one scale finer keeps small faces from flickering


@dataclass(frozen=True)
class Seen:
    """k points of the surface: known (h, w) boolean says at which pixels of the crop at SCALE they are, in order.

    faces (k,), weights (k, 3) barycentric, points (k, 3), back (3,) the direction from the surface to the camera.
    """

    known: np.ndarray
    faces: np.ndarray
    weights: np.ndarray
    points: np.ndarray
    back: np.ndarray


@once
def seen(view, mesh):
    """The surface that a view sees. Raises ValueError when the view names faces that the mesh does not have."""
    if view.face.max(initial=-1) >= len(mesh.faces):
        raise ValueError(
            f"the view shows face {view.face.max()}, the mesh has {len(mesh.faces)} faces: render this mesh again"
        )
    box, step = picture(view).box, 2**SCALE
    face = view.face[box][::step, ::step]
    known = face >= 0
    rows, columns = np.nonzero(known)
    rows, columns = rows * step + box[0].start, columns * step + box[1].start
    origins, directions = pixel_rays(rows, columns, view.viewpoint, view.face.shape)
    points = origins + view.depth[rows, columns, None].astype(np.float64) * directions
    weights = barycentric(mesh, face[known], points).clip(0, 1)
    weights /= weights.sum(axis=1, keepdims=True)
    return Seen(known, face[known], weights, points, view.viewpoint.axes[2])


def surface_conspicuity(values, mesh, view, filled=True, on_centre=False):
    """Centre-surround and N of values (k,) at the points of seen(view, mesh): the map (h / 16, w / 16) f4 (T3.1.1).

    on_centre: see stages.conspicuity.operators.centre_surround.
    The background takes the values of the surface beside it, unless filled=False, where it is zero.
    """
    image, known = picture(view), seen(view, mesh).known
    drawn = np.zeros(known.shape, dtype=np.float32)
    drawn[known] = values
    drawn = fill(drawn, known) if filled else drawn
    summed = centre_surround(pyramid(drawn, SCALE), image.cover, FLOOR, on_centre)
    return image.whole(normalise(summed, image.cover[COMMON]), COMMON)
