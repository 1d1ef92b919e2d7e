"""Channel weights from the likeness of a conspicuity map to the ground truth's saliency map (T3.2.1.2 to T3.2.1.4)."""

import numpy as np
from skimage.metrics import structural_similarity

from .euclidean import average, checked_maps

WINDOW = 11  # pixels, what sigma 1.5 takes in scikit-image; Wang et al. 2004, T [63], and MATLAB's ssim


def view_similarities(maps, gts, mask=None):
    """SSIM of each channel's map with the ground truth's in one view: dict channel -> likeness in -1..1.

    maps: dict channel -> (h, w) in 0..1; gts (h, w) in 0..1, the ground truth saliency map (T3.2.1.3), both zero off
    the object. SSIM is that of Wang et al. 2004 with their Gaussian window, T [63].

    mask None is the thesis's way: the mean over the whole image. Black background is then perfectly alike, and so is
    a dark map to the dark part of the ground truth: over 36 views of six objects, noise on the whole object got 0.82,
    a map with one bright pixel 0.98. mask (h, w) boolean, the object: the mean over its pixels alone, which takes the
    background out (noise 0.01), though not the reward for darkness on the object (one pixel 0.86). A flat map gets 0
    whatever SSIM says: it has nothing to say, and would have the highest weight.

    A view without ground truth (gts zero everywhere) has no likeness: {}. Raises ValueError for maps that
    stages.weights.euclidean refuses, that leave 0..1 or are smaller than the window, and for a ground truth or mask
    that checked_truth refuses.
    """
    maps, shape = checked_maps(maps)
    gts, mask = checked_truth(gts, mask, shape)
    if min(shape) < WINDOW:
        raise ValueError(f"maps of {shape[0]} x {shape[1]} pixels are smaller than SSIM's window of {WINDOW}")
    if any(values.min() < 0 or values.max() > 1 for values in maps.values()):
        raise ValueError("maps must lie in 0..1")
    if not gts.any():
        return {}
    return {channel: _likeness(values, gts, mask) for channel, values in maps.items()}


def _likeness(values, gts, mask):
    if np.ptp(values) == 0:
        return 0.0
    settings = {"data_range": 1.0, "gaussian_weights": True, "sigma": 1.5, "use_sample_covariance": False}
    mean, local = structural_similarity(values, gts, full=True, **settings)
    return float(mean if mask is None else local[mask].mean())


def similarity_weights(views):
    """The likeness averaged over views, at least zero: dict channel -> weight in 0..1 (T table 3.1, second column).

    views: the dicts of view_similarities, each view counts alike; an empty one is left out. A channel that is on the
    whole the ground truth's opposite gets 0, since eq. 3.9 has no place for negative weights. For several objects
    `average` the objects' weights (stages.weights.euclidean).

    Raises ValueError when no view has a ground truth, or the views name different channels.
    """
    return {channel: max(value, 0.0) for channel, value in average(views).items()}


def checked_truth(gts, mask, shape):
    """(gts (h, w) f8, mask (h, w) boolean or None); ValueError for another shape than the maps', or a gts off 0..1."""
    gts = np.asarray(gts, dtype=np.float64)
    mask = None if mask is None else np.asarray(mask, dtype=bool)
    if gts.shape != shape or (mask is not None and mask.shape != shape):
        raise ValueError(f"maps are {shape}, ground truth {gts.shape}, mask {np.shape(mask)}: they must agree")
    if not (gts.min() >= 0 and gts.max() <= 1):
        raise ValueError(f"the ground truth must lie in 0..1, got {gts.min():g} to {gts.max():g}")
    if mask is not None and not mask.any():
        raise ValueError("the mask holds no pixel of the object")
    return gts, mask
