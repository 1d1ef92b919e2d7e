"""A view cropped to its object and prepared for all channels: background filled, and in pyramids.

The object's values continue into the background without a step at the silhouette, so that no filter sees the
background.
"""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from haptic_glance.base.lazy import cv2
from haptic_glance.base.weak_cache import weak_cache
from haptic_glance.mesh.mesh import Mesh
from haptic_glance.mesh.rays import RayScene

from .. import camera
from ..camera import Viewpoint
from ..views import View
from .operators import OUTPUT_SCALE, down, pyramid

GRID = 2**OUTPUT_SCALE  # the crop starts on this grid, so that its pyramid is part of the pyramid of the view
MARGIN = 32  # pixels around the object, so that a filter at scale 4 sees the filled background, not the border
SILHOUETTE_BAND = 5 / 900  # of the image's rows: where shading fades to the silhouette; treated as background
COVERED = 0.1  # share of its footprint for a pyramid pixel to be on the object; keeps thin structures


@weak_cache
def cropped_view(view: View, filled: bool = True) -> "CroppedView":
    """The CroppedView of a view, shared by its channels. filled=False leaves the background as rendered."""
    return CroppedView(checked_rgb(view), view.mask, filled)


def checked_rgb(view: View) -> np.ndarray:
    """The rgb of a view. Raises ValueError when it is not of type uint8, or shows nothing of the object."""
    if view.rgb.dtype != np.uint8:
        raise ValueError(f"the rgb of a view must be of type uint8, got {view.rgb.dtype}")
    if not view.mask.any():
        raise ValueError("the view shows nothing of the object, so that it has no channel; `conspicuity` gives zeros")
    return view.rgb


