"""The surface points under the pixels of a view, and conspicuity maps of values at these points."""

from dataclasses import dataclass

import numpy as np

from stages.kit import Mesh
from stages.kit.camera import DISTANCE, screen_position
from stages.views import View

from .background import fill
from .cropped_view import cropped_view
from .kernels import locate_pixels
from .operators import OUTPUT_SCALE, centre_surround, normalise, pyramid
from .weak_cache import weak_cache

FLOOR = 0.02  # of the range of the values; a flatter map is noise of the mesh
SCALE = 1  # one scale finer than centre-surround starts at, so that small faces are not aliased


@dataclass(frozen=True)
class VisibleSurface:
    """The k surface points that a view shows: at the true pixels of known (h, w), of the crop at SCALE, in order.

    faces (k,), weights (k, 3) barycentric, points (k, 3), back (3,) the direction from the surface to the camera.
    """

    known: np.ndarray
    faces: np.ndarray
    weights: np.ndarray
    points: np.ndarray
    back: np.ndarray


@weak_cache
def visible_surface(view: View, mesh: Mesh) -> VisibleSurface:
    """The VisibleSurface of a view of a mesh. Raises ValueError when the view has faces that the mesh does not have."""
    if view.face.max(initial=-1) >= len(mesh.faces):
        raise ValueError(
            f"the view shows face {view.face.max()}, the mesh has {len(mesh.faces)} faces: render this mesh again"
        )
    box, step = cropped_view(view).box, 2**SCALE
    face = view.face[box][::step, ::step]
    known = face >= 0
    rows, columns = np.nonzero(known)
    rows, columns = rows * step + box[0].start, columns * step + box[1].start
    right, up = screen_position(rows, columns, view.face.shape)
    heights, axes = DISTANCE - view.depth[rows, columns].astype(np.float64), view.viewpoint.axes
    geometry = mesh.vertices, mesh.faces, mesh.face_crosses
    points, weights = locate_pixels(right, up, heights, axes, face[known], *geometry)
    return VisibleSurface(known, face[known], weights, points, axes[2])


def surface_conspicuity(
    values: np.ndarray, mesh: Mesh, view: View, filled: bool = True, on_centre: bool = False
) -> np.ndarray:
    """Centre-surround and N of values (k,) at the points of visible_surface: a map (h / 16, w / 16) f4 (T3.1.1).

    on_centre: see stages.conspicuity.operators.centre_surround. The values extend into the background; with
    filled=False it is zero.
    """
    image, known = cropped_view(view), visible_surface(view, mesh).known
    image_values = np.zeros(known.shape, dtype=np.float32)
    image_values[known] = values
    image_values = fill(image_values, known) if filled else image_values
    summed = centre_surround(pyramid(image_values, SCALE), image.cover, FLOOR, on_centre)
    return image.place_in_view(normalise(summed, image.cover[OUTPUT_SCALE]), OUTPUT_SCALE)
