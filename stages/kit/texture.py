"""Pictures on a surface: texture coordinates per face corner, so that a seam splits the picture and not the surface."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Texture:
    """What a mesh of m faces is painted with; a material of one plain colour is an image of one pixel.

    uv (m, 3, 2) f8, a pair per face corner: u to the right, v up, (0, 0) the lower left corner of the image, which
    repeats outside 0..1. image (m,) i8: which of the images a face shows. images: arrays (h, w, 4) u1, RGBA.
    """

    uv: np.ndarray
    image: np.ndarray
    images: tuple[np.ndarray, ...]

    def __post_init__(self) -> None:
        uv = np.ascontiguousarray(self.uv, dtype=np.float64)
        image = np.ascontiguousarray(self.image, dtype=np.int64)
        images = tuple(np.ascontiguousarray(one, dtype=np.uint8) for one in self.images)
        if uv.ndim != 3 or uv.shape[1:] != (3, 2) or not np.isfinite(uv).all():
            raise ValueError(f"uv must be finite and of shape (m, 3, 2), got {uv.shape}")
        if image.shape != uv.shape[:1]:
            raise ValueError(f"image must have shape {uv.shape[:1]}, got {image.shape}")
        if len(image) and not 0 <= image.min() <= image.max() < len(images):
            raise ValueError(f"image names pictures outside 0..{len(images) - 1}")
        if any(one.ndim != 3 or one.shape[2] != 4 or one.size == 0 for one in images):
            raise ValueError(f"images must have shape (h, w, 4), got {[one.shape for one in images]}")
        for name, value in (("uv", uv), ("image", image), ("images", images)):
            object.__setattr__(self, name, value)

    def of(self, faces: np.ndarray) -> "Texture":
        """The Texture of some faces: ids or (m,) boolean."""
        return Texture(self.uv[faces], self.image[faces], self.images)

    def turned(self, flips: np.ndarray) -> "Texture":
        """The Texture after the order of the corners was reversed in the faces (m,) boolean."""
        uv = self.uv.copy()
        uv[flips] = uv[flips][:, ::-1]
        return Texture(uv, self.image, self.images)

    def sample(self, faces: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """(k, 3) u1 RGB at texture coordinates uv (k, 2) on the images of faces (k,), nearest pixel."""
        found = np.empty((len(faces), 3), dtype=np.uint8)
        shown = self.image[faces]
        for number in np.unique(shown):
            here, (h, w) = shown == number, self.images[number].shape[:2]
            across, up = np.floor(uv[here] * (w, h)).astype(np.int64).T
            found[here] = self.images[number][(h - 1 - up) % h, across % w, :3]
        return found
