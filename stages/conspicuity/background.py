"""Keeps the background out of filters: extends the object's values into it, without a step at the silhouette."""

import cv2
import numpy as np

from .operators import down

FILLED, KEPT = BACKGROUNDS = ("filled", "kept")
MIN_WEIGHT = 1e-3  # a coarse pixel with less known weight is unknown; far above rounding in single precision


def check_background(name: str) -> None:
    """Raises ValueError unless `name` is one of BACKGROUNDS."""
    if name not in BACKGROUNDS:
        raise ValueError(f"conspicuity.background={name!r}: choose one of {', '.join(BACKGROUNDS)}")


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
