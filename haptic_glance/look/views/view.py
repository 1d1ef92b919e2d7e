"""A rendered view, the material of its surface, and the rounding that both renderers share.

A material is matte by default, with a highlight where a setting asks for one.
"""

from dataclasses import astuple, dataclass
from functools import cached_property
from math import ceil, floor

import numpy as np

from ..camera import DISTANCE, Viewpoint

BACKGROUNDS = {"black": 0, "grey": 128, "white": 255}
DEPTH_STEP = 2.0**-16  # of a unit: 1.3 % of a pixel at 900 rows; exact in float32, so views are stored without loss


@dataclass(frozen=True, eq=False)
class View:
    """A rendered image of a mesh.

    Attributes
    ----------
    rgb : (h, w, 3) array of uint8
        Colours.
    depth : (h, w) array of float
        Distance from the camera plane in units of the mesh, inf off the object.
    face : (h, w) array of int
        Id of the visible face, -1 off the object.
    viewpoint : Viewpoint
        The viewpoint.
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


def pixel_box(places: np.ndarray, size: tuple[int, int]) -> tuple[int, int, int, int]:
    """(top, left, bottom, right) of the pixels that a mesh can cover, the last two exclusive; zeros without corners.

    places (3, k): rows, columns and depths of the vertices that lie in a face, see haptic_glance.look.camera.project.
    Raises ValueError when the mesh leaves the frame or extends behind the camera: an image never crops its object.
    """
    if not places.size:
        return 0, 0, 0, 0
    (top, left, near), (bottom, right, far) = places.min(axis=1).tolist(), places.max(axis=1).tolist()
    rows, columns = size
    if min(top, left) < -0.5 or bottom > rows - 0.5 or right > columns - 0.5 or near <= 0 or far >= 2 * DISTANCE:
        needs = f"rows {top:.0f}..{bottom:.0f}, columns {left:.0f}..{right:.0f}"
        raise ValueError(
            f"the mesh leaves the frame of {rows} x {columns} pixels ({needs}): normalise it with "
            "haptic_glance.normalise (bounding sphere of radius 0.5 at the origin), or choose a wider image"
        )
    return max(ceil(top), 0), max(ceil(left), 0), min(floor(bottom) + 1, rows), min(floor(right) + 1, columns)


@dataclass
class Material:
    """How a surface reflects the head light; the default is Lambert's, matte. The names are MATLAB's (T3.1.5).

    A point of colour C, whose normal has the cosine c to the light, has the brightness C (ambient + diffuse c) + white
    specular c^shininess, at most white. That is the model of Blinn (Models of light reflection for computer synthesized
    pictures, SIGGRAPH 1977): the half vector of a head light is the view axis. Raises ValueError for a share of the
    light outside 0..1, and for a shininess outside 1..1000.
    """

    ambient: float = 0.0  # share of the light that comes from all sides
    diffuse: float = 1.0  # share of the head light that leaves in the surface's own colour
    specular: float = 0.0  # share of the head light in the middle of a highlight, which is white
    shininess: float = 20.0  # exponent: the higher, the smaller the highlight; 5 to 20 are usual

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            low, high = (1, 1000) if name == "shininess" else (0, 1)
            if not low <= value <= high:
                raise ValueError(f"{name}={value} of a material must be between {low} and {high}")

    @property
    def values(self) -> np.ndarray:
        """(4,) f8: ambient, diffuse, specular, shininess."""
        return np.array(astuple(self), dtype=np.float64)


LAMBERT = Material()
