"""The View that a renderer returns, and the checks and rounding that both renderers share."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stages.kit import Mesh, Viewpoint
from stages.kit.camera import DISTANCE, project

BACKGROUNDS = {"black": 0, "grey": 128, "white": 255}
DEPTH_STEP = 2.0**-16  # of a unit: 1.3 % of a pixel at 900 rows; exact in float32, so views are stored without loss


@dataclass(frozen=True, eq=False)
class View:
    """A rendered image of a mesh.

    rgb (h, w, 3) u1; depth (h, w) f4, distance from the camera plane in units of the mesh, inf off the object;
    face (h, w) i4, the id of the visible face, -1 off the object; viewpoint, the stages.kit.Viewpoint.
    """

    rgb: np.ndarray
    depth: np.ndarray
    face: np.ndarray
    viewpoint: Viewpoint

    def __post_init__(self) -> None:
        if self.face.ndim != 2 or self.depth.shape != self.face.shape or self.rgb.shape != (*self.face.shape, 3):
            shapes = f"rgb {self.rgb.shape}, depth {self.depth.shape}, face {self.face.shape}"
            raise ValueError(f"a view needs rgb (h, w, 3), depth (h, w) and face (h, w), got {shapes}")

    @cached_property
    def mask(self) -> np.ndarray:
        """(h, w) boolean: the pixel is on the object."""
        return self.face >= 0


def empty_view(viewpoint: Viewpoint, size: tuple[int, int], background: str) -> View:
    """A view of the background only, for a renderer to fill in."""
    rgb = np.full((*size, 3), BACKGROUNDS[background], dtype=np.uint8)
    return View(rgb, np.full(size, np.inf, dtype=np.float32), np.full(size, -1, dtype=np.int32), viewpoint)


def round_depth(depth: np.ndarray) -> np.ndarray:
    """Depths rounded to multiples of DEPTH_STEP, as f4; inf stays inf."""
    return (np.rint(np.asarray(depth) / DEPTH_STEP) * DEPTH_STEP).astype(np.float32)


def pixel_box(mesh: Mesh, viewpoint: Viewpoint, size: tuple[int, int]) -> tuple[int, int, int, int]:
    """(top, left, bottom, right) of the pixels that the mesh can cover, the last two exclusive; zeros without faces.

    Raises ValueError when the mesh leaves the frame or extends behind the camera: an image never crops its object.
    """
    if not len(mesh.faces):
        return 0, 0, 0, 0
    rows, columns, depths = project(mesh.vertices[mesh.used], viewpoint, size)
    low = np.array([rows.min(), columns.min()])
    high = np.array([rows.max(), columns.max()])
    if (low < -0.5).any() or (high > np.array(size) - 0.5).any() or depths.min() <= 0 or depths.max() >= 2 * DISTANCE:
        needs = f"rows {low[0]:.0f}..{high[0]:.0f}, columns {low[1]:.0f}..{high[1]:.0f}"
        raise ValueError(
            f"the mesh leaves the frame of {size[0]} x {size[1]} pixels ({needs}): normalise it with "
            "stages.meshes.normalise (bounding sphere of radius 0.5 at the origin), or choose a wider image"
        )
    top, left = np.ceil(low).astype(int).clip(0)
    bottom, right = (np.floor(high).astype(int) + 1).clip(None, size)
    return int(top), int(left), int(bottom), int(right)
