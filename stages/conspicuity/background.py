"""Keeps the background out of the filters: the object's values run on into it, without a step at the silhouette."""

import cv2
import numpy as np

from .operators import down

ENOUGH = 1e-3  # a coarse pixel with less known weight than this is unknown; far above rounding in single precision


def fill(image, known):
    """The image with its unknown pixels filled smoothly from the known ones; these stay as they are.

    Pull-push: normalised convolution down a pyramid until all is known, then back up (Gortler et al., The Lumigraph,
    SIGGRAPH 1996, section 3.4; Knutsson and Westin, Normalized and differential convolution, CVPR 1993). image (h, w)
    or (h, w, c) f4, known (h, w) boolean. Zero where nothing is known at all.
    """
    if known.all() or max(known.shape) == 1:
        return np.where(_like(known, image), image, 0)
    weight = known.astype(np.float32)
    image = image * _like(weight, image)
    pulled, share = down(image), down(weight)
    coarse = fill(pulled / _like(np.maximum(share, ENOUGH), pulled), share > ENOUGH)
    pushed = cv2.pyrUp(coarse, dstsize=known.shape[::-1])
    return np.where(_like(known, image), image, pushed)


def _like(plane, image):
    return plane if image.ndim == 2 else plane[..., None]