class CroppedView:
    """The crop of a view around the object: rgb (h, w, 3) u1 with silhouette and background filled, and pyramids.

    The view shows some of the object. mask (h, w) boolean: the pixel is on the object; known (h, w) boolean: its colour
    is as rendered, not filled.
    """

    def __init__(self, rgb: np.ndarray, mask: np.ndarray, filled: bool) -> None:
        self.shape = mask.shape
        self.box = _box(mask)
        self.mask = np.ascontiguousarray(mask[self.box])
        self.known = core(self.mask, max(round(SILHOUETTE_BAND * len(mask)), 1)) if filled else np.ones_like(self.mask)
        rgb = rgb[self.box]
        red, green, blue = (rgb[..., k] for k in range(3))
        self.grey_only = not (((red != green) | (red != blue)) & self.mask).any()
        planes = rgb[..., 0] if self.grey_only else rgb
        self._planes = np.ascontiguousarray(planes)
        if filled:
            self._planes = np.rint(fill(planes.astype(np.float32), self.known)).astype(np.uint8)

    @cached_property
    def rgb(self) -> np.ndarray:
        """(h, w, 3) u1."""
        return cv2.merge([self._planes] * 3) if self.grey_only else self._planes

    @cached_property
    def intensity(self) -> np.ndarray:
        """(h, w) f4 in 0..1: (r + g + b) / 3 (T3.1.1)."""
        planes = (
            self._planes if self.grey_only else cv2.transform(self._planes.astype(np.float32), np.full((1, 3), 1 / 3))
        )
        return planes.astype(np.float32) / np.float32(255)

    @cached_property
    def luminance(self) -> np.ndarray:
        """(h, w) u1: luma of ITU-R BT.601, the usual grey image."""
        return self._planes if self.grey_only else cv2.cvtColor(self._planes, cv2.COLOR_RGB2GRAY)

    @cached_property
    def intensity_pyramid(self) -> dict[int, np.ndarray]:
        """{0..8: (h, w) f4}."""
        return pyramid(self.intensity)

    @cached_property
    def cover(self) -> dict[int, np.ndarray]:
        """{0..4: (h, w) boolean}: where the object is, at each scale."""
        shares = pyramid(self.mask.astype(np.float32), last=OUTPUT_SCALE)
        return {scale: share > COVERED for scale, share in shares.items()}

    def place_in_view(self, crop: np.ndarray, scale: int) -> np.ndarray:
        """A map of the crop at a scale as a map of the whole view at that scale, zero around the crop."""
        size = [-(-side // 2**scale) for side in self.shape]
        framed = np.zeros(size, dtype=np.float32)
        top, left = self.box[0].start >> scale, self.box[1].start >> scale
        framed[top : top + crop.shape[0], left : left + crop.shape[1]] = crop
        return framed

    def zero_map(self) -> np.ndarray:
        """A map of the view at the output scale that is zero everywhere."""
        return np.zeros([-(-side // GRID) for side in self.shape], dtype=np.float32)


def core(mask: np.ndarray, band: int) -> np.ndarray:
    """(h, w) boolean: the mask without its outermost `band` pixels; parts that would vanish stay unchanged."""
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * band + 1, 2 * band + 1))
    inner = cv2.erode(mask.astype(np.uint8), disc, borderType=cv2.BORDER_CONSTANT, borderValue=0)
    thick = cv2.dilate(cv2.dilate(inner, disc), np.ones((3, 3), np.uint8))
    return (inner > 0) | (mask & (thick == 0))


def _box(mask):
    """Slices of the object's bounding box with a margin, starting on the grid."""
    slices = []
    for axis in (1, 0):
        indices = np.flatnonzero(mask.any(axis=axis))
        start = max(indices[0] - MARGIN, 0) // GRID * GRID
        slices.append(slice(start, min(indices[-1] + 1 + MARGIN, len(mask) if axis else mask.shape[1])))
    return tuple(slices)


FILLED, KEPT = BACKGROUNDS = ("filled", "kept")
MIN_WEIGHT = 1e-3  # a coarse pixel with less known weight is unknown; far above rounding in single precision


def fill(image: np.ndarray, known: np.ndarray) -> np.ndarray:
    """The image with its unknown pixels filled smoothly from the known ones, which stay unchanged.

    Pull-push: normalised convolution down a pyramid until all pixels are known, then back up (Gortler et al., The
    Lumigraph, SIGGRAPH 1996, section 3.4; Knutsson and Westin, Normalized and differential convolution, CVPR 1993).
    image (h, w) or (h, w, c) f4, known (h, w) boolean. Zero when no pixel is known.
    """
    if known.all() or max(known.shape) == 1:
        return np.where(_like(known, image), image, 0)
    weight = known.astype(np.float32)
    image = image * _like(weight, image)
    pulled, share = down(image), down(weight)
    coarse = fill(pulled / _like(np.maximum(share, MIN_WEIGHT), pulled), share > MIN_WEIGHT)
    pushed = cv2.pyrUp(coarse, dstsize=known.shape[::-1])
    return np.where(_like(known, image), image, pushed)


def _like(plane, image):
    return plane if image.ndim == 2 else plane[..., None]


SAME_DEPTH = 1e-4  # units, a tenth of a pixel at 900 rows: depths closer than this are one surface


def facing(mesh: Mesh, viewpoints: Sequence[Viewpoint], scene: RayScene | None = None) -> np.ndarray:
    """(v, n) f8 in 0..1: the cosine between the line of sight of each view and the normal of each vertex; 0 if hidden.

    mesh: normalised. scene: the RayScene of the mesh if there is one already. Both sides of the surface count, since
    open meshes show their inside. Occlusion is tested by one exact ray per vertex.
    """
    scene = RayScene(mesh) if scene is None else scene
    cosines = np.zeros((len(viewpoints), len(mesh.vertices)))
    for row, viewpoint in zip(cosines, viewpoints, strict=True):
        back = viewpoint.axes[2]
        depth = camera.DISTANCE - mesh.vertices @ back
        origins = mesh.vertices + depth[:, None] * back
        hits = scene.cast(origins, np.broadcast_to(-back, origins.shape))
        visible = hits.distance >= depth - SAME_DEPTH
        row[visible] = np.abs(mesh.vertex_normals[visible] @ back)
    return cosines
